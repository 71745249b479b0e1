// SPDX-License-Identifier: BSD-3-Clause
// Encodes a mission with Protobuf lite, and checks every field of a received plan.
#include "team/plan.h"

#include <xxhash.h>

#include <algorithm>
#include <optional>

#include "core/mission_limits.h"
#include "core/require.h"
#include "team/messages.h"
#include "team/plan.pb.h"

namespace ergocast {
namespace {

constexpr std::size_t kMaxPlanBytes = std::size_t{kMaxPlanParts} * kMaxPlanBytesPerMessage;

constexpr const char* kRemedy = ": install the same version on every host";

/// The error for bytes without a readable version.
std::string unreadable_plan() {
  return std::string(
             "the mission's plan is damaged or of a much newer version than this program, "
             "which is " ERGOCAST_VERSION) +
         kRemedy;
}

/// The error for a plan that falsely claims this version.
std::string broken_plan() {
  return std::string("the mission's plan says that it is of version " ERGOCAST_VERSION
                     ", but breaks that version's rules: it is damaged or another build's") +
         kRemedy;
}

/// Whether the text is a possible version: arbitrary received text must not reach a terminal.
bool is_version(const std::string& text) {
  return !text.empty() && text.size() <= static_cast<std::size_t>(kMaxVersionLength) &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

// Conversion of each part of a mission in both directions.

void write(const Box& domain, proto::Plan::Domain& out) {
  out.set_origin_x_m(domain.origin_m.x());
  out.set_origin_y_m(domain.origin_m.y());
  out.set_size_x_m(domain.size_m.x());
  out.set_size_y_m(domain.size_m.y());
}
Box read(const proto::Plan::Domain& in) {
  return {{in.origin_x_m(), in.origin_y_m(), 0}, {in.size_x_m(), in.size_y_m(), 0}};
}

void write(const Basis& basis, proto::Plan::Basis& out) {
  out.set_modes_x(basis.modes_x);
  out.set_modes_y(basis.modes_y);
  out.set_normalized(basis.normalized);
  out.set_norm_form(basis.sobolev_form == SobolevForm::kNorm);
  out.set_sobolev_exponent(basis.sobolev_exponent);
}
Basis read(const proto::Plan::Basis& in) {
  return {.modes_x = in.modes_x(),
          .modes_y = in.modes_y(),
          .sobolev_form = in.norm_form() ? SobolevForm::kNorm : SobolevForm::kSquaredNorm,
          .sobolev_exponent = in.sobolev_exponent(),
          .normalized = in.normalized()};
}

void write(const ControlLaw& law, proto::Plan::Law& out) {
  out.set_u_max_mps(law.u_max_mps);
  out.set_relative_regularization(law.regularization == Regularization::kRelative);
  out.set_epsilon(law.epsilon);
  out.set_adaptive_perturbation(law.perturbation == Perturbation::kAdaptive);
  out.set_noise_intensity(law.noise_intensity);
  out.set_noise_ceiling(law.noise_ceiling);
  out.set_contraction_gain_per_s(law.contraction_gain_per_s);
  out.set_contraction_center_x_m(law.contraction_center_m.x());
  out.set_contraction_center_y_m(law.contraction_center_m.y());
  out.set_anticipation(law.anticipation);
  out.set_ends_with_plan(law.ends_with_plan);
  out.set_paired_pushes(law.paired_pushes);
}
ControlLaw read(const proto::Plan::Law& in) {
  return {.u_max_mps = in.u_max_mps(),
          .regularization =
              in.relative_regularization() ? Regularization::kRelative : Regularization::kAbsolute,
          .epsilon = in.epsilon(),
          .perturbation =
              in.adaptive_perturbation() ? Perturbation::kAdaptive : Perturbation::kConstant,
          .noise_intensity = in.noise_intensity(),
          .noise_ceiling = in.noise_ceiling(),
          .contraction_gain_per_s = in.contraction_gain_per_s(),
          .contraction_center_m = {in.contraction_center_x_m(), in.contraction_center_y_m(), 0},
          .anticipation = in.anticipation(),
          .ends_with_plan = in.ends_with_plan(),
          .paired_pushes = in.paired_pushes()};
}

void write(const Timing& timing, proto::Plan::Timing& out) {
  out.set_dt_s(timing.dt_s);
  out.set_tick_count(timing.tick_count);
  out.set_broadcast_period_ticks(timing.broadcast_period_ticks);
  out.set_realtime(timing.pace == Pace::kRealtime);
  out.set_realtime_factor(timing.realtime_factor);
  out.set_lockstep_timeout_s(timing.lockstep_timeout_s);
  out.set_command_hold_s(timing.command_hold_s);
  out.set_admission_timeout_s(timing.admission_timeout_s);
  out.set_catch_up_limit_ticks(timing.catch_up_limit_ticks);
  out.set_evict_on_timeout(timing.on_timeout == OnTimeout::kEvict);
}
Timing read(const proto::Plan::Timing& in) {
  return {.dt_s = in.dt_s(),
          .tick_count = in.tick_count(),
          .broadcast_period_ticks = in.broadcast_period_ticks(),
          .pace = in.realtime() ? Pace::kRealtime : Pace::kLockstep,
          .realtime_factor = in.realtime_factor(),
          .lockstep_timeout_s = in.lockstep_timeout_s(),
          .command_hold_s = in.command_hold_s(),
          .admission_timeout_s = in.admission_timeout_s(),
          .catch_up_limit_ticks = in.catch_up_limit_ticks(),
          .on_timeout = in.evict_on_timeout() ? OnTimeout::kEvict : OnTimeout::kEndMission};
}

/// Nothing if the number of coefficients or starts does not fit.
std::optional<Mission> read(const proto::Plan& in) {
  Mission mission;
  mission.name = in.name();
  mission.seed = in.seed();
  mission.domain = read(in.domain());
  mission.basis = read(in.basis());
  const auto is_mode_count = [](int modes) { return limits::kModes.contain(modes); };
  if (!is_mode_count(mission.basis.modes_x) || !is_mode_count(mission.basis.modes_y) ||
      in.target_coefficients_size() != mission.basis.mode_count() || in.starts_m_size() % 2 != 0) {
    return std::nullopt;
  }
  mission.target_coefficients =
      Eigen::Map<const Coefficients>(in.target_coefficients().data(), mission.basis.mode_count());
  mission.law = read(in.law());
  mission.timing = read(in.timing());
  for (int i = 0; i < in.starts_m_size(); i += 2) {
    mission.starts_m.emplace_back(in.starts_m(i), in.starts_m(i + 1), 0);
  }
  mission.quorum = in.quorum();
  mission.forget_silent_after_s = in.forget_silent_after_s();
  mission.goal_ergodic_metric = in.goal_ergodic_metric();
  mission.disturbance_intensity = in.disturbance_intensity();
  mission.radio_range_m = in.radio_range_m();
  mission.speed_limit_mps = in.speed_limit_mps();
  mission.dead_reckoning = in.dead_reckoning();
  mission.wait_for_logger = in.wait_for_logger();
  return mission;
}

}  // namespace

std::vector<std::byte> encode_plan(const Mission& mission) {
  proto::Plan plan;
  plan.set_version(ERGOCAST_VERSION);
  plan.set_name(mission.name);
  plan.set_seed(mission.seed);
  write(mission.domain, *plan.mutable_domain());
  write(mission.basis, *plan.mutable_basis());
  const Coefficients& target = mission.target_coefficients;
  plan.mutable_target_coefficients()->Add(target.data(), target.data() + target.size());
  write(mission.law, *plan.mutable_law());
  write(mission.timing, *plan.mutable_timing());
  for (const Eigen::Vector3d& x_m : mission.starts_m) {
    plan.add_starts_m(x_m.x());
    plan.add_starts_m(x_m.y());
  }
  plan.set_quorum(mission.quorum);
  plan.set_forget_silent_after_s(mission.forget_silent_after_s);
  plan.set_goal_ergodic_metric(mission.goal_ergodic_metric);
  plan.set_disturbance_intensity(mission.disturbance_intensity);
  plan.set_radio_range_m(mission.radio_range_m);
  plan.set_speed_limit_mps(mission.speed_limit_mps);
  plan.set_dead_reckoning(mission.dead_reckoning);
  plan.set_wait_for_logger(mission.wait_for_logger);

  std::vector<std::byte> bytes(plan.ByteSizeLong());
  // within_limits() keeps it below this size.
  ERGOCAST_REQUIRE(bytes.size() <= kMaxPlanBytes);
  ERGOCAST_REQUIRE(plan.SerializeToArray(bytes.data(), static_cast<int>(bytes.size())));
  return bytes;
}

std::variant<Mission, std::string> decode_plan(std::span<const std::byte> bytes) noexcept try {
  if (bytes.size() > kMaxPlanBytes) return unreadable_plan();
  proto::Plan plan;
  const bool whole = plan.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
  // Only the version itself can read the fields after its number.
  if (!is_version(plan.version())) return unreadable_plan();
  if (plan.version() != ERGOCAST_VERSION) {
    return "the mission's plan is of version " + plan.version() +
           ", this program is " ERGOCAST_VERSION + kRemedy;
  }
  std::optional<Mission> mission = read(plan);
  if (!whole || !mission || !within_limits(*mission)) return broken_plan();
  // A mission has exactly one encoding: bytes that differ from it were not written by
  // encode_plan().
  if (!std::ranges::equal(encode_plan(*mission), bytes)) return broken_plan();
  return std::move(*mission);
} catch (...) {
  return "out of memory";
}

std::string plan_hash(std::span<const std::byte> plan) {
  XXH128_canonical_t hash;
  XXH128_canonicalFromHash(&hash, XXH3_128bits(plan.data(), plan.size()));
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : hash.digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace ergocast
