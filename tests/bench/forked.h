// SPDX-License-Identifier: BSD-3-Clause
// A copy of this process that runs one function and ends with its handle, or with this process.
#pragma once

#include <sys/types.h>

#include <functional>
#include <utility>

namespace ergocast::bench {

class Forked {
 public:
  /// Runs `life` in a child. Create it while this process has only one thread.
  explicit Forked(const std::function<void()>& life);
  Forked(Forked&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}
  Forked& operator=(Forked&&) = delete;
  ~Forked();

 private:
  pid_t pid_;
};

}  // namespace ergocast::bench
