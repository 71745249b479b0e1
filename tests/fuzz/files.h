// SPDX-License-Identifier: BSD-3-Clause
// Files that hold an input, for readers that need a path.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

/// A file in memory that holds `content` until the next call.
inline std::filesystem::path memory_file(Input content) {
  static const int fd = memfd_create("input", MFD_CLOEXEC);
  const auto size = static_cast<ssize_t>(content.size());
  ERGOCAST_REQUIRE(ftruncate(fd, 0) == 0 && pwrite(fd, content.data(), content.size(), 0) == size);
  return "/proc/self/fd/" + std::to_string(fd);
}

/// A folder of this process, in memory if possible; removed when it ends.
class Folder {
 public:
  Folder() {
    std::string name = access("/dev/shm", W_OK) == 0 ? "/dev/shm/" : "/tmp/";
    name += "ergocast-fuzz-XXXXXX";
    ERGOCAST_REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  Folder(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }
  void write(const char* name, std::string_view content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace ergocast::fuzz
