// SPDX-License-Identifier: BSD-3-Clause
// The entry points for libFuzzer: the one target of this program.
#include "tests/fuzz/target.h"

extern "C" {

std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ergocast::fuzz::targets().front().run({data, size});
  return 0;
}

/// libFuzzer's own mutations, which follow the comparisons it sees, in turn with the target's.
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                    unsigned seed) {
  const auto mutate = ergocast::fuzz::targets().front().mutate;
  if (mutate == nullptr || seed % 2 == 0) return LLVMFuzzerMutate(data, size, max_size);
  return mutate({data, max_size}, size, seed / 2);
}

}  // extern "C"
