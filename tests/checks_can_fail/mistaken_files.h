// SPDX-License-Identifier: BSD-3-Clause
// The files that the scenarios of scenario_mistakes.h name.
#pragma once

#include <filesystem>
#include <string>

namespace ergocast::test {

void write_file(const std::filesystem::path& file, const std::string& text);

/// Writes maps, polygons and grids; most have a mistake.
void write_mistaken_files(const std::filesystem::path& folder);

}  // namespace ergocast::test
