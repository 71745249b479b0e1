// SPDX-License-Identifier: BSD-3-Clause
// A team's picture as events of Cursor on Target: types, places, courses, times and escapes.
#include <gtest/gtest.h>

#include <pugixml.hpp>

#include "cli/tak/team_events.h"
#include "tests/support/team.h"

namespace ergocast::cli {
namespace {

using namespace test;

const GeoPlace kOrigin{47.5, 9.2};
/// 2026-01-31T12:00:00.250Z
const WallTime kTime = WallTime(std::chrono::milliseconds(1'769'860'800'250));

AgentRow robot_at(AgentId id, std::vector<double> x_m, std::vector<double> v_mps) {
  AgentRow row;
  row.author = author_of(id);
  row.position_m = std::move(x_m);
  row.velocity_mps = std::move(v_mps);
  row.position_tick = 100;
  return row;
}

class Cot : public ::testing::Test {
 protected:
  Cot() {
    picture_.run = 0xabc;
    picture_.scenario = mission_.name;
    picture_.tick = 100;
    picture_.dt_s = 0.1;
    picture_.processes = {{.name = "world", .heard = true}};
    picture_.agents = {robot_at(0, {1000, 2000}, {3, 4})};
  }
  std::vector<CotEvent> due(Instant now = at(0s)) { return events_.due(picture_, mission_, now); }
  /// The only event that is due.
  CotEvent only(Instant now = at(0s)) {
    auto all = due(now);
    EXPECT_EQ(all.size(), 1U);
    return all.empty() ? CotEvent() : all.front();
  }
  ProcessRow& world() { return picture_.processes.front(); }

