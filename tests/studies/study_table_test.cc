// SPDX-License-Identifier: BSD-3-Clause
// A study's rows as text, and the results that follow from all of them.
#include "studies/study_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "studies/study_page.h"
#include "studies/study_summary.h"

namespace ergocast::studies {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kNever = std::numeric_limits<double>::infinity();

Study two_by_two() {
  Study study{{"law.epsilon", "law.regularization"}, {}};
  for (const char* epsilon : {"0.1", "1"}) {
    for (const char* form : {"ABSOLUTE", "RELATIVE"}) {
      study.points.push_back({"mission", {epsilon, form}, 2, 15});
    }
  }
  return study;
}

StudyFigures figures_of(std::uint64_t seed, double metric) {
  StudyFigures figures;
  figures.seed = seed;
  figures.agents = 2;
  figures.complete = true;
  figures.metric_at.fill(kNone);
  figures.escape_time_s.fill(kNone);
  for (int i = 0; i < 4; ++i) figures.metric_at[i] = metric * (5 - i);
  figures.metric = metric;
  figures.slope = -1.0 / 3;
  figures.escape_time_s[0] = kNever;
  figures.messages = 1234567890123;
  figures.speed_mean_mps = 0.1;
  return figures;
}

TEST(StudyTable, RowsReadBackExactly) {
  const Study study = two_by_two();
  const StudyTable table(study);
  const StudyRow row{2, figures_of(18446744073709551615U, 0.1 + 0.2)};
  const std::string line = table.line(row);
  const auto read = table.parse(line);
  ASSERT_TRUE(read) << line;
  EXPECT_EQ(read->point, 2U);
  EXPECT_EQ(read->figures.seed, row.figures.seed);
  EXPECT_EQ(read->figures.metric, 0.1 + 0.2);
  EXPECT_EQ(read->figures.slope, -1.0 / 3);
  EXPECT_EQ(read->figures.messages, 1234567890123);
  EXPECT_EQ(read->figures.escape_time_s[0], kNever);
  EXPECT_TRUE(std::isnan(read->figures.escape_time_s[1]));
  EXPECT_EQ(table.line(*read), line);
}

TEST(StudyTable, HasAColumnForEachFieldTimeAndAgent) {
  const Study study = two_by_two();
  EXPECT_EQ(
      StudyTable(study).header(),
      "scenario,law.epsilon,law.regularization,seed,agents,messages,ergodic_metric,detection_"
      "probability,"
      "time_to_half_s,time_to_four_fifths_s,objects_found,time_to_first_find_s,wrong_confirmations,"
      "greatest_age_s,sliced_wasserstein_m,path_m,slope,"
      "offset2_mean_m2,offset2_max_m2,edge_share,speed_mean_mps,ergodic_metric_at_1_s,"
      "ergodic_metric_at_1.25_s,ergodic_metric_at_1.6_s,ergodic_metric_at_2_s,"
      "ergodic_metric_at_2.5_s,ergodic_metric_at_3.2_s,ergodic_metric_at_4_s,"
      "ergodic_metric_at_5_s,ergodic_metric_at_6.3_s,ergodic_metric_at_8_s,"
      "ergodic_metric_at_10_s,ergodic_metric_at_12.5_s,escape_time_0_s,escape_time_1_s");
}

TEST(StudyTable, RefusesWhatIsNoRowOfTheStudy) {
  const Study study = two_by_two();
  const StudyTable table(study);
  const std::string line = table.line({0, figures_of(1, 0.5)});
  EXPECT_FALSE(table.parse(table.header()));
  EXPECT_FALSE(table.parse(line.substr(0, line.rfind(','))));
  EXPECT_FALSE(table.parse(line + ",1"));
  EXPECT_FALSE(table.parse("another" + line));
  EXPECT_FALSE(table.parse(line + "x"));
  EXPECT_FALSE(table.parse(""));
}

TEST(Summarize, ComparesEqualSeedsWithTheFirstPoint) {
  const Study study = two_by_two();
  std::vector<StudyRow> rows;
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    rows.push_back({0, figures_of(seed, static_cast<double>(seed))});
    rows.push_back({1, figures_of(seed, 3 * static_cast<double>(seed))});
  }
  rows.push_back({2, figures_of(99, 7)});
  const auto summaries = summarize(study, rows);
  ASSERT_EQ(summaries.size(), 4U);
  EXPECT_EQ(summaries[0].metric.value, 5);
  EXPECT_EQ(summaries[0].metric.low, 2);
  EXPECT_EQ(summaries[0].metric.high, 8);
  EXPECT_NEAR(summaries[1].ratio->value, 3, 1e-12);
  EXPECT_NEAR(summaries[1].ratio->low, 3, 1e-12);
  EXPECT_FALSE(summaries[2].ratio) << "no seed in common";
  EXPECT_EQ(summaries[2].runs, 1U);
  EXPECT_EQ(summaries[3].runs, 0U);
  ASSERT_EQ(summaries[0].metric_over_time.size(), 5U);
  EXPECT_EQ(summaries[0].metric_over_time[0].first, 1);
  EXPECT_EQ(summaries[0].metric_over_time[0].second.value, 25);
  EXPECT_EQ(summaries[0].metric_over_time.back().first, 15);
}

