// SPDX-License-Identifier: BSD-3-Clause
// Findings are sorted, wrapped, coloured only on request, and complete as JSON.
#include "cli/doctor/print.h"

#include <nlohmann/json.hpp>

#include "tests/cli/doctor/fixture.h"

namespace ergocast::doctor {
namespace {

const Findings kFindings = {
    {"clock", Level::kOk, "synchronised", "", ""},
    {"TTL", Level::kNote, "ttl=0", "Right for one host.", "--lcm-url X"},
    {"route", Level::kProblem, "none", "Nothing is sent.", "ip route add\nip r"}};

TEST(Print, TheWorstComesFirstWithItsCommandsBelow) {
  const std::string text = text_of(url_of("ttl=0"), kFindings, {});
  EXPECT_TRUE(contains(text,
                       "problem  route  none\n"
                       "                Nothing is sent.\n"
                       "                    ip route add\n"
                       "                    ip r\n"
                       "note     TTL    ttl=0\n"))
      << text;
  EXPECT_TRUE(contains(text, "ok       clock  synchronised\n")) << text;
  EXPECT_TRUE(contains(text, "1 problem, 0 warnings, 1 note; 1 of 3 checks")) << text;
  EXPECT_FALSE(contains(text, "\033"));
}

TEST(Print, ColoursOnlyWhereTheyAreWanted) {
  EXPECT_TRUE(
      contains(text_of(url_of("ttl=0"), kFindings, {true, 80}), "\033[1;31mproblem\033[0m"));
}

TEST(Print, ExplanationsFitTheirColumnsAndCommandsStayWhole) {
  Findings findings = {{"route", Level::kProblem, "none", "", std::string(90, 'c')}};
  for (int i = 0; i < 60; ++i) findings[0].why += "word ";
  std::istringstream lines(text_of(url_of("ttl=0"), findings, {false, 60}));
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(line.size() <= 60 || !contains(line, "word")) << line;
  }
  EXPECT_TRUE(contains(lines.str(), std::string(90, 'c')));
}

TEST(Print, PeersAreATable) {
  const Peer good{"robot-1",
                  "0.1.0",
                  "10.0.0.2",
                  {{150, 50}, {150, 25}},
                  Loss{{150, 50}, {150, 50}},
                  {0.001, 0.002, 0.003},
                  0};
  Peer deaf = good;
  deaf.to_it.reset();
  deaf.round_trips_s.clear();
  const std::string text = text_of(std::vector<Peer>{good, deaf});
  EXPECT_TRUE(contains(text,
                       "robot-1  10.0.0.2  yes          0.0 / 50.0      0.0 / 0.0     "
                       "2.00 / 3.00 / 3.00  0\n"))
      << text;
  EXPECT_TRUE(contains(text, "robot-1  10.0.0.2  NO")) << text;
  EXPECT_EQ(text_of(std::vector<Peer>{}), "");
}

TEST(Print, JsonHoldsFindingsAndPeers) {
  const Peer good{"robot-1", "0.1.0", "10.0.0.2", {{150, 50}, {135, 45}}, std::nullopt, {}, 2};
  const auto json = nlohmann::json::parse(json_of(url_of("ttl=0"), kFindings, {good}));
  EXPECT_EQ(json["findings"].size(), 3u);
  EXPECT_EQ(json["findings"][2]["level"], "problem");
  EXPECT_EQ(json["findings"][2]["remedy"], "ip route add\nip r");
  EXPECT_EQ(json["peers"][0]["hears_this_host"], false);
  EXPECT_NEAR(json["peers"][0]["from_it"]["lost_percent"], 10, 1e-9);
  EXPECT_TRUE(json["peers"][0]["round_trip_ms"].is_null());
}

}  // namespace
}  // namespace ergocast::doctor
