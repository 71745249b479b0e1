// SPDX-License-Identifier: BSD-3-Clause
// A team's messages as topics: the coverage is that of an export, and nothing old counts.
#include "cli/foxglove/live_topics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/team.h"

namespace ergocast::cli {
namespace {

using namespace test;
using nlohmann::json;

constexpr std::uint64_t kTime_ns = 5'000'000'000;

class FoxgloveTopics : public ::testing::Test {
 protected:
  void announce_mission(std::vector<Hold> holds = {},
                        std::vector<RosterEntry> roster = roster_of(2)) {
    announce(mission_);
    MissionPart part = mission_part(++revision_, MissionState::kRunning, std::move(roster));
    if (!holds.empty()) part.amendments = pauses(std::move(holds));
    follower_.receive(part);
    ASSERT_TRUE(follower_.mission());
  }
  void move(Tick tick, const std::vector<Eigen::Vector3d>& x_m, std::int64_t roster_revision = 0) {
    WorldState world = world_state(tick, x_m);
    world.roster_revision = roster_revision;
    topics_.take(world, follower_);
  }
  void show(Tick tick, std::uint64_t time_ns = kTime_ns) {
    picture_.tick = tick;
    picture_.dt_s = mission_.timing.dt_s;
    topics_.show(time_ns, picture_, follower_);
  }
  LiveChannels::Channel& channel(const std::string& topic) {
    for (LiveChannels::Id id = 1; channels_.has(id); ++id)
      if (channels_.get(id).topic == topic) return channels_.get(id);
    ADD_FAILURE() << "no " << topic;
    return channels_.get(1);
  }
  json newest(const std::string& topic) {
    const auto& kept = channel(topic).kept;
    return kept.empty() ? json() : json::parse(kept.back().json);
  }
  /// The coverage that these places alone have, as an export shows it.
  json coverage_of_places(const std::vector<Eigen::Vector3d>& x_m) {
    Coefficients sums = Coefficients::Zero(mission_.basis.mode_count());
    for (const auto& one : x_m) sums += basis_values(one, mission_.domain, mission_.basis);
    const auto [columns, rows] = coverage_cells(mission_);
    return json::parse(foxglove::grid(
        kTime_ns, density_of(sums / static_cast<double>(x_m.size()), mission_, columns, rows),
        mission_));
  }

