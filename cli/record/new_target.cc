// SPDX-License-Identifier: BSD-3-Clause
// Writes the mission as a scenario's text, and compiles the new target as that scenario's own.
#include "cli/record/new_target.h"

#include <algorithm>
#include <cmath>

#include "logger/mission_text.h"
#include "plan/plan.h"
#include "scenario/origin.h"
#include "text/shortest.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

/// Cells along x and y, and along z, in which densities are compared.
constexpr int kCells = 48, kLayers = 16;

std::string origin_text(const fs::path& recorded) {
  std::error_code error;
  if (recorded.empty() || !fs::exists(recorded, error)) return {};
  const auto origin = read_origin(recorded);
  if (!origin || !*origin) return {};
  return "origin { latitude_deg: " + shortest((*origin)->latitude_deg) +
         " longitude_deg: " + shortest((*origin)->longitude_deg) + " }\n";
}

/// Why the compiled mission is not the team's in all but its target; nothing if it is.
std::optional<Problem> difference(const Mission& team, Mission compiled) {
  const char* const remedy = "use the ergocast that started the team";
  if (compiled.basis.table_hash != team.basis.table_hash)
    return Problem{"the running mission", "this program computes other modes of its free domain",
                   remedy};
  compiled.target_coefficients = team.target_coefficients;
  compiled.cosine_target = team.cosine_target;
  compiled.wait_for_logger = team.wait_for_logger;
  if (encode_plan(compiled) == encode_plan(team)) return std::nullopt;
  return Problem{"the running mission", "this program does not compile it to the same plan",
                 remedy};
}

/// The coefficients in cosines.
const Coefficients& cosines_of(const TargetChange& change, const Mission& mission) {
  return mission.basis.free_domain ? change.cosine : change.target;
}

/// How often each mode counts in Σ μ_k f_k / ∫ f_k², in multiples of the uniform density.
Coefficients weights_of(const Basis& basis) {
  Coefficients weights(basis.mode_count());
  for (int k = 0; k < basis.mode_count(); ++k) {
    const int n = k % basis.modes_y, m = k / basis.modes_y % basis.modes_x,
              l = k / basis.modes_y / basis.modes_x;
    weights[k] = std::ldexp(1.0, (l > 0) + (m > 0) + (n > 0));
  }
  return weights;
}

/// The middle of a cell.
Eigen::Vector3d middle_m(const Box& domain, int i, int j, int layer, int layers) {
  const Eigen::Array3d share((i + 0.5) / kCells, (j + 0.5) / kCells, (layer + 0.5) / layers);
  return domain.origin_m + (share * domain.size_m.array()).matrix();
}

}  // namespace

Result<Scenario, std::vector<Problem>> load_new_target(const Mission& mission, const fs::path& file,
                                                       const Overrides& overrides,
                                                       const fs::path& recorded) {
  auto loaded =
      Scenario::load_target(file, overrides, mission_text(mission) + origin_text(recorded));
  if (!loaded) return loaded;
  if (auto problem = difference(mission, loaded->mission()))
    return failure(std::vector{*std::move(problem)});
  return loaded;
}

Result<Scenario, std::vector<Problem>> parse_new_target(const Mission& mission,
                                                        std::string_view text) {
  auto parsed = Scenario::parse_target(text, mission_text(mission));
  if (!parsed) return parsed;
  if (auto problem = difference(mission, parsed->mission()))
    return failure(std::vector{*std::move(problem)});
  return parsed;
}

std::string zone_context(const Mission& mission, const fs::path& recorded) {
  return mission_text(mission) + origin_text(recorded);
}

std::string seconds_text(Tick ticks, const Mission& mission) {
  constexpr double kDigits = 1e6;  // not those of rounding
  const double time_s = static_cast<double>(ticks) * mission.timing.dt_s;
  return shortest(std::round(time_s * kDigits) / kDigits) + " s";
}

TargetChange target_change_of(const Scenario& scenario) {
  return {.target = scenario.mission().target_coefficients,
          .cosine = scenario.mission().cosine_target};
}

TargetChange target_now(const Mission& mission, const Amendments& list, Tick tick) {
  const TargetChange* const change = target_at(list.targets, tick);
  if (change != nullptr) return *change;
  return {.target = mission.target_coefficients, .cosine = mission.cosine_target};
}

double share_that_differs(const Mission& mission, const TargetChange& a, const TargetChange& b) {
  const Basis basis = in_cosines(mission).basis;
  const Coefficients difference =
      (cosines_of(a, mission) - cosines_of(b, mission)).cwiseProduct(weights_of(basis));
  const int layers = mission.domain.planar() ? 1 : kLayers;
  double sum = 0;
  for (int layer = 0; layer < layers; ++layer) {
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        const Eigen::Vector3d x_m = middle_m(mission.domain, i, j, layer, layers);
        sum += std::abs(basis_values(x_m, mission.domain, basis).dot(difference));
      }
    }
  }
  return std::min(1.0, sum / 2 / (kCells * kCells * layers));
}

}  // namespace ergocast::cli
