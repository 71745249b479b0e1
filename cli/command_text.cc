// SPDX-License-Identifier: BSD-3-Clause
// Writes numbers so that they read back exactly.
#include "cli/command_text.h"

#include "ops/deploy/script.h"
#include "text/shortest.h"

namespace ergocast::cli {

std::string options_of(const Overrides& overrides) {
  std::string text;
  if (overrides.duration_s) text += " --duration " + shortest(*overrides.duration_s);
  if (overrides.agents) text += " --agents " + std::to_string(*overrides.agents);
  if (overrides.realtime_factor) {
    text += " --realtime=" + shortest(*overrides.realtime_factor);
  } else if (overrides.pace == Pace::kLockstep) {
    text += " --lockstep";
  }
  for (const FieldValue& field : overrides.fields) {
    text += " --set " + shell_word(field.path) + '=' + shell_word(field.value);
  }
  return text;
}

}  // namespace ergocast::cli
