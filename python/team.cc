// SPDX-License-Identifier: BSD-3-Clause
// Binds the parts of agents: the controller, the coverage table, and the team with perfect
// communication.
#include "core/law/control.h"
#include "core/law/coverage_table.h"
#include "lab/ideal_team.h"
#include "python/arrays.h"
#include "python/module.h"
#include "python/own_law.h"

namespace ergocast::python {
namespace {

using namespace pybind11::literals;

AgentId agent_in(int agent) {
  check(agent >= 0 && agent < kMaxAgents,
        "agent: must be from 0 to " + std::to_string(kMaxAgents - 1));
  return agent;
}

/// A controller, and the basis that determines the shape of its arrays.
struct Steering {
  explicit Steering(const Mission& plan)
      : domain(plan.domain), basis(plan.basis), controller(plan) {}
  Box domain;
  Basis basis;
  Controller controller;
};

/// A coverage table, and the position of its owner.
struct Coverage {
  Coverage(const Basis& modes, const Box& where, double step_s)
      : basis(modes), domain(where), dt_s(step_s), table(modes, step_s) {}
  Basis basis;
  Box domain;
  double dt_s;
  CoverageTable table;
};

Numbers command(Steering& steering, int agent, Tick tick, const Numbers& x_m) {
  check(tick >= 0, "tick: must not be negative");
  const AgentId id = agent_in(agent);
  const Eigen::Vector3d place = position_in(x_m, steering.domain, "x_m");
  return array_of(
      steering.controller.command(id, tick, place, BasisAt(place, steering.domain, steering.basis)),
      steering.domain);
}

void add_controller(py::module_& module) {
  py::class_<Steering>(module, "Controller", R"(The control step of a mission: core/law/control.h.

Before the first set_coverage() B is 0.)")
      .def(py::init<const Mission&>(), "mission"_a)
      .def(
          "set_coverage",
          [](Steering& s, const Numbers& coverage) {
            s.controller.set_coverage(coefficients_in(coverage, s.basis, "coverage"));
          },
          "coverage"_a, "Takes in c, shape (modes_x, modes_y). All later commands use it.")
      .def("command", &command, "agent"_a, "tick"_a, "x_m"_a,
           R"(The velocity of (10) at x_m: u − k (x − centre) + perturbation, shape (2,) [m/s].

A function of (seed, agent, tick), the place and the coverage.)")
      .def_property_readonly(
          "spectral_gradient",
          [](const Steering& s) { return array_of(s.controller.spectral_gradient(), s.domain); },
          "B of (6) at the last command, shape (2,) [1/m].")
      .def_property_readonly(
          "epsilon", [](const Steering& s) { return s.controller.epsilon(); },
          "The ε that belongs to the last coverage.")
      .def(
          "metric",
          [](const Steering& s, const Numbers& coverage) {
            return s.controller.metric(coefficients_in(coverage, s.basis, "coverage"));
          },
          "coverage"_a, "φ² of `coverage` against the mission's target.");
}

Coverage make_coverage(const Basis& basis, const Box& domain, double dt_s) {
  check(std::isfinite(dt_s) && dt_s > 0, "dt_s: must be finite and above 0");
  check(basis.planar() || !domain.planar(), "modes_z: the domain is a plane");
  return {basis, domain, dt_s};
}

void add_sample(Coverage& coverage, int agent, const Numbers& x_m, Incarnation incarnation) {
  const Author author{agent_in(agent), incarnation};
  const bool known = coverage.table.steps_held(author).has_value();
  check(known || coverage.table.row_count() < kMaxRosterEntries,
        "the table is full: " + std::to_string(kMaxRosterEntries) + " rows");
  const Eigen::Vector3d place = position_in(x_m, coverage.domain, "x_m");
  coverage.table.add_sample(author, BasisAt(place, coverage.domain, coverage.basis));
}

/// The number of blocks that were new.
int merge(Coverage& mine, const Coverage& theirs) {
  check(shape_of(mine.basis) == shape_of(theirs.basis) && mine.dt_s == theirs.dt_s,
        "theirs: has other modes or another dt_s");
  constexpr std::int64_t kAnySteps = std::int64_t{1} << 48;
  int newer = 0;
  for (std::size_t row = 0; row < theirs.table.row_count(); ++row) {
    for (int block = 0; block < theirs.table.block_count(); ++block) {
      const Contribution sent = theirs.table.block(theirs.table.author(row), block);
      newer += mine.table.merge(sent, kAnySteps) == Merge::kNewer ? 1 : 0;
    }
  }
  return newer;
}

void add_coverage_table(py::module_& module) {
  py::class_<Coverage>(
      module, "CoverageTable",
      R"(The coverage of all agents as one agent knows it: core/law/coverage_table.h.

One row of cumulative sums Σ f dt for each (agent, incarnation); more steps win, so
that merging is commutative, associative and idempotent.)")
      .def(py::init(&make_coverage), "basis"_a, "domain"_a, "dt_s"_a)
      .def("add_sample", &add_sample, "agent"_a, "x_m"_a, "incarnation"_a = 1,
           "S += f(x) dt in the row of (agent, incarnation); x_m has the shape (2,) [m].")
      .def("merge", &merge, "theirs"_a,
           "Takes in all rows of another table with the same modes and dt_s; returns how many "
           "blocks were newer.")
      .def(
          "average",
          [](const Coverage& c) {
            Coefficients average(c.basis.mode_count());
            c.table.average(average);
            return array_of(average, c.basis);
          },
          "c = Σ S / Σ time over all rows, (4): shape (modes_x, modes_y); 0 without samples.")
      .def(
          "steps",
          [](const Coverage& c, int agent, Incarnation incarnation) {
            return c.table.steps_held({agent_in(agent), incarnation});
          },
          "agent"_a, "incarnation"_a = 1, "Samples in that row; None if there is no such row.")
      .def_property_readonly(
          "covered_s", [](const Coverage& c) { return c.table.covered_s(); },
          "Time that all rows cover together [s].");
}

lab::IdealTeam make_ideal_team(const Mission& mission, const std::string& edges,
                               const py::object& law) {
  check(edges == "reflect" || edges == "none",
        "edges: must be \"reflect\" or \"none\", not \"" + edges + "\"");
  return lab::IdealTeam(mission, edges == "none" ? lab::Edges::kNone : lab::Edges::kReflect,
                        laws_of(law, mission));
}

using Of = const Eigen::Vector3d& (lab::IdealTeam::*)(std::size_t) const;

/// One row for each agent.
template <Of kOf>
Numbers rows(const lab::IdealTeam& team) {
  const py::ssize_t axes = axes_of(team.mission().domain);
  Numbers result({static_cast<py::ssize_t>(team.size()), axes});
  double* out = result.mutable_data();
  for (std::size_t agent = 0; agent < team.size(); ++agent)
    out = std::copy_n((team.*kOf)(agent).data(), axes, out);
  return result;
}

void step(lab::IdealTeam& team, Tick count) {
  check(count >= 0, "count: must not be negative");
  for (Tick i = 0; i < count; ++i) {
    if (i % 256 == 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    team.step();
  }
}

void add_ideal_team(py::module_& module) {
  using lab::IdealTeam;
  py::class_<IdealTeam>(module, "IdealTeam",
                        R"(The method with perfect communication: lab/ideal_team.h.

Bit for bit a lockstep mission for which stands_for() is true, several times as fast.
edges: "reflect", or "none": agents leave the domain, as in the paper's theorems.
law: one of your own, as in simulate(), or None: the law of the mission.)")
      .def(py::init(&make_ideal_team), "mission"_a, "edges"_a = "reflect", "law"_a = py::none())
      .def_static(
          "stands_for", [](const Mission& mission) { return IdealTeam::stands_for(mission); },
          "mission"_a, "Whether a distributed team would compute the same.")
      .def("step", &step, "count"_a = 1,
           "Runs `count` ticks. After an error of the law, the mission has ended.")
      .def_property_readonly("tick", &IdealTeam::tick, "Steps done.")
      .def_property_readonly("t_s", &IdealTeam::t_s, "The time that they took [s].")
      .def_property_readonly("positions_m", &rows<&IdealTeam::x_m>,
                             "Where the agents are now, shape (agents, 2) [m].")
      .def_property_readonly("velocities_mps", &rows<&IdealTeam::v_mps>,
                             "Their velocities in the last step, shape (agents, 2) [m/s].")
      .def_property_readonly(
          "coverage",
          [](const IdealTeam& team) { return array_of(team.coverage(), team.mission().basis); },
          "c of the last step, shape (modes_x, modes_y).")
      .def_property_readonly("metric", &IdealTeam::metric, "φ² of that coverage.");
}

}  // namespace

void add_team(py::module_& module) {
  add_controller(module);
  add_coverage_table(module);
  add_ideal_team(module);
}

}  // namespace ergocast::python
