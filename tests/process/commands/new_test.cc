// SPDX-License-Identifier: BSD-3-Clause
// `ergocast new` for small maps: what it writes passes the checks, and runs as it is.
#include <cstdlib>

#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

/// '#' is occupied, '?' unknown. The door of the first two is 1 m wide.
constexpr const char* kTwoRooms = R"(
??????????????????????????????????????????????????
?################################################?
?#......................#.......................#?
?#......................#.......................#?
?#......................#.......................#?
?#......................#.......................#?
?#......................#.......................#?
?#......................#.......................#?
?#......................#.......................#?
?#......................#.......................#?
?#......................#.......................#?
?#......................#.......................#?
?#......................#.......................#?
?#......................#.......................#?
?#..............................................#?
?#..............................................#?
?#..............................................#?
?#..............................................#?
?#..............................................#?
?################################################?
??????????????????????????????????????????????????)";

/// The room in the north has no door, and the way into the east is too narrow for the robots.
constexpr const char* kClosedRooms = R"(
##################################################
#............#...................................#
#............#...................................#
#............#...................................#
##############...................................#
#................................................#
#................................................#
#................................................#
#................................................#
#................................................#
#............................#####################
#............................#...................#
#............................#...................#
#................................................#
#............................#...................#
#............................#...................#
##################################################)";

constexpr const char* kCorridor = R"(
########################################
#......................................#
#......................................#
#......................................#
#......................................#
#......#################################
#......################################?
#......################################?
#......################################?
#......################################?
#......################################?
########################################)";

/// Two halls of 20 m by 24 m with pairs of posts, between which robots do not fit. The posts are
/// smaller than a cell of the modes' grid.
std::string halls_with_posts() {
  constexpr int kColumns = 200, kRows = 120;
  std::string drawing;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const bool side = row == 0 || row == kRows - 1 || column == 0 || column == kColumns - 1;
      const bool between = column == kColumns / 2 && (row < 20 || row > 36);
      const bool post = row % 12 == 10 && row < 112 && (column % 12 == 10 || column % 12 == 2) &&
                        std::abs(column - kColumns / 2) > 5 && column > 9 && column < 192;
      drawing += side || between || post ? '#' : '.';
    }
    drawing += '\n';
  }
  return drawing;
}

class New : public OwnHost {
 protected:
  std::filesystem::path map(const std::string& drawing, const std::string& origin = "[0, 0, 0]",
                            const std::string& free_thresh = "0.196") {
    std::vector<std::string> rows;
    std::istringstream lines(drawing);
    for (std::string line; std::getline(lines, line);)
      if (!line.empty()) rows.push_back(line);
    std::filesystem::create_directories(folder_ / "maps");
    std::ofstream picture(folder_ / "maps/floor.pgm", std::ios::binary);
    picture << "P5\n" << rows[0].size() << ' ' << rows.size() << "\n255\n";
    for (const std::string& row : rows) {
      for (const char c : row) picture << (c == '#' ? '\0' : c == '?' ? '\xcd' : '\xfe');
    }
    std::ofstream(folder_ / "maps/floor.yaml")
        << "image: floor.pgm\nresolution: 0.2\norigin: " << origin
        << "\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: " << free_thresh << '\n';
    return folder_ / "maps/floor.yaml";
  }
  int make(const std::filesystem::path& map, std::vector<std::string> more = {}) {
    std::filesystem::remove(scenario());
    more.insert(more.begin(), {"new", "--map", map, "--out", scenario()});
    return ergocast(more);
  }
  /// Where the robots' centres can be, as the command has printed it.
  double free_m2() {
    const std::string said = output(), before = "their centres can be in ";
    return std::stod(said.substr(said.find(before) + before.size()));
  }
  std::filesystem::path scenario() const { return folder_ / "floor.textproto"; }
  /// The scenario, `check` of it and a short run have no warning.
  void expect_that_it_runs() {
    EXPECT_FALSE(answered("warning")) << output();
    ASSERT_EQ(ergocast({"check", scenario()}), 0) << output();
    EXPECT_FALSE(answered("warning")) << output();
    std::filesystem::remove_all(out());
    ASSERT_EQ(ergocast({"simulate", scenario(), "--duration", "20", "--out", out()}), 0)
        << output();
    EXPECT_FALSE(answered("warning")) << output();
    EXPECT_TRUE(answered("m kept, nearest")) << output();
  }
};

