// SPDX-License-Identifier: BSD-3-Clause
// Calls the person's object once a tick, and checks what it returns.
#include "python/own_law.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/home.h"
#include "logger/observer.h"
#include "plan/plan.h"
#include "python/arrays.h"
#include "python/module.h"
#include "studies/study_run.h"
#include "team/mission_follower.h"

namespace ergocast::python {
namespace {

using namespace pybind11::literals;

/// What ergocast.Law.wanted_mps() gets.
struct TeamInput {
  Tick tick;
  double t_s;
  py::array_t<std::int64_t> agents;
  Numbers x_m, u_max_mps, c, mu;
  py::object mission;
};

/// By which share of u_max rounding may make a velocity faster than u_max.
constexpr double kRounding = 1e-9;

/// Python code sees it as ergocast.LawError.
struct LawRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void require(bool condition, const std::string& otherwise) {
  if (!condition) throw LawRefused(otherwise);
}

/// The person's object, and the state of the one mission that it steers.
class TeamLaw {
 public:
  TeamLaw(py::object law, const Mission& mission)
      : law_(std::move(law)),
        name_(py::cast<std::string>(py::type::of(law_).attr("__name__"))),
        mission_(mission),
        shown_(py::cast(mission)) {
    observer_.begin(mission_);
    for (int kind = 0; kind < std::max(1, static_cast<int>(mission_.kinds.size())); ++kind)
      u_max_mps_.push_back(law_of(mission_, kind).u_max_mps);
  }

  void set_u_max(int kind, double u_max_mps) {
    u_max_mps_[static_cast<std::size_t>(kind)] = u_max_mps;
  }

  Eigen::Vector3d wanted_mps(const LawInput& input) {
    if (failed_)
      throw LawRefused(where() + "it failed, and the mission has ended (begin another one)");
    if (input.tick != tick_) ask(input.tick, input.places);
    const auto at = std::ranges::lower_bound(places_, input.agent, {}, &TeamPlace::agent);
    if (at == places_.end() || at->agent != input.agent) return {0, 0, 0};  // it has just joined
    return wanted_mps_[static_cast<std::size_t>(at - places_.begin())];
  }

 private:
  double u_max_of(AgentId agent) const {
    return u_max_mps_[static_cast<std::size_t>(planned_kind(mission_, agent))];
  }

  void ask(Tick tick, std::span<const TeamPlace> places) {
    failed_ = true;
    const std::vector<TeamPlace> before = std::exchange(places_, {places.begin(), places.end()});
    const double passed_s = static_cast<double>(tick - tick_) * mission_.timing.dt_s;
    tick_ = tick;
    for (const auto& [id, x_m] : places_) {
      const auto at = std::ranges::find(before, id, &TeamPlace::agent);
      const bool charging =
          at != before.end() && charges(mission_, id, x_m, (x_m - at->x_m) / passed_s);
      if (!rests(mission_, id, tick) && !charging)
        observer_.see(mission_, tick, planned_kind(mission_, id), x_m);
    }
    const py::gil_scoped_acquire python;
    take(law_.attr("wanted_mps")(input()));
    failed_ = false;
  }

  /// Begins an error.
  std::string where() const {
    return name_ + ".wanted_mps() at tick " + std::to_string(tick_) + ": ";
  }

  TeamInput input() const {
    const auto count = static_cast<py::ssize_t>(places_.size());
    const py::ssize_t axes = axes_of(mission_.domain);
    TeamInput input{tick_,
                    static_cast<double>(tick_) * mission_.timing.dt_s,
                    py::array_t<std::int64_t>(count),
                    Numbers({count, axes}),
                    Numbers(count),
                    array_of(observer_.coverage(), mission_.basis),
                    array_of(mission_.target_coefficients, mission_.basis),
                    shown_};
    double* x_m = input.x_m.mutable_data();
    for (py::ssize_t i = 0; i < count; ++i) {
      const TeamPlace& agent = places_[static_cast<std::size_t>(i)];
      input.agents.mutable_at(i) = agent.agent;
      input.u_max_mps.mutable_at(i) = u_max_of(agent.agent);
      x_m = std::copy_n(agent.x_m.data(), axes, x_m);
    }
    return input;
  }

  /// Checks the velocities, and takes them in.
  void take(const py::object& returned) {
    const py::ssize_t axes = axes_of(mission_.domain);
    const auto shape = "(" + std::to_string(places_.size()) + ", " + std::to_string(axes) + ")";
    require(!returned.is_none(), where() + "returned None, not velocities of shape " + shape);
    const Numbers rows = numbers_in(returned, shape);
    require(rows.ndim() == 2 && rows.shape(0) == static_cast<py::ssize_t>(places_.size()) &&
                rows.shape(1) == axes,
            where() + "the shape of the velocities must be " + shape + ", not " + shape_text(rows));
    wanted_mps_.clear();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      Eigen::Vector3d v_mps(0, 0, 0);
      std::copy_n(rows.data(static_cast<py::ssize_t>(i)), axes, v_mps.data());
      check_velocity(v_mps, places_[i].agent);
      wanted_mps_.push_back(v_mps);
    }
  }

