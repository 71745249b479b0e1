// SPDX-License-Identifier: BSD-3-Clause
// A record keeps all amendments of its mission.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "logger/amendments_file.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "modes/provide.h"
#include "plan/amendment_list.h"
#include "tests/logger/drawn_target.h"
#include "tests/logger/record.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

std::vector<bool> voids_of(const ReceivedAmendments& heard) {
  std::vector<bool> voids;
  for (const ReceivedAmendment& one : heard.all()) voids.push_back(one.is_void);
  return voids;
}

/// The number of the target at a tick; −1: the plan's.
std::int32_t target_at(const ReceivedAmendments& heard, Tick tick) {
  const ReceivedAmendment* const found = heard.target_at(tick);
  return found == nullptr ? -1 : found->amendment.number;
}

Zone zone_lasting(Tick ticks) {
  return {.until = ticks, .corners_m = {{100, 100}, {200, 100}, {200, 200}}};
}

// ---- what was received ----

TEST(ReceivedAmendments, AllTargetsAreKeptThoughAListHasTwo) {
  ReceivedAmendments heard;
  Amendments list;
  for (int i = 0; i < 5; ++i) {
    name_target(list, 10 * (i + 1), target_of(static_cast<std::uint64_t>(i)));
    ASSERT_LE(list.targets.size(), 2U);
    heard.note(list);
  }
  for (const Tick tick : {0, 9}) EXPECT_EQ(target_at(heard, tick), -1);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(target_at(heard, 10 * (i + 1)), i);
    EXPECT_EQ(target_at(heard, 10 * (i + 1) + 9), i);
  }
  EXPECT_EQ(heard.list().targets.size(), 5U);
  EXPECT_TRUE(are_amendments(heard.list(), small_mission(1)));
  EXPECT_EQ(heard.unknown_content(), nullptr);
}

TEST(ReceivedAmendments, AnAmendmentThatALaterListLacksIsVoid) {
  ReceivedAmendments heard;
  Amendments common;
  name_target(common, 10, target_of(1));
  Amendments lost = common, kept = common;
  name_target(lost, 20, target_of(2));
  heard.note(lost);
  EXPECT_EQ(target_at(heard, 20), 1);
  heard.note(common);
  EXPECT_EQ(target_at(heard, 20), 0) << "its coordinator's successor does not know it";
  EXPECT_EQ(voids_of(heard), (std::vector<bool>{false, true}));
  name_target(kept, 30, target_of(3));
  heard.note(kept);
  EXPECT_EQ(target_at(heard, 29), 0);
  EXPECT_EQ(target_at(heard, 30), 1);
  EXPECT_EQ(heard.all().size(), 3U) << "two have the number 1";
  EXPECT_EQ(voids_of(heard), (std::vector<bool>{false, true, false}));
  EXPECT_EQ(heard.list().targets, kept.targets);
  heard.note(lost);
  EXPECT_EQ(voids_of(heard), (std::vector<bool>{false, false, true})) << "another one wins";
}

TEST(ReceivedAmendments, NoListVoidsWhatItNoLongerNames) {
  ReceivedAmendments heard;
  Amendments list;
  for (Tick i = 0; i < 2 * static_cast<Tick>(kMaxRecentAmendments); ++i) {
    name_target(list, 10 * (i + 1), target_of(static_cast<std::uint64_t>(i)));
    heard.note(list);
  }
  EXPECT_EQ(heard.all().size(), 2 * kMaxRecentAmendments);
  for (const bool is_void : voids_of(heard)) EXPECT_FALSE(is_void);
  EXPECT_EQ(heard.list().recent, list.recent);
  EXPECT_EQ(heard.list().named, list.named);
}

TEST(ReceivedAmendments, ATargetWithoutNumbersIsNamed) {
  ReceivedAmendments heard;
  Amendments list;
  for (int i = 0; i < 3; ++i)
    name_target(list, 10 * (i + 1), target_of(static_cast<std::uint64_t>(i)));
  heard.note(list);
  ASSERT_NE(heard.unknown_content(), nullptr);
  EXPECT_EQ(heard.unknown_content()->amendment.number, 0);
  EXPECT_EQ(target_at(heard, 19), -1);
  EXPECT_EQ(target_at(heard, 20), 1);
}

