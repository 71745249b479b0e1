// SPDX-License-Identifier: BSD-3-Clause
// Declares one option for each override; only lockstep and real time exclude each other.
#include "scenario/override_options.h"

#include <string>

namespace ergocast {

void add_override_options(CLI::App& command, Overrides& overrides) {
  command.add_option("--seed", overrides.seed, "Other random numbers")
      ->check([](const std::string& text) {
        return text.starts_with('-') ? "--seed must not be negative" : std::string();
      });
  command.add_option("--duration", overrides.duration_s, "Mission time [s]");
  command.add_option("--agents", overrides.agents,
                     "Team size: listed starts are cut, or random ones added");
  auto* lockstep = command.add_flag_callback(
      "--lockstep", [&overrides] { overrides.pace = Pace::kLockstep; },
      "As fast as the machine goes, bit for bit repeatable");
  command
      .add_option_function<double>(
          "--realtime",
          [&overrides](double factor) {
            overrides.pace = Pace::kRealtime;
            overrides.realtime_factor = factor;
          },
          "By the wall clock, FACTOR times as fast (default 1)")
      ->expected(0, 1)
      ->default_str("1")
      ->type_name("FACTOR")
      ->excludes(lockstep);
}

}  // namespace ergocast