TEST_F(New, WritesAScenarioThatRunsForRoomsACorridorAndATurnedMap) {
  ASSERT_EQ(make(map(kTwoRooms)), 0) << output();
  const double straight_m2 = free_m2();
  expect_that_it_runs();
  EXPECT_NE(text_of(scenario()).find("file: \"maps/floor.yaml\""), std::string::npos);
  EXPECT_NE(text_of(scenario()).find("free_domain: true"), std::string::npos);

  ASSERT_EQ(make(map(kCorridor), {"--robots", "2", "--speed", "0.3", "--radius", "0.15"}), 0)
      << output();
  expect_that_it_runs();
  EXPECT_NE(text_of(scenario()).find("speed_limit_mps: 0.3"), std::string::npos);

  ASSERT_EQ(make(map(kTwoRooms, "[-3, 12.5, 0.4]")), 0) << output();
  EXPECT_NEAR(free_m2(), straight_m2, 0.05 * straight_m2);
  expect_that_it_runs();
}

TEST_F(New, LeavesOutWhatTheRobotsCannotReach) {
  ASSERT_EQ(make(map(kClosedRooms), {"--radius", "0.15"}), 0) << output();
  expect_that_it_runs();
}

TEST_F(New, PostsHoldNoRobotUp) {
  ASSERT_EQ(make(map(halls_with_posts()), {"--robots", "6"}), 0) << output();
  EXPECT_NE(text_of(scenario()).find("free_domain: true"), std::string::npos);
  ASSERT_EQ(ergocast({"simulate", scenario(), "--duration", "200", "--out", out()}), 0) << output();
  EXPECT_LT(summary()["separation"]["longest_block_s"], 10);
}

TEST_F(New, ItsScenarioIsCheckedWithItsRoomsAndAPicture) {
  ASSERT_EQ(make(map(kClosedRooms), {"--radius", "0.15"}), 0) << output();
  const std::filesystem::path picture = folder_ / "rooms.svg";
  ASSERT_EQ(ergocast({"check", scenario(), "--picture", picture}), 0) << output();
  EXPECT_TRUE(answered("floor.yaml: ")) << output();
  EXPECT_TRUE(answered("rooms for bodies that keep 0.27 m from walls: 3")) << output();
  EXPECT_TRUE(answered("agents start here")) << output();
  EXPECT_TRUE(answered("cut off, so it counts as wall")) << output();
  EXPECT_NE(text_of(picture).find("url(#closed)"), std::string::npos);
  EXPECT_TRUE(text_of(picture).ends_with("</svg>\n"));
  EXPECT_EQ(ergocast({"check", scenario(), "--picture", folder_ / "none/rooms.svg"}), 2);
}

TEST_F(New, RefusesMapsWithoutRoomAndTooManyRobots) {
  EXPECT_EQ(make(map(kTwoRooms), {"--radius", "3"}), 2);
  EXPECT_TRUE(answered("has no room for robots with a radius of 3 m")) << output();
  EXPECT_EQ(make(map("###\n###")), 2);
  EXPECT_TRUE(answered("has no free cell")) << output();
  EXPECT_EQ(make(map(kTwoRooms), {"--robots", "200"}), 2);
  EXPECT_TRUE(answered("has room for ")) << output();
  EXPECT_TRUE(answered("or fewer")) << output();
  EXPECT_EQ(make(folder_ / "maps/floor.pgm"), 2);
  EXPECT_TRUE(answered("is no description of a map")) << output();
  EXPECT_EQ(make(folder_ / "none.yaml"), 2);
  EXPECT_FALSE(std::filesystem::exists(scenario()));
}

TEST_F(New, NeverWritesOverAFile) {
  ASSERT_EQ(make(map(kTwoRooms)), 0) << output();
  EXPECT_EQ(ergocast({"new", "--map", map(kTwoRooms), "--out", scenario()}), 2);
  EXPECT_TRUE(answered("is there already")) << output();
}

}  // namespace
}  // namespace ergocast::test