TEST(ReceivedAmendments, AnEndIsKnownThoughTheListNamesNewerAmendments) {
  ReceivedAmendments heard;
  Amendments list;
  name_end(list, 10, 700);
  for (int i = 0; i < 40; ++i) name_target(list, 20 + i, target_of(1));
  heard.note(list);
  EXPECT_EQ(heard.ends(), (std::vector<EndChange>{{0, 10, 700}}));
}

TEST(ReceivedAmendments, AllZonesAreKeptThoughAListHasThoseInForce) {
  ReceivedAmendments heard;
  Amendments list;
  for (int i = 0; i < 20; ++i) {
    Zone zone = zone_lasting(5);
    zone.corners_m[2].y() = 200.0 + i;
    name_zone(list, 10 * i, 10 * i, 2, zone);
    ASSERT_EQ(list.zones.size(), 1U);
    heard.note(list);
  }
  EXPECT_EQ(heard.list().zones.size(), 20U);
  EXPECT_EQ(heard.unknown_content(), nullptr);
}

TEST(ReceivedAmendments, AZoneIsCancelledAsLongAsAnAmendmentSaysSo) {
  ReceivedAmendments heard;
  Amendments list;
  const Zone zone = zone_lasting(100);
  name_zone(list, 10, 10, 2, zone);
  const Amendments before = list;
  name_reopening(list, 30, 0);
  heard.note(list);
  EXPECT_EQ(heard.list(), list);
  heard.note(before);
  EXPECT_EQ(heard.list(), before) << "its coordinator's successor does not know it";
  Amendments later = before;
  name_zone(later, 150, 150, 2, zone);
  ReceivedAmendments successor = heard;
  successor.note(later);
  ASSERT_EQ(successor.list().zones.size(), 2U);
  EXPECT_EQ(successor.list().zones[0].cancelled, -1) << "and no list has that zone any more";
  heard.note(list);
  name_zone(list, 40, 40, 2, zone);
  ASSERT_EQ(list.zones.size(), 1U);
  heard.note(list);
  ASSERT_EQ(heard.list().zones.size(), 2U);
  EXPECT_EQ(heard.list().zones[0].cancelled, 30) << "the list has it no more";
  EXPECT_EQ(heard.list().zones[1].cancelled, -1);
}

// ---- amendments.json ----

class AmendmentsFile : public testing::Test {
 protected:
  Result<ReceivedAmendments> read(const nlohmann::ordered_json& summary = nullptr) const {
    return recorded_amendments(own.path(), summary, mission);
  }
  void write(const std::string& text) const {
    std::ofstream(own.path() / "amendments.json", std::ios::binary) << text;
  }
  /// Three targets, of which one is void, and a pause.
  ReceivedAmendments sample(bool free_domain = false) const {
    ReceivedAmendments heard;
    Amendments list;
    name_target(list, 10, target_of(1, free_domain));
    Amendments lost = list;
    name_target(lost, 20, target_of(2, free_domain));
    heard.note(lost);
    name_pause(list, 30);
    name_pause(list, 40);
    name_target(list, 50, target_of(3, free_domain));
    heard.note(list);
    return heard;
  }

  const TempFolder own;
  Mission mission = small_mission(1);
};

TEST_F(AmendmentsFile, ReadsBackBitForBit) {
  for (const bool free_domain : {false, true}) {
    mission.basis.free_domain = free_domain;
    const ReceivedAmendments heard = sample(free_domain);
    write(amendments_text(heard, 0.1));
    const auto read_again = read();
    ASSERT_TRUE(read_again) << read_again.error();
    EXPECT_EQ(read_again->all(), heard.all());
    EXPECT_EQ(read_again->holds(), heard.holds());
    EXPECT_EQ(read_again->list(), heard.list());
    EXPECT_EQ(amendments_text(*read_again, 0.1), amendments_text(heard, 0.1));
  }
}

TEST_F(AmendmentsFile, HasZones) {
  ReceivedAmendments heard;
  Amendments list;
  Zone zone;
  zone.until = 5;
  zone.corners_m = {{100, 100.1}, {200, 100}, {200, 200 + 1e-13}};
  name_zone(list, 10, 10, 2, zone);
  heard.note(list);
  const std::string text = amendments_text(heard, 0.1);
  write(text);
  auto again = read();
  ASSERT_TRUE(again) << again.error();
  EXPECT_EQ(again->list(), list);
  EXPECT_FALSE(amendments_json(heard, 0.1)[0].contains("corners_m"));
  const auto damaged = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    write(changed);
    return !read();
  };
  EXPECT_TRUE(damaged("100.1", "100.2")) << "it has another hash";
  EXPECT_TRUE(damaged("[100.0,100.1],", ""));
  EXPECT_TRUE(damaged("100.1", "\"x\""));
  EXPECT_TRUE(damaged("\"until_tick\":17", "\"until_tick\":12"));
  EXPECT_TRUE(damaged("\"closed_tick\":10", "\"closed_tick\":13"));
}

