// SPDX-License-Identifier: BSD-3-Clause
// Preloaded into programs, gives ergocast-logger no number where it forgets what was covered, as a
// damaged installation might; other programs get the real one.
#include <dlfcn.h>

#include <cerrno>
#include <cmath>
#include <cstring>

namespace {

bool is_logger() {
  static const bool is = std::strcmp(program_invocation_short_name, "ergocast-logger") == 0;
  return is;
}

}  // namespace

/// Sums that have been halved are multiplied by it. It is one of the few functions of the C library
/// that sums depend on.
extern "C" double ldexp(double x, int exponent) noexcept {
  static auto* const real = reinterpret_cast<double (*)(double, int)>(dlsym(RTLD_NEXT, "ldexp"));
  return is_logger() ? std::nan("") : real(x, exponent);
}
