// SPDX-License-Identifier: BSD-3-Clause
// Which parts of MISSION are to be sent. A small mission is sent as a whole each time. A large one
// is sent part by part in turn. Parts that have changed are sent a few times before the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ergocast {

class PartSchedule {
 public:
  /// The most parts that are sent at once. A process that misses any part of P receives it within
  /// ceil(P / kMostAtOnce) repetitions.
  static constexpr std::size_t kMostAtOnce = 32;
  /// How often a changed part is sent before the others.
  static constexpr int kTimesSent = 3;

  /// The numbers of the parts to send now, ascending.
  /// @param hashes  of all parts as they are now
  std::vector<std::size_t> next(const std::vector<std::uint64_t>& hashes);

  /// Whether a changed part has not been sent yet.
  bool behind() const;

 private:
  struct Part {
    std::uint64_t hash = 0;
    int owed = 0;  // how often it is still to be sent before others
  };
  std::vector<Part> parts_;
  std::size_t turn_ = 0;
};

}  // namespace ergocast
