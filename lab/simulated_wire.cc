// SPDX-License-Identifier: BSD-3-Clause
// Decodes each message in place, because it takes a kilobyte, and uses the memory again.
#include "lab/simulated_wire.h"

#include "lcmtypes/codec.h"

namespace ergocast::lab {

std::shared_ptr<Decoded> SimulatedWire::pass(const Message& message) {
  encode(message, bytes_);
  if (spare_.empty()) return std::make_shared<Decoded>(decode(bytes_, run_));
  auto decoded = std::move(spare_.back());
  spare_.pop_back();
  std::destroy_at(decoded.get());
  ::new (decoded.get()) Decoded(decode(bytes_, run_));
  return decoded;
}

Decoded SimulatedWire::pass_damaged(std::uint64_t copy) {
  damaged_ = bytes_;
  damage(damaged_, seed_, copy);
  return decode(damaged_, run_);
}

}  // namespace ergocast::lab