  Mission mission_ = small_mission(2);
  MissionFollower follower_;
  LiveChannels channels_;
  LiveTopics topics_{channels_, GeoPlace{47.5, 9.2}, {}};
  TeamPicture picture_;
  std::int64_t revision_ = 0;
};

TEST_F(FoxgloveTopics, HaveEachNewPlaceOnce) {
  announce_mission();
  move(1, {{100, 200, 0}, {300, 400, 0}});
  move(2, {{101, 200, 0}});
  topics_.show_places(kTime_ns);
  topics_.show_places(kTime_ns + 1);
  EXPECT_EQ(channel("/agents/0/pose").count, 1U);
  EXPECT_EQ(newest("/agents/0/pose")["pose"]["position"]["x"], 101);
  EXPECT_EQ(newest("/agents/1/pose")["pose"]["position"]["y"], 400);
  EXPECT_NEAR(newest("/agents/0/location")["latitude"], 47.5 + 200 / 111'180.0, 1e-5);
  move(1, {{9, 9, 0}});  // an old one
  topics_.show_places(kTime_ns);
  EXPECT_EQ(channel("/agents/0/pose").count, 1U);
}

TEST_F(FoxgloveTopics, HavePlacesAtMost20TimesASecond) {
  announce_mission();
  // A world of 1000 ticks a second, shown after each tick, for 3 s.
  std::vector<std::uint64_t> shown_ns;
  for (Tick tick = 0; tick <= 3000; ++tick) {
    move(tick, {{100 + 0.1 * static_cast<double>(tick), 200, 0}, {300, 400, 0}});
    const auto before = channel("/agents/0/pose").count;
    const std::uint64_t time_ns = kTime_ns + static_cast<std::uint64_t>(tick) * 1'000'000;
    topics_.show_places(time_ns);
    if (channel("/agents/0/pose").count > before) shown_ns.push_back(time_ns);
  }
  EXPECT_EQ(shown_ns.size(), 61U);
  for (std::size_t i = 20; i < shown_ns.size(); ++i)
    EXPECT_GE(shown_ns[i] - shown_ns[i - 20], 1'000'000'000U) << i;
  EXPECT_EQ(newest("/agents/0/pose")["pose"]["position"]["x"], 400);
  // A clock that was set back by seconds stops nothing.
  move(3001, {{500, 200, 0}});
  topics_.show_places(kTime_ns - 3'000'000'000U);
  EXPECT_EQ(newest("/agents/0/pose")["pose"]["position"]["x"], 500);
}

TEST_F(FoxgloveTopics, HaveTheCoverageOfAllPlacesThatCount) {
  announce_mission({{.from = 4, .until = 6}});
  ++channel("/coverage").subscribers;
  std::vector<RosterEntry> roster = roster_of(2);
  move(1, {{100, 200, 0}, {300, 400, 0}});
  move(1, {{100, 200, 0}, {300, 400, 0}});    // repeated
  move(2, {{500, 600, 0}, {-5000, 400, 0}});  // outside
  move(5, {{700, 800, 0}, {700, 800, 0}});    // in a pause
  roster[1].recall_revision = 9;
  announce_mission({{.from = 4, .until = 6}}, roster);
  move(7, {{900, 900, 0}, {1000, 1000, 0}}, 8);
  move(8, {{900, 950, 0}, {1500, 1500, 0}}, 9);  // agent 1 rests
  show(8);
  EXPECT_EQ(newest("/coverage")["data"], coverage_of_places({{100, 200, 0},
                                                             {300, 400, 0},
                                                             {500, 600, 0},
                                                             {900, 900, 0},
                                                             {1000, 1000, 0},
                                                             {900, 950, 0}})["data"]);
}

TEST_F(FoxgloveTopics, HaveNoCoverageThatNobodyReadsAndOneASecond) {
  announce_mission();
  move(1, {{100, 200, 0}});
  show(1);
  EXPECT_EQ(channel("/coverage").count, 0U);
  ++channel("/coverage").subscribers;
  show(1);
  show(1, kTime_ns + 2 * LiveTopics::kCoveragePeriod_ns);
  EXPECT_EQ(channel("/coverage").count, 1U);  // nothing is new
  move(2, {{100, 200, 0}});
  show(2, kTime_ns + LiveTopics::kCoveragePeriod_ns / 2);
  EXPECT_EQ(channel("/coverage").count, 1U);
  show(2, kTime_ns + LiveTopics::kCoveragePeriod_ns);
  EXPECT_EQ(channel("/coverage").count, 2U);
}

TEST_F(FoxgloveTopics, HaveEachTargetAndAmendmentFromItsTickOn) {
  announce_mission();
  show(1);
  show(2);
  EXPECT_EQ(channel("/target").count, 1U);
  Amendments list;
  name_pause(list, 5);
  TargetChange target;
  target.target = mission_.target_coefficients;
  target.target[1] = 0.5;
  name_target(list, 7, target);
  MissionPart part = mission_part(++revision_, MissionState::kRunning, roster_of(2));
  part.amendments = encode_amendments(list);
  follower_.receive(part);
  show(4);
  EXPECT_EQ(channel("/amendments").count, 0U);
  show(5);
  EXPECT_EQ(newest("/amendments")["message"], "amendment 0: the mission is paused");
  EXPECT_EQ(channel("/target").count, 1U);
  show(7);
  show(8);
  EXPECT_EQ(channel("/target").count, 2U);
  EXPECT_EQ(channel("/amendments").count, 2U);
  const auto [columns, rows] = coverage_cells(mission_);
  EXPECT_EQ(newest("/target")["data"],
            json::parse(foxglove::grid(0, density_of(target.target, mission_, columns, rows),
                                       mission_))["data"]);
}

TEST_F(FoxgloveTopics, HaveOneRowOfMetricsForEachTime) {
  announce_mission();
  show(1);
  EXPECT_EQ(channel("/metrics").count, 0U);  // φ² is not known
  AgentRow row;
  row.author = author_of(0);
  row.status = status_of(0, 1, 9);
  row.status->ergodic_metric = 0.25;
  row.status->contributions_received = 12;
  row.status->blocked_ticks = 4;
  picture_.agents = {row};
  picture_.ergodic_metric = 0.25;
  show(10);
  show(10);
  EXPECT_EQ(channel("/metrics").count, 1U);
  const json metrics = newest("/metrics");
  EXPECT_EQ(metrics["tick"], 10);
  EXPECT_EQ(metrics["ergodic_metric"], 0.25);
  EXPECT_EQ(metrics["basis"], "cosines");
  EXPECT_EQ(metrics["contributions_received"], 12);
  EXPECT_EQ(metrics["blocked_share"], 0.4);
  EXPECT_TRUE(metrics["detection_probability"].is_null());
  picture_.detection_probability = 0.5;
  show(11);
  EXPECT_EQ(newest("/metrics")["detection_probability"], 0.5);
}

TEST_F(FoxgloveTopics, HaveLinesOfLogs) {
  topics_.show_line(kTime_ns, "2026-04-12T10:15:01.000 warning sim: late");
  EXPECT_EQ(newest("/log")["level"], 3);
  EXPECT_EQ(newest("/log")["name"], "sim");
  EXPECT_EQ(newest("/log")["message"], "late");
  EXPECT_EQ(newest("/log")["timestamp"]["sec"], 5);
  topics_.show_line(kTime_ns, "and \xff a second line");
  EXPECT_EQ(newest("/log")["level"], 2);
}

}  // namespace
}  // namespace ergocast::cli
