// SPDX-License-Identifier: BSD-3-Clause
// Collects what compiler, build folder and processor tell.
#include "runtime/process/build_facts.h"

#include <lcm/lcm.h>

#include <string_view>
#include <vector>

#include "core/base/vectorized.h"

// Only programs have it; cmake/Commit.cmake writes it. A library or a test has none.
extern "C" const char ergocast_commit[] __attribute__((weak));

namespace ergocast {
namespace {

using Features = std::vector<std::string_view>;

std::string listed(const Features& features, const char* none) {
  std::string text;
  for (const std::string_view feature : features)
    text += (text.empty() ? "" : ", ") + std::string(feature);
  return text.empty() ? none : text;
}

std::string architecture() {
#if defined(__x86_64__)
  return "x86-64";
#elif defined(__aarch64__)
  return "arm64";
#else
  return "an unnamed processor";
#endif
}

/// What the compiler took for granted, beyond the least processor of the architecture.
Features needed_features() {
  Features features;
#ifdef __SSE4_2__
  features.push_back("SSE4.2");
#endif
#ifdef __AVX__
  features.push_back("AVX");
#endif
#ifdef __AVX2__
  features.push_back("AVX2");
#endif
#ifdef __FMA__
  features.push_back("FMA");
#endif
#ifdef __AVX512F__
  features.push_back("AVX-512");
#endif
  return features;
}

// The text of a macro's value.
#define ERGOCAST_TEXT_OF(value) #value
#define ERGOCAST_VALUE_TEXT(macro) ERGOCAST_TEXT_OF(macro)

/// What core/base/vectorized.h uses if the processor has it.
Features optional_features() {
  constexpr std::string_view kCopies = ERGOCAST_VALUE_TEXT((ERGOCAST_VECTORIZED));
  return kCopies.find("avx2") != kCopies.npos ? Features{"AVX2"} : Features{};
}

Features present_features() {
  Features features;
#ifdef __x86_64__
  if (__builtin_cpu_supports("sse4.2") != 0) features.push_back("SSE4.2");
  if (__builtin_cpu_supports("avx") != 0) features.push_back("AVX");
  if (__builtin_cpu_supports("avx2") != 0) features.push_back("AVX2");
  if (__builtin_cpu_supports("fma") != 0) features.push_back("FMA");
  if (__builtin_cpu_supports("avx512f") != 0) features.push_back("AVX-512");
#endif
  return features;
}

std::string commit_line() {
  const std::string commit = ergocast_commit != nullptr ? ergocast_commit : "";
  return commit.empty() ? "" : "commit " + commit + '\n';
}

}  // namespace

std::string facts_text() {
  return "ergocast " ERGOCAST_VERSION " (LCM " + std::to_string(LCM_MAJOR_VERSION) + "." +
         std::to_string(LCM_MINOR_VERSION) + "." + std::to_string(LCM_MICRO_VERSION) +
         ", built with " ERGOCAST_COMPILER ")\n" + commit_line() + "processor: built for " +
         architecture() + " with " + listed(needed_features(), "no extension") + "; may use " +
         listed(optional_features(), "no other") +
         "; here: " + listed(present_features(), "no extension");
}

bool processor_has_fma() {
#ifdef __x86_64__
  return __builtin_cpu_supports("fma") != 0;
#else
  return true;
#endif
}

}  // namespace ergocast