TEST_F(AmendmentsFile, HasCancelledZones) {
  ReceivedAmendments heard;
  Amendments list;
  name_zone(list, 10, 10, 2, zone_lasting(50));
  name_reopening(list, 30, 0);
  heard.note(list);
  const std::string text = amendments_text(heard, 0.1);
  write(text);
  auto again = read();
  ASSERT_TRUE(again) << again.error();
  EXPECT_EQ(again->list(), list);
  EXPECT_EQ(amendments_json(heard, 0.1)[0]["cancelled_tick"], 30);
  EXPECT_EQ(amendments_json(heard, 0.1)[1]["kind"], "reopen");
  EXPECT_EQ(amendments_json(heard, 0.1)[1]["zone"], 0);
  for (const auto& [from, to] : {std::pair("\"cancelled_tick\":30", "\"cancelled_tick\":9"),
                                 std::pair("\"cancelled_tick\":30", "\"cancelled_tick\":null"),
                                 std::pair("\"zone\":0", "\"zone\":1")}) {
    std::string changed = text;
    changed.replace(changed.find(from), std::string(from).size(), to);
    write(changed);
    EXPECT_FALSE(read()) << to;
  }
}

TEST_F(AmendmentsFile, HasWhatTheSummaryListsAndTheNumbers) {
  const ReceivedAmendments heard = sample();
  const auto file = nlohmann::json::parse(amendments_text(heard, 0.1));
  EXPECT_EQ(file["holds"], (nlohmann::json{{30, 40}}));
  ASSERT_EQ(file["amendments"].size(), 5U);
  const auto& lost = file["amendments"][1];
  EXPECT_EQ(lost["number"], 1);
  EXPECT_EQ(lost["kind"], "target");
  EXPECT_EQ(lost["from_tick"], 20);
  EXPECT_EQ(lost["t_s"], 2);
  EXPECT_EQ(lost["void"], true);
  EXPECT_EQ(lost["target"].size(), 20U);
  EXPECT_EQ(file["amendments"][2]["kind"], "pause");
  EXPECT_FALSE(file["amendments"][2].contains("hash"));
  auto listed = amendments_json(heard, 0.1);
  ASSERT_EQ(listed.size(), 5U);
  EXPECT_FALSE(listed[1].contains("target"));
  EXPECT_EQ(listed[1]["hash"], to_hex(target_hash(*heard.all()[1].target)));
}

TEST_F(AmendmentsFile, KeepsEndsAndTargetsThatWereReplacedBeforeTheirTick) {
  ReceivedAmendments heard;
  Amendments list;
  name_end(list, 20, 70);
  TargetChange change{.target = small_mission(2).target_coefficients};
  change.target[1] = 0.5;
  name_target(list, 30, change);
  heard.note(list);
  change.target[1] = 0;
  replace_target(list, change);
  name_end(list, 40, 100);
  heard.note(list);
  EXPECT_EQ(heard.list(), list);
  EXPECT_EQ(heard.ends(), list.ends);
  EXPECT_EQ(heard.target_at(30)->amendment.number, 2);
  write(amendments_text(heard, 0.1));
  const auto read_again = read();
  ASSERT_TRUE(read_again) << read_again.error();
  EXPECT_EQ(read_again->all(), heard.all());
  EXPECT_EQ(read_again->list(), list);
  std::string text = amendments_text(heard, 0.1);
  write(text.replace(text.find("\"tick_count\":70"), 15, "\"tick_count\":0 "));
  EXPECT_FALSE(read());
}

TEST_F(AmendmentsFile, PausesAreReadFromTheSummaryIfThereIsNone) {
  EXPECT_TRUE(read()->empty());
  const auto holds = [](const char* text) {
    return nlohmann::ordered_json{{"holds", nlohmann::ordered_json::parse(text)}};
  };
  EXPECT_EQ(read(holds("[[3, 5], [9, null]]"))->holds(), (std::vector<Hold>{{3, 5}, {9, -1}}));
  EXPECT_TRUE(read(holds("[[5, 3]]"))->empty());
  EXPECT_TRUE(read(holds("7"))->empty());
  write(amendments_text(sample(), 0.1));
  EXPECT_EQ(read(holds("[[3, 5]]"))->holds(), (std::vector<Hold>{{30, 40}}));
}

