// SPDX-License-Identifier: BSD-3-Clause
// The compiled plan: every field of a mission is encoded, to the last bit.
#include "team/plan.h"

#include <gtest/gtest.h>

#include <bit>

#include "core/mission_limits.h"
#include "team/messages.h"
#include "tests/team/rich_mission.h"

namespace ergocast {
namespace {

using test::rich_mission;
using Bytes = std::vector<std::byte>;

/// Every field as a text, to the last bit. A new field of a mission must be added here: the names
/// of all are listed.
class Fields {
 public:
  explicit Fields(const Mission& mission) {
    const auto& [name, seed, domain, basis, target, law, timing, starts, quorum, forget, goal,
                 disturbance, radio_range, speed_limit, reckoning, waits] = mission;
    texts.push_back(name);
    add(seed);
    add(domain);
    add(basis);
    add(target);
    add(law);
    add(timing);
    add(starts);
    add_all(quorum, forget, goal, disturbance, radio_range, speed_limit, reckoning, waits);
  }

  std::vector<std::string> texts;

 private:
  template <class... All>
  void add_all(const All&... all) {
    (add(all), ...);
  }
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void add(T value) { texts.push_back(std::to_string(static_cast<std::uint64_t>(value))); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  // A plan says no z yet.
  void add(const Eigen::Vector3d& x_m) { add_all(x_m.x(), x_m.y()); }
  void add(const std::vector<Eigen::Vector3d>& places_m) {
    std::string all;
    for (const Eigen::Vector3d& x_m : places_m) all += text_of(x_m.x()) + text_of(x_m.y());
    texts.push_back(all);
  }
  void add(const Coefficients& values) {
    std::string all = std::to_string(values.size());
    for (const double value : values) all += text_of(value);
    texts.push_back(all);
  }
  void add(const Box& box) {
    const auto& [origin, size] = box;
    add_all(origin, size);
  }
  void add(const Basis& basis) {
    const auto& [modes_x, modes_y, modes_z, form, exponent, normalized] = basis;
    add_all(modes_x, modes_y, form, exponent, normalized);
  }
  void add(const ControlLaw& law) {
    const auto& [u_max, regularization, epsilon, perturbation, intensity, ceiling, gain, center,
                 anticipation, ends, paired] = law;
    add_all(u_max, regularization, epsilon, perturbation, intensity, ceiling, gain, center,
            anticipation, ends, paired);
  }
  void add(const Timing& timing) {
    const auto& [dt, ticks, period, pace, factor, timeout, hold, admission, catch_up, on_timeout] =
        timing;
    add_all(dt, ticks, period, pace, factor, timeout, hold, admission, catch_up, on_timeout);
  }
  static std::string text_of(double value) {
    return ' ' + std::to_string(std::bit_cast<std::uint64_t>(value));
  }
};

void expect_travels(const Mission& mission) {
  const Bytes plan = encode_plan(mission);
  const auto read = decode_plan(plan);
  ASSERT_TRUE(std::holds_alternative<Mission>(read)) << std::get<std::string>(read);
  EXPECT_EQ(Fields(std::get<Mission>(read)).texts, Fields(mission).texts);
  EXPECT_EQ(encode_plan(std::get<Mission>(read)), plan);
}

TEST(Plan, CarriesEveryFieldOfAMission) {
  const Mission mission = rich_mission();
  const auto rich = Fields(mission).texts, plain = Fields(Mission()).texts;
  ASSERT_EQ(rich.size(), plain.size());
  for (std::size_t i = 0; i < rich.size(); ++i)
    EXPECT_NE(rich[i], plain[i]) << "default: field " << i;
  expect_travels(mission);
}

// Two swapped switches would not show if both are true.
TEST(Plan, CarriesEachSwitchByItself) {
  for (int flipped = 0; flipped < 10; ++flipped) {
    SCOPED_TRACE(flipped);
    Mission m = rich_mission();
    bool* const switches[] = {&m.basis.normalized, &m.law.ends_with_plan, &m.law.paired_pushes,
                              &m.dead_reckoning, &m.wait_for_logger};
    if (flipped < 5) *switches[flipped] = !*switches[flipped];
    if (flipped == 5) m.basis.sobolev_form = SobolevForm::kSquaredNorm;
    if (flipped == 6) m.law.regularization = Regularization::kAbsolute;
    if (flipped == 7) m.law.perturbation = Perturbation::kConstant, m.law.noise_ceiling = 0;
    if (flipped == 8) m.timing.pace = Pace::kLockstep;
    if (flipped == 9) m.timing.on_timeout = OnTimeout::kEndMission;
    expect_travels(m);
  }
}

TEST(Plan, CarriesZerosOfEitherSign) {
  Mission mission = rich_mission();
  mission.domain.origin_m = {0, -0.0, 0};
  mission.starts_m[0] = {-0.0, 0, 0};
  mission.radio_range_m = mission.speed_limit_mps = mission.goal_ergodic_metric = 0;
  mission.target_coefficients[3] = -0.0;
  expect_travels(mission);
}

TEST(Plan, HashIsXxh3Of128Bits) {
  EXPECT_EQ(plan_hash({}), "99aa06d3014798d86001c324468d497f");  // the published value for no bytes
  Mission mission = rich_mission();
  const std::string hash = plan_hash(encode_plan(mission));
  EXPECT_EQ(plan_hash(encode_plan(rich_mission())), hash);
  mission.seed = 2;
  EXPECT_NE(plan_hash(encode_plan(mission)), hash);
}

TEST(Plan, OfTheLargestMissionFitsItsMessages) {
  Mission mission = rich_mission();
  mission.name = std::string(kMaxNameLength, 'x');
  mission.basis.modes_x = mission.basis.modes_y = kMaxModesPerAxis;
  mission.target_coefficients = Coefficients::Constant(kMaxModesPerAxis * kMaxModesPerAxis, 0.7);
  mission.target_coefficients[0] = 1;
  mission.starts_m.assign(kMaxAgents, {17.5, 20.5, 0});
  mission.quorum = kMaxAgents;
  mission.timing.tick_count = 80'000'000;
  mission.timing.broadcast_period_ticks = mission.timing.catch_up_limit_ticks = 1000;
  EXPECT_LE(encode_plan(mission).size(), std::size_t{kMaxPlanParts} * kMaxPlanBytesPerMessage);
  expect_travels(mission);
}

}  // namespace
}  // namespace ergocast
