// SPDX-License-Identifier: BSD-3-Clause
// Checks whether a scenario suits the modes of a free domain.
#include "scenario/rules/validate_free_domain.h"

#include <string>

#include "core/base/ids.h"
#include "scenario/rules/validate_kinds.h"

namespace ergocast {

void validate_free_domain(const proto::Scenario& scenario, Checks& checks) {
  const proto::Basis& basis = scenario.basis();
  if (!basis.free_domain() || !checks.sound("basis") || !checks.sound("domain")) return;
  const std::string remedy = "or write free_domain: false";
  if (scenario.domain().has_size_z_m()) {
    checks.problem("basis.free_domain", "needs a plane, and the domain is a box",
                   "leave domain.size_z_m out, " + remedy);
    return;
  }
  if (const int modes = basis.modes_x() * basis.modes_y(); modes > kMostFreeModes) {
    checks.problem("basis.free_domain",
                   std::to_string(modes) + " modes are above the limit of a free domain, " +
                       std::to_string(kMostFreeModes),
                   "write fewer, such as 16 along each axis, " + remedy);
  }
  for (int i = 0; i < scenario.agents().kind_size(); ++i) {
    const proto::Kind& kind = scenario.agents().kind(i);
    const std::string path = indexed("agents.kind", i);
    const std::string footprint = footprint_path(scenario.agents(), i);
    if (kind.footprint_sigma_m() > 0 && checks.sound(footprint)) {
      checks.problem(footprint, "is a blur of cosines, and basis.free_domain uses none",
                     "write footprint_sigma_m: 0, " + remedy);
    }
    if (kind.has_band()) {
      checks.problem(path + ".band", "is of cosines, and basis.free_domain uses none",
                     "remove the band, " + remedy);
    }
  }
}

}  // namespace ergocast
