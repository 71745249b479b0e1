// SPDX-License-Identifier: BSD-3-Clause
// Real processes whose bodies keep a distance, in both paces, and the distances in their record.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "tests/process/support/mission.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

/// The shortest distance of two vehicles in the rows of one tick [m].
double least_recorded_distance_m(const std::string& trajectory) {
  std::map<long, std::vector<std::pair<double, double>>> places_m;
  std::istringstream rows(trajectory);
  std::string row;
  for (std::getline(rows, row); std::getline(rows, row);) {
    std::replace(row.begin(), row.end(), ',', ' ');
    std::istringstream columns(row);
    long tick = 0, agent = 0;
    double t_s = 0, x_m = 0, y_m = 0;
    columns >> tick >> t_s >> agent >> x_m >> y_m;
    places_m[tick].emplace_back(x_m, y_m);
  }
  double least_m = 1e300;
  for (const auto& [tick, team_m] : places_m) {
    for (std::size_t i = 0; i < team_m.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        least_m = std::min(least_m, std::hypot(team_m[i].first - team_m[j].first,
                                               team_m[i].second - team_m[j].second));
      }
    }
  }
  return least_m;
}

class CrowdRun : public OwnHost, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, CrowdRun, ::testing::Values("--lockstep", "--realtime=10"),
                         name_of_pace);

TEST_P(CrowdRun, KeepsItsDistanceAndReportsWhatThatCost) {
  ASSERT_EQ(ergocast({"run", scenario_file("crowded_team"), GetParam(), "--duration", "20", "--out",
                      out()}),
            0)
      << output();
  EXPECT_NE(output().find("distance  8 m kept, nearest 8."), std::string::npos) << output();
  const double least_m = least_recorded_distance_m(text_of(out() / "trajectory.csv"));
  EXPECT_GE(least_m, 8);
  EXPECT_LT(least_m, 9) << "no crowd";
  const bool lockstep = std::string(GetParam()) == "--lockstep";
  EXPECT_EQ(ergocast({"verify", out()}), lockstep ? 0 : 2) << output();

  const auto kept = summary()["separation"];
  EXPECT_EQ(kept["distance_m"], 8);
  EXPECT_DOUBLE_EQ(kept["nearest_m"], least_m);
  EXPECT_GT(kept["blocked_share"], 0);
  EXPECT_GE(kept["longest_block_s"], 0.1);
  const std::string metrics = text_of(out() / "metrics.csv");
  EXPECT_GT(std::stod(metrics.substr(metrics.rfind(',') + 1)), 0) << metrics;
  EXPECT_NE(text_of(out() / "report.html").find("longest_block_s"), std::string::npos);
}

class CheckedScenario : public OwnHost {
 protected:
  bool printed(const std::string& part) const { return output().find(part) != std::string::npos; }
};

TEST_F(CheckedScenario, ReportsTheDistanceThatBodiesThatFollowLateKeep) {
  const std::string late = "separation.response_s=0.25";
  ASSERT_EQ(ergocast({"check", scenario_file("crowded_team"), "--set", late}), 0) << output();
  EXPECT_TRUE(
      printed("bodies follow 0.25 s late: they close 10 % of a gap in a tick, and keep 5 m "
              "more, in all 13 m from each other, 5 m from the edges\n"))
      << output();
  ASSERT_EQ(ergocast({"check", scenario_file("office")}), 0);
  EXPECT_TRUE(printed(" m from the edges and 0.55 m from walls\n")) << output();
  ASSERT_EQ(ergocast({"check", scenario_file("crowded_team")}), 0);
  EXPECT_FALSE(printed("late")) << output();
}

}  // namespace
}  // namespace ergocast::test
