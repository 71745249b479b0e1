// SPDX-License-Identifier: BSD-3-Clause
// Tables of columns say what a study shows; page and terminal print the columns for which there
// are values.
#include "lab/studies/study_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>
#include <span>

#include "lab/studies/html.h"
#include "lab/studies/study_figures.h"
#include "lab/studies/study_style.h"
#include "report/markup.h"

namespace ergocast::studies {
namespace {

using Summaries = std::vector<PointSummary>;
using Cell = std::optional<std::string>;

/// "1.1 [0.764, 1.46] × 10⁻³": a small value and its interval in the same power of ten.
std::string interval(const Estimate& estimate) {
  const bool small = estimate.value > 0 && estimate.value < 0.01;
  const int decade = small ? static_cast<int>(std::floor(std::log10(estimate.value))) : 0;
  const auto scaled = [unit = std::pow(10, decade)](double value) {
    return readable(value / unit);
  };
  const std::string text =
      scaled(estimate.value) + " [" + scaled(estimate.low) + ", " + scaled(estimate.high) + ']';
  return small ? text + " × " + power_of_ten(decade, false) : text;
}

std::string percent(double share) { return readable(std::round(share * 1000) / 10) + "\u00a0%"; }

std::string seconds(double t_s) { return std::isinf(t_s) ? "never" : readable(t_s) + "\u00a0s"; }

struct Described {
  const char* title;
  Cell (*cell)(const PointSummary&);
};

constexpr Described kResults[] = {
    {"runs", [](const PointSummary& s) -> Cell { return readable(static_cast<double>(s.runs)); }},
    {"φ² at the end [95 %]", [](const PointSummary& s) -> Cell { return interval(s.metric); }},
    {"against the first [95 %]",
     [](const PointSummary& s) -> Cell { return s.ratio ? Cell(interval(*s.ratio)) : Cell(); }},
    {"slope",
     [](const PointSummary& s) -> Cell {
       return s.slope ? Cell(readable(std::round(*s.slope * 100) / 100)) : Cell();
     }},
};

constexpr Described kEscapes[] = {
    {"agents",
     [](const PointSummary& s) -> Cell {
       return readable(static_cast<double>(s.escape_times_s.size()));
     }},
    {"within 15 s", [](const PointSummary& s) -> Cell { return percent(s.escaped_share(15)); }},
    {"within 60 s", [](const PointSummary& s) -> Cell { return percent(s.escaped_share(60)); }},
    {"median",
     [](const PointSummary& s) -> Cell { return seconds(quantile(s.escape_times_s, 0.5)); }},
    {"99th percentile",
     [](const PointSummary& s) -> Cell { return seconds(quantile(s.escape_times_s, 0.99)); }},
};

constexpr Described kMotion[] = {
    {"mean ‖x − centre‖²",
     [](const PointSummary& s) -> Cell { return readable(s.offset2_mean_m2) + "\u00a0m²"; }},
    {"greatest",
     [](const PointSummary& s) -> Cell { return readable(s.offset2_max_m2) + "\u00a0m²"; }},
    {"time at the edge", [](const PointSummary& s) -> Cell { return percent(s.edge_share); }},
    {"mean speed",
     [](const PointSummary& s) -> Cell { return with_unit(s.speed_mean_mps, "m/s"); }},
    {"contributions a run",
     [](const PointSummary& s) -> Cell { return readable(std::round(s.messages)); }},
};

/// What tells the points apart, a column each.
std::vector<Column> point_columns(const Study& study) {
  std::vector<Column> columns;
  const bool several_scenarios = study.points.front().scenario != study.points.back().scenario;
  if (several_scenarios || study.fields.empty()) {
    columns.push_back({"scenario", true});
    for (const StudyPoint& point : study.points)
      columns.back().cells.push_back(escape(point.scenario));
  }
  for (std::size_t i = 0; i < study.fields.size(); ++i) {
    columns.push_back({escape(study.fields[i]), true});
    for (const StudyPoint& point : study.points)
      columns.back().cells.push_back(escape(point.values[i]));
  }
  return columns;
}

/// A row for each point; empty where `holds` does not.
std::string points_table(const Study& study, const Summaries& summaries,
                         std::span<const Described> described, bool (*holds)(const PointSummary&)) {
  std::vector<Column> columns = point_columns(study);
  for (const Described& column : described) {
    columns.push_back({column.title, false});
    for (const PointSummary& summary : summaries) {
      columns.back().cells.push_back(holds(summary) ? column.cell(summary) : Cell());
    }
  }
  return table(std::move(columns), study.points.size());
}

bool was_flown(const PointSummary& summary) { return summary.runs > 0; }
bool has_escapes(const PointSummary& summary) { return !summary.escape_times_s.empty(); }

std::string section(const std::string& title, const std::string& content) {
  return "<section><h2>" + title + "</h2>\n" + content + "</section>\n";
}

std::string title_of(const Study& study) {
  std::set<std::string> scenarios;
  for (const StudyPoint& point : study.points) scenarios.insert(point.scenario);
  std::string title;
  for (const std::string& scenario : scenarios) title += (title.empty() ? "" : ", ") + scenario;
  return title;
}

std::string counts(const Study& study, const Summaries& summaries) {
  std::size_t runs = 0, fewest = summaries.front().runs, most = 0;
  for (const PointSummary& summary : summaries) {
    runs += summary.runs;
    fewest = std::min(fewest, summary.runs);
    most = std::max(most, summary.runs);
  }
  const std::string seeds = readable(static_cast<double>(most));
  Facts facts("cards");
  facts.add("runs", readable(static_cast<double>(runs)));
  facts.add("points", readable(static_cast<double>(study.points.size())));
  facts.add("seeds a point",
            fewest == most ? seeds : readable(static_cast<double>(fewest)) + " to " + seeds);
  return facts.html();
}

std::string conventions() {
  Facts facts("facts");
  facts.add(
      "φ²",
      "at the last tick; it can be compared only between points with the same weights and modes");
  facts.add("[95 %] of a median",
            "order statistics, which assume nothing about the distribution; below six "
            "seeds from the smallest to the largest, which is less sure");
  facts.add("against the first",
            "the geometric mean of φ² over φ² of the first point with the same seed; "
            "bootstrap over the seeds");
  facts.add("slope", "the power of t that fits φ² over the last decade of time; median");
  facts.add(
      "escaped",
      "of the agents that start on a symmetry line or point of the domain, those that have been "
      "farther from it than 1 % of the shorter side");
  facts.add("time at the edge",
            "share of all agents’ ticks closer to an edge than 0.1 % of the shorter side");
  return facts.html();
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string plain(const Estimate& estimate) {
  return short_number(estimate.value) + " [" + short_number(estimate.low) + ", " +
         short_number(estimate.high) + ']';
}

/// What a terminal shows of a point, after its name.
std::vector<std::string> terminal_cells(const PointSummary& s) {
  if (s.runs == 0) return {"0", "-", "-", "-", "-"};
  const bool held = !s.escape_times_s.empty();
  return {std::to_string(s.runs), plain(s.metric), s.ratio ? plain(*s.ratio) : "-",
          s.slope ? short_number(*s.slope) : "-",
          held ? short_number(100 * s.escaped_share(60)) + " %" : "-"};
}

/// The figures, two side by side.
std::string figures_section(const std::vector<Figure>& figures) {
  std::string html = "<section class=\"figures\">\n";
  for (const Figure& figure : figures) {
    html += std::string("<figure") + (figure.wide ? " class=\"wide\"" : "") + "><h2>" +
            escape(figure.title) + "</h2>\n<div class=\"scroll\">" + figure.svg +
            "</div><figcaption>" + escape(figure.caption) + "</figcaption></figure>\n";
  }
  return html + "</section>\n";
}

std::string framed_page(const std::string& title, const std::string& kind,
                        const std::string& header, const std::string& content) {
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n";
  html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n";
  html += element("title", escape(title) + " – Ergocast") + element("style", kPageStyle);
  html += "</head><body><main>\n<header><p>" + escape(kind) + "</p>\n" +
          element("h1", escape(title)) + header + "</header>\n";
  return html + content + "</main></body></html>\n";
}

}  // namespace

std::string study_page(const StudyFacts& facts, const Summaries& summaries) {
  std::string html = counts(facts.study, summaries);
  html += section("Results", points_table(facts.study, summaries, kResults, was_flown));
  html += figures_section(study_figures(facts.study, summaries));
  if (std::any_of(summaries.begin(), summaries.end(), has_escapes)) {
    html += section("Escapes", points_table(facts.study, summaries, kEscapes, has_escapes));
  }
  html += section("Motion and messages", points_table(facts.study, summaries, kMotion, was_flown));
  html += section("Conventions", conventions());
  html += section("How to reproduce", "<pre>" + escape(facts.command) +
                                          "</pre>\n<p>Made by ergocast " + escape(facts.version) +
                                          ". Every run is a row of study.csv.</p>\n");
  return framed_page(title_of(facts.study), "Ergocast study", "", html);
}

std::string study_text(const Study& study, const Summaries& summaries) {
  std::vector<std::vector<std::string>> lines{
      {"", "runs", "phi^2 [95 %]", "against the first [95 %]", "slope", "escaped in 60 s"}};
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    lines.push_back({name_of(study.points[i], study)});
    for (std::string& cell : terminal_cells(summaries[i])) lines.back().push_back(std::move(cell));
  }
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

}  // namespace ergocast::studies
