// SPDX-License-Identifier: BSD-3-Clause
// A record keeps all amendments of its mission, and each of its rows counts against the target of
// the row's own time.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/noise.h"
#include "logger/amendments_file.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "modes/provide.h"
#include "plan/amendment_list.h"
#include "tests/logger/record.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

/// A target of 20 modes with all digits of a double.
TargetChange target_of(std::uint64_t seed, bool free_domain = false) {
  TargetChange change;
  for (Coefficients* numbers : {&change.target, &change.cosine}) {
    if (numbers == &change.cosine && !free_domain) break;
    *numbers = Coefficients::Zero(20);
    for (int k = 0; k < 20; k += 2) {
      const auto pair = uniform_pair(seed, Purpose::kStart, numbers == &change.cosine, k);
      numbers->segment(k, 2) = 0.2 * (pair - Eigen::Vector2d(0.5, 0.5));
    }
    (*numbers)[0] = 1;
  }
  return change;
}

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

// ---- what was heard ----

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

TEST(ReceivedAmendments, AllZonesAreKeptThoughAListHasThoseInForce) {
  ReceivedAmendments heard;
  Amendments list;
  for (int i = 0; i < 20; ++i) {
    Zone zone;
    zone.until = 5;
    zone.corners_m = {{100, 100}, {200, 100}, {200, 200.0 + i}};
    name_zone(list, 10 * i, 2, zone);
    ASSERT_EQ(list.zones.size(), 1U);
    heard.note(list);
  }
  EXPECT_EQ(heard.list().zones.size(), 20U);
  EXPECT_EQ(heard.unknown_content(), nullptr);
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
  name_zone(list, 10, 2, zone);
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

// ---- φ² ----

Eigen::Vector3d place_at(Tick tick, AgentId id) {
  return on_ground(2000 * uniform_pair(3, Purpose::kStart, static_cast<std::uint32_t>(id),
                                       static_cast<std::uint64_t>(tick)));
}
WorldState pair_at(Tick tick) { return world_state(tick, {place_at(tick, 0), place_at(tick, 1)}); }

/// φ² over the ticks [from, end) of `pair_at`: each counts against `target_at(tick)`.
template <class TargetAt>
double metric_over(const Mission& mission, Tick from, Tick end, const TargetAt& target_at) {
  Coefficients residual = Coefficients::Zero(mission.basis.mode_count());
  for (Tick tick = from; tick < end; ++tick)
    for (AgentId id = 0; id < 2; ++id)
      residual += basis_values(place_at(tick, id), mission.domain, mission.basis) - target_at(tick);
  residual /= 2 * static_cast<double>(end - from);
  return ergodic_metric(residual, Coefficients::Zero(residual.size()),
                        sobolev_weights(mission.basis, mission.domain));
}

MissionPart amended(std::int64_t revision, const Amendments& list) {
  MissionPart part = mission_part(revision, MissionState::kRunning, roster_of(2));
  part.amendments = encode_amendments(list);
  return part;
}

/// Three targets, from the ticks 20, 30 and 55 on, each named some ticks before.
class ChangedTarget : public testing::Test {
 protected:
  ChangedTarget() {
    for (std::uint64_t i = 0; i < 3; ++i) {
      TargetChange change = target_of(i);
      targets.push_back(change.target);
      name_target(lists.emplace_back(i > 0 ? lists.back() : Amendments()), kFrom[i],
                  std::move(change));
    }
  }
  const Coefficients& target_at(Tick tick) const {
    const Coefficients* target = &mission.target_coefficients;
    for (std::size_t i = 0; i < 3; ++i)
      if (tick >= kFrom[i]) target = &targets[i];
    return *target;
  }
  /// The ticks up to `end`; each list arrives `notice` ticks before its target holds.
  void fly(Record& record, Tick end, Tick notice = 5) const {
    for (Tick tick = 0; tick <= end; ++tick) {
      for (std::size_t i = 0; i < 3; ++i)
        if (tick == kFrom[i] - notice)
          give(record.recorder, amended(static_cast<std::int64_t>(i) + 1, lists[i]), at(0s));
      record.deliver(pair_at(tick));
    }
  }
  void expect_metrics(const std::vector<std::string>& rows) const {
    ASSERT_EQ(rows.size(), 11U);
    for (const std::string& row : rows) {
      const auto tick = static_cast<Tick>(number(row, 0));
      const double expected =
          metric_over(mission, 0, tick + 1, [this](Tick at) { return target_at(at); });
      EXPECT_NEAR(number(row, 2), expected, 1e-12 * expected) << tick;
    }
  }

  static constexpr std::array<Tick, 3> kFrom{20, 30, 55};
  Mission mission = small_mission(2);
  std::vector<Coefficients> targets;
  std::vector<Amendments> lists;  // after each change
};

TEST_F(ChangedTarget, EachMomentCountsAgainstTheTargetOfItsOwnTime) {
  Record record(mission);
  fly(record, 100);
  expect_metrics(record.metrics_rows());
}

TEST_F(ChangedTarget, NoRowIsWrittenBeforeTheMissionOfItsTickIsKnown) {
  Record record(mission);
  for (Tick tick = 0; tick <= 100; ++tick) {
    WorldState state = pair_at(tick);
    for (const Tick from : kFrom) state.roster_revision += tick >= from - 1 ? 1 : 0;
    record.deliver(state);
    EXPECT_LE(record.trajectory_rows().size(), 2U * (static_cast<std::size_t>(kFrom[0]) - 1));
  }
  for (std::size_t i = 0; i < 3; ++i)
    record.deliver(amended(static_cast<std::int64_t>(i) + 1, lists[i]));
  EXPECT_EQ(record.trajectory_rows().size(), 200U);
  expect_metrics(record.metrics_rows());
}

TEST_F(ChangedTarget, ARowWaitsNoLongerThanTheWorldForItsRecorder) {
  Record record(mission);
  for (Tick tick = 0; tick <= 10; ++tick) {
    WorldState state = pair_at(tick);
    state.roster_revision = 1;
    record.deliver(state, at(1s));
  }
  EXPECT_TRUE(record.trajectory_rows().empty());
  advance(record.recorder, at(1s) + seconds(mission.timing.lockstep_timeout_s / 4) - 1ms);
  EXPECT_TRUE(record.trajectory_rows().empty());
  advance(record.recorder, at(1s) + seconds(mission.timing.lockstep_timeout_s / 4));
  EXPECT_EQ(record.trajectory_rows().size(), 20U);
}

TEST_F(ChangedTarget, ARowThatWaitsIsWrittenAtTheEnd) {
  Record record(mission);
  for (Tick tick = 0; tick <= 10; ++tick) {
    WorldState state = pair_at(tick);
    state.roster_revision = 1;
    record.deliver(state);
  }
  record.recorder.stop("a signal stopped the logger");
  EXPECT_EQ(record.trajectory_rows().size(), 20U);
}

TEST_F(ChangedTarget, EachTargetHasThePhiSquaredOfItsOwnTime) {
  Record record(mission);
  fly(record, 100);
  const auto& facts = record.recorder.facts().targets;
  ASSERT_EQ(facts.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const Tick from = i > 0 ? kFrom[i - 1] : 0, until = i < 3 ? kFrom[i] : 100;
    EXPECT_EQ(facts[i].from, from);
    EXPECT_EQ(facts[i].until, until);
    const double expected =
        metric_over(mission, from, until, [this](Tick at) { return target_at(at); });
    EXPECT_NEAR(facts[i].ergodic_metric, expected, 1e-9 * expected) << i;
  }
  const auto summary = summarize(record.recorder, {});
  ASSERT_EQ(summary["targets"].size(), 4U);
  EXPECT_TRUE(summary["targets"][0]["amendment"].is_null());
  EXPECT_EQ(summary["targets"][3]["amendment"], 2);
  EXPECT_EQ(summary["targets"][3]["from_tick"], 55);
  EXPECT_EQ(summary["targets"][3]["until_tick"], 100);
  EXPECT_EQ(summary["targets"][3]["ergodic_metric"], facts[3].ergodic_metric);
  ASSERT_EQ(summary["amendments"].size(), 3U);
  EXPECT_EQ(summary["amendments"][2]["from_tick"], 55);
  EXPECT_FALSE(summary.contains("holds"));
}

TEST_F(ChangedTarget, WithoutAChangeTheSummaryNamesNone) {
  Record record(mission);
  for (Tick tick = 0; tick <= 100; ++tick) record.deliver(pair_at(tick));
  const auto summary = summarize(record.recorder, {});
  for (const char* key : {"targets", "amendments", "holds"})
    EXPECT_FALSE(summary.contains(key)) << key;
}

TEST_F(ChangedTarget, ATargetThatTurnsOutToBeVoidDoesNotHoldAnyLonger) {
  Record record(mission);
  Amendments lost = lists[0];
  name_target(lost, 40, target_of(9));
  for (Tick tick = 0; tick <= 100; ++tick) {
    if (tick == 10) give(record.recorder, amended(1, lists[0]), at(0s));
    if (tick == 35) give(record.recorder, amended(2, lost), at(0s));
    if (tick == 39) give(record.recorder, amended(3, lists[0]), at(0s));
    record.deliver(pair_at(tick));
  }
  const double expected = metric_over(mission, 0, 100, [this](Tick tick) {
    return tick < kFrom[0] ? mission.target_coefficients : targets[0];
  });
  EXPECT_NEAR(record.recorder.facts().ergodic_metric_last, expected, 1e-12 * expected);
  EXPECT_EQ(record.recorder.facts().targets.size(), 2U);
  EXPECT_EQ(summarize(record.recorder, {})["amendments"][1]["void"], true);
}

TEST_F(ChangedTarget, AResumedRecordCountsItsRowsAgainstTheirTargetsAgain) {
  Record lived(mission);
  fly(lived, 100);
  const TempFolder own;
  std::ofstream(own.path() / "trajectory.csv") << lived.trajectory.str();
  std::ofstream(own.path() / "metrics.csv") << std::string(kMetricsHeader) << '\n';
  std::ofstream(own.path() / "amendments.json")
      << amendments_text(lived.recorder.amendments(), 0.1);
  std::ostringstream trajectory, metrics;
  announce(mission);
  Recorder resumed(kRun, kLoggerLife, trajectory, metrics);
  resumed.resume(read_run(own.path(), mission).value());
  give(resumed, amended(1, lists[2]), at(0s));
  EXPECT_EQ(rows_of(metrics.str()), lived.metrics_rows());
  const auto &again = resumed.facts().targets, &before = lived.recorder.facts().targets;
  ASSERT_EQ(again.size(), before.size());
  for (std::size_t i = 0; i < again.size(); ++i)
    EXPECT_EQ(again[i].ergodic_metric, before[i].ergodic_metric) << i;
}

TEST(ChangedTargetInAFreeDomain, CountsInBothBases) {
  Mission mission = small_mission(2);
  mission.cosine_target = mission.target_coefficients;
  mission.basis.free_domain = true;
  mission.basis.table_hash = table_of(mission).value()->hash;
  Record record(mission);
  Amendments list;
  const TargetChange change = target_of(5, true);
  name_target(list, 40, change);
  give(record.recorder, amended(1, list), at(0s));
  for (Tick tick = 0; tick <= 100; ++tick) record.deliver(pair_at(tick));
  const Mission cosines = in_cosines(mission);
  const auto target_at = [&](Tick tick) {
    return tick < 40 ? cosines.target_coefficients : change.cosine;
  };
  const RunFacts& facts = record.recorder.facts();
  const double all = metric_over(cosines, 0, 100, target_at),
               since = metric_over(cosines, 40, 100, target_at);
  EXPECT_NEAR(facts.cosine_metric_last, all, 1e-12 * all);
  ASSERT_EQ(facts.targets.size(), 2U);
  EXPECT_NEAR(facts.targets[1].cosine_metric, since, 1e-9 * since);
  Mission with_table = mission;
  ASSERT_FALSE(provide_table(with_table));
  const auto free_target_at = [&](Tick tick) {
    return tick < 40 ? mission.target_coefficients : change.target;
  };
  const double in_modes = metric_over(with_table, 0, 100, free_target_at);
  EXPECT_NEAR(facts.ergodic_metric_last, in_modes, 1e-12 * in_modes);
}

}  // namespace
}  // namespace ergocast
