// SPDX-License-Identifier: BSD-3-Clause
// Explains the parser's errors for people.
#pragma once

#include <google/protobuf/descriptor.h>

#include <optional>
#include <string>

#include "scenario/parse/error_recovery.h"
#include "scenario/parse/problem.h"

namespace ergocast {

/// The meaning and the remedy of the parser's `message` about `broken`; without a `where`.
Problem explained(const std::string& message, const BrokenField& broken = {});

/// A field that the person probably meant.
struct MeantField {
  std::string block;  ///< its path from the scenario; empty: in the same block
  std::string field;
};
/// The field that `wrong`, which `message` does not have, most likely means.
std::optional<MeantField> field_meant(const google::protobuf::Descriptor& message,
                                      const std::string& wrong);

/// "a, b, c".
std::string names_of_fields(const google::protobuf::Descriptor& message);

/// "A, B or C".
std::string enum_names(const google::protobuf::EnumDescriptor& type);

}  // namespace ergocast