TEST_F(AmendmentsFile, IsRefusedWithItsNameIfItIsDamaged) {
  const std::string text = amendments_text(sample(), 0.1);
  const auto changed = [&text](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.substr(0, at) + to + text.substr(at + from.size());
  };
  for (const std::string& damaged :
       {std::string(), std::string("[]"), std::string("{\"holds\": []}"),
        text.substr(0, text.size() / 2), changed("[[30,40]]", "[[40,30]]"),
        changed("\"number\":0", "\"number\":9"), changed("\"number\":0", "\"number\":-1"),
        changed("\"from_tick\":10", "\"from_tick\":1e3"),
        changed("\"from_tick\":10", "\"from_tick\":51"), changed("\"target\"", "\"aim\""),
        changed("[1.0,", "[1.0,0.25,"), changed("[1.0,", "[1.0,\"a\","), changed("[1.0,", "[0.5,"),
        changed("\"hash\":\"", "\"hash\":\"z"), changed("\"hash\":\"", "\"hash\":\"1"),
        changed("\"void\":true", "\"void\":1")}) {
    write(damaged);
    const auto read_again = read();
    ASSERT_FALSE(read_again) << damaged;
    EXPECT_NE(read_again.error().find("amendments.json"), std::string::npos) << read_again.error();
    EXPECT_NE(read_again.error().find("remove it"), std::string::npos) << read_again.error();
  }
  write(text);
  mission.basis.modes_x = 4;
  EXPECT_FALSE(read()) << "it is of another mission";
}

TEST_F(AmendmentsFile, AMissingTargetIsNamed) {
  const ReceivedAmendments heard = sample();
  const nlohmann::ordered_json summary{{"amendments", amendments_json(heard, 0.1)}};
  EXPECT_TRUE(missing_target(own.path(), summary, {}));
  write(amendments_text(heard, 0.1));
  EXPECT_FALSE(missing_target(own.path(), summary, heard));
  EXPECT_FALSE(missing_target(own.path(), nullptr, {}));
  ReceivedAmendments late;
  Amendments list;
  for (int i = 0; i < 3; ++i) name_target(list, 10 * i, target_of(7));
  late.note(list);
  EXPECT_TRUE(missing_target(own.path(), summary, late));
}

TEST_F(AmendmentsFile, KeepsLawsAndOperators) {
  ReceivedAmendments heard;
  Amendments list;
  LawChange law = plans_law(small_mission(2));
  for (int i = 1; i <= 4; ++i) {
    law.kinds[0].u_max_mps = small_mission(2).law.u_max_mps / i;
    name_law(list, 10 * i, law);
    list.recent.back().by = "operator " + std::to_string(i);
    heard.note(list);
  }
  EXPECT_EQ(voids_of(heard), std::vector<bool>(4, false));
  EXPECT_EQ(heard.list().laws.size(), 4U);
  EXPECT_EQ(heard.unknown_content(), nullptr);
  write(amendments_text(heard, 0.1));
  const auto read_again = read();
  ASSERT_TRUE(read_again) << read_again.error();
  EXPECT_EQ(read_again->all(), heard.all());
  EXPECT_EQ(read_again->all()[1].amendment.by, "operator 2");
  EXPECT_FALSE(amendments_json(heard, 0.1)[0].contains("law"));
  const std::string text = amendments_text(heard, 0.1);
  const auto damaged = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t at = changed.find(from);
    EXPECT_NE(at, changed.npos) << from;
    if (at != changed.npos) changed.replace(at, from.size(), to);
    write(changed);
    return !read();
  };
  EXPECT_TRUE(damaged("\"u_max_mps\":", "\"u_max_mps\":-")) << "it is none";
  EXPECT_TRUE(damaged("\"noise_intensity\":0.0", "\"noise_intensity\":0.1")) << "another hash";
  EXPECT_TRUE(damaged("\"noise_ceiling\"", "\"ceiling\""));
  EXPECT_TRUE(damaged("operator 1", "operator\\n1"));
  EXPECT_TRUE(damaged("\"operator 1\"", "7"));
  EXPECT_FALSE(damaged(",\"by\":\"operator 1\"", "")) << "older records name nobody";
}

}  // namespace
}  // namespace ergocast
