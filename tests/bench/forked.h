// SPDX-License-Identifier: BSD-3-Clause
// A copy of this process that does one thing and is gone with its handle, or with this process.
#pragma once

#include <sys/types.h>

#include <functional>
#include <utility>

namespace ergocast::bench {

class Forked {
 public:
  /// Starts `life` in a child. To be made while this process has one thread.
  explicit Forked(const std::function<void()>& life);
  Forked(Forked&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}
  Forked& operator=(Forked&&) = delete;
  ~Forked();

 private:
  pid_t pid_;
};

}  // namespace ergocast::bench
