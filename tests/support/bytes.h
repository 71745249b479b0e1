// SPDX-License-Identifier: BSD-3-Clause
// A message as its bytes: two messages are equal if their bytes are.
#pragma once

#include <vector>

#include "lcmtypes/codec.h"

namespace ergocast::test {

inline std::vector<std::byte> bytes_of(const Message& message) {
  std::vector<std::byte> bytes;
  encode(message, bytes);
  return bytes;
}

}  // namespace ergocast::test
