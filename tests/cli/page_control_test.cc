// SPDX-License-Identifier: BSD-3-Clause
// What the page's process passes on to the process that gives the orders.
#include "cli/watch/page_control.h"

#include <gtest/gtest.h>

#include <chrono>

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

class PassedOn : public ::testing::Test {
 protected:
  PassedOn() {
    ends_.first.send("{}");
    control_.listen(now_);
  }
  bool pass_on(ControlAct act) {
    ControlRequest request;
    request.act = act;
    return content_.control(request, "a request");
  }

  std::pair<ControlLink, ControlLink> ends_ = ControlLink::pair().value();
  PageControl control_{std::move(ends_.second), "token"};
  PageServer::Content content_ =
      control_.joined({{}, {}, {}, [] { return [] { return std::string(); }; }});
  Instant now_{100s};
};

TEST_F(PassedOn, AFloodOfRequestsLeavesRoomForAStopAtOnce) {
  int passed = 0;
  for (int i = 0; i < 10'000; ++i) passed += pass_on(ControlAct::kHere) ? 1 : 0;
  EXPECT_EQ(passed, PageControl::kMostInASecond);
  EXPECT_TRUE(pass_on(ControlAct::kStopNow));
  now_ += 1s;
  ends_.first.send("{}");
  control_.listen(now_);
  EXPECT_TRUE(pass_on(ControlAct::kHere));
}

TEST_F(PassedOn, NothingGoesToAProcessThatDoesNotAnswer) {
  now_ += 10s;
  control_.listen(now_);
  EXPECT_FALSE(pass_on(ControlAct::kStopNow));
  const auto browser = content_.events();
  EXPECT_EQ(browser(), "event: control\ndata: {\"silent\":true}\n\n");
  ends_.first.send("{}");
  control_.listen(now_);
  EXPECT_TRUE(pass_on(ControlAct::kStopNow));
  EXPECT_EQ(browser(), "event: control\ndata: {}\n\n");
}

// The process that gives the orders then writes the report, which may take long.
TEST_F(PassedOn, SilenceAfterTheMissionsEndIsNoFault) {
  ends_.first.send(std::string(kControlOver) + R"(,"acts":[]})");
  control_.listen(now_);
  const auto browser = content_.events();
  EXPECT_EQ(browser(), "event: control\ndata: {\"over\":true,\"acts\":[]}\n\n");
  now_ += 60s;
  control_.listen(now_);
  EXPECT_EQ(browser(), "");
  EXPECT_TRUE(pass_on(ControlAct::kHere));
  EXPECT_FALSE(pass_on(ControlAct::kStopNow));
}

/// A request with that target.
std::optional<ControlRequest> drawn(const std::string& target) {
  return ControlRequest::parse(
      R"({"operator":1,"name":"","number":1,"tick":0,"act":"target","target":)" + target + "}");
}

TEST(DrawnTargetRequest, HasPeaksAndPolygonsOfNumbers) {
  const auto request =
      drawn(R"({"peaks":[[1,2,3.5]],"polygons":[[[0,0],[4,0],[4,4]]],"uniform":0.5})");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->target->text(),
            "target {\n  gaussians { mean_x_m: 1 mean_y_m: 2 sigma_m: 3.5 weight: 1 }\n"
            "  regions { weight: 1 polygon { vertices { x_m: 0 y_m: 0 } vertices { x_m: 4 y_m: 0 } "
            "vertices { x_m: 4 y_m: 4 } } }\n  uniform_weight: 2\n}\n");
}

TEST(DrawnTargetRequest, IsRefusedIfItHasAnythingElse) {
  std::string many = "[1,2,3]";
  for (std::size_t i = 0; i < DrawnTarget::kMostParts; ++i) many += ",[1,2,3]";
  for (const std::string& wrong :
       {std::string("null"), std::string(R"({"peaks":[],"polygons":[],"uniform":0})"),
        std::string(R"({"peaks":[[1,2]],"polygons":[],"uniform":0})"),
        std::string(R"({"peaks":[[1,2,"3"]],"polygons":[],"uniform":0})"),
        std::string(R"({"peaks":[[1,2,1e999]],"polygons":[],"uniform":0})"),
        std::string(R"({"peaks":[[1,2,3]],"polygons":[[[0,0],[1,1]]],"uniform":0})"),
        std::string(R"({"peaks":[[1,2,3]],"polygons":[],"uniform":1})"),
        std::string(R"({"peaks":[[1,2,3]],"polygons":[],"uniform":0,"file":"/etc/passwd"})"),
        R"({"peaks":[)" + many + R"(],"polygons":[],"uniform":0})"})
    EXPECT_FALSE(drawn(wrong)) << wrong;
  EXPECT_FALSE(ControlRequest::parse(
      R"({"operator":1,"name":"","number":1,"tick":0,"act":"pause","target":{}})"));
}

