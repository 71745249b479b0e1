// SPDX-License-Identifier: BSD-3-Clause
// Binds records and simulations as plain arrays and texts; python/ergocast/ makes frames of them.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "cli/record/run_directory.h"
#include "cli/record/simulated_record.h"
#include "cli/team/recorded_team.h"
#include "core/mission/kinds.h"
#include "logger/observer.h"
#include "logger/run_data.h"
#include "logger/summary.h"
#include "python/arrays.h"
#include "python/module.h"
#include "python/own_law.h"
#include "report/report.h"
#include "report/target_density.h"
#include "runtime/process/shipped_scenarios.h"
#include "text/printable.h"

namespace ergocast::python {
namespace {

using namespace pybind11::literals;
namespace fs = std::filesystem;

/// The text of an error; the package raises it as its own RecordError or ScenarioError.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class Value>
Value value_or_throw(Result<Value> read) {
  if (!read) throw Refused(read.error());
  return *std::move(read);
}

// ---- records ----

struct Record {
  fs::path folder;
  Mission mission;
  RunData rows;
};

Record read_record(const fs::path& folder) {
  const py::gil_scoped_release others_may_run;
  Record record{folder, value_or_throw(read_mission(folder)), {}};
  record.rows = value_or_throw(read_run(folder, record.mission));
  const Tick ticks = tick_after(
      record.rows.holds(), tick_count_of(record.mission.timing, record.rows.amendments.ends()));
  for (const auto& [agent, track] : record.rows.tracks) {
    if (track.back().tick < ticks) continue;
    throw Refused((folder / kTrajectoryFile).string() + ": tick: agent " + std::to_string(agent) +
                  " has a row of tick " + std::to_string(track.back().tick) +
                  ", and the plan ends before tick " + std::to_string(ticks) +
                  ": copy plan.binpb and tables of one run");
  }
  return record;
}

/// Copies a column into a numpy array.
template <class Number>
py::array_t<Number> column(const std::vector<Number>& values) {
  return py::array_t<Number>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::dict trajectory(const Record& record) {
  std::vector<Tick> tick;
  std::vector<AgentId> agent;
  std::vector<double> t_s;
  std::array<std::vector<double>, 3> x_m, v_mps;
  for_each_row(record.rows, [&](AgentId id, const TrackPoint& point) {
    tick.push_back(point.tick);
    agent.push_back(id);
    t_s.push_back(point.t_s);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      x_m[axis].push_back(point.x_m[static_cast<Eigen::Index>(axis)]);
      v_mps[axis].push_back(point.v_mps[static_cast<Eigen::Index>(axis)]);
    }
  });
  const std::string names = record.mission.domain.planar() ? "xy" : "xyz";
  py::dict table("tick"_a = column(tick), "t_s"_a = column(t_s), "agent"_a = column(agent));
  for (std::size_t axis = 0; axis < names.size(); ++axis)
    table[py::str(names[axis] + std::string("_m"))] = column(x_m[axis]);
  for (std::size_t axis = 0; axis < names.size(); ++axis)
    table[py::str(std::string("v") + names[axis] + "_mps")] = column(v_mps[axis]);
  return table;
}

py::dict metrics(const Record& record) {
  const std::vector<MetricsRow>& rows = record.rows.metrics;
  std::vector<Tick> tick;
  for (const MetricsRow& row : rows) tick.push_back(row.tick);
  const auto counts = [&rows](double MetricsRow::*member) {
    std::vector<std::int64_t> values;
    for (const MetricsRow& row : rows) values.push_back(static_cast<std::int64_t>(row.*member));
    return column(values);
  };
  const auto numbers = [&rows](double MetricsRow::*member) {
    std::vector<double> values;
    for (const MetricsRow& row : rows) values.push_back(row.*member);
    return column(values);
  };
  return py::dict("tick"_a = column(tick), "t_s"_a = numbers(&MetricsRow::t_s),
                  "ergodic_metric"_a = numbers(&MetricsRow::ergodic_metric),
                  "detection_probability"_a = numbers(&MetricsRow::detection_probability),
                  "metric_spread"_a = numbers(&MetricsRow::spread),
                  "max_staleness_s"_a = numbers(&MetricsRow::max_staleness_s),
                  "contributions_received"_a = counts(&MetricsRow::received),
                  "contributions_lost"_a = counts(&MetricsRow::lost),
                  "blocked_share"_a = numbers(&MetricsRow::blocked_share));
}

/// c after each of `ticks`, from the same data as the recorder's φ²: in the order of the file,
/// members only. After a change of the target it is shifted (core/law/target_shift.h).
Numbers coverage(const Record& record, const std::vector<Tick>& ticks,
                 const std::optional<std::vector<std::tuple<AgentId, Tick, Tick>>>& members) {
  check(std::is_sorted(ticks.begin(), ticks.end()), "ticks: must ascend");
  const Mission& mission = record.mission;
  const int modes = mission.basis.mode_count();
  std::vector<py::ssize_t> shape = shape_of(mission.basis);
  shape.insert(shape.begin(), static_cast<py::ssize_t>(ticks.size()));
  Numbers result(shape);
  double* out = result.mutable_data();
  std::fill(out, out + result.size(), 0.0);
  const RecordedRests rests(record.rows, mission);
  Observer observer;
  observer.begin(mission);
  auto next = ticks.begin();
  const auto write_before = [&](Tick tick) {
    for (; next != ticks.end() && *next < tick; ++next, out += modes) {
      if (!observer.has_seen_any()) continue;
      const Coefficients c = observer.coverage();
      std::copy(c.data(), c.data() + modes, out);
    }
  };
  const auto is_member = [&members](AgentId agent, Tick tick) {
    return !members || std::any_of(members->begin(), members->end(), [&](const auto& member) {
      const auto& [id, from, until] = member;
      return id == agent && tick >= from && tick < until;
    });
  };
  const ReceivedAmendment* target = nullptr;
  const auto aim_at = [&](Tick tick) {
    const ReceivedAmendment* const now = record.rows.amendments.target_at(tick);
    if (now != target) observer.begin_target(mission, now->target->target);
    target = now;
  };
  for_each_row(record.rows, [&](AgentId agent, const TrackPoint& point) {
    if (next == ticks.end()) return;
    write_before(point.tick);
    aim_at(point.tick);
    const bool counts =
        !is_held(record.rows.holds(), point.tick) && !rests.rests(agent, point.tick);
    if (counts && is_member(agent, point.tick)) {
      const Tick counted = counted_ticks(record.rows.holds(), point.tick);
      observer.see(mission, counted, planned_kind(mission, agent), point.x_m);
    }
  });
  write_before(std::numeric_limits<Tick>::max());
  return result;
}

/// The text of summary.json; nullopt if there is none.
std::optional<std::string> summary(const Record& record) {
  const auto read = value_or_throw(read_summary(record.folder));
  if (read.is_null()) return std::nullopt;
  return to_text(read);
}

std::optional<Eigen::MatrixXd> target_density(const Record& record) {
  Field field = value_or_throw(read_target_density(record.folder / kTargetDensityFile));
  if (field.size() == 0) return std::nullopt;
  return field;
}

// ---- scenarios ----

/// (path, value, how the error calls it).
using Fields = std::vector<std::tuple<std::string, std::string, std::string>>;

/// Throws the problems, one on each line.
Scenario load(const fs::path& file, std::optional<std::uint64_t> seed, const Fields& fields) {
  const py::gil_scoped_release others_may_run;
  std::string name = file.string();
  if (const std::string problem = shipped_scenario()(name); !problem.empty())
    throw Refused(problem);
  Overrides overrides{.seed = seed};
  for (const auto& [path, value, flag] : fields) overrides.fields.push_back({path, value, flag});
  auto loaded = Scenario::load(name, overrides);
  if (loaded) return *std::move(loaded);
  std::string text;
  for (const Problem& problem : loaded.error())
    text += (text.empty() ? "" : "\n") + to_string(problem);
  throw Refused(text);
}

/// Simulates into `out`, new or empty. A signal, such as Ctrl-C, ends it in order.
/// @param law  an object of ergocast.Law, or None
void simulate(const Scenario& scenario, const fs::path& out, bool report, const py::object& law,
              const std::string& law_name) {
  const cli::OwnLaw own{laws_of(law, scenario.mission()), law_name};
  std::optional<py::error_already_set> interrupted;
  {
    const py::gil_scoped_release others_may_run;
    const fs::path folder = value_or_throw(cli::prepare_run_directory(out, scenario));
    const auto record = value_or_throw(RunRecord::create(folder));
    const auto look = [&](cli::SimulationInProgress& simulation) {
      const py::gil_scoped_acquire others_wait;
      if (interrupted || PyErr_CheckSignals() == 0) return;
      interrupted.emplace();
      simulation.end("interrupted from Python");
    };
    value_or_throw(cli::simulate_into(*record, scenario, look, nullptr, {}, own));
    if (report && !interrupted) {
      const Mission& mission = scenario.mission();
      const auto problem = write_report(folder, mission, cli::recorded_team(folder, mission));
      if (problem) throw Refused(*problem);
    }
  }
  if (interrupted) throw *interrupted;
}

}  // namespace

void add_records(py::module_& module) {
  static const py::exception<Refused> refused(module, "Refused", PyExc_ValueError);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Refused& problem) {
      PyErr_SetString(refused.ptr(), printable(problem.what()).c_str());
    }
  });
  py::class_<Record>(module, "Record",
                     "A run directory, read. Refused: with file, line and remedy.")
      .def(py::init(&read_record), "folder"_a)
      .def_readonly("mission", &Record::mission)
      .def("trajectory", &trajectory, "The columns of trajectory.csv, all segments.")
      .def("metrics", &metrics, "The columns of metrics.csv, all segments.")
      .def("coverage", &coverage, "ticks"_a, "members"_a,
           "c after each of `ticks`, which ascend: shape (ticks, modes_x, modes_y).")
      .def("summary", &summary, "The text of summary.json, or None.")
      .def("target_density", &target_density, "target_density.csv, or None.");
  py::class_<Scenario>(module, "Scenario",
                       "A scenario without problems. Refused: one problem a line.")
      .def(py::init(&load), "file"_a, "seed"_a, "fields"_a)
      .def_property_readonly("mission", [](const Scenario& scenario) { return scenario.mission(); })
      .def("simulate", &simulate, "out"_a, "report"_a, "law"_a = py::none(), "law_name"_a = "",
           "Writes the record into `out`, new or empty.");
}

}  // namespace ergocast::python
