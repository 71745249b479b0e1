// SPDX-License-Identifier: BSD-3-Clause
// The law of spiral.py in C++. spiral SCENARIO SEEDS prints P(found) under the scenario's law and
// under this one.
#include <ergocast/core/mission/kinds.h>
#include <ergocast/plan/plan.h>
#include <ergocast/scenario/scenario.h>
#include <ergocast/studies/study_run.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

using namespace ergocast;

class Spiral final : public Law {  // of one agent
 public:
  Spiral(const Mission& mission, int kind)
      : domain_(mission.domain),
        dt_s_(mission.timing.dt_s),
        u_max_mps_(law_of(mission, kind).u_max_mps) {}
  LawNeeds needs() const override { return {.coverage = false}; }
  void set_law(const LawNumbers& numbers) override { u_max_mps_ = numbers.u_max_mps; }
  Eigen::Vector3d wanted_mps(const LawInput& input) override {
    const Eigen::Vector3d out_m = input.x_m - domain_.center_m();
    const double t_s = static_cast<double>(input.tick) * dt_s_;
    const double wanted_m = domain_.shortest_side_m() / 2 * std::abs(std::sin(t_s / 100));
    const Eigen::Vector3d along_m(-out_m.y(), out_m.x(), 0);  // a quarter turn to the left
    const Eigen::Vector3d way_m = along_m + out_m * (wanted_m / std::max(out_m.norm(), 1.0) - 1);
    return way_m * (u_max_mps_ / std::max(way_m.norm(), 1e-9));
  }

 private:
  Box domain_;
  double dt_s_, u_max_mps_;
};

int main(int count, char** words) {
  const auto scenario = Scenario::load(count > 1 ? words[1] : "");
  if (!scenario) return (std::puts(to_string(scenario.error().front()).c_str()), 2);
  const LawMaker spirals = [](const Mission& mission, int kind) {
    return std::make_unique<Spiral>(mission, kind);
  };
  for (int seed = 1; seed <= (count > 2 ? std::atoi(words[2]) : 1); ++seed) {
    const auto plan = encode_plan(scenario->with_seed(static_cast<std::uint64_t>(seed)).mission());
    std::printf("%d %.9f %.9f\n", seed, studies::run_study_mission(plan).detection_probability,
                studies::run_study_mission(plan, spirals).detection_probability);
  }
}
