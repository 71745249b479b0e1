// SPDX-License-Identifier: BSD-3-Clause
// `ergocast export --to geojson`: a record on a map.
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

class ExportedMap : public OwnHost {
 protected:
  /// The features of a simulated mission's map.
  nlohmann::json map_of(const std::string& scenario, const std::vector<std::string>& more = {}) {
    std::vector<std::string> simulate{
        "simulate", scenario_file(scenario), "--duration", "20", "--out", out()};
    simulate.insert(simulate.end(), amendments_.begin(), amendments_.end());
    EXPECT_EQ(ergocast(simulate), 0) << output();
    std::vector<std::string> words{"export", out(), "--to", "geojson"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(ergocast(words), 0) << output();
    return nlohmann::json::parse(text_of(out() / "export.geojson"))["features"];
  }
  static std::vector<nlohmann::json> of_kind(const nlohmann::json& features,
                                             const std::string& kind) {
    std::vector<nlohmann::json> found;
    for (const auto& feature : features) {
      if (feature["properties"]["kind"] == kind) found.push_back(feature);
    }
    return found;
  }

  std::vector<std::string> amendments_;
};

TEST_F(ExportedMap, OfAScenarioWithoutAnOriginLiesAtZeroWithANote) {
  const auto features = map_of("quadrimodal_corners");
  EXPECT_NE(output().find("note: the scenario has no origin"), std::string::npos) << output();
  EXPECT_NE(output().find("--origin LATITUDE,LONGITUDE"), std::string::npos) << output();
  EXPECT_EQ(of_kind(features, "track").size(), 4U);
  const auto corner = of_kind(features, "domain").at(0)["geometry"]["coordinates"][0][2];
  EXPECT_NEAR(corner[0], 2000 / 111319.5, 1e-5);
  EXPECT_NEAR(corner[1], 2000 / 110574.4, 1e-5);
}

TEST_F(ExportedMap, HasTheWalls) {
  const auto walls = of_kind(map_of("two_rooms", {"--origin", "0,0"}), "wall");
  EXPECT_EQ(output().find("note"), std::string::npos) << output();
  ASSERT_EQ(walls.size(), 2U);
  const auto rings = walls[0]["geometry"]["coordinates"];
  ASSERT_EQ(rings.size(), 1U) << "no room is in it";
  ASSERT_EQ(rings[0].size(), 5U);
  EXPECT_EQ(rings[0].front(), rings[0].back());
  EXPECT_NEAR(rings[0][0][0], 980 / 111319.5, 1e-5);
}

TEST_F(ExportedMap, HasTheStations) {
  const auto stations = of_kind(map_of("home_by_dusk"), "station");
  ASSERT_EQ(stations.size(), 4U);
  EXPECT_EQ(stations[1]["properties"]["agent"], 1);
  EXPECT_EQ(stations[1]["properties"]["rests_from_s"], 8) << "twelve seconds before the end";
  EXPECT_NEAR(stations[1]["geometry"]["coordinates"][0], 14 / 111319.5, 1e-7);
}

TEST_F(ExportedMap, HasTheZonesAndAmendments) {
  std::ofstream file(folder_ / "zone.textproto");
  for (const auto& [x_m, y_m] : {std::pair{900, 900}, {1100, 900}, {1100, 1100}})
    file << "vertices { x_m: " << x_m << " y_m: " << y_m << " }\n";
  file.close();
  amendments_ = {"--amend", "15+3:" + (folder_ / "zone.textproto").string(), "--end", "1:30s"};
  const auto features = map_of("quadrimodal_corners");
  const auto zones = of_kind(features, "zone");
  ASSERT_EQ(zones.size(), 1U);
  EXPECT_EQ(zones[0]["properties"]["amendment"], 1);
  EXPECT_EQ(zones[0]["properties"]["free_from_s"], 15);
  EXPECT_EQ(zones[0]["properties"]["until_s"], 18);
  EXPECT_LT(zones[0]["properties"]["closed_from_s"], 15);
  const auto ring = zones[0]["geometry"]["coordinates"][0];
  ASSERT_EQ(ring.size(), 4U);
  EXPECT_NEAR(ring[1][0], 1100 / 111319.5, 1e-5);
  const auto amendments = of_kind(features, "domain").at(0)["properties"]["amendments"];
  ASSERT_EQ(amendments.size(), 2U);
  EXPECT_EQ(amendments[0]["tick_count"], 300);
}

TEST_F(ExportedMap, TablesAndMcapHaveWhatHasChanged) {
  amendments_ = {"--law", "2:u_max_mps=3", "--end", "1:30s"};
  map_of("quadrimodal_corners");
  ASSERT_EQ(ergocast({"export", out(), "--to", "csv"}), 0) << output();
  EXPECT_EQ(text_of(out() / "export/amendments.csv"),
            "number,kind,from_tick,t_s,change,by\n"
            "0,end,10,1,\"the end at 30 s of mission time\",\"simulate\"\n"
            "1,law,20,2,\"law u_max_mps 3\",\"simulate\"\n");
  ASSERT_EQ(ergocast({"export", out(), "--to", "mcap"}), 0) << output();
  const std::string mcap = text_of(out() / "export.mcap");
  EXPECT_NE(mcap.find("/amendments"), std::string::npos);
  EXPECT_NE(mcap.find("amendment 1: law u_max_mps 3"), std::string::npos);
}

TEST_F(ExportedMap, TablesLeaveNoChangesOfAnEarlierRecord) {
  map_of("quadrimodal_corners");
  std::filesystem::create_directories(out() / "export");
  std::ofstream(out() / "export/amendments.csv") << "of another record";
  ASSERT_EQ(ergocast({"export", out(), "--to", "csv"}), 0) << output();
  EXPECT_FALSE(std::filesystem::exists(out() / "export/amendments.csv"));
  EXPECT_TRUE(std::filesystem::exists(out() / "export/metrics.csv"));
}

}  // namespace
}  // namespace ergocast::test
