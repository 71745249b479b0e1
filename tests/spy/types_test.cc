// SPDX-License-Identifier: BSD-3-Clause
// The jar for lcm-spy: types, the plan's reader, and pictures of given messages. LCM's Java reads
// our messages, and we read its messages.
#include <cmath>
#include <map>
#include <numeric>

#include "core/block_layout.h"
#include "lcm_types.h"
#include "lcmtypes/channels.h"
#include "runtime/clock.h"
#include "runtime/transport.h"
#include "scenario/scenario.h"
#include "target/target.h"
#include "team/plan.h"
#include "tests/lcmtypes/sample_messages.h"
#include "tests/spy/spy_desk.h"

namespace ergocast {
namespace {

using namespace test;

class SpyJar : public WithProbe {
 protected:
  void SetUp() override {
    const std::string missing = missing_for_spy(false);
    if (!missing.empty()) GTEST_SKIP() << "not installed when this was built:" << missing;
  }
  /// The plan that a scenario's agents receive, and its file.
  Scenario plan_of(const std::string& name) { return plan_of_file(scenario_file(name)); }
  Scenario plan_of_file(const std::filesystem::path& file) {
    auto loaded = Scenario::load(file);
    const auto& scenario = std::get<Scenario>(loaded);
    const auto plan = encode_plan(scenario.mission());
    std::ofstream(plan_file(), std::ios::binary)
        .write(reinterpret_cast<const char*>(plan.data()),
               static_cast<std::streamsize>(plan.size()));
    return scenario;
  }
  /// The same for a shipped scenario with one Gaussian as its target.
  void plan_of_bell(const std::string& name, const std::string& bell) {
    std::string text = text_of(scenario_file(name));
    const auto target = text.find("target {"), end = text.find("\n}", target);
    text.replace(target, end - target, "target { gaussians { " + bell + " }");
    std::ofstream(folder_ / "one_bell.textproto") << text;
    plan_of_file(folder_ / "one_bell.textproto");
  }
  std::filesystem::path plan_file() const { return folder_ / "plan.binpb"; }
  /// The positions of "agent" and "target" in the map of those axes, as shares of its sides.
  std::map<std::string, std::pair<double, double>> places(const std::string& axes) {
    std::istringstream printed(ask({"map", plan_file(), axes}));
    std::map<std::string, std::pair<double, double>> found;
    for (std::string what; printed >> what;) printed >> found[what].first >> found[what].second;
    return found;
  }
  static constexpr double kPixels = 0.01;  // four of 400
};

TEST_F(SpyJar, LcmSpyKnowsEveryTypeByTheFingerprintThatTravels) {
  std::vector<std::string> question{"types"};
  std::string expected;
  for (const auto& [name, fingerprint] : kLcmTypes) {
    question.push_back(std::to_string(fingerprint));
    expected += std::to_string(fingerprint) + " ergocast." + name + "\n";
  }
  ASSERT_GE(question.size(), 15U);
  EXPECT_NE(ask(question).find(expected), std::string::npos) << output() << "expected\n"
                                                             << expected;
}

TEST_F(SpyJar, EveryMessageComesBackFromLcmsJavaAsItWasSent) {
  const LcmUrl url = std::get<LcmUrl>(LcmUrl::parse(kUrl));
  std::map<std::string, Bytes> heard;
  const auto ours = std::get<0>(Transport::open(
      url, 0, {}, {0, kEveryType, 0},
      {.on_message = [](const Message&, Bus, AgentId) {},
       .on_accepted =
           [&heard](Bus, std::string_view channel, std::span<const std::byte> bytes) {
             heard[std::string(channel)].assign(bytes.begin(), bytes.end());
           }}));
  Child echo = begin(probe_command({"echo", url.of(Bus::kSwarm), url.of(Bus::kWorld)}));
  Outbox outbox;
  std::map<std::string, Bytes> expected;
  for (const Message& message : every_message()) {
    outbox.push_back({Bus::kSwarm, message});
    expected[channel_of(message)] = encoded(message);
  }
  EXPECT_TRUE(eventually([&] {
    ours->publish(outbox);
    ours->deliver_until(now() + std::chrono::milliseconds(100), -1);
    return heard == expected;
  })) << output();
  echo.send(SIGTERM);
  wait_for(echo);
}

/// Reads the format of Java's Double.toHexString.
double next_number(std::istream& in) {
  std::string word;
  in >> word;
  return std::strtod(word.c_str(), nullptr);
}

TEST_F(SpyJar, APlanIsReadToTheLastBit) {
  for (const char* name :
       {"quadrimodal_corners", "harbour_patrol", "uniform_square", "cube_corners"}) {
    SCOPED_TRACE(name);
    const Scenario scenario = plan_of(name);
    const Mission& mission = scenario.mission();
    std::istringstream printed(ask({"plan", plan_file()}));
    std::string read_name;
    printed >> read_name;
    EXPECT_EQ(read_name, scenario.name());
    for (const double value :
         {mission.domain.origin_m.x(), mission.domain.origin_m.y(), mission.domain.origin_m.z(),
          mission.domain.size_m.x(), mission.domain.size_m.y(), mission.domain.size_m.z(),
          mission.timing.dt_s,
          mission.timing.dt_s * static_cast<double>(mission.timing.tick_count)}) {
      EXPECT_DOUBLE_EQ(next_number(printed), value);
    }
    EXPECT_EQ(next_number(printed), mission.basis.modes_x);
    EXPECT_EQ(next_number(printed), mission.basis.modes_y);
    EXPECT_EQ(next_number(printed), mission.basis.modes_z);
    for (const double value : mission.target_coefficients.reshaped<Eigen::RowMajor>()) {
      ASSERT_EQ(next_number(printed), value);
    }
  }
}

/// The encoded modes of all blocks, each after its block's number.
std::string modes_by_block(const Mission& mission) {
  const BlockLayout layout(mission);
  const auto count = static_cast<std::size_t>(mission.basis.mode_count());
  std::vector<double> modes(count);
  std::iota(modes.begin(), modes.end(), 0);
  std::vector<double> slots = modes;
  if (!layout.in_basis_order()) {
    slots.resize(static_cast<std::size_t>(layout.slot_count()));
    layout.to_slots(modes.data(), slots.data());
  }
  std::string text;
  for (int b = 0; b < layout.block_count(); ++b) {
    text += "block " + std::to_string(b);
    const auto [first, slot_count] = layout.slots_of(b);
    for (int slot = first; slot < first + slot_count; ++slot)
      text += ' ' + std::to_string(std::lround(slots[static_cast<std::size_t>(slot)]));
    text += '\n';
  }
  return text;
}

TEST_F(SpyJar, KnowsWhichModesABlockHas) {
  for (const char* name : {"quadrimodal_corners", "cube_corners"}) {
    for (const std::string time : {"", " high_mode_period_factor: 4",
                                   " high_mode_period_factor: 4 contribution_encoding: FIXED16"}) {
      std::string text = text_of(scenario_file(name));
      text.replace(text.find("time {"), 6, "time {" + time);
      std::ofstream(folder_ / "rare.textproto") << text;
      const Mission mission = plan_of_file(folder_ / "rare.textproto").mission();
      const int room = BlockLayout(mission).block_size();
      EXPECT_NE(ask({"modes", plan_file(), std::to_string(room)}).find(modes_by_block(mission)),
                std::string::npos)
          << name << time << output();
    }
  }
}

TEST_F(SpyJar, TheMapHasXToTheRightAndYUpwards) {
  // One Gaussian at a place whose four mirror images are different places.
  plan_of_bell("quadrimodal_corners", "mean_x_m: 600 mean_y_m: 1600 sigma_m: 150");
  auto found = places("xy");
  EXPECT_NEAR(found["target"].first, 0.3, kPixels) << output();
  EXPECT_NEAR(found["target"].second, 0.8, kPixels);
  EXPECT_NEAR(found["agent"].first, 0.75, kPixels);  // where SpyProbe puts it
  EXPECT_NEAR(found["agent"].second, 0.125, kPixels);
}

TEST_F(SpyJar, StationsAreOpenSquares) {
  std::string text = text_of(scenario_file("quadrimodal_corners"));
  text.replace(text.find("starts {"), 0,
               "kind { name: \"robots\" count: 4 reserve_s: 60 station { x_m: 500 y_m: 1200 } } ");
  std::ofstream(folder_ / "home.textproto") << text;
  plan_of_file(folder_ / "home.textproto");
  const auto ink_at = [&](const char* x, const char* y) {
    const std::string printed = ask({"ink", plan_file(), x, y});
    return std::stoi("0" + printed.substr(std::min(printed.size(), printed.find("ink ") + 4)));
  };
  EXPECT_GE(ink_at("0.25", "0.6"), 4 * 18) << output();
  EXPECT_LE(ink_at("0.25", "0.6"), 4 * 50) << "it is open";
  EXPECT_EQ(ink_at("0.25", "0.4"), 0);
}

TEST_F(SpyJar, ABoxIsSeenAlongEachAxis) {
  plan_of_bell("cube_corners", "mean_x_m: 300 mean_y_m: 800 mean_z_m: 400 sigma_m: 100");
  const std::map<char, std::pair<double, double>> expected = {
      {'x', {0.3, 0.75}}, {'y', {0.8, 0.125}}, {'z', {0.4, 0.625}}};
  for (const std::string axes : {"xy", "xz", "yz"}) {
    auto found = places(axes);
    EXPECT_NEAR(found["target"].first, expected.at(axes[0]).first, kPixels) << axes << output();
    EXPECT_NEAR(found["target"].second, expected.at(axes[1]).first, kPixels) << axes;
    EXPECT_NEAR(found["agent"].first, expected.at(axes[0]).second, kPixels) << axes;
    EXPECT_NEAR(found["agent"].second, expected.at(axes[1]).second, kPixels) << axes;
  }
}

TEST_F(SpyJar, NoBytesHarmIt) {
  plan_of("quadrimodal_corners");
  EXPECT_NE(ask({"hostile", plan_file()}).find("unharmed"), std::string::npos) << output();
}

}  // namespace
}  // namespace ergocast