  /// A returned object may convert itself to numbers by code of its own. Errors of that code other
  /// than TypeError and ValueError are passed on unchanged.
  Numbers numbers_in(const py::object& returned, const std::string& shape) const {
    try {
      return Numbers(returned);
    } catch (const py::error_already_set& error) {
      if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_ValueError)) throw;
    }
    throw LawRefused(where() + "returned no numbers, but velocities of shape " + shape +
                     " are wanted");
  }

  void check_velocity(const Eigen::Vector3d& v_mps, AgentId agent) const {
    const std::string who = where() + "agent " + std::to_string(agent);
    require(v_mps.allFinite(), who + " wants a velocity that is not finite");
    const double speed_mps = length_of(v_mps), u_max_mps = u_max_of(agent);
    require(speed_mps <= u_max_mps * (1 + kRounding),
            who + " wants " + text_of(speed_mps) + " m/s, above its u_max_mps of " +
                text_of(u_max_mps) + " (shorten the velocity)");
  }

  static std::string text_of(double value) {
    return py::cast<std::string>(py::str(py::float_(value)));
  }

  py::object law_;
  std::string name_;
  Mission mission_;
  py::object shown_;  // mission_
  Observer observer_;
  std::vector<double> u_max_mps_;  // of each kind
  Tick tick_ = -1;
  bool failed_ = false;  // the object has returned no valid velocities for tick_
  std::vector<TeamPlace> places_;
  std::vector<Eigen::Vector3d> wanted_mps_;
};

/// The law of one agent, which returns the agent's row of the team's velocities.
class MemberLaw final : public Law {
 public:
  MemberLaw(std::shared_ptr<TeamLaw> team, int kind) : team_(std::move(team)), kind_(kind) {}
  LawNeeds needs() const override { return {.coverage = false, .team = true, .places = true}; }
  void set_law(const LawNumbers& numbers) override { team_->set_u_max(kind_, numbers.u_max_mps); }
  Eigen::Vector3d wanted_mps(const LawInput& input) override { return team_->wanted_mps(input); }

 private:
  std::shared_ptr<TeamLaw> team_;
  int kind_;
};

/// Runs a mission and returns the bytes of its StudyFigures, which cli/study/python_law.h reads.
py::bytes study_figures(const py::bytes& plan, const py::object& law) {
  const std::string_view bytes = plan;
  const std::span<const std::byte> span = std::as_bytes(std::span(bytes.data(), bytes.size()));
  const auto mission = decode_plan_with_table(span);
  check(mission.has_value(), "plan: does not decode");
  const LawMaker laws = laws_of(law, *mission);
  const studies::StudyFigures figures = [&] {
    const py::gil_scoped_release others_may_run;
    return studies::run_study_mission(span, laws);
  }();
  return py::bytes(reinterpret_cast<const char*>(&figures), sizeof figures);
}

}  // namespace

LawMaker laws_of(const py::object& law, const Mission& mission) {
  if (law.is_none()) return make_law;
  const py::tuple made = py::module_::import("ergocast._law").attr("made")(law);
  if (const auto why = studies::why_not_in_python(mission)) throw LawRefused(*why);
  auto team = std::make_shared<TeamLaw>(made[0], mission);
  return [team](const Mission&, int kind) { return std::make_unique<MemberLaw>(team, kind); };
}

void add_own_laws(py::module_& module) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const LawRefused& problem) {
      const py::object kind = py::module_::import("ergocast._errors").attr("LawError");
      PyErr_SetString(kind.ptr(), problem.what());
    }
  });
  py::class_<TeamInput>(module, "LawInput", "The agents of a tick, as ergocast.Law gets them.")
      .def_readonly("tick", &TeamInput::tick, "The tick, among those that count.")
      .def_readonly("t_s", &TeamInput::t_s, "Its time [s].")
      .def_readonly("agents", &TeamInput::agents, "Their numbers, ascending: shape (n,).")
      .def_readonly("x_m", &TeamInput::x_m, "Where they are: shape (n, 2), in a box (n, 3) [m].")
      .def_readonly("u_max_mps", &TeamInput::u_max_mps,
                    "What each may want at most: shape (n,) [m/s].")
      .def_readonly("c", &TeamInput::c,
                    "The team's coverage, this tick included, (4): shape (modes_x, modes_y).")
      .def_readonly("mu", &TeamInput::mu, "μ of the target, (3): shape (modes_x, modes_y).")
      .def_readonly("mission", &TeamInput::mission, "Domain, basis, dt_s and all else.");
  module.def("study_figures", &study_figures, "plan"_a, "law"_a,
             "Runs a compiled plan for ergocast study.");
  module.attr("STUDY_FIGURES_BYTES") = sizeof(studies::StudyFigures);
}

}  // namespace ergocast::python
