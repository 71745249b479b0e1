// SPDX-License-Identifier: BSD-3-Clause
// The one place that knows all laws.
#include "core/law/law.h"

#include "core/law/control.h"
#include "core/law/mower.h"
#include "core/law/searcher.h"

namespace ergocast {

std::unique_ptr<Law> make_law(const Mission& mission, int kind) {
  switch (mission.law.kind) {
    case LawKind::kMow:
      return std::make_unique<Mower>(mission, kind);
    case LawKind::kSearch:
      return std::make_unique<Searcher>(mission, kind);
    case LawKind::kCover:
      break;
  }
  return std::make_unique<Controller>(mission, kind);
}

LawNeeds law_needs(const Mission& mission) {
  switch (mission.law.kind) {
    case LawKind::kMow:
      return Mower::kNeeds;
    case LawKind::kSearch:
      return Searcher::kNeeds;
    case LawKind::kCover:
      break;
  }
  return Controller::kNeeds;
}

}  // namespace ergocast
