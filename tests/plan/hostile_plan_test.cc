// SPDX-License-Identifier: BSD-3-Clause
// Bytes from the network are accepted as a plan only if this program could have encoded them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "plan/mission_fields.h"
#include "plan/plan.h"
#include "team/messages.h"
#include "tests/plan/rich_mission.h"
#include "tests/plan/taken_plan.h"

namespace ergocast {
namespace {

using test::decoded;
using test::has;
using test::is_taken;
using test::problem_of;
using test::rich_mission;
using test::rich_mission_in_space;
using test::with_walls;
using Bytes = std::vector<std::byte>;

/// Every double of a mission but those of μ.
class Numbers : public FieldVisitor {
 public:
  explicit Numbers(Mission& mission) : mission_(mission) { list_fields(*this, mission); }
  /// Walls are constant, so they are replaced.
  ~Numbers() {
    if (!walls_.empty()) mission_.walls = walls_;
  }
  Numbers(const Numbers&) = delete;

  std::vector<double*> all;

  void number(const Field&, int&) {}
  void number(const Field&, double& value) { all.push_back(&value); }
  void part(const Field&, auto& part) { list_fields(*this, part); }
  void part(const Field&, std::vector<AgentKind>&) {}
  void places(const Field&, const Field&, Eigen::Vector3d& x_m) {
    all.insert(all.end(), {&x_m.x(), &x_m.y(), &x_m.z()});
  }
  void places(const Field& xy, const Field& z, std::vector<Eigen::Vector3d>& places_m) {
    for (Eigen::Vector3d& x_m : places_m) places(xy, z, x_m);
  }
  using FieldVisitor::derived;
  void derived(const Field&, IndexedRings& rings) {
    walls_ = rings.rings();
    for (Ring& ring : walls_) {
      for (Eigen::Vector2d& x_m : ring) all.insert(all.end(), {&x_m.x(), &x_m.y()});
    }
  }

 private:
  Mission& mission_;
  Rings walls_;
};

TEST(HostilePlan, CutShortIsRefused) {
  const Bytes plan = encode_plan(rich_mission());
  for (std::size_t length = 0; length < plan.size(); ++length) {
    EXPECT_FALSE(decoded(std::span(plan).first(length))) << length;
  }
}

TEST(HostilePlan, OfRandomBytesIsRefusedOrWithinLimits) {
  std::mt19937 random(1);
  const Bytes plans[] = {encode_plan(with_walls(rich_mission())),
                         encode_plan(rich_mission_in_space())};
  for (int i = 0; i < 20000; ++i) {
    const Bytes& plan = plans[i / 2 % 2];
    Bytes noisy = plan;
    if (i % 2 == 0) noisy.resize(random() % plan.size());
    for (int changes = 1 + i % 8; changes > 0 && !noisy.empty(); --changes) {
      noisy[random() % noisy.size()] = std::byte{static_cast<unsigned char>(random())};
    }
    const auto mission = decoded(noisy);
    EXPECT_TRUE(!mission || encode_plan(*mission) == noisy);
  }
}

TEST(HostilePlan, WithANumberThatIsNoneOrHugeIsRefused) {
  for (const Mission& good :
       {rich_mission(), rich_mission_in_space(), with_walls(rich_mission())}) {
    Mission mission = good;
    const std::size_t count = Numbers(mission).all.size();
    ASSERT_GT(count, 25u);
    for (std::size_t i = 0; i < count; ++i) {
      for (const double bad : {std::nan(""), double{INFINITY}, -double{INFINITY}, -1e300, 1e300}) {
        Mission broken = good;
        *Numbers(broken).all[i] = bad;
        EXPECT_FALSE(is_taken(broken)) << i << ": " << bad;
      }
    }
  }
}

TEST(HostilePlan, WithACoefficientThatCannotBeIsRefused) {
  for (const double bad :
       {1.001, -1.001, std::nan(""), -std::nan(""), double{INFINITY}, -double{INFINITY}}) {
    Mission mission = rich_mission();
    mission.target_coefficients[5] = bad;
    EXPECT_FALSE(is_taken(mission)) << bad;
  }
  Mission mission = rich_mission();
  mission.target_coefficients[0] = 0.999;
  EXPECT_FALSE(is_taken(mission));
}

TEST(HostilePlan, OfAnotherVersionIsRefusedWithBothVersionsNamed) {
  Bytes plan = encode_plan(rich_mission());
  ASSERT_EQ(plan[0], std::byte{0x0A});  // the version comes first
  const auto length = static_cast<std::size_t>(plan[1]);
  const std::string ours(reinterpret_cast<const char*>(plan.data()) + 2, length);
  std::string theirs = ours;
  theirs.back() = theirs.back() == '7' ? '8' : '7';
  plan[1 + length] = std::byte{static_cast<unsigned char>(theirs.back())};
  const std::string sentence = "the mission's plan is of version " + theirs + ", this program is " +
                               ours + ": install the same version on every host";
  EXPECT_EQ(problem_of(plan), sentence);
  // The rest may be in a format that we cannot parse.
  plan.resize(2 + length + 1);
  EXPECT_EQ(problem_of(plan), sentence);
}

TEST(HostilePlan, WithoutAVersionIsDamagedOrMuchNewer) {
  EXPECT_TRUE(has(problem_of({}), "damaged or of a much newer version"));
  for (const int byte : {0x1b, 0xff}) {  // no received text moves the cursor of a terminal
    Bytes plan = encode_plan(rich_mission());
    plan[3] = static_cast<std::byte>(byte);
    EXPECT_TRUE(has(problem_of(plan), "damaged or of a much newer version"));
  }
}

// Protobuf would accept these: unknown fields, a field given twice, padding.
TEST(HostilePlan, WithASpellingOfItsOwnIsRefused) {
  const Bytes plan = encode_plan(rich_mission());
  const auto appended = [&](std::initializer_list<int> bytes) {
    Bytes longer = plan;
    for (const int byte : bytes) longer.push_back(std::byte{static_cast<unsigned char>(byte)});
    return longer;
  };
  EXPECT_FALSE(decoded(appended({0xf8, 0x01, 0x01})));  // field 31
  EXPECT_FALSE(decoded(appended({0x22, 0x00})));        // an empty domain to be merged
  EXPECT_FALSE(decoded(appended({0x18, 0x09})));        // another seed
  EXPECT_FALSE(decoded(appended({0x00})));
  Bytes twice = plan;
  twice.insert(twice.end(), plan.begin(), plan.end());
  EXPECT_FALSE(decoded(twice));
  EXPECT_FALSE(decoded(Bytes(std::size_t{kMaxPlanParts} * kMaxPlanBytesPerMessage + 1)));
}

}  // namespace
}  // namespace ergocast
