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

}  // namespace
}  // namespace ergocast::cli
