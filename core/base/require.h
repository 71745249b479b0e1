// SPDX-License-Identifier: BSD-3-Clause
// Programming errors stop the program. Input from users or the network is never checked with this.
#pragma once

#include <cstdio>
#include <cstdlib>

/// Aborts with the broken condition and its place when `condition` is false: a bug in the caller.
#define ERGOCAST_REQUIRE(condition)                                                             \
  do {                                                                                          \
    if (!(condition)) {                                                                         \
      std::fprintf(stderr, "%s:%d: broken precondition: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                             \
    }                                                                                           \
  } while (false)
