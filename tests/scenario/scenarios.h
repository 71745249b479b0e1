// SPDX-License-Identifier: BSD-3-Clause
// Scenario texts for tests, and the two possible results of reading them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "plan/plan.h"
#include "scenario/scenario.h"

namespace ergocast::test {

inline constexpr const char* kShipped[] = {
    "paper_fig1a",    "paper_fig1b", "paper_fig2a",  "paper_fig2b",    "quadrimodal_corners",
    "uniform_square", "lake_search", "field_survey", "harbour_patrol", "cube_corners",
    "water_column",   "two_rooms",   "lost_hiker",   "mine_line",      "search_rooms"};

inline std::filesystem::path shipped(const std::string& name) {
  return std::filesystem::path(ERGOCAST_SCENARIO_DIR) / (name + ".textproto");
}

/// The shortest text that makes a scenario.
inline constexpr std::string_view kSmall = R"(
domain { size_x_m: 100 size_y_m: 50 }
target { uniform_weight: 1 }
law { u_max_mps: 5 }
time { duration_s: 60 }
agents { starts { x_m: 10 y_m: 20 } }
)";

/// kSmall with `from` replaced by `to`.
inline std::string small_with(std::string_view from, std::string_view to) {
  std::string text(kSmall);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline ::testing::AssertionResult has(std::string_view text, std::string_view part) {
  if (text.find(part) != std::string_view::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no \"" << part << "\" in:\n" << text;
}

inline std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += to_string(problem) + "\n";
  return text;
}

using Loaded = Result<Scenario, std::vector<Problem>>;

inline std::string problems_of(const Loaded& loaded) {
  return loaded ? "no problem" : joined(loaded.error());
}

inline Scenario good(Loaded loaded) {
  if (!loaded) {
    throw std::runtime_error(joined(loaded.error()));  // fails the test, with the reason
  }
  return *std::move(loaded);
}

inline Scenario good(std::string_view text, const Overrides& overrides = {}) {
  return good(Scenario::parse(text, "small.textproto", overrides));
}

inline std::vector<std::byte> plan_of(const Scenario& scenario) {
  return encode_plan(scenario.mission());
}

/// The problems of `text`, none if it has none.
inline std::vector<Problem> problems_of(std::string_view text, const Overrides& overrides = {}) {
  const Loaded loaded = Scenario::parse(text, "f", overrides);
  return loaded ? std::vector<Problem>{} : loaded.error();
}

}  // namespace ergocast::test
