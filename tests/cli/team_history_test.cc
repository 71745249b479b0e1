// SPDX-License-Identifier: BSD-3-Clause
// The history of the statuses: the columns of metrics.csv, within bounds.
#include "cli/team/team_history.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace ergocast {
namespace {

using Json = nlohmann::ordered_json;

/// Two agents that answer, and one without a status yet.
TeamPicture picture_at(Tick tick) {
  TeamPicture picture;
  picture.tick = tick;
  picture.dt_s = 0.1;
  picture.ergodic_metric = 0.25;
  for (const double phi : {0.25, 0.75}) {
    AgentStatus status;
    status.answered_tick = tick;
    status.ergodic_metric = phi;
    status.max_staleness_s = 8 * phi;
    status.contributions_received = 10;
    status.contributions_lost = 3;
    picture.agents.push_back({.author = {}, .status = status});
  }
  picture.agents.push_back({.author = {}, .status = std::nullopt});
  return picture;
}

TEST(TeamHistory, HasTheColumnsOfTheMetrics) {
  TeamHistory history;
  history.add(picture_at(0));
  history.add(picture_at(20));
  history.add(picture_at(20));  // the time has not advanced
  TeamPicture unknown = picture_at(30);
  unknown.ergodic_metric.reset();
  history.add(unknown);
  EXPECT_EQ(history.json(),
            Json::parse(R"({"t": [0.0, 2.0], "phi": [0.25, 0.25], "spread": [0.5, 0.5],
                            "age": [6.0, 6.0], "received": [20, 20], "lost": [6, 6]})"));
}

TEST(TeamHistory, LeavesOutAgentsThatHaveSentNothing) {
  TeamPicture picture = picture_at(0);
  picture.agents.erase(picture.agents.begin(), picture.agents.begin() + 2);
  TeamHistory history;
  history.add(picture);
  EXPECT_EQ(history.json()["spread"], Json::parse("[null]"));
  EXPECT_EQ(history.json()["age"], Json::parse("[null]"));
}

TEST(TeamHistory, IsBoundedAndKeepsItsBegin) {
  TeamHistory history;
  const Tick end = 10 * static_cast<Tick>(TeamHistory::kMostRows);
  for (Tick tick = 0; tick < end; ++tick) history.add(picture_at(tick));
  const Json t = history.json()["t"];
  EXPECT_LT(t.size(), TeamHistory::kMostRows);
  EXPECT_GE(t.size(), TeamHistory::kMostRows / 2);
  EXPECT_EQ(t.front(), 0.0);
  EXPECT_GT(t.back(), 0.1 * static_cast<double>(end - 20));
  for (std::size_t i = 2; i < t.size(); ++i)
    EXPECT_NEAR(t[i].get<double>() - t[i - 1].get<double>(), t[1].get<double>(), 1e-6);
}

}  // namespace
}  // namespace ergocast
