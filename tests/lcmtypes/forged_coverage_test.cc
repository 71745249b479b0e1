// SPDX-License-Identifier: BSD-3-Clause
// Forged coverage that only the table can detect, not the codec: it has no effect.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/law/coverage_table.h"
#include "lcmtypes/codec.h"
#include "tests/lcmtypes/sample_messages.h"

namespace ergocast {
namespace {

using namespace test;

constexpr double kDt = 0.1;
constexpr std::int64_t kSteps = 1000;

Basis basis() {
  Basis basis;
  basis.modes_x = basis.modes_y = 15;
  return basis;
}

/// Block 0 of an agent that stood for 100 s where every cosine is `cosine`; S_00 is the time.
Contribution standing_still(double cosine) {
  Contribution m = contribution();
  m.steps = kSteps;
  m.elapsed_s = kSteps * kDt;
  m.block = 0;
  std::ranges::fill(m.sums.edit(), m.elapsed_s * cosine);
  m.sums.edit()[0] = m.elapsed_s;
  return m;
}

Merge merged_from_bytes(const Contribution& theirs, CoverageTable& table) {
  return table.merge(decoded_as<Contribution>(encoded(theirs)), kSteps);
}

void expect_no_effect(const Contribution& lie) {
  CoverageTable table(basis(), kDt);
  const Merge merged = merged_from_bytes(lie, table);
  EXPECT_TRUE(merged == Merge::kRefusedRange || merged == Merge::kRefusedShift);
  EXPECT_EQ(table.row_count(), 0u);
  Coefficients average = Coefficients::Ones(225);
  table.average(average);
  EXPECT_EQ(average.cwiseAbs().maxCoeff(), 0);
}

TEST(CodecAndTable, HonestRoundingOfACosineIsAccepted) {
  // |cos| by recurrence exceeds 1 by about 3e-15.
  CoverageTable table(basis(), kDt);
  EXPECT_EQ(merged_from_bytes(standing_still(1 + 3e-15), table), Merge::kNewer);
  EXPECT_EQ(merged_from_bytes(standing_still(-1 - 3e-15), table), Merge::kStale);
}

TEST(CodecAndTable, ASumLargerThanTheTimeItCoversIsRefused) {
  expect_no_effect(standing_still(1 + 1e-8));
  expect_no_effect(standing_still(-1 - 1e-8));
}

TEST(CodecAndTable, ASumLargerThanItsOwnS00IsRefused) {
  // S_00 is the sum of dt itself, because f_00 = 1: it cannot differ from the time covered.
  for (const double s00 : {0.0, 50.0, -100.0, 100 * (1 - 1e-8)}) {
    Contribution lie = standing_still(1);
    lie.sums.edit()[0] = s00;
    expect_no_effect(lie);
  }
}

TEST(CodecAndTable, ASumThatIsNotANumberIsRefused) {
  for (const double bad : {kNan, -kNan, kInfinity, -kInfinity}) {
    for (const std::size_t mode : {0, 1, 127}) {
      Contribution lie = standing_still(0.5);
      lie.sums.edit()[mode] = bad;
      expect_no_effect(lie);
    }
  }
}

}  // namespace
}  // namespace ergocast
