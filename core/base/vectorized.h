// SPDX-License-Identifier: BSD-3-Clause
// A second copy of a function for processors with AVX2; the program chooses when it starts.
//
// Both copies give the same bits: their loops have independent lanes or sums in a fixed order, and
// -ffp-contract=off keeps multiplications and additions apart.
#pragma once

// The choice is made before the sanitizers' runtimes exist.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ERGOCAST_VECTORIZED __attribute__((target_clones("avx2", "default")))
#else
#define ERGOCAST_VECTORIZED
#endif

// A part of such a function: compiled for its caller's processor.
#if defined(__GNUC__)
#define ERGOCAST_VECTORIZED_PART [[gnu::always_inline]] inline
#else
#define ERGOCAST_VECTORIZED_PART inline
#endif

// Stands before a loop in which no pass reads what another one writes, although the compiler cannot
// see it.
#if defined(__GNUC__) && !defined(__clang__)
#define ERGOCAST_INDEPENDENT _Pragma("GCC ivdep")
#else
#define ERGOCAST_INDEPENDENT
#endif

namespace ergocast {

/// Modes that are added up together over many rows, so that their sums stay in registers.
inline constexpr int kModesPerStride = 8;

}  // namespace ergocast
