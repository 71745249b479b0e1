// SPDX-License-Identifier: BSD-3-Clause
// Writes the bytes into a memfd and seals it, so that the file never gets shorter under a process
// that maps it.
#include "runtime/process/sealed_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace ergocast {
namespace {

constexpr int kSeals = F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;

bool write_all(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

/// A new file with a descriptor above those of the standard streams, because a child reopens these;
/// −1: there is none.
int new_file(const std::string& name) {
  const int descriptor = memfd_create(name.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (descriptor < 0 || descriptor > STDERR_FILENO) return descriptor;
  const int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  close(descriptor);
  return moved;
}

}  // namespace

SealedFile::SealedFile(int descriptor)
    : descriptor_(new int(descriptor), [](const int* one) {
        close(*one);
        delete one;
      }) {}

Result<SealedFile> SealedFile::make(const std::string& name, std::span<const std::byte> bytes) {
  const auto problem = [&name] {
    return failure(name + ": cannot be kept in memory: " + std::strerror(errno));
  };
  const int descriptor = new_file(name);
  if (descriptor < 0) return problem();
  SealedFile file(descriptor);
  if (!write_all(descriptor, bytes) || fchmod(descriptor, S_IRUSR) != 0 ||
      fcntl(descriptor, F_ADD_SEALS, kSeals) != 0) {
    return problem();
  }
  return file;
}

}  // namespace ergocast
