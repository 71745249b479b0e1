// SPDX-License-Identifier: BSD-3-Clause
// The compiled plan: every field of a mission is encoded, to the last bit.
#include "plan/plan.h"

#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "core/motion/walls.h"
#include "plan/mission_fields.h"
#include "team/messages.h"
#include "tests/plan/rich_mission.h"

namespace ergocast {
namespace {

using test::rich_mission;
using test::rich_mission_in_space;
using test::with_false_alarms;
using test::with_free_domain;
using test::with_inertia;
using test::with_lease;
using test::with_places;
using test::with_sites;
using test::with_stations;
using test::with_walls;
using test::with_wings;
using Bytes = std::vector<std::byte>;

/// Every field as a text, to the last bit.
class Fields : public FieldVisitor {
 public:
  explicit Fields(const Mission& mission) { list_fields(*this, mission); }

  std::vector<std::string> texts;

  void number(const Field&, double value) { texts.push_back(text_of(value)); }
  void flag(const Field&, bool value) { texts.push_back(std::to_string(value)); }
  void choice(const Field&, auto value, Words) {
    texts.push_back(std::to_string(static_cast<int>(value)));
  }
  void text(const Field&, const std::string& value) { texts.push_back(value); }
  void part(const Field&, const auto& part) { list_fields(*this, part); }
  void part(const Field&, const std::vector<AgentKind>&) {}
  void places(const Field&, const Field&, const Eigen::Vector3d& x_m) {
    texts.push_back(text_of(x_m));
  }
  void places(const Field&, const Field&, const std::vector<Eigen::Vector3d>& places_m) {
    std::string all;
    for (const Eigen::Vector3d& x_m : places_m) all += text_of(x_m);
    texts.push_back(all);
  }
  void derived(const Field&, std::integral auto value) { texts.push_back(std::to_string(value)); }
  void derived(const Field&, const Coefficients& values) {
    std::string all;
    for (const double value : values) all += text_of(value);
    texts.push_back(all);
  }
  void derived(const Field&, const IndexedRings& rings) {
    std::string all;
    for (const Ring& ring : rings) {
      all += " ring";
      for (const Eigen::Vector2d& x_m : ring) all += text_of(on_ground(x_m));
    }
    texts.push_back(all);
  }

 private:
  static std::string text_of(double value) {
    return ' ' + std::to_string(std::bit_cast<std::uint64_t>(value));
  }
  static std::string text_of(const Eigen::Vector3d& x_m) {
    return text_of(x_m.x()) + text_of(x_m.y()) + text_of(x_m.z());
  }
};

/// Changes the switch of this number, among all fields with a few values.
class Switch : public FieldVisitor {
 public:
  explicit Switch(int number) : left_(number) {}

  bool turned() const { return left_ < 0; }
  void flag(const Field&, bool& value) {
    if (left_-- == 0) value = !value;
  }
  template <class Enum>
  void choice(const Field&, Enum& value, Words words) {
    if (left_-- == 0)
      value = static_cast<Enum>((static_cast<std::size_t>(value) + 1) % words.size());
  }
  void part(const Field&, auto& part) { list_fields(*this, part); }
  void part(const Field&, std::vector<AgentKind>&) {}
  void derived(const Field& field, bool& value) { flag(field, value); }
  using FieldVisitor::derived;

