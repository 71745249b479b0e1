// SPDX-License-Identifier: BSD-3-Clause
// Preloaded into a program, makes its kernel refuse socket filters.
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

extern "C" int setsockopt(int fd, int level, int name, const void* value,
                          socklen_t length) noexcept {
  if (level == SOL_SOCKET && name == SO_ATTACH_FILTER) {
    errno = ENOPROTOOPT;
    return -1;
  }
  return static_cast<int>(syscall(SYS_setsockopt, fd, level, name, value, length));
}