TEST(Summarize, CountsEscapesByAgents) {
  const Study study = two_by_two();
  StudyFigures first = figures_of(1, 1), second = figures_of(2, 1);
  first.escape_time_s[1] = 3;
  second.escape_time_s[0] = 20;
  const PointSummary summary = summarize(study, {{0, first}, {0, second}})[0];
  EXPECT_EQ(summary.escape_times_s, (std::vector<double>{3, 20, kNever}));
  EXPECT_EQ(summary.escaped_share(2.9), 0);
  EXPECT_NEAR(summary.escaped_share(3), 1.0 / 3, 1e-15);
  EXPECT_NEAR(summary.escaped_share(1e9), 2.0 / 3, 1e-15);
}

TEST(Summarize, HasTheMedianOfWhatIsFound) {
  const Study study = two_by_two();
  std::vector<StudyRow> rows;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    StudyFigures figures = figures_of(seed, 1);
    figures.detection_probability = 0.2 * static_cast<double>(seed);
    figures.half_time_s = seed < 3 ? kNever : 7;
    rows.push_back({0, figures});
  }
  const PointSummary summary = summarize(study, rows)[0];
  EXPECT_NEAR(summary.found->value, 0.4, 1e-12);
  EXPECT_NEAR(summary.found->low, 0.2, 1e-12);
  EXPECT_NEAR(summary.found->high, 0.6, 1e-12);
  EXPECT_EQ(summary.half_time_s->value, kNever);
  EXPECT_EQ(summary.half_time_s->low, 7);
}

/// The data of a page.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "id=\"data\">";
  const auto at = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
}

TEST(StudyPage, IsWholeForAnyStudyAlsoAnEmptyOne) {
  const Study study = two_by_two();
  const std::vector<std::string> commands(4, "fly it");
  std::vector<StudyRow> rows;
  for (std::size_t runs = 0; runs < 3; ++runs) {
    const std::string page =
        study_page({study, "1.2.3", "ergocast study <&>", commands}, summarize(study, rows));
    EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
    EXPECT_TRUE(page.ends_with("</html>\n"));
    EXPECT_EQ(page.find("<&>"), std::string::npos);
    const auto data = data_of(page)["study"];
    EXPECT_EQ(data["command"], "ergocast study <&>");
    ASSERT_EQ(data["points"].size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(data["points"][i]["runs"], i < runs ? 1 : 0);
      EXPECT_EQ(data["points"][i].contains("metric"), i < runs);
      EXPECT_EQ(data["points"][i]["command"], "fly it");
    }
    rows.push_back({runs, figures_of(1, 0.5)});
  }
}

TEST(StudySummary, HasTheMedianOfAQuantityAndItsRatioIfAllValuesAreFactors) {
  const Study study = two_by_two();
  StudyFigures slow = figures_of(1, 0.5), fast = slow, never = slow;
  slow.half_time_s = 40;
  fast.half_time_s = 10;
  never.half_time_s = kNever;
  const Quantity half_time{"time_to_half_s", &StudyFigures::half_time_s};
  const auto summaries = summarize(study, {{0, slow}, {1, fast}, {2, never}}, half_time);
  ASSERT_EQ(summaries.size(), 4U);
  EXPECT_EQ(summaries[0].value.value, 40);
  EXPECT_EQ(summaries[1].ratio.value().value, 0.25);
  EXPECT_EQ(summaries[2].value.value, kNever);
  EXPECT_FALSE(summaries[2].ratio);
  EXPECT_EQ(summaries[3].runs, 0U);
  const std::string text = quantity_text(study, half_time.column, summaries);
  EXPECT_NE(text.find("time_to_half_s [95 %]"), std::string::npos) << text;
  EXPECT_NE(text.find("never"), std::string::npos) << text;
  EXPECT_NE(text.find("0.25 [0.25, 0.25]"), std::string::npos) << text;
}

TEST(StudyPage, HasWhatThePointsAreLike) {
  const Study study = two_by_two();
  StudyFigures second = figures_of(2, 0.25);
  second.escape_time_s[1] = 3;
  second.detection_probability = 0.5;
  second.half_time_s = kNever;
  const auto data = data_of(study_page({study, "1.2.3", "", std::vector<std::string>(4)},
                                       summarize(study, {{0, figures_of(1, 0.5)}, {0, second}})));
  const auto point = data["study"]["points"][0];
  EXPECT_EQ(point["values"], nlohmann::json::parse(R"(["0.1", "ABSOLUTE"])"));
  EXPECT_EQ(point["metric"], nlohmann::json::parse("[0.375, 0.25, 0.5]"));
  EXPECT_EQ(point["found"], nlohmann::json::parse("[0.25, 0.0, 0.5]"));
  EXPECT_EQ(point["half_found_s"], nlohmann::json::parse(R"(["never", 0.0, "never"])"));
  EXPECT_EQ(point["over_time"][0], nlohmann::json::parse("[1, 1.875, 1.25, 2.5]"));
  EXPECT_EQ(point["escapes"]["within_15_s"], 0.3333);
  EXPECT_EQ(point["escapes"]["late_s"], "never");
  EXPECT_EQ(point["escapes"]["shares"], nlohmann::json::parse("[[3, 0.3333], [15, 0.3333]]"));
}

TEST(StudyText, NamesEveryPoint) {
  const Study study = two_by_two();
  const std::string text = study_text(study, summarize(study, {{1, figures_of(1, 0.5)}}));
  EXPECT_NE(text.find("law.epsilon = 0.1, law.regularization = RELATIVE"), std::string::npos)
      << text;
  EXPECT_NE(text.find("0.5"), std::string::npos) << text;
  EXPECT_NE(text.find("phi^2 in cosines [95 %]"), std::string::npos) << "by which all compare";
}

}  // namespace
}  // namespace ergocast::studies