TEST(DrawnTargetRequest, OfABoxHasHeights) {
  const auto request = drawn(
      R"({"peaks":[[1,2,3,4]],"polygons":[[[0,0],[4,0],[4,4]]],"uniform":0,"heights_m":[[5,6]]})");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->target->text(),
            "target {\n  gaussians { mean_x_m: 1 mean_y_m: 2 mean_z_m: 3 sigma_m: 4 weight: 1 }\n"
            "  regions { weight: 1 polygon { vertices { x_m: 0 y_m: 0 } vertices { x_m: 4 y_m: 0 } "
            "vertices { x_m: 4 y_m: 4 } low_z_m: 5 high_z_m: 6 } }\n}\n");
  for (const char* heights : {"[]", "[[5]]", "[[5,6],[7,8]]", "5"})
    EXPECT_FALSE(drawn(
        std::string(R"({"peaks":[],"polygons":[[[0,0],[4,0],[4,4]]],"uniform":0,"heights_m":)") +
        heights + "}"))
        << heights;
  EXPECT_FALSE(drawn(R"({"peaks":[[1,2,3]],"polygons":[],"uniform":0,"heights_m":[]})"));
}

/// A request with that zone.
std::optional<ControlRequest> zone(const std::string& zone) {
  return ControlRequest::parse(
      R"({"operator":1,"name":"","number":1,"tick":0,"act":"zone","zone":)" + zone + "}");
}

TEST(DrawnZoneRequest, HasCornersHeightsAndADuration) {
  const auto request =
      zone(R"({"corners_m":[[0,0],[4,0],[4,4.5]],"lasts_s":90.5,"heights_m":[1,2]})");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->zone->text(),
            "vertices { x_m: 0 y_m: 0 }\nvertices { x_m: 4 y_m: 0 }\nvertices { x_m: 4 y_m: 4.5 }\n"
            "low_z_m: 1\nhigh_z_m: 2\n");
  EXPECT_EQ(request->zone->duration(), "90.5s");
  const auto plane = zone(R"({"corners_m":[[0,0],[4,0],[4,4]],"lasts_s":600})");
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->zone->text(),
            "vertices { x_m: 0 y_m: 0 }\nvertices { x_m: 4 y_m: 0 }\nvertices { x_m: 4 y_m: 4 }\n");
}

TEST(DrawnZoneRequest, IsRefusedIfItHasAnythingElse) {
  for (const char* wrong :
       {"null", "{}", R"({"corners_m":[[0,0],[4,0]],"lasts_s":600})",
        R"({"corners_m":[[0,0],[4,0],[4,4,4]],"lasts_s":600})",
        R"({"corners_m":[[0,0],[4,0],[4,1e999]],"lasts_s":600})",
        R"({"corners_m":[[0,0],[4,0],[4,4]]})", R"({"corners_m":[[0,0],[4,0],[4,4]],"lasts_s":0})",
        R"({"corners_m":[[0,0],[4,0],[4,4]],"lasts_s":"600"})",
        R"({"corners_m":[[0,0],[4,0],[4,4]],"lasts_s":600,"heights_m":[1]})",
        R"({"corners_m":[[0,0],[4,0],[4,4]],"lasts_s":600,"heights_m":null})",
        R"({"corners_m":[[0,0],[4,0],[4,4]],"lasts_s":600,"file":"/etc/passwd"})"})
    EXPECT_FALSE(zone(wrong)) << wrong;
  EXPECT_FALSE(
      ControlRequest::parse(R"({"operator":1,"name":"","number":1,"tick":0,"act":"zone"})"));
  EXPECT_FALSE(ControlRequest::parse(
      R"({"operator":1,"name":"","number":1,"tick":0,"act":"pause","zone":{}})"));
}

/// A request with that act, and more keys.
std::optional<ControlRequest> request_to(const std::string& act, const std::string& more) {
  return ControlRequest::parse(R"({"operator":1,"name":"","number":5,"tick":0,"act":")" + act +
                               '"' + more + "}");
}

TEST(CancellationRequest, NamesTheZonesAmendment) {
  const auto request = request_to("reopen", R"(,"amendment":3)");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->act, ControlAct::kReopen);
  EXPECT_EQ(request->amendment, 3);
  for (const char* wrong : {"", R"(,"amendment":-1)", R"(,"amendment":"3")", R"(,"amendment":3.5)",
                            R"(,"amendment":1000000)", R"(,"amendment":3,"zone":{})",
                            R"(,"amendment":3,"agent":1)", R"(,"amendment":3,"instead_of":4)"})
    EXPECT_FALSE(request_to("reopen", wrong)) << wrong;
  EXPECT_FALSE(request_to("pause", R"(,"amendment":3)"));
}

TEST(DrawnZoneRequest, MayReplaceAnEarlierRequest) {
  const std::string drawn = R"(,"zone":{"corners_m":[[0,0],[4,0],[4,4]],"lasts_s":600})";
  EXPECT_EQ(request_to("zone", drawn).value().instead_of, 0);
  EXPECT_EQ(request_to("zone", drawn + R"(,"instead_of":4)").value().instead_of, 4);
  for (const char* wrong : {"0", "5", "\"4\"", "null"})
    EXPECT_FALSE(request_to("zone", drawn + R"(,"instead_of":)" + wrong)) << wrong;
}

}  // namespace
}  // namespace ergocast::cli
