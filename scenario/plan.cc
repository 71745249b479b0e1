// SPDX-License-Identifier: BSD-3-Clause
// Serialises the plan deterministically with the version first, and refuses the plan of another
// version by that field.
#include "scenario/plan.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/stubs/logging.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "team/messages.h"
#include "core/require.h"
#include "scenario/plan.pb.h"
#include "scenario/scenario.h"

namespace ergocast {
namespace {

constexpr std::size_t kMaxPlanBytes = std::size_t{kMaxPlanParts} * kMaxPlanBytesPerMessage;

bool is_mode_count(int modes) { return modes >= 1 && modes <= kMaxModesPerAxis; }

/// |∫ f ρ| ≤ 1, but for the rounding of the quadrature.
bool is_coefficient(double value) { return std::abs(value) <= 1 + 1e-9; }

std::optional<Coefficients> coefficients_of(const proto::MissionPlan& plan) {
  const proto::Basis& basis = plan.scenario().basis();
  if (!is_mode_count(basis.modes_x()) || !is_mode_count(basis.modes_y())) return std::nullopt;
  const auto& values = plan.target_coefficients();
  if (values.size() != basis.modes_x() * basis.modes_y() || values.Get(0) != 1) return std::nullopt;
  for (const double value : values) {
    if (!is_coefficient(value)) return std::nullopt;  // nan is none either
  }
  return Eigen::Map<const Coefficients>(values.data(), basis.modes_x(), basis.modes_y());
}

/// What a version looks like; the word of a stranger is not to reach a terminal as it is.
bool is_version(const std::string& text) {
  return !text.empty() && text.size() <= static_cast<std::size_t>(kMaxVersionLength) &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

constexpr const char* kRemedy = ": install the same version on every host";

/// Of bytes in which not even a version can be found.
std::string unreadable_plan() {
  return std::string("the mission's plan is damaged or of a much newer version than this program, "
                     "which is " ERGOCAST_VERSION) + kRemedy;
}

}  // namespace

std::string broken_plan() {
  return std::string("the mission's plan says that it is of version " ERGOCAST_VERSION
                     ", but breaks that version's rules: it is damaged or another build's") + kRemedy;
}

std::vector<std::byte> encode_plan(const proto::Scenario& scenario, const Coefficients& target) {
  proto::MissionPlan plan;
  plan.set_version(ERGOCAST_VERSION);
  *plan.mutable_scenario() = scenario;
  plan.mutable_scenario()->clear_description();
  plan.mutable_scenario()->clear_target();
  plan.mutable_target_coefficients()->Add(target.data(), target.data() + target.size());

  std::vector<std::byte> bytes(plan.ByteSizeLong());
  // The limits of a scenario keep it well below.
  ERGOCAST_REQUIRE(bytes.size() <= kMaxPlanBytes);
  google::protobuf::io::ArrayOutputStream array(bytes.data(), static_cast<int>(bytes.size()));
  google::protobuf::io::CodedOutputStream stream(&array);
  stream.SetSerializationDeterministic(true);
  ERGOCAST_REQUIRE(plan.SerializeToCodedStream(&stream));
  return bytes;
}

std::variant<Plan, std::string> parse_plan(std::span<const std::byte> bytes) {
  if (bytes.size() > kMaxPlanBytes) return unreadable_plan();
  // Protobuf prints what it thinks of a string that is not UTF-8; whoever sends rubbish is not to
  // fill our terminal.
  const google::protobuf::LogSilencer silence;
  proto::MissionPlan plan;
  const bool whole = plan.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
  // What follows the version may be written in a way that only that version knows.
  if (!is_version(plan.version())) return unreadable_plan();
  if (plan.version() != ERGOCAST_VERSION) {
    return "the mission's plan is of version " + plan.version() +
           ", this program is " ERGOCAST_VERSION + kRemedy;
  }
  std::optional<Coefficients> target = coefficients_of(plan);
  if (!whole || !target) return broken_plan();
  plan.DiscardUnknownFields();
  return Plan{std::move(*plan.mutable_scenario()), std::move(*target)};
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
