// SPDX-License-Identifier: BSD-3-Clause
// Writes a mission as Protobuf's text format, in the order of scenario.proto.
#include "logger/mission_text.h"

#include "core/mission_limits.h"
#include "text/shortest.h"

namespace ergocast {
namespace {

/// One block of Protobuf's text format, its fields in their order.
class Block {
 public:
  explicit Block(std::string indent = "") : indent_(std::move(indent)) {}

  void put(const char* field, const std::string& word) {
    text_ += indent_ + field + ": " + word + '\n';
  }
  void put(const char* field, const char* word) { put(field, std::string(word)); }
  void put(const char* field, double value) { put(field, shortest(value)); }
  void put(const char* field, int value) { put(field, std::to_string(value)); }
  void put(const char* field, bool value) { put(field, value ? "true" : "false"); }
  void put(const char* field, const Block& block) {
    text_ += indent_ + field + " {\n" + block.text_ + indent_ + "}\n";
  }
  void put_point(const char* field, const Eigen::Vector3d& x_m) {
    text_ +=
        indent_ + field + " { x_m: " + shortest(x_m.x()) + " y_m: " + shortest(x_m.y()) + " }\n";
  }
  const std::string& text() const { return text_; }

 private:
  std::string indent_, text_;
};

Block block_of(const Box& domain) {
  Block block("  ");
  block.put("origin_x_m", domain.origin_m.x());
  block.put("origin_y_m", domain.origin_m.y());
  block.put("size_x_m", domain.size_m.x());
  block.put("size_y_m", domain.size_m.y());
  return block;
}

Block block_of(const Basis& basis) {
  Block block("  ");
  block.put("modes_x", basis.modes_x);
  block.put("modes_y", basis.modes_y);
  block.put("normalized", basis.normalized);
  block.put("sobolev_form", basis.sobolev_form == SobolevForm::kNorm ? "NORM" : "SQUARED_NORM");
  block.put("sobolev_exponent", basis.sobolev_exponent);
  return block;
}

void put_contraction_center(const Eigen::Vector3d& center_m, const Box& domain, Block& block) {
  if (center_m == domain.center_m()) return block.put("contraction_center", "DOMAIN_CENTER");
  if (center_m.isZero(0)) return block.put("contraction_center", "COORDINATE_ORIGIN");
  block.put("contraction_center", "POINT");
  block.put("contraction_x_m", center_m.x());
  block.put("contraction_y_m", center_m.y());
}

Block block_of(const ControlLaw& law, const Box& domain) {
  const bool relative = law.regularization == Regularization::kRelative;
  const bool adaptive = law.perturbation == Perturbation::kAdaptive;
  Block block("  ");
  block.put("u_max_mps", law.u_max_mps);
  block.put("regularization", relative ? "RELATIVE" : "ABSOLUTE");
  block.put("epsilon", law.epsilon);
  block.put("noise_intensity", law.noise_intensity);
  block.put("contraction_gain_per_s", law.contraction_gain_per_s);
  put_contraction_center(law.contraction_center_m, domain, block);
  block.put("perturbation", adaptive ? "ADAPTIVE" : "CONSTANT");
  if (adaptive) block.put("noise_ceiling", law.noise_ceiling);
  block.put("anticipation", law.anticipation);
  block.put("ends_with_plan", law.ends_with_plan);
  block.put("paired_pushes", law.paired_pushes);
  return block;
}

Block block_of(const Timing& timing) {
  Block block("  ");
  block.put("dt_s", timing.dt_s);
  block.put("duration_s", duration_s(timing));
  block.put("broadcast_period_ticks", timing.broadcast_period_ticks);
  block.put("pace", timing.pace == Pace::kRealtime ? "REALTIME" : "LOCKSTEP");
  block.put("realtime_factor", timing.realtime_factor);
  block.put("lockstep_timeout_s", timing.lockstep_timeout_s);
  block.put("on_timeout", timing.on_timeout == OnTimeout::kEvict ? "EVICT" : "END_MISSION");
  block.put("command_hold_s", timing.command_hold_s);
  block.put("admission_timeout_s", timing.admission_timeout_s);
  block.put("catch_up_limit_ticks", timing.catch_up_limit_ticks);
  return block;
}

Block block_of_the_team(const Mission& mission) {
  Block block("  ");
  for (const Eigen::Vector3d& x_m : mission.starts_m) block.put_point("starts", x_m);
  block.put("random_count", 0);
  block.put("quorum", mission.quorum);
  block.put("forget_silent_after_s", mission.forget_silent_after_s);
  block.put("dead_reckoning", mission.dead_reckoning);
  return block;
}

Block block_of_the_world(const Mission& mission) {
  Block block("  ");
  block.put("disturbance_intensity", mission.disturbance_intensity);
  block.put("radio_range_m", mission.radio_range_m);
  if (mission.speed_limit_mps > 0) block.put("speed_limit_mps", mission.speed_limit_mps);
  return block;
}

}  // namespace

std::string mission_text(const Mission& mission) {
  Block scenario;
  scenario.put("name", '"' + mission.name + '"');
  scenario.put("description", "\"\"");
  scenario.put("seed", std::to_string(mission.seed));
  scenario.put("domain", block_of(mission.domain));
  scenario.put("basis", block_of(mission.basis));
  scenario.put("law", block_of(mission.law, mission.domain));
  scenario.put("time", block_of(mission.timing));
  scenario.put("agents", block_of_the_team(mission));
  scenario.put("world", block_of_the_world(mission));
  if (mission.goal_ergodic_metric > 0)
    scenario.put("goal_ergodic_metric", mission.goal_ergodic_metric);
  return scenario.text();
}

}  // namespace ergocast
