// SPDX-License-Identifier: BSD-3-Clause
// Preloaded into a program, makes the system refuse new processes while the file
// $ERGOCAST_TEST_NO_MORE_PROCESSES exists.
#include <dlfcn.h>
#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

extern "C" pid_t fork() noexcept {
  const char* file = std::getenv("ERGOCAST_TEST_NO_MORE_PROCESSES");
  if (file != nullptr && access(file, F_OK) == 0) {
    errno = EAGAIN;
    return -1;
  }
  using Fork = pid_t (*)();
  return reinterpret_cast<Fork>(dlsym(RTLD_NEXT, "fork"))();
}
