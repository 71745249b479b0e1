// SPDX-License-Identifier: BSD-3-Clause
// Chooses what the page needs of each point, with only the digits that it shows.
#include "studies/study_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "report/web_page.h"

namespace ergocast::studies {
namespace {

using Json = nlohmann::ordered_json;
using Summaries = std::vector<PointSummary>;

/// Longer distributions are thinned out.
constexpr std::size_t kMostSteps = 100;

Json number(double value) { return page_number(value, 4); }

Json interval(const Estimate& estimate) {
  return Json::array({number(estimate.value), number(estimate.low), number(estimate.high)});
}

/// "never" if most do not get there.
Json time_or_never(double t_s) { return std::isinf(t_s) ? Json("never") : number(t_s); }

Json times_or_never(const Estimate& estimate) {
  return {time_or_never(estimate.value), time_or_never(estimate.low), time_or_never(estimate.high)};
}

/// [t, share of the agents that have escaped by then], ascending, up to the end of the mission.
Json shares(const std::vector<double>& times_s, double end_s) {
  const std::size_t every = times_s.size() / kMostSteps + 1;
  const auto all = static_cast<double>(times_s.size());
  Json list = Json::array();
  double last = 0;
  for (std::size_t i = 0; i < times_s.size() && times_s[i] <= end_s; ++i) {
    last = static_cast<double>(i + 1) / all;
    const bool drawn = (i + 1) % every == 0 || i + 1 == times_s.size() || times_s[i + 1] > end_s;
    if (drawn) list.push_back(Json::array({number(times_s[i]), number(last)}));
  }
  list.push_back(Json::array({number(end_s), number(last)}));
  return list;
}

Json escapes(const PointSummary& summary, double end_s) {
  const std::vector<double>& times_s = summary.escape_times_s;
  return {{"within_15_s", number(summary.escaped_share(15))},
          {"within_60_s", number(summary.escaped_share(60))},
          {"median_s", time_or_never(quantile(times_s, 0.5))},
          {"late_s", time_or_never(quantile(times_s, 0.99))},
          {"shares", shares(times_s, end_s)}};
}

Json point_json(const StudyPoint& point, const std::string& command, const PointSummary& summary) {
  Json json = {{"scenario", point.scenario},
               {"values", point.values},
               {"command", command},
               {"runs", summary.runs}};
  if (summary.runs == 0) return json;
  json["metric"] = interval(summary.metric);
  if (summary.ratio) json["ratio"] = interval(*summary.ratio);
  if (summary.slope) json["slope"] = number(*summary.slope);
  if (summary.found) json["found"] = interval(*summary.found);
  if (summary.half_time_s) json["half_found_s"] = times_or_never(*summary.half_time_s);
  json["over_time"] = Json::array();
  for (const auto& [t_s, median] : summary.metric_over_time) {
    json["over_time"].push_back(
        Json::array({number(t_s), number(median.value), number(median.low), number(median.high)}));
  }
  if (!summary.escape_times_s.empty()) json["escapes"] = escapes(summary, point.duration_s);
  json["offset2_mean_m2"] = number(summary.offset2_mean_m2);
  json["offset2_max_m2"] = number(summary.offset2_max_m2);
  json["edge_share"] = number(summary.edge_share);
  json["speed_mean_mps"] = number(summary.speed_mean_mps);
  json["messages"] = number(summary.messages);
  return json;
}

std::string title_of(const Study& study) {
  std::set<std::string> scenarios;
  for (const StudyPoint& point : study.points) scenarios.insert(point.scenario);
  std::string title;
  for (const std::string& scenario : scenarios) title += (title.empty() ? "" : ", ") + scenario;
  return title;
}

std::string short_number(double value) {
  char text[32];
  if (std::isinf(value)) return "never";
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string plain(const Estimate& estimate) {
  return short_number(estimate.value) + " [" + short_number(estimate.low) + ", " +
         short_number(estimate.high) + ']';
}

/// The cells that a terminal shows of a point, after its name.
std::vector<std::string> terminal_cells(const PointSummary& s) {
  if (s.runs == 0) return {"0", "-", "-", "-", "-"};
  const bool held = !s.escape_times_s.empty();
  return {std::to_string(s.runs), plain(s.metric), s.ratio ? plain(*s.ratio) : "-",
          s.slope ? short_number(*s.slope) : "-",
          held ? short_number(100 * s.escaped_share(60)) + " %" : "-"};
}

/// Columns as wide as their widest cell; the first one begins on the left.
std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines[0].size());
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (const auto& line : lines) {
    std::string row = line[0] + std::string(widths[0] - line[0].size(), ' ');
    for (std::size_t i = 1; i < line.size(); ++i)
      row += "  " + std::string(widths[i] - line[i].size(), ' ') + line[i];
    text += row + '\n';
  }
  return text;
}

}  // namespace

std::string study_page(const StudyFacts& facts, const Summaries& summaries) {
  Json points = Json::array();
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    points.push_back(point_json(facts.study.points[i], facts.point_commands[i], summaries[i]));
  }
  const std::string title = title_of(facts.study);
  return html_file(study_web_page(), title,
                   {{"study",
                     {{"title", title},
                      {"fields", facts.study.fields},
                      {"points", std::move(points)},
                      {"command", facts.command},
                      {"version", facts.version}}}});
}

std::string study_text(const Study& study, const Summaries& summaries) {
  std::vector<std::vector<std::string>> lines{{"", "runs", "phi^2 in cosines [95 %]",
                                               "against the first [95 %]", "slope",
                                               "escaped in 60 s"}};
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    lines.push_back({name_of(study.points[i], study)});
    for (std::string& cell : terminal_cells(summaries[i])) lines.back().push_back(std::move(cell));
  }
  return aligned(lines);
}

std::string quantity_text(const Study& study, const char* name,
                          const std::vector<QuantitySummary>& summaries) {
  std::vector<std::vector<std::string>> lines{
      {"", "runs", std::string(name) + " [95 %]", "against the first [95 %]"}};
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    const QuantitySummary& summary = summaries[i];
    lines.push_back({name_of(study.points[i], study), std::to_string(summary.runs),
                     summary.runs > 0 ? plain(summary.value) : "-",
                     summary.ratio ? plain(*summary.ratio) : "-"});
  }
  return aligned(lines);
}

}  // namespace ergocast::studies
