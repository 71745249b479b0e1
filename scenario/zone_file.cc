// SPDX-License-Identifier: BSD-3-Clause
// Reads the file as the only keep-out of a target, so that a zone has the same formats and rules.
#include "scenario/zone_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <system_error>
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
/// What the text of a zone consists of.
const std::string kCorners = "vertices { x_m: … y_m: … } for each corner";

/// How far outside the domain is_zone() accepts a corner, in multiples of the domain's longer side.
constexpr double kFarthest = 10;

std::string field(const std::string& name) { return std::string(kPath) + "." + name; }

/// Whether the text has any field of a scenario, even if it has mistakes, too.
bool is_scenario(const std::string& text) {
  proto::Scenario scenario;
  Findings mistakes("");
  read_text(text, scenario, mistakes);
  return scenario.ByteSizeLong() > 0;
}

/// Why a text is no polygon as a whole, and what to do; nothing if it may be one.
std::optional<FileProblem> why_no_polygon(const std::string& text) {
  const auto is = [](const char* what, std::string remedy) {
    return FileProblem{FileProblem::Kind::kUnreadable, what, std::move(remedy)};
  };
  if (text.find_first_not_of(" \t\r\n") == text.npos) return is("is empty", "write " + kCorners);
  if (is_scenario(text))
    return is("is a scenario, and a zone is one polygon", "write only " + kCorners);
  if (text.find("x_m") == text.npos && text.find("file") == text.npos)
    return is("is no polygon",
              "name GeoJSON (.geojson), KML (.kml), a drawing (.svg) or a text: " + kCorners);
  return std::nullopt;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
    text.replace(at, from.size(), to);
}

/// Names fields and columns as the file has them.
Problems as_in_file(Problems problems, const fs::path& file) {
  const std::string whole_name = fs::absolute(file).lexically_normal().string() + ": ";
  for (Problem& problem : problems) {
    const bool is_unknown = problem.what.starts_with("unknown field");
    if (is_unknown && !problem.remedy.starts_with("did you mean"))
      problem.remedy = "a zone's text has " + kCorners + ", and in a box low_z_m and high_z_m";
    for (std::string* text : {&problem.where, &problem.what, &problem.remedy}) {
      replace_all(*text, field(""), "");
      replace_all(*text, std::string(kPath), "polygon");
      replace_all(*text, kBlock, "");
      replace_all(*text, " in Polygon", "");
    }
    if (is_polygon_file(file) && problem.where == file.string() + ": file") {
      problem.where = file.string();
      replace_all(problem.what, whole_name, "");
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
  std::error_code ignored;
  if (is_polygon_file(file) && fs::file_size(file, ignored) != 0) {
    scenario.mutable_target()->add_keep_outs()->set_file(file.filename().string());
    return true;
  }
  auto text = read_whole(file, kMaxScenarioBytes);
  const auto problem = text ? why_no_polygon(*text) : text.error();
  if (problem) {
    findings.add_to_file(problem->what, problem->remedy);
    return false;
  }
  return read_text(std::string(kBefore) + *text + std::string(kAfter), scenario, findings);
}

/// Reports the first coordinate that is no number, or far from the domain.
bool has_near_numbers(const proto::Polygon& polygon, const Box& domain, Checks& checks) {
  const double far_m = kFarthest * domain.size_m.maxCoeff();
  const auto is_near = [&](const std::string& name, double value_m, int axis) {
    const double low_m = domain.origin_m[axis] - far_m;
    const double high_m = domain.origin_m[axis] + domain.size_m[axis] + far_m;
    const std::string wanted = "from " + shortest(low_m) + " to " + shortest(high_m);
    return checks.in_range(field(name), value_m, {limits::between(low_m, high_m)}, wanted);
  };
  for (int i = 0; i < polygon.vertices_size(); ++i) {
    const std::string vertex = indexed("vertices", i) + '.';
    const proto::Vertex& corner = polygon.vertices(i);
    if (!is_near(vertex + "x_m", corner.x_m(), 0) || !is_near(vertex + "y_m", corner.y_m(), 1))
      return false;
  }
  return true;
}

/// Reports a prism that has no height, or none in the domain.
void check_heights(const proto::Polygon& polygon, const Box& domain, Checks& checks) {
  const double floor_m = domain.origin_m.z(), top_m = floor_m + domain.size_m.z();
  const double low_m = polygon.has_low_z_m() ? polygon.low_z_m() : floor_m;
  const double high_m = polygon.has_high_z_m() ? polygon.high_z_m() : top_m;
  const bool has_height = low_m < high_m && std::isfinite(low_m) && std::isfinite(high_m);
  if (has_height && low_m < top_m && high_m > floor_m) return;
  checks.problem(
      field(polygon.has_low_z_m() ? "low_z_m" : "high_z_m"),
      "from " + shortest(low_m) + " to " + shortest(high_m) + " m it has no height in the domain",
      "write low_z_m below high_z_m, between " + shortest(floor_m) + " and " + shortest(top_m));
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
  if (!has_near_numbers(polygon, domain, checks)) return;
  const auto flaw = flaw_of(polygon_of(polygon), least_area_m2(domain.size_m.maxCoeff()));
  if (flaw && polygon.holes_size() == 0)
    checks.problem(flaw->corner < 0 ? std::string(kPath) : field(indexed("vertices", flaw->corner)),
                   flaw->what, flaw->remedy);
  if (polygon.vertices_size() > static_cast<int>(kMaxZoneCorners))
    checks.problem(std::string(kPath),
                   "has " + std::to_string(polygon.vertices_size()) + " corners, above the limit " +
                       std::to_string(kMaxZoneCorners),
                   "draw the zone with fewer");
  if (domain.planar()) {
    if (polygon.has_low_z_m()) checks.of_a_box_alone(field("low_z_m"));
    if (polygon.has_high_z_m()) checks.of_a_box_alone(field("high_z_m"));
  } else {
    check_heights(polygon, domain, checks);
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
  if (is_polygon_file(file)) return false;  // such a file may also be a target
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
  if (is_geodata(file) && !scenario.has_origin()) {
    findings.add_to_file(
        "needs the origin of the mission's scenario, but that has none, or is not on this host",
        "write the corners in metres in a text: " + kCorners);
    return problems();
  }
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
  if (is_zone(zone, domain)) return zone;
  checks.problem(std::string(kPath), "cannot be a zone of this domain", "draw it anew");
  return problems();
}

}  // namespace ergocast
