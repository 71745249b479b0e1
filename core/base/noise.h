// SPDX-License-Identifier: BSD-3-Clause
// Random numbers as a function of (seed, purpose, who, step): no generator state anywhere, so runs
// repeat bit for bit, in any order and after any restart.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/base/geometry.h"

namespace ergocast {

enum class Purpose : std::uint32_t {
  kPerturbation = 1,  ///< dW_i of (9)
  kDisturbance = 2,   ///< actuation noise of the simulated world
  kStart = 3,         ///< random initial positions
  kIncarnation = 4,   ///< identities in a simulation
  kFault = 5,         ///< the laboratory's network
  kAnswer = 6,        ///< random delays before answers
  kPush = 7,          ///< the part of an adaptive perturbation that is held for several steps
  kSide = 8,          ///< on which side a blocked body tries to pass
  kHand = 9,          ///< on which side an agent goes along a wall that holds it up
  kObject = 10,       ///< where the simulated world's objects are
  kDetection = 11,    ///< whether a sensor detects an object
  kReport = 12,       ///< the error of a reported place
  kFalseAlarm = 13,   ///< whether and where a sensor reports nothing real
  kDrift = 14,        ///< the headings of drifting objects
};

/// Two independent 64-bit words (Philox 4×32-10, Salmon et al. 2011).
struct RandomBits {
  std::uint64_t first, second;
};
RandomBits random_words(std::uint64_t seed, Purpose purpose, std::uint32_t who, std::uint64_t step);

/// Two independent numbers, uniform in (0, 1).
Eigen::Vector2d uniform_pair(std::uint64_t seed, Purpose purpose, std::uint32_t who,
                             std::uint64_t step);

/// Two independent standard normal numbers (Box–Muller).
Eigen::Vector2d normal_pair(std::uint64_t seed, Purpose purpose, std::uint32_t who,
                            std::uint64_t step);

/// A place in `domain`, uniform.
Eigen::Vector3d uniform_in(const Box& domain, std::uint64_t seed, Purpose purpose,
                           std::uint32_t who, std::uint64_t step);

/// An independent standard normal number for each axis along which something moves in `domain`. x
/// and y are those of normal_pair(), in every domain; in a plane z is 0, and no third number is
/// drawn.
Eigen::Vector3d normal_in(const Box& domain, std::uint64_t seed, Purpose purpose, std::uint32_t who,
                          std::uint64_t step);

}  // namespace ergocast
