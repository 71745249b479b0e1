// SPDX-License-Identifier: BSD-3-Clause
// A file in memory that no process can change any more, not even this one. A launcher hands such
// files to the processes that it starts. So no change of a file on the disk reaches them.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "core/base/result.h"

namespace ergocast {

/// Copies share one file. It exists as long as one of them, or a process that has opened it.
class SealedFile {
 public:
  /// An error if the system has no memory or no descriptor for it. Only its owner may read it.
  /// @param name  shown in /proc/PID/maps
  static Result<SealedFile> make(const std::string& name, std::span<const std::byte> bytes);

  /// Child::Program::hand() gives it to a program.
  int descriptor() const { return *descriptor_; }
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor()); }

 private:
  explicit SealedFile(int descriptor);

  std::shared_ptr<const int> descriptor_;  // closed with the last copy
};

}  // namespace ergocast
