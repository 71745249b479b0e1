// SPDX-License-Identifier: BSD-3-Clause
// Runs the benchmarks of a program in a separate network, if the system allows it.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>

#include "tests/support/own_host.h"

int main(int argc, char** argv) {
  try {
    ergocast::test::enter_own_host();
  } catch (const std::exception& why) {
    std::fprintf(stderr, "%s: using the network of this machine\n", why.what());
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
