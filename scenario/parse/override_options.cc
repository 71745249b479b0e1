// SPDX-License-Identifier: BSD-3-Clause
// Declares one option for each override; only lockstep and real time exclude each other.
#include "scenario/parse/override_options.h"

namespace ergocast {

void add_override_options(CLI::App& command, Overrides& overrides) {
  command.add_option("--seed", overrides.seed, "Seed of the random numbers")
      ->check([](const std::string& text) {
        return text.starts_with('-') ? "--seed must not be negative" : std::string();
      });
  command.add_option("--duration", overrides.duration_s, "Mission time [s]");
  command.add_option("--agents", overrides.agents,
                     "Team size: listed starts are cut, or random ones added");
  auto* lockstep = command.add_flag_callback(
      "--lockstep", [&overrides] { overrides.pace = Pace::kLockstep; },
      "As fast as the machine allows; runs repeat bit for bit");
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
  add_set_option(command, overrides.fields);
}

void add_set_option(CLI::App& command, std::vector<FieldValue>& fields) {
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&fields](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              auto [path, value] = split_field(text, "--set", "FIELD=VALUE");
              fields.push_back({std::move(path), std::move(value), "--set " + text});
            }
          },
          "A field of the scenario and its value, such as law.epsilon=0.1; once for each field")
      ->allow_extra_args(false)
      ->type_name("FIELD=VALUE");
}

std::pair<std::string, std::string> split_field(const std::string& text, const std::string& option,
                                                const std::string& form) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw CLI::ValidationError(option, "\"" + text + "\" is not " + form);
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace ergocast
