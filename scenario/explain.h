// SPDX-License-Identifier: BSD-3-Clause
// The parser's complaints in words that help.
#pragma once

#include <google/protobuf/descriptor.h>

#include <optional>
#include <string>

#include "scenario/salvage.h"
#include "scenario/scenario.h"

namespace ergocast {

/// What the parser's `message` about `broken` means, and what to do about it; without a `where`.
Problem explained(const std::string& message, const BrokenField& broken = {});

/// A field that somebody may have meant.
struct MeantField {
  std::string block;  ///< its path from the scenario; empty: where it was looked for
  std::string field;
};
/// What a field `wrong`, which `message` does not have, was most likely to be.
std::optional<MeantField> field_meant(const google::protobuf::Descriptor& message,
                                      const std::string& wrong);

/// "a, b, c".
std::string names_of_fields(const google::protobuf::Descriptor& message);

/// "A, B or C".
std::string enum_names(const google::protobuf::EnumDescriptor& type);

}  // namespace ergocast
