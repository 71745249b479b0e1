// SPDX-License-Identifier: BSD-3-Clause
// Writes the list of a mission's fields in Protobuf's text format.
#include "logger/mission_text.h"

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

  std::string text() {
    enter("");
    return "  kind {\n" + fields_ + "  }\n";
  }

  void kind_name(int, const char* name, const std::string& value) { put(name, '"' + value + '"'); }
  void number(int, const char* name, double value, const Limits&, bool given = true) {
    if (given) put(name, shortest(value));
  }
  void choice(int, const char* name, auto value, Words words, bool = true) {
    put(name, std::data(words)[static_cast<std::size_t>(value)]);
  }
  void own_vehicle(int, const char* name, const std::optional<VehicleLimits>& vehicle) {
    if (!vehicle) return;
    part_ = std::string(name) + '.';
    list_fields(*this, *vehicle);
    part_.clear();
  }
  void number_unless(int, const char* name, double value, const Limits&, double usual) {
    if (value != usual) put(name, shortest(value));
  }
  void stations(int, int, const char* name, const std::vector<Eigen::Vector3d>& places_m) {
    enter("");
    for (const Eigen::Vector3d& x_m : places_m)
      fields_ += "    " + std::string(name) + " { " + place_text(x_m, planar_) + " }\n";
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
  std::string text() {
    enter("");
    return text_;
  }

  void number(int, const char* name, double value, const Limits&, bool given = true) {
    if (given) put(name, shortest(value));
  }
  void number_unless(int, const char* name, double value, const Limits&, double usual) {
    if (value != usual) put(name, shortest(value));
  }
  void height(int, const char* name, double value, const Limits&, double) {
    if (!mission_.domain.planar()) put(name, shortest(value));
  }
  void flag(int, const char* name, bool value) { put(name, value ? "true" : "false"); }
  void choice(int, const char* name, auto value, Words words, bool given = true) {
    if (given) put(name, std::data(words)[static_cast<std::size_t>(value)]);
  }
  void seed(int, const char* name, std::uint64_t value) { put(name, std::to_string(value)); }
  void name(int, const char* name, const std::string& value) {
    put(name, '"' + value + '"');
    put("description", "\"\"");
  }
  void kinds(int, const char*, const std::vector<AgentKind>& kinds) {
    for (const AgentKind& kind : kinds) {
      enter("agents");
      text_ += KindWriter(kind, mission_.domain.planar()).text();
    }
  }
  void part(int, const char* name, const auto& part) {
    part_ = std::string(name) + '.';
    list_fields(*this, part);
    if (!last_.empty()) put("contraction_z_m", last_);
    last_.clear();
    part_.clear();
  }
  void contraction_center(int, int, const Eigen::Vector3d& center_m) {
    if (center_m == mission_.domain.center_m()) return put("contraction_center", "DOMAIN_CENTER");
    if (center_m.isZero(0)) return put("contraction_center", "COORDINATE_ORIGIN");
    put("contraction_center", "POINT");
    put("contraction_x_m", shortest(center_m.x()));
    put("contraction_y_m", shortest(center_m.y()));
    if (!mission_.domain.planar()) last_ = shortest(center_m.z());
  }
  void duration(int, const Timing& timing) { put("duration_s", shortest(duration_s(timing))); }
  void walls(int, const char*, const Rings& walls) {
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
  void starts(int, int, const std::vector<Eigen::Vector3d>& starts_m) {
    enter("agents");
    for (const Eigen::Vector3d& x_m : starts_m)
      text_ += "  starts { " + place_text(x_m, mission_.domain.planar()) + " }\n";
    put("agents.random_count", "0");
  }

 private:
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
  void put(const char* name, const std::string& value) {
    const std::string path = part_ + name;
    const std::size_t dot = path.rfind('.');
    enter(dot == std::string::npos ? "" : path.substr(0, dot));
    text_ += (block_.empty() ? "" : "  ") + path.substr(dot + 1) + ": " + value + '\n';
  }

  const Mission& mission_;
  std::string text_, part_, block_;
  std::string last_;  // the last field of a part, if not empty
};

}  // namespace

std::string mission_text(const Mission& mission) { return TextWriter(mission).text(); }

}  // namespace ergocast
