// SPDX-License-Identifier: BSD-3-Clause
// The jar for lcm-spy: types, the plan's reader, and the view of given messages. LCM's Java reads
// what we send, and the reverse.
#include <cmath>
#include <map>

#include "lcm_types.h"
#include "lcmtypes/channels.h"
#include "plan/plan.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/transport.h"
#include "scenario/scenario.h"
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
    const auto& scenario = loaded.value();
    const auto plan = encode_plan(scenario.mission());
    std::ofstream(plan_file(), std::ios::binary)
        .write(reinterpret_cast<const char*>(plan.data()),
               static_cast<std::streamsize>(plan.size()));
    return scenario;
  }
  std::filesystem::path plan_file() const { return folder_ / "plan.binpb"; }
  /// Whether the last answer has this line.
  bool prints(const std::string& line) const {
    return ("\n" + output()).find("\n" + line + "\n") != std::string::npos;
  }
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
  const LcmUrl url = LcmUrl::parse(kUrl).value();
  std::map<std::string, Bytes> heard;
  const auto ours =
      Transport::open(
          url, 0, {}, {0, kEveryType, 0},
          {.on_message = [](const Message&, Bus, AgentId) {},
           .on_accepted =
               [&heard](Bus, std::string_view channel, std::span<const std::byte> bytes) {
                 heard[std::string(channel)].assign(bytes.begin(), bytes.end());
               }})
          .value();
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
  for (const char* name : {"quadrimodal_corners", "harbour_patrol", "cube_corners", "two_rooms"}) {
    SCOPED_TRACE(name);
    const Scenario scenario = plan_of(name);
    const Mission& mission = scenario.mission();
    std::istringstream printed(ask({"plan", plan_file()}));
    std::string read_name;
    printed >> read_name;
    EXPECT_EQ(read_name, scenario.name());
    for (const double value :
         {mission.domain.origin_m.x(), mission.domain.origin_m.y(), mission.domain.size_m.x(),
          mission.domain.size_m.y(), mission.timing.dt_s}) {
      EXPECT_EQ(next_number(printed), value);
    }
    EXPECT_EQ(next_number(printed), mission.timing.tick_count);
    EXPECT_EQ(next_number(printed), mission.walls.size());
    for (const Ring& ring : mission.walls) {
      for (const Eigen::Vector2d& corner_m : ring) {
        ASSERT_EQ(next_number(printed), corner_m.x());
        ASSERT_EQ(next_number(printed), corner_m.y());
      }
    }
  }
}

TEST_F(SpyJar, TheMapHasXToTheRightAndYUpwardsAndWalls) {
  for (const bool walls : {false, true}) {
    plan_of(walls ? "two_rooms" : "quadrimodal_corners");
    std::istringstream answer(ask({"map", plan_file()}));
    std::string agent, wall;
    double x = -1, y = -1, pixels = -1;
    answer >> agent >> x >> y >> wall >> pixels;
    EXPECT_NEAR(x, 0.75, 0.01) << output();  // where SpyProbe puts it; four pixels of 400
    EXPECT_NEAR(y, 0.125, 0.01) << output();
    // Two walls of 40 m × 900 m, but for their smoothed edges.
    EXPECT_NEAR(pixels, walls ? 2 * 8 * 180 : 0, walls ? 100 : 0) << output();
  }
}

TEST_F(SpyJar, TheViewShowsTimeAgentsAndMetricAndWhetherTheCoordinatorIsSilent) {
  plan_of("quadrimodal_corners");
  ask({"words", plan_file()});
  const std::string begun = "quadrimodal_corners, 0.5 of 600 s; running, 3 of 4 agents alive, ";
  for (const std::string& line : {
           std::string("No mission received yet: it is sent once a second"),
           std::string("quadrimodal_corners, 0.0 of 600 s; no report of the coordinator yet"),
           begun + "agent 2 is silent",
           begun + "agent 2 is silent, φ² = 0.000123",
           std::string("running, 3 of 4 agents alive, agent 2 is silent, φ² = 0.000123; no report "
                       "of the coordinator for 4 s"),
       }) {
    EXPECT_TRUE(prints(line)) << line << "\nin\n" << output();
  }
}

TEST_F(SpyJar, NoBytesHarmIt) {
  plan_of("quadrimodal_corners");
  EXPECT_NE(ask({"hostile", plan_file()}).find("unharmed"), std::string::npos) << output();
}

}  // namespace
}  // namespace ergocast
