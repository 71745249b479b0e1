// SPDX-License-Identifier: BSD-3-Clause
// The table that people read: aligned, narrow, and with the worst on top.
#include "cli/team/team_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

namespace ergocast {
namespace {

AgentRow row_of(AgentId id, Condition condition) {
  AgentRow row;
  row.author = {id, 0xabcdef0123456789};
  row.condition = condition;
  AgentStatus status;
  status.header.tick = 599999;
  status.phase = AgentPhase::kRunning;
  status.ergodic_metric = 0.00123456;
  status.answered_tick = 599999;
  status.max_staleness_s = 12.34;
  status.loop_lag_s = 0.0012;
  status.host = "robot-12";
  row.status = status;
  row.tick = 599999;
  return row;
}

TeamPicture running_team() {
  TeamPicture picture;
  picture.run = 0x1234;
  picture.scenario = "quadrimodal_corners";
  picture.state = MissionState::kRunning;
  picture.tick = picture.counted = 599999;
  picture.tick_count = 1000000;
  picture.dt_s = 0.1;
  picture.ergodic_metric = 0.00123;
  picture.agents_alive = 2;
  picture.agents_expected = 3;
  picture.agents = {row_of(2, Condition::kSilent), row_of(0, Condition::kOk),
                    row_of(127, Condition::kOk)};
  picture.agents[0].silent_s = 4.2;
  picture.agents[0].status->refused = {0, 0, 3, 0, 0, 0, 1};
  picture.agents[1].restarts = 1;
  picture.agents[1].position_m = {10, 20.5};
  picture.processes = {{"coordinator", true, false, 0.1, 0xc0ffee, "base", 599999},
                       {"world", true, true, 3.4, 0xabc, "", 599990},
                       {"logger", false, false, 3.4, 0, "", 0}};
  picture.trouble = true;
  return picture;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(TeamTable, ShowsWhichBodyBlocksAnAgentOnceItLasts) {
  AgentRow row = row_of(0, Condition::kOk);
  row.status->blocked_by = 3;
  row.blocked_s = 0.9;
  EXPECT_EQ(condition_text(row), "ok");
  row.blocked_s = 4;
  EXPECT_EQ(condition_text(row), "blocked by agent 3 for 4 s");
  row.status->blocked_by = kUnassigned;
  EXPECT_EQ(condition_text(row), "blocked by an edge for 4 s");
  row.condition = Condition::kSilent;
  EXPECT_EQ(condition_text(row), "silent 0 s");
}

TEST(TeamTable, NamesTheHostToUpdate) {
  TeamPicture picture = running_team();
  EXPECT_EQ(team_table(picture, false).find("update"), std::string::npos);
  picture.other_versions = {{"rover1", "0.2.0"}, {"rover2\x1b[", "99.0"}};
  picture.version = "0.3.0";
  const std::string text = team_table(picture, false);
  EXPECT_NE(text.find("an agent on rover1 cannot join: it has version 0.2.0 and this host has "
                      "0.3.0; update rover1 to 0.3.0\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("; update this host to 99.0\n"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos) << "received text stays printable";
  EXPECT_EQ(nlohmann::json::parse(team_json(picture))["other_versions"]["rover1"], "0.2.0");
}

TEST(TeamTable, SaysWhatHasBeenFoundOnceALoggerHasSaidSo) {
  TeamPicture picture = running_team();
  EXPECT_EQ(nlohmann::json::parse(team_json(picture))["detection_probability"], nullptr);
  EXPECT_EQ(nlohmann::json::parse(team_json(picture))["objects"], nullptr);
  picture.detection_probability = 0.4312;
  EXPECT_EQ(nlohmann::json::parse(team_json(picture))["detection_probability"], 0.4312);
  EXPECT_EQ(lines_of(team_table(picture, false))[1],
            "2 of 3 agents alive, phi^2 0.00123 (median), found 43.1 % of objects drawn from the "
            "target, unauthenticated");
  picture.objects = 3;
  picture.finds = {{.object = 2, .agent = 1, .tick = 80, .t_s = 8, .x_m = {100, 250.5, 0}}};
  EXPECT_EQ(lines_of(team_table(picture, false))[1],
            "2 of 3 agents alive, phi^2 0.00123 (median), found 43.1 % of objects drawn from the "
            "target, 1 of 3 hidden objects found, the newest: object 2 found by agent 1 at (100.0, "
            "250.5) m after 8.0 s, unauthenticated");
  EXPECT_EQ(nlohmann::json::parse(team_json(picture))["objects"],
            nlohmann::json::parse(R"({"count": 3, "found": 1, "finds": [{"object": 2, "agent": 1,
                                      "tick": 80, "t_s": 8.0, "x_m": 100.0, "y_m": 250.5}]})"));
}

TEST(TeamTable, NamesClientsWhereThereAreSome) {
  TeamPicture picture = running_team();
  EXPECT_EQ(team_table(picture, false).find("shown to"), std::string::npos);
  picture.clients = {"browser 127.0.0.1:5", "TAK at \x1b[2J"};
  const std::string text = team_table(picture, false);
  EXPECT_NE(text.find("\nshown to  browser 127.0.0.1:5\nshown to  TAK at "), std::string::npos)
      << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos) << "received text stays printable";
}

TEST(TeamTable, ShowsEverythingInLinesThatFit) {
  EXPECT_EQ(
      team_table(running_team(), false),
      "quadrimodal_corners, run 0000000000001234, running, tick 599999 of 1000000 (60 %), t = "
      "59999.9 s\n2 of 3 agents alive, phi^2 0.00123 (median), unauthenticated\n\ncoordinator  "
      "alive  life 000000  tick 599999  on base\nworld        silent 3 s  life 000000  tick "
      "599990\nlogger       no message\n\n id  state       host      life     tick   phi^2 stale s "
      "lag ms lost drops restarts  refused\n  2  silent 4 s  robot-12  abcdef 599999 0.00123    "
      "12.3    1.2    0     0        0  tag 3 range 1\n  0  ok          robot-12  abcdef 599999 "
      "0.00123    12.3    1.2    0     0        1\n127  ok          robot-12  abcdef 599999 "
      "0.00123    12.3    1.2    0     0        0\n");
  for (const std::string& line : lines_of(team_table(running_team(), false))) {
    EXPECT_LE(line.size(), 100u) << line;
  }
}

TEST(TeamTable, WarnsOfLateCommandsWithTheRemedy) {
  TeamPicture picture = running_team();
  picture.tick = 1000;
  picture.agents_expected = 3;
  picture.missed_deadlines = 29;
  EXPECT_EQ(team_table(picture, false).find("warning"), std::string::npos);
  picture.missed_deadlines = 360;
  EXPECT_EQ(lines_of(team_table(picture, false))[2],
            "warning: 12 % of the commands came too late for their tick, and vehicles went on with "
            "older ones: this machine or the network is too slow. Choose a smaller --realtime "
            "factor, a longer time.dt_s or fewer agents");
  EXPECT_NE(team_table(picture, true).find("\x1b[33mwarning: 12 %"), std::string::npos);
  const auto json = nlohmann::json::parse(team_json(picture));
  EXPECT_EQ(json["late_share"], 0.12);
  EXPECT_TRUE(json["warning"].get<std::string>().starts_with("12 % of the commands"));
  EXPECT_EQ(nlohmann::json::parse(team_json(running_team()))["warning"], nullptr);
}

TEST(TeamTable, ColourChangesNothingButColour) {
  std::string coloured = team_table(running_team(), true);
  EXPECT_NE(coloured.find("\x1b[31;1msilent 4 s\x1b[0m"), std::string::npos) << coloured;
  for (auto at = coloured.find('\x1b'); at != std::string::npos; at = coloured.find('\x1b')) {
    coloured.erase(at, coloured.find('m', at) - at + 1);
  }
  EXPECT_EQ(coloured, team_table(running_team(), false));
}

TEST(TeamTable, NamesTheProcessThatAnAgentWaitsFor) {
  AgentRow row = row_of(1, Condition::kWaiting);
  row.status->waiting_for = 3;
  EXPECT_EQ(condition_text(row), "waiting for 3");
  row.status->waiting_for = kWorld;
  EXPECT_EQ(condition_text(row), "waiting for world");
}

TEST(TeamTable, OfALongHostNameOrAnAgentWithoutMessagesStaysAligned) {
  TeamPicture picture = running_team();
  picture.agents[0].status->host = std::string(63, 'h');
  picture.agents[1].status->host = "über-träge-robotermaschine";
  picture.agents[2].status.reset();
  const auto lines = lines_of(team_table(picture, false));
  const std::string title = lines[7];
  EXPECT_NE(title.find("life"), std::string::npos);
  EXPECT_EQ(lines[8].find("…"), title.find("life") - 3) << lines[8];
  EXPECT_NE(lines[9].find("über-träge-ro…"), std::string::npos) << lines[9];
  EXPECT_EQ(lines[10].find("abcdef"), title.find("life"));
}

TEST(TeamTable, IsCutToTheTerminalsHeight) {
  EXPECT_EQ(cut_to_height("a\nb\nc\n", 3), "a\nb\nc\n");
  EXPECT_EQ(cut_to_height("a\nb\nc\nd\n", 3), "a\nb\n… and 2 more\n");
}

TEST(TeamJson, HasOneClockAndTheWorldsTickBeside) {
  TeamPicture picture = running_team();
  picture.tick = 700;
  picture.counted = 500;
  const auto json = nlohmann::json::parse(team_json(picture));
  EXPECT_EQ(json["tick"], 500);
  EXPECT_EQ(json["t_s"], 50);
  EXPECT_EQ(json["world_tick"], 700);
  EXPECT_EQ(json["agents"][0]["tick"], 599999);
  EXPECT_NE(team_table(picture, false).find("tick 500 of"), std::string::npos);
}

TEST(TeamTable, NamesTheTargetThatHoldsInMissionTime) {
  TeamPicture picture = running_team();
  EXPECT_EQ(team_table(picture, false).find("amendment"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(team_json(picture))["target"], nullptr);
  picture.holds = {{100, 300}};
  picture.target = {.number = 3, .kind = AmendmentKind::kTarget, .from = 1400};
  EXPECT_NE(team_table(picture, false).find(", target of amendment 3 since t = 120.0 s, "),
            std::string::npos)
      << team_table(picture, false);
  EXPECT_EQ(nlohmann::json::parse(team_json(picture))["target"],
            nlohmann::json::parse(R"({"amendment": 3, "from_tick": 1400})"));
}

TEST(TeamTable, NamesTheLawThatHolds) {
  TeamPicture picture = running_team();
  EXPECT_EQ(nlohmann::json::parse(team_json(picture))["law"], nullptr);
  picture.law = LawChange{.number = 5, .from = 1400, .kinds = {{8, 0.5, 2}}};
  picture.law_text = "u_max_mps 8";
  EXPECT_NE(team_table(picture, false).find(", law of amendment 5 (u_max_mps 8), "),
            std::string::npos)
      << team_table(picture, false);
  EXPECT_EQ(nlohmann::json::parse(team_json(picture))["law"],
            nlohmann::json::parse(R"({"amendment": 5, "from_tick": 1400, "kinds": [
                {"u_max_mps": 8.0, "noise_intensity": 0.5, "noise_ceiling": 2.0}]})"));
}

TEST(TeamJson, IsOneLineWithNullForWhatIsNotKnown) {
  const std::string line = team_json(running_team());
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json["run_id"], "0000000000001234");
  EXPECT_EQ(json["state"], "running");
  EXPECT_EQ(json["tick"], 599999);
  EXPECT_EQ(json["agents"][0]["state"], "silent");
  EXPECT_EQ(json["agents"][0]["refused"]["tag"], 3);
  EXPECT_EQ(json["agents"][1]["restarts"], 1);
  EXPECT_EQ(json["agents"][1]["position_m"], nlohmann::json::parse("[10.0, 20.5]"));
  EXPECT_EQ(json["agents"][2]["position_m"], nullptr);
  EXPECT_EQ(json["processes"]["world"]["state"], "silent");
  EXPECT_EQ(json["processes"]["logger"]["tick"], nullptr);
  const auto unknown = nlohmann::json::parse(team_json(TeamPicture{}));
  for (const char* key : {"scenario", "state", "tick_count", "t_s", "ergodic_metric"}) {
    EXPECT_EQ(unknown[key], nullptr) << key;
  }
}

}  // namespace
}  // namespace ergocast