  Mission mission_ = small_mission(1);
  TeamPicture picture_;
  TeamEvents events_{kOrigin};
};

TEST_F(Cot, HasARobotWhereItIsWithItsCourseAndSpeed) {
  const CotEvent event = only();
  EXPECT_EQ(event.uid, "ergocast-0000000000000abc-agent-0");
  EXPECT_EQ(event.callsign, "small 0");
  EXPECT_EQ(event.type, "a-f-G");
  // By the ellipsoid: a degree of latitude is 111 180 m there, and one of longitude 75 330 m.
  EXPECT_NEAR(event.place.latitude_deg, 47.5 + 2000 / 111'180.0, 1e-5);
  EXPECT_NEAR(event.place.longitude_deg, 9.2 + 1000 / 75'330.0, 1e-5);
  ASSERT_TRUE(event.track);
  EXPECT_NEAR(event.track->course_deg, 36.87, 0.01);
  EXPECT_DOUBLE_EQ(event.track->speed_mps, 5);
  EXPECT_EQ(event.lasts, 5s);
}

TEST_F(Cot, SaysWhichWayARobotThatStandsHasCome) {
  picture_.agents[0].velocity_mps = {0, 0};
  EXPECT_FALSE(only().track) << "no course is known";
  picture_.agents[0].velocity_mps = {-1, 0};
  EXPECT_DOUBLE_EQ(only(at(1s)).track->course_deg, 270);
  picture_.agents[0].velocity_mps = {0, 0};
  const CotEvent event = only(at(2s));
  EXPECT_DOUBLE_EQ(event.track->course_deg, 270);
  EXPECT_DOUBLE_EQ(event.track->speed_mps, 0);
}

TEST_F(Cot, TellsTheTypeByTheVehicle) {
  mission_.kinds = {{.name = "plane", .vehicle = VehicleLimits{VehicleKind::kFixedWing}},
                    {.name = "rover", .vehicle = VehicleLimits{VehicleKind::kUnicycle}},
                    {.name = "other"}};
  picture_.agents = {robot_at(0, {0, 0, 30}, {1, 0, 0}), robot_at(1, {0, 0, 0}, {1, 0, 0}),
                     robot_at(2, {0, 0, 9.5}, {1, 0, 0})};
  for (const int i : {0, 1, 2})
    picture_.agents[static_cast<std::size_t>(i)].kind =
        mission_.kinds[static_cast<std::size_t>(i)].name;
  mission_.domain.size_m.z() = 100;
  const auto events = due();
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].type, "a-f-A-M-F-Q");
  EXPECT_EQ(events[1].type, "a-f-G-U-C");
  EXPECT_EQ(events[2].type, "a-f-A-M-H-Q");
  EXPECT_NE(events[2].remarks.find("kind other, height 9.5 m"), std::string::npos);
}

TEST_F(Cot, SendsARobotAtMostOnceASecond) {
  EXPECT_EQ(due().size(), 1U);
  EXPECT_TRUE(due(at(999ms)).empty());
  EXPECT_EQ(due(at(1s)).size(), 1U);
  EXPECT_TRUE(due(at(1999ms)).empty());
}

TEST_F(Cot, SendsNoOldPlaceAsNew) {
  world().silent_s = 3.1;
  EXPECT_TRUE(due().empty());
  world().silent_s = 0;
  picture_.tick = 131;
  EXPECT_TRUE(due().empty());
  picture_.tick = 130;
  picture_.over = true;
  EXPECT_TRUE(due().empty());
  picture_.over = false;
  EXPECT_EQ(due().size(), 1U);
}

TEST_F(Cot, HasZonesContactsAndFinds) {
  picture_.agents.clear();
  Zone zone;
  zone.number = 4;
  zone.corners_m = {{0, 0}, {300, 0}, {0, 300}};
  picture_.zones = {zone};
  picture_.finds = {{.object = 1, .agent = 3, .t_s = 12.5, .x_m = {10, 20, 0}}};
  picture_.contacts = {
      {.cell = 7, .reports = 2, .probability = 0.875, .x_m = {50, 60}, .t_s = 12.5}};
  const auto events = due();
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].uid, "ergocast-0000000000000abc-zone-4");
  EXPECT_EQ(events[0].type, "u-d-f");
  ASSERT_EQ(events[0].outline.size(), 3U);
  EXPECT_NEAR(events[0].outline[2].latitude_deg, 47.5 + 300 / 111'180.0, 1e-6);
  EXPECT_NEAR(events[0].place.longitude_deg, 9.2 + 100 / 75'330.0, 1e-6);
  EXPECT_EQ(events[1].type, "b-m-p-s-m");
  EXPECT_EQ(events[1].callsign, "small object 1");
  EXPECT_EQ(events[1].remarks, "object 1 found by agent 3 at (10.0, 20.0) m after 12.5 s");
  EXPECT_EQ(events[2].uid, "ergocast-0000000000000abc-contact-7");
  EXPECT_EQ(events[2].remarks,
            "87.5 % likely at (50.0, 60.0) m, 2 reports, the newest after 12.5 s");
  EXPECT_TRUE(due(at(4999ms)).empty());
  EXPECT_EQ(due(at(5s)).size(), 3U);
}

TEST_F(Cot, MarksAReplay) {
  picture_.replay = true;
  const CotEvent event = only();
  EXPECT_EQ(event.uid, "ergocast-replay-0000000000000abc-agent-0");
  EXPECT_EQ(event.callsign, "replay of small 0");
}

TEST_F(Cot, WritesWellFormedXml) {
  CotEvent event = only();
  event.callsign = "a<b>&\"c'\x01";
  event.remarks = "]]> & <x/>";
  event.outline = {{1, 2}, {3, 4}, {5, -6}};
  event.argb = -65536;
  const std::string text = cot_xml(event, kTime);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(text.c_str())) << text;
  const pugi::xml_node node = document.child("event");
  EXPECT_STREQ(node.attribute("version").value(), "2.0");
  EXPECT_STREQ(node.attribute("time").value(), "2026-01-31T12:00:00.250Z");
  EXPECT_STREQ(node.attribute("start").value(), "2026-01-31T12:00:00.250Z");
  EXPECT_STREQ(node.attribute("stale").value(), "2026-01-31T12:00:05.250Z");
  EXPECT_STREQ(node.child("point").attribute("hae").value(), "9999999.0");
  const pugi::xml_node detail = node.child("detail");
  EXPECT_STREQ(detail.child("contact").attribute("callsign").value(), "a<b>&\"c'\\x01");
  EXPECT_STREQ(detail.child("remarks").text().get(), "]]> & <x/>");
  std::vector<std::string> corners;
  for (const auto& link : detail.children("link"))
    corners.emplace_back(link.attribute("point").value());
  EXPECT_EQ(corners, (std::vector<std::string>{"1.0000000,2.0000000", "3.0000000,4.0000000",
                                               "5.0000000,-6.0000000", "1.0000000,2.0000000"}));
  EXPECT_STREQ(detail.child("strokeColor").attribute("value").value(), "-65536");
  EXPECT_STREQ(detail.child("fillColor").attribute("value").value(), "1090453504");
}

}  // namespace
}  // namespace ergocast::cli
