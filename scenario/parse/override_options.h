// SPDX-License-Identifier: BSD-3-Clause
// The command-line options that override fields of a scenario file.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scenario/parse/source.h"

namespace ergocast {

/// --seed, --duration, --agents, --lockstep, --realtime and --set.
void add_override_options(CLI::App& command, Overrides& overrides);

/// --set FIELD=VALUE, for each field once.
void add_set_option(CLI::App& command, std::vector<FieldValue>& fields);

/// The two sides of the first "=" of `text`. Throws CLI::ValidationError of `option`, with the form
/// that it wants, if there is no "=" or nothing before it.
std::pair<std::string, std::string> split_field(const std::string& text, const std::string& option,
                                                const std::string& form);

}  // namespace ergocast
