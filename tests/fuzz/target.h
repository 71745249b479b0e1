// SPDX-License-Identifier: BSD-3-Clause
// A fuzz target: a function of bytes that must return for any input.
//
// Each file of this folder with the name of a folder of corpus/ defines one, with
// FUZZ_TARGET(name). clang's libFuzzer runs one target in each program (fuzzer_main.cc); the
// ordinary build runs all of them over the files in corpus/ (corpus_test.cc).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/require.h"

namespace ergocast::fuzz {

using Input = std::span<const std::uint8_t>;

struct Target {
  const char* name;
  void (*run)(Input);
  /// Changes the first `size` of `space` bytes with knowledge of the format; returns the new size.
  std::size_t (*mutate)(std::span<std::uint8_t> space, std::size_t size,
                        std::uint64_t seed) = nullptr;
};

/// All targets of this program.
inline std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}

struct Registration {
  explicit Registration(const Target& target) { targets().push_back(target); }
};

inline std::string_view text_of(Input input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}
inline std::span<const std::byte> bytes_of(Input input) { return std::as_bytes(input); }

}  // namespace ergocast::fuzz

/// Defines `void NAME(Input input)` as this file's target.
#define FUZZ_TARGET(NAME)                                                    \
  static void NAME(::ergocast::fuzz::Input input);                           \
  static const ::ergocast::fuzz::Registration registration_({#NAME, &NAME}); \
  static void NAME(::ergocast::fuzz::Input input)

/// The same with a mutator.
#define FUZZ_TARGET_WITH(NAME, MUTATE)                                               \
  static void NAME(::ergocast::fuzz::Input input);                                   \
  static const ::ergocast::fuzz::Registration registration_({#NAME, &NAME, MUTATE}); \
  static void NAME(::ergocast::fuzz::Input input)
