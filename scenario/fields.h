// SPDX-License-Identifier: BSD-3-Clause
// One table of every number in a scenario: its default and its limits, as scenario.proto's comments
// state them; the limits of what a mission has, too, are in core/mission_limits.h. What depends on more
// than one field is in validate.cc.
#pragma once

#include <google/protobuf/descriptor.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "core/mission_limits.h"

namespace ergocast {

/// Numbers allowed for a field, and how they are said.
struct Range : Limits {
  bool coordinate = false;  ///< a place: what people should write follows from the domain

  constexpr Range(const Limits& limits, bool is_coordinate = false)
      : Limits(limits), coordinate(is_coordinate) {}
  bool contains(double value) const { return contain(value); }
  /// "0 to 10", or "above 0, at most 10".
  std::string text() const;
};

enum class Absence {
  kRefused,    ///< the field is required
  kDefaulted,  ///< it becomes FieldRule::default_value
  kLeft,       ///< other fields decide what it means
};

struct FieldRule {
  std::string_view message, field;
  Range range;
  Absence absence;
  double default_value = 0;
};

/// The rule of a number's field, or null for one that has none: seed.
const FieldRule* rule_of(const google::protobuf::FieldDescriptor& field);

inline constexpr std::uint64_t kDefaultSeed = 1;

}  // namespace ergocast
