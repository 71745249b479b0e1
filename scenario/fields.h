// SPDX-License-Identifier: BSD-3-Clause
// The table of every number in a scenario: its default and its limits, as scenario.proto's comments
// state them. core/mission_limits.h has the limits that a mission has, too. validate.cc has the
// rules that depend on more than one field.
#pragma once

#include <google/protobuf/descriptor.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "core/mission_limits.h"

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
  kRefused,    ///< the field is required
  kDefaulted,  ///< it becomes FieldRule::default_value
  kLeft,       ///< other fields determine its value
};

struct FieldRule {
  std::string_view message, field;
  Range range;
  Absence absence;
  double default_value = 0;
};

/// The rule of a numeric field, or null for the one without a rule: seed.
const FieldRule* rule_of(const google::protobuf::FieldDescriptor& field);

inline constexpr std::uint64_t kDefaultSeed = 1;

}  // namespace ergocast
