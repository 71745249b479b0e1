// SPDX-License-Identifier: BSD-3-Clause
// Reads the file as the only keep-out of a target, so that a zone has the same formats and rules.
#include "scenario/zone_file.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "scenario/compile/defaults.h"
#include "scenario/compile/new_target.h"
#include "scenario/compile/polygon_files.h"
#include "scenario/parse/convert.h"
#include "scenario/parse/findings.h"
#include "scenario/parse/text.h"
#include "scenario/rules/checks.h"
#include "scenario/rules/polygon_flaw.h"
#include "scenario/rules/validate_target.h"
#include "scenario/scenario.h"
#include "scenario/scenario.pb.h"
#include "text/input_file.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;
using Problems = std::vector<Problem>;

constexpr std::string_view kBefore = "target{keep_outs{", kAfter = "\n}}";
constexpr std::string_view kPath = "target.keep_outs[0]";
const std::string kBlock = "target.keep_outs.";

std::string field(const std::string& name) { return std::string(kPath) + "." + name; }

bool is_drawing(const fs::path& file) {
  const std::string end = file.extension().string();
  return end == ".geojson" || end == ".json" || end == ".svg";
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
    text.replace(at, from.size(), to);
}

/// Names fields and columns as the file has them.
Problems as_in_file(Problems problems, const fs::path& file) {
  for (Problem& problem : problems) {
    for (std::string* text : {&problem.where, &problem.what, &problem.remedy}) {
      replace_all(*text, field(""), "");
      replace_all(*text, std::string(kPath), "polygon");
      replace_all(*text, kBlock, "");
    }
    const std::string first = file.string() + ":1:";
    if (!problem.where.starts_with(first)) continue;
    const auto column = std::strtol(problem.where.c_str() + first.size(), nullptr, 10);
    problem.where = first + std::to_string(std::max(1L, column - std::ssize(kBefore)));
  }
  return problems;
}

/// Fills in the keep-out; false if the file cannot be read, which is then reported.
bool read_polygon(const fs::path& file, proto::Scenario& scenario, Findings& findings) {
  if (is_drawing(file)) {
    scenario.mutable_target()->add_keep_outs()->set_file(file.filename().string());
    return true;
  }
  auto text = read_whole(file, kMaxScenarioBytes);
  if (!text) {
    findings.add_to_file(text.error().what, text.error().remedy);
    return false;
  }
  return read_text(std::string(kBefore) + *text + std::string(kAfter), scenario, findings);
}

/// Reports what a zone may not be, though a keep-out may.
void check(const proto::Scenario& scenario, Checks& checks) {
  const int count = scenario.target().keep_outs_size();
  if (count != 1) {
    checks.problem(std::string(kPath),
                   "the file has " + std::to_string(count) + " polygons, and a zone is one",
                   "write one file for each zone, and send them one after the other");
    return;
  }
  const proto::Polygon& polygon = scenario.target().keep_outs(0);
  if (polygon.has_solid()) checks.problem(field("solid"), "is not for zones", "leave it out");
  if (polygon.holes_size() > 0)
    checks.problem(field("holes[0]"), "a zone has no holes", "cut the polygon into two zones");
  const Box domain = domain_of(scenario.domain());
  const auto flaw = flaw_of(polygon_of(polygon), least_area_m2(domain.size_m.maxCoeff()));
  if (flaw && polygon.holes_size() == 0)
    checks.problem(std::string(kPath), flaw->what, flaw->remedy);
  if (polygon.vertices_size() > static_cast<int>(kMaxZoneCorners))
    checks.problem(std::string(kPath),
                   "has " + std::to_string(polygon.vertices_size()) + " corners, above the limit " +
                       std::to_string(kMaxZoneCorners),
                   "draw the zone with fewer");
  if (domain.planar()) {
    if (polygon.has_low_z_m()) checks.of_a_box_alone(field("low_z_m"));
    if (polygon.has_high_z_m()) checks.of_a_box_alone(field("high_z_m"));
  }
}

bool is_sound(const proto::Scenario& scenario, Checks& checks, const Findings& findings) {
  check(scenario, checks);
  return findings.empty();
}

Zone zone_of(const proto::Polygon& polygon, const Box& domain) {
  Zone zone;
  zone.until = 1;
  zone.corners_m = polygon_of(polygon).outline;
  if (domain.planar()) return zone;
  const double floor_m = domain.origin_m.z();
  zone.low_m = polygon.has_low_z_m() ? polygon.low_z_m() : floor_m;
  zone.high_m = polygon.has_high_z_m() ? polygon.high_z_m() : floor_m + domain.size_m.z();
  return zone;
}

}  // namespace

bool looks_like_zone(const fs::path& file) {
  if (is_drawing(file)) return false;  // such a file may also be a target
  const auto text = read_whole(file, kMaxScenarioBytes);
  if (!text) return false;
  Findings findings(file.string());
  proto::Scenario scenario;
  const bool read = read_polygon(file, scenario, findings);
  return read && findings.empty() && scenario.target().keep_outs_size() == 1 &&
         (scenario.target().keep_outs(0).vertices_size() > 0 ||
          scenario.target().keep_outs(0).has_file());
}

Result<Zone, Problems> load_zone(const fs::path& file, const std::string& running) {
  proto::Scenario mission, scenario;
  Findings misread("the running mission"), findings(file.string());
  if (!read_text(running, mission, misread)) return failure(misread.take());
  const auto problems = [&] { return failure(as_in_file(findings.take(), file)); };
  if (!read_polygon(file, scenario, findings) || !findings.empty()) return problems();
  Checks checks(findings);
  place_in(mission, scenario, checks);
  const Box domain = domain_of(scenario.domain());
  proto::Polygon as_written =
      scenario.target().keep_outs_size() > 0 ? scenario.target().keep_outs(0) : proto::Polygon();
  fill_in(scenario, file.string());
  read_polygon_files(scenario, checks, findings);
  if (!findings.empty()) return problems();
  if (scenario.target().keep_outs_size() == 1) {
    proto::Polygon& polygon = *scenario.mutable_target()->mutable_keep_outs(0);
    *as_written.mutable_vertices() = polygon.vertices();
    *as_written.mutable_holes() = polygon.holes();
    polygon = as_written;
  }
  if (!is_sound(scenario, checks, findings)) return problems();
  const Zone zone = zone_of(scenario.target().keep_outs(0), domain);
  if (!is_zone(zone, domain)) {
    checks.problem(std::string(kPath), "is far from the domain, or its heights are",
                   "move it into the domain, with low_z_m below high_z_m");
    return problems();
  }
  return zone;
}

}  // namespace ergocast
