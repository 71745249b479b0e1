// SPDX-License-Identifier: BSD-3-Clause
// Axes need numbers: for any range, at least two marks have labels.
#include "report/axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace ergocast {
namespace {

TEST(Axes, LogarithmicOnesHaveTwoLabelsAndMoreOverAnyRange) {
  for (int exponent = -12; exponent <= 9; ++exponent) {
    for (const double mantissa : {1.0, 1.01, 1.5, 2.1, 4.9, 5.1, 9.0, 9.9}) {
      for (double ratio = 1.02; ratio < 1e13; ratio *= 1.17) {
        const Axis axis = log_axis("", mantissa * std::pow(10, exponent),
                                   mantissa * std::pow(10, exponent) * ratio);
        for (const int count : {5, 6}) {
          std::set<std::string> labels;
          double lowest = 1, highest = 0;
          for (const AxisMark& mark : marks(axis, count)) {
            const double at = axis.position(mark.value);
            ASSERT_TRUE(at > -1e-6 && at < 1 + 1e-6)
                << axis.low << " to " << axis.high << ": " << mark.value;
            if (mark.label.empty()) continue;
            labels.insert(mark.label);
            lowest = std::min(lowest, at);
            highest = std::max(highest, at);
          }
          EXPECT_GE(labels.size(), 2U) << axis.low << " to " << axis.high;
          EXPECT_GT(highest - lowest, 0.2) << axis.low << " to " << axis.high << ": crowded";
        }
      }
    }
  }
}

}  // namespace
}  // namespace ergocast
