// SPDX-License-Identifier: BSD-3-Clause
// Runs the steps text, defaults, validation, target and plan, and stops at the first step that
// finds problems.
#include "scenario/scenario.h"

#include <utility>

#include "scenario/compile/compile_target.h"
#include "scenario/compile/defaults.h"
#include "scenario/compile/free_domain.h"
#include "scenario/compile/new_target.h"
#include "scenario/compile/omit_defaults.h"
#include "scenario/compile/polygon_files.h"
#include "scenario/origin.h"
#include "scenario/parse/convert.h"
#include "scenario/parse/findings.h"
#include "scenario/parse/text.h"
#include "scenario/rules/checks.h"
#include "scenario/rules/validate.h"
#include "scenario/rules/validate_stations.h"
#include "scenario/rules/validate_walls.h"
#include "scenario/rules/warnings.h"
#include "scenario/scenario.pb.h"
#include "target/maps/occupancy_map.h"
#include "text/input_file.h"

namespace ergocast {
namespace {

using Problems = std::vector<Problem>;

/// The contents of `file`, or why it cannot be read.
Result<std::string, Problem> read_file(const std::filesystem::path& file) {
  auto read = read_whole(file, kMaxScenarioBytes);
  if (read) return *std::move(read);
  FileProblem& problem = read.error();
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    problem.remedy = "name a file, such as " + (file / "scenario.textproto").string();
  return failure(Problem{file.string(), std::move(problem.what), std::move(problem.remedy)});
}

/// The text of a mission, for which a new target is read.
Result<proto::Scenario, Problems> running_mission(const std::string& text) {
  proto::Scenario mission;
  Findings misread("the running mission");
  if (!read_text(text, mission, misread)) return failure(misread.take());
  return mission;
}

}  // namespace

struct Scenario::State {
  proto::Scenario text;  ///< defaults filled in, starts listed
  DensityGrid target_density;
  Mission mission;
  int listed_starts;  ///< the others were drawn
  Problems warnings;

  std::vector<std::filesystem::path> polygon_files, by_whole_path;
  std::vector<MapRooms> map_rooms;

  State(proto::Scenario scenario, CompiledTarget target, int listed)
      : text(std::move(scenario)),
        target_density(std::move(target.density)),
        mission(mission_of(text)),
        listed_starts(listed) {
    mission.target_coefficients = std::move(target.coefficients);
  }

