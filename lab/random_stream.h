// SPDX-License-Identifier: BSD-3-Clause
// A stream of random numbers that follows from a seed and a stream number alone.
#pragma once

#include <cstdint>

#include "core/base/noise.h"
#include "core/base/portable_math.h"

namespace ergocast::lab {

class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint32_t stream) : seed_(seed), stream_(stream) {}

  std::uint64_t word() { return random_words(seed_, Purpose::kFault, stream_, ++draws_).first; }
  /// In (0, 1).
  double uniform() { return uniform_pair(seed_, Purpose::kFault, stream_, ++draws_).x(); }
  bool coin() { return uniform() < 0.5; }
  double exponential(double mean) { return -mean * portable::log(uniform()); }
  /// Between `least` and `most`, each power of ten as likely.
  double log_uniform(double least, double most) {
    return least * portable::pow(most / least, uniform());
  }

 private:
  std::uint64_t seed_;
  std::uint32_t stream_;
  std::uint64_t draws_ = 0;
};

}  // namespace ergocast::lab