 private:
  int left_;
};

void expect_travels(const Mission& mission) {
  const Bytes plan = encode_plan(mission);
  const auto read = decode_plan(plan);
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(Fields(*read).texts, Fields(mission).texts);
  EXPECT_EQ(encode_plan(*read), plan);
}

TEST(Plan, CarriesEveryFieldOfAMission) {
  const Mission mission = rich_mission_in_space();
  const Mission plain_mission;
  const auto rich = Fields(mission).texts, plain = Fields(plain_mission).texts,
             moving = Fields(with_inertia(mission)).texts,
             flying = Fields(with_wings(mission)).texts, walled = Fields(with_walls(mission)).texts,
             freed = Fields(with_free_domain(rich_mission())).texts,
             leased = Fields(with_lease(mission)).texts, counted = Fields(rich_mission()).texts,
             placed = Fields(with_places(rich_mission())).texts,
             alarmed = Fields(with_false_alarms(rich_mission())).texts,
             divided = Fields(with_sites(rich_mission())).texts;
  ASSERT_EQ(rich.size(), plain.size());
  for (std::size_t i = 0; i < rich.size(); ++i)
    EXPECT_TRUE(rich[i] != plain[i] || moving[i] != plain[i] || flying[i] != plain[i] ||
                walled[i] != plain[i] || freed[i] != plain[i] || leased[i] != plain[i] ||
                counted[i] != plain[i] || placed[i] != plain[i] || alarmed[i] != plain[i] ||
                divided[i] != plain[i])
        << "default: field " << i;
  expect_travels(mission);
  expect_travels(rich_mission());
  expect_travels(with_inertia(mission));
  expect_travels(with_wings(rich_mission()));
  expect_travels(with_free_domain(rich_mission()));
  expect_travels(with_walls(rich_mission()));
  expect_travels(with_lease(rich_mission()));
  expect_travels(with_places(rich_mission()));
  expect_travels(with_false_alarms(rich_mission()));
  expect_travels(with_sites(rich_mission()));
  expect_travels(with_stations(rich_mission()));
  expect_travels(with_stations(rich_mission_in_space()));
}

// Two swapped switches would not show if both are true.
TEST(Plan, CarriesEachSwitchByItself) {
  int count = 0;
  for (;; ++count) {
    SCOPED_TRACE(count);
    Mission mission = rich_mission();
    Switch one(count);
    list_fields(one, mission);
    if (!one.turned()) break;
    if (mission.law.perturbation == Perturbation::kConstant) mission.law.noise_ceiling = 0;
    if (mission.vehicle.kind != VehicleKind::kPoint) mission = with_inertia(mission);
    if (mission.basis.free_domain) mission = with_free_domain(mission);
    if (!mission.separation.guard) mission.timing.command_hold_s = 0;
    expect_travels(mission);
  }
  EXPECT_GE(count, 10);
}

// cli/spy/Plan.java and the plans of recorded runs rely on these bytes. A new field must not change
// them.
TEST(Plan, KeepsTheBytesOfItsFields) {
  Mission mission = rich_mission();
  mission.wait_for_logger = true;
  mission.separation = {};
  std::string plan;
  for (const std::byte byte : encode_plan(mission)) {
    plan += "0123456789abcdef"[static_cast<unsigned>(byte) >> 4];
    plan += "0123456789abcdef"[static_cast<unsigned>(byte) & 15];
  }
  constexpr const char* kParts[] = {
      "12047269636818ffffffffffffffffff0122",  // name, seed, domain
      "0900000000000008c0110000000000001040190000000000405940210000000000004a402a",
      "080310021801200129000000000000fc3f",  // basis
      // μ
      "3230000000000000f03f9a9999999999b93f9a9999999999c9bf333333333333d33f9a9999999999d9bf"
      "9a9999999999e13f3a",
      // law
      "0900000000000016401001"
      "19000000000000d03f2001"
      "29000000000000e83f31000000000000f83f392d431cebe2362a3f410000000000804040"
      "490000000000004140510000000000000c4058016001",
      // timing
      "09000000000000c03f10e00318072001"
      "290000000000000440310000000000002640"
      "399a9999999999e93f410000000000003f4048065001",
      // starts, the team and the world
      "4a200000000000003140000000000000344000000000000032400000000000003540"
      "51000000000000284059b81e85eb51b89e3f61333333333333e33f690000000000004e40"
      "7100000000000020407801800101",
      "a00602",  // quorum
  };
  std::size_t at = 0;
  for (const char* part : kParts) {
    const std::size_t found = plan.find(part, at);
    ASSERT_NE(found, std::string::npos) << part << " is not in " << plan.substr(at);
    at = found + std::string(part).size();
  }
  EXPECT_EQ(at, plan.size());
}

TEST(Plan, CarriesZerosOfEitherSign) {
  Mission mission = rich_mission();
  mission.domain.origin_m = {0, -0.0, 0};
  mission.starts_m[0] = {-0.0, 0, 0};
  mission.radio_range_m = mission.speed_limit_mps = mission.goal_ergodic_metric = 0;
  mission.separation = {};
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
  mission.starts_m.clear();
  for (int i = 0; i < kMaxAgents; ++i)
    mission.starts_m.emplace_back(-2.5 + 2 * (i % 50), 8.5 + 2 * (i / 50), 0);
  mission.kinds.resize(kMaxKinds, mission.kinds.front());
  for (int i = 0; i < kMaxKinds; ++i) {
    AgentKind& kind = mission.kinds[static_cast<std::size_t>(i)];
    kind.name = std::string(kMaxKindNameLength - 1, 'x') + static_cast<char>('a' + i);
    kind.count = kMaxAgents / kMaxKinds;
  }
  mission.quorum = kMaxAgents;
  mission.timing.tick_count = 80'000'000;
  mission.objects.motion = {};  // in so many ticks objects may not drift
  mission.timing.broadcast_period_ticks = mission.timing.catch_up_limit_ticks = 1000;
  mission.timing.high_mode_period_factor = 1;
  Rings walls;
  for (int i = 0; i < kMaxWallVertices / 3; ++i) {
    const Eigen::Vector2d at(-3 + i % 100, 52 + i / 100);  // where nobody begins
    walls.push_back({at, at + Eigen::Vector2d(0.5, 0), at + Eigen::Vector2d(0, 0.5)});
  }
  mission.walls = std::move(walls);
  mission.wall_clearance_m = 1;
  EXPECT_LE(encode_plan(mission).size(), std::size_t{kMaxPlanParts} * kMaxPlanBytesPerMessage);
  expect_travels(mission);
}

}  // namespace
}  // namespace ergocast