  /// The same domain, walls and target as those of another mission.
  void use_free_domain_of(const Mission& other) {
    mission.basis = other.basis;
    mission.target_coefficients = other.target_coefficients;
    mission.cosine_target = other.cosine_target;
  }
};

/// A scenario as it was read, and what was found in it.
struct Scenario::Written {
  proto::Scenario text;
  std::string file;
  Findings findings;
  std::optional<proto::Scenario> running{};  ///< the mission that its target is for
};

Result<Scenario, Problems> Scenario::load(const std::filesystem::path& file,
                                          const Overrides& overrides) {
  const auto text = read_file(file);
  if (!text) return failure(Problems{text.error()});
  return parse(*text, file.string(), overrides);
}

Result<Scenario, Problems> Scenario::parse(std::string_view text, const std::string& file,
                                           const Overrides& overrides) {
  Written written{{}, file, Findings(file)};
  if (!read_text(text, written.text, written.findings)) return failure(written.findings.take());
  put_over(overrides, written.text, written.findings);
  return compile(written);
}

Result<Scenario, Problems> Scenario::load_target(const std::filesystem::path& file,
                                                 const Overrides& overrides,
                                                 const std::string& running) {
  auto mission = running_mission(running);
  if (!mission) return failure(mission.error());
  Written written{{}, file.string(), Findings(file.string()), *std::move(mission)};
  Findings& findings = written.findings;
  if (!read_target_file(file.string(), written.running->domain(), written.text, findings)) {
    const auto text = read_file(file);
    if (!text) return failure(Problems{text.error()});
    if (!read_text(*text, written.text, findings)) return failure(findings.take());
  }
  refuse_other_fields(overrides, findings);
  put_over(overrides, written.text, findings);
  if (!findings.empty()) return failure(findings.take());
  return compile(written);
}

Result<Scenario, Problems> Scenario::parse_target(std::string_view text,
                                                  const std::string& running) {
  auto mission = running_mission(running);
  if (!mission) return failure(mission.error());
  const std::string name = "target";
  Written written{{}, name, Findings(name), *std::move(mission)};
  if (!read_text(text, written.text, written.findings)) return failure(written.findings.take());
  return compile(written);
}

Result<Scenario, Problems> Scenario::compile(Written& written) {
  auto& [scenario, file, findings, running] = written;
  std::vector<std::filesystem::path> by_whole_path;
  for (const std::string* name : file_names(scenario)) {
    if (name->starts_with('/')) by_whole_path.emplace_back(*name);
  }
  Checks checks(findings);
  if (running) place_in(*running, scenario, checks);
  fill_in(scenario, file);
  auto polygon_files = read_polygon_files(scenario, checks, findings);
  if (running) {
    complete_from(*running, scenario, checks);
    fill_in(scenario, file);
  }
  validate(scenario, checks);
  std::optional<CompiledTarget> target;
  if (checks.sound("domain") && checks.sound("basis") && checks.sound("target")) {
    target = compile_target(scenario, checks);
  }
  if (target && findings.empty())
    validate_free_region(mission_of(scenario), target->density, checks);
  if (!findings.empty()) return failure(findings.take());

  make_walls(scenario);
  const int listed_starts = scenario.agents().starts_size();
  draw_starts(scenario);
  validate_ways_home(mission_of(scenario), checks);
  if (std::vector<Problem> unreachable = findings.take(); !unreachable.empty())
    return failure(unreachable);
  omit_defaults(mission_of(scenario), scenario);
  auto state = std::make_shared<State>(std::move(scenario), std::move(*target), listed_starts);
  state->polygon_files = std::move(polygon_files.files);
  state->map_rooms = std::move(polygon_files.maps);
  state->by_whole_path = std::move(by_whole_path);
  if (auto problem = use_free_domain(state->target_density, state->mission)) {
    findings.add("basis.free_domain", "the free domain has no modes: " + *problem,
                 "widen the narrowest way, or write free_domain: false");
    return failure(findings.take());
  }
  findings.add_notes();
  if (!running) warn(state->mission, findings);
  warn_of_target(state->mission, state->target_density, findings);
  state->warnings = findings.take();
  return Scenario(std::move(state));
}

Result<std::optional<GeoPlace>, Problems> read_origin(const std::filesystem::path& file) {
  const auto text = read_file(file);
  if (!text) return failure(Problems{text.error()});
  Findings findings(file.string());
  proto::Scenario scenario;
  if (!read_text(*text, scenario, findings)) return failure(findings.take());
  if (!scenario.has_origin()) return std::optional<GeoPlace>();
  const GeoPlace place{scenario.origin().latitude_deg(), scenario.origin().longitude_deg()};
  Checks checks(findings);
  checks.in_range("origin.latitude_deg", place.latitude_deg, {limits::between(-90, 90)});
  checks.in_range("origin.longitude_deg", place.longitude_deg, {limits::between(-180, 180)});
  if (!findings.empty()) return failure(findings.take());
  return std::optional(place);
}

Scenario Scenario::with_seed(std::uint64_t seed) const {
  proto::Scenario scenario = state_->text;
  scenario.set_seed(seed);
  proto::Agents& agents = *scenario.mutable_agents();
  const int drawn = agents.starts_size() - state_->listed_starts;
  agents.mutable_starts()->DeleteSubrange(state_->listed_starts, drawn);
  agents.set_random_count(drawn);
  draw_starts(scenario);
  omit_defaults(mission_of(scenario), scenario);
  auto state = std::make_shared<State>(
      std::move(scenario), CompiledTarget{mission().target_coefficients, state_->target_density},
      state_->listed_starts);
  state->use_free_domain_of(mission());
  return Scenario(std::move(state));
}

Scenario::Scenario(std::shared_ptr<const State> state) : state_(std::move(state)) {}
Scenario::Scenario(const Scenario&) = default;
Scenario::Scenario(Scenario&&) noexcept = default;
Scenario::~Scenario() = default;
Scenario& Scenario::operator=(Scenario other) noexcept {
  state_.swap(other.state_);
  return *this;
}

std::string Scenario::print() const { return print_text(state_->text); }
const std::vector<Problem>& Scenario::warnings() const { return state_->warnings; }
const std::string& Scenario::name() const { return state_->text.name(); }
const std::string& Scenario::description() const { return state_->text.description(); }
std::vector<std::filesystem::path> Scenario::map_files() const {
  std::vector<std::filesystem::path> files;
  for (const proto::Map& map : state_->text.target().maps()) {
    files.emplace_back(map.file());
    if (!is_occupancy_map(map.file())) continue;
    if (auto about = read_map_yaml(map.file())) files.push_back(std::move(about->image));
  }
  for (const proto::Voxels& voxels : state_->text.target().voxels())
    files.emplace_back(voxels.file());
  files.insert(files.end(), state_->polygon_files.begin(), state_->polygon_files.end());
  return files;
}
const std::vector<std::filesystem::path>& Scenario::files_by_whole_path() const {
  return state_->by_whole_path;
}
const std::vector<MapRooms>& Scenario::map_rooms() const { return state_->map_rooms; }
const DensityGrid& Scenario::target_density() const { return state_->target_density; }
const Mission& Scenario::mission() const { return state_->mission; }

}  // namespace ergocast
