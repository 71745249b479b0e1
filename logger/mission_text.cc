// SPDX-License-Identifier: BSD-3-Clause
// Writes the list of a mission's fields in Protobuf's text format.
#include "logger/mission_text.h"

#include <utility>

#include "plan/mission_fields.h"
#include "text/shortest.h"

namespace ergocast {
namespace {

std::string place_text(const Eigen::Vector3d& x_m, bool planar) {
  return "x_m: " + shortest(x_m.x()) + " y_m: " + shortest(x_m.y()) +
         (planar ? "" : " z_m: " + shortest(x_m.z()));
}

/// A kind, with a line for each field.
class KindWriter : public FieldVisitor {
 public:
  KindWriter(const AgentKind& kind, bool planar) : planar_(planar) { list_fields(*this, kind); }

  std::string block() {
    enter("");
    return "  kind {\n" + fields_ + "  }\n";
  }

  void text(const Field& field, const std::string& value) { put(field.name, '"' + value + '"'); }
  void number(const Field& field, double value) {
    if (field.when.given) put(field.name, shortest(value));
  }
  /// A kind of its own may be a point, which the mission's vehicle is not.
  void choice(const Field& field, auto value, Words words) {
    put(field.name, std::data(words)[static_cast<std::size_t>(value)]);
  }
  void part(const Field& field, const std::optional<VehicleLimits>& vehicle) {
    if (!vehicle) return;
    part_ = std::string(field.name) + '.';
    list_fields(*this, *vehicle);
    part_.clear();
  }
  void part(const Field& field, const Battery& battery) {
    part_ = std::string(field.name) + '.';
    list_fields(*this, battery);
    part_.clear();
  }
  void places(const Field& xy, const Field&, const std::vector<Eigen::Vector3d>& places_m) {
    enter("");
    for (const Eigen::Vector3d& x_m : places_m)
      fields_ += "    " + std::string(xy.name) + " { " + place_text(x_m, planar_) + " }\n";
  }

 private:
  /// Closes the block that is open, and opens `block`, unless that is empty or open already.
  void enter(const std::string& block) {
    if (block == block_) return;
    if (!block_.empty()) fields_ += "    }\n";
    if (!block.empty()) fields_ += "    " + block + " {\n";
    block_ = block;
  }
  void put(const char* name, const std::string& value) {
    const std::string path = part_ + name;
    const std::size_t dot = path.find('.');
    enter(dot == std::string::npos ? "" : path.substr(0, dot));
    fields_ += (block_.empty() ? "    " : "      ") +
               (dot == std::string::npos ? path : path.substr(dot + 1)) + ": " + value + '\n';
  }

  bool planar_;
  std::string fields_, part_, block_;
};

class TextWriter : public FieldVisitor {
 public:
  explicit TextWriter(const Mission& mission) : mission_(mission) { list_fields(*this, mission); }

  /// All fields, each in its block.
  std::string all() {
    enter("");
    return text_;
  }

