// SPDX-License-Identifier: BSD-3-Clause
// Goes through the list of a mission's fields.
#include "scenario/compile/omit_defaults.h"

#include <string_view>
#include <vector>

#include "plan/mission_fields.h"

namespace ergocast {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

bool is_empty(const Message& block) {
  std::vector<const FieldDescriptor*> set;
  block.GetReflection()->ListFields(block, &set);
  return set.empty();
}

const FieldDescriptor& field_of(const Message& block, std::string_view name) {
  return *block.GetDescriptor()->FindFieldByName(std::string(name));
}

/// Calls `change` with the block below `block` that has the field of a name such as "band.from",
/// and with that field, if both are there. Clears the blocks on the way that are then empty.
void in_block(Message& block, std::string_view name, const auto& change) {
  const std::size_t dot = name.find('.');
  const FieldDescriptor& field = field_of(block, name.substr(0, dot));
  const auto& fields = *block.GetReflection();
  if (dot == std::string_view::npos) return change(block, field);
  if (!fields.HasField(block, &field)) return;
  Message& inner = *fields.MutableMessage(&block, &field);
  in_block(inner, name.substr(dot + 1), change);
  if (is_empty(inner)) fields.ClearField(&block, &field);
}

class Omission : public FieldVisitor {
 public:
  /// @param words  whether also words are omitted
  Omission(Message& block, bool planar, bool words = true)
      : block_(block), planar_(planar), words_(words) {}

  void number(const Field& field, double) { omit(field); }
  void flag(const Field& field, bool) { omit(field); }
  void choice(const Field& field, auto, Words) {
    if (words_) omit(field);
  }
  void part(const Field& field, const std::vector<AgentKind>& kinds) {
    in_block(block_, field.name, [&](Message& block, const FieldDescriptor& found) {
      for (std::size_t i = 0; i < kinds.size(); ++i) {
        Omission inner(
            *block.GetReflection()->MutableRepeatedMessage(&block, &found, static_cast<int>(i)),
            planar_);
        list_fields(inner, kinds[i]);
      }
    });
  }
  /// A kind of its own may be a point, which the mission's vehicle is not.
  void part(const Field& field, const std::optional<VehicleLimits>& vehicle) {
    if (vehicle) look_into(field, *vehicle, false);
  }
  void part(const Field& field, const auto& part) { look_into(field, part, words_); }

 private:
  void look_into(const Field& field, const auto& part, bool words) {
    in_block(block_, field.name, [&](Message& block, const FieldDescriptor& found) {
      const auto& fields = *block.GetReflection();
      if (!fields.HasField(block, &found)) return;
      Message& inner = *fields.MutableMessage(&block, &found);
      Omission omission(inner, planar_, words);
      list_fields(omission, part);
      if (is_empty(inner)) fields.ClearField(&block, &found);
    });
  }
  void omit(const Field& field) {
    if (field.when.given || (field.when.in_box && !planar_)) return;
    in_block(block_, field.name, [](Message& block, const FieldDescriptor& found) {
      block.GetReflection()->ClearField(&block, &found);
    });
  }

  Message& block_;
  bool planar_, words_;
};

}  // namespace

void omit_defaults(const Mission& mission, proto::Scenario& scenario) {
  Omission omission(scenario, mission.domain.planar());
  list_fields(omission, mission);
}

}  // namespace ergocast
