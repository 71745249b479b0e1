// The parser's complaints in words that help.
#pragma once

#include <google/protobuf/descriptor.h>

#include <string>

#include "scenario/salvage.h"
#include "scenario/scenario.h"

namespace ergocast {

/// What the parser's `message` about `broken` means, and what to do about it; without a `where`.
Problem explained(const std::string& message, const BrokenField& broken = {});

/// "A, B or C".
std::string enum_names(const google::protobuf::EnumDescriptor& type);

}  // namespace ergocast