  void number(const Field& field, double value) {
    if (field.number > last_number_) put_last();
    if (is_given(field)) put(field.name, shortest(value));
  }
  void flag(const Field& field, bool value) {
    if (is_given(field)) put(field.name, value ? "true" : "false");
  }
  void choice(const Field& field, auto value, Words words) {
    if (is_given(field)) put(field.name, std::data(words)[static_cast<std::size_t>(value)]);
  }
  void text(const Field& field, const std::string& value) {
    put(field.name, '"' + value + '"');
    put("description", "\"\"");
    put("seed", std::to_string(mission_.seed));
  }
  void part(const Field&, const std::vector<AgentKind>& kinds) {
    for (const AgentKind& kind : kinds) {
      enter("agents");
      text_ += KindWriter(kind, mission_.domain.planar()).block();
    }
  }
  void part(const Field&, const HiddenObjects& objects) {
    if (objects.total() == 0) return;
    enter("world");
    text_ += "  objects {\n";
    if (objects.count > 0) text_ += "    count: " + std::to_string(objects.count) + '\n';
    for (const Eigen::Vector3d& x_m : objects.places_m)
      text_ += "    places {\n      x_m: " + shortest(x_m.x()) +
               "\n      y_m: " + shortest(x_m.y()) + "\n    }\n";
    if (objects.end_when_found > 0)
      text_ += "    end_when_found: " + std::to_string(objects.end_when_found) + '\n';
    if (const ObjectMotion& motion = objects.motion; motion.any()) {
      text_ += "    motion {\n      speed_mps: " + shortest(motion.speed_mps) + '\n';
      if (motion.persistence_s != ObjectMotion().persistence_s)
        text_ += "      persistence_s: " + shortest(motion.persistence_s) + '\n';
      text_ += "    }\n";
    }
    text_ += "  }\n";
  }
  void part(const Field& field, const auto& part) {
    part_ = std::string(field.name) + '.';
    list_fields(*this, part);
    put_last();
    part_.clear();
  }
  /// The centre of the contraction.
  void places(const Field&, const Field& z, const Eigen::Vector3d& center_m) {
    last_number_ = z.number;
    if (center_m == mission_.domain.center_m()) return put("contraction_center", "DOMAIN_CENTER");
    if (center_m.isZero(0)) return put("contraction_center", "COORDINATE_ORIGIN");
    put("contraction_center", "POINT");
    put("contraction_x_m", shortest(center_m.x()));
    put("contraction_y_m", shortest(center_m.y()));
    if (!mission_.domain.planar()) last_ = shortest(center_m.z());
  }
  void places(const Field&, const Field&, const std::vector<Eigen::Vector3d>& starts_m) {
    enter("agents");
    for (const Eigen::Vector3d& x_m : starts_m)
      text_ += "  starts { " + place_text(x_m, mission_.domain.planar()) + " }\n";
    put("agents.random_count", "0");
  }
  using FieldVisitor::derived;
  /// The number of ticks.
  void derived(const Field&, const Tick&) {
    put("duration_s", shortest(duration_s(mission_.timing)));
  }
  void derived(const Field&, const IndexedRings& walls) {
    const std::vector<int> depth = depths(walls);
    for (std::size_t i = 0; i < walls.size(); ++i) {
      enter("world");
      const bool is_hole = depth[i] % 2 == 1;
      if (is_hole) {
        text_ += "    holes {\n" + corners("      ", walls[i]) + "    }\n";
      } else {
        text_ += "  walls {\n" + corners("    ", walls[i]);
      }
      if (i + 1 == walls.size() || depth[i + 1] % 2 == 0) text_ += "  }\n";
    }
  }

 private:
  bool is_given(const Field& field) const {
    return field.when.given || (field.when.in_box && !mission_.domain.planar());
  }
  static std::string corners(const std::string& indent, const Ring& ring) {
    std::string text;
    for (const Eigen::Vector2d& corner_m : ring) {
      text += indent + "vertices { x_m: " + shortest(corner_m.x()) +
              " y_m: " + shortest(corner_m.y()) + " }\n";
    }
    return text;
  }
  /// Closes the block that is open, and opens `block`, unless that is empty or open already.
  void enter(const std::string& block) {
    if (block == block_) return;
    if (!block_.empty()) text_ += "}\n";
    if (!block.empty()) text_ += block + " {\n";
    block_ = block;
  }
  void put_last() {
    if (!last_.empty()) put("contraction_z_m", std::exchange(last_, {}));
  }
  void put(const char* name, const std::string& value) {
    const std::string path = part_ + name;
    const std::size_t dot = path.rfind('.');
    enter(dot == std::string::npos ? "" : path.substr(0, dot));
    text_ += (block_.empty() ? "" : "  ") + path.substr(dot + 1) + ": " + value + '\n';
  }

  const Mission& mission_;
  std::string text_, part_, block_;
  std::string last_;     // contraction_z_m, if it is yet to be written: …
  int last_number_ = 0;  // … after the fields of the law up to this number
};

}  // namespace

std::string mission_text(const Mission& mission) { return TextWriter(mission).all(); }

}  // namespace ergocast
