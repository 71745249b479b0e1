// SPDX-License-Identifier: BSD-3-Clause
// Every test of this program runs on a separate host, and sees no run of other tests.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "tests/support/own_host.h"
#include "tests/support/temp_folder.h"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (!GTEST_FLAG_GET(list_tests)) {
    try {
      ergocast::test::enter_own_host();
    } catch (const std::runtime_error& error) {
      std::fprintf(stderr, "cannot make a host for the test: %s\n", error.what());
      return 1;
    }
  }
  const ergocast::test::TempFolder session;
  setenv("XDG_RUNTIME_DIR", session.path().c_str(), 1);
  return RUN_ALL_TESTS();
}
