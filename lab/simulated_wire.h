// SPDX-License-Identifier: BSD-3-Clause
// Passes messages through the codec as bytes, as a real wire does, and can damage them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "lab/network.h"
#include "team/messages.h"

namespace ergocast::lab {

class SimulatedWire {
 public:
  SimulatedWire(RunId run, std::uint64_t seed) : run_(run), seed_(seed) {}

  /// What a receiver of this run decodes.
  std::shared_ptr<Decoded> pass(const Message& message);
  /// The same of a damaged copy of the last message.
  Decoded pass_damaged(std::uint64_t copy);
  /// Takes the memory of a message that nobody needs any more.
  void reuse(std::shared_ptr<Decoded> decoded) { spare_.push_back(std::move(decoded)); }

 private:
  RunId run_;
  std::uint64_t seed_;
  std::vector<std::byte> bytes_, damaged_;
  std::vector<std::shared_ptr<Decoded>> spare_;
};

}  // namespace ergocast::lab
