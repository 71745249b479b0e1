// SPDX-License-Identifier: BSD-3-Clause
// Preloaded into a program, makes its kernel's clock appear unsynchronised.
#include <sys/timex.h>

extern "C" int adjtimex(timex* time) noexcept {
  *time = {};
  time->status = STA_UNSYNC;
  return TIME_ERROR;
}
