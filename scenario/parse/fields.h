// SPDX-License-Identifier: BSD-3-Clause
// The table of every number in a scenario: its default and its limits, which
// docs/reference/scenario.md prints. A mission's numbers have the limits of plan/mission_fields.h
// and, unless the table says otherwise, the defaults of core/mission/mission.h.
// scenario/rules/validate.cc has the rules that depend on more than one field.
#pragma once

#include <google/protobuf/message.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "plan/mission_limits.h"

namespace ergocast {

/// The numbers allowed for a field, with their text.
struct Range : Limits {
  bool coordinate = false;  ///< a place: useful values follow from the domain

  constexpr Range(const Limits& limits, bool is_coordinate = false)
      : Limits(limits), coordinate(is_coordinate) {}
  bool contains(double value) const { return contain(value); }
  /// "0 to 10", or "above 0, at most 10".
  std::string text() const;
};

enum class Absence {
  kRefused,    ///< the field is required; one along z only in a box
  kDefaulted,  ///< it becomes FieldRule::default_value
  kLeft,       ///< other fields determine its value
};

struct FieldRule {
  Range range;
  Absence absence;
  double default_value = 0;
};

/// The rule of a numeric field, or null for the one without a rule: seed.
const FieldRule* rule_of(const google::protobuf::FieldDescriptor& field);

/// Whether the field is one of boxes alone: it names z.
bool is_along_z(const google::protobuf::FieldDescriptor& field);

/// The value of a numeric field.
double number_in(const google::protobuf::Message& block,
                 const google::protobuf::FieldDescriptor& field);

struct FoundField {
  const google::protobuf::Message& block;
  const google::protobuf::FieldDescriptor& field;
};
/// The field of a name such as "quorum", or "agents.quorum" in a block of `block`.
/// @pre there is one
FoundField find_field(const google::protobuf::Message& block, std::string_view name);

inline constexpr std::uint64_t kDefaultSeed = 1;

}  // namespace ergocast
