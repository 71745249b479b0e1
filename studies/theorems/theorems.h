// SPDX-License-Identifier: BSD-3-Clause
// The contents of docs/theorems.md: simulated parts, each with a file of its own, and the tables
// and figures made from them.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "core/mission/mission.h"

namespace ergocast::studies {

struct Part {
  std::string name;  ///< of its file, without ".csv"
  std::function<void(std::ostream&)> write;
};

/// The law, target and domain of the paper's Fig. 2, from its shipped scenario.
Mission paper_mission();

std::vector<Part> theorem1_parts(int seeds);
std::vector<Part> fig2a_parts(int seeds);
std::vector<Part> theorem2_parts(int seeds);
std::vector<Part> corollary1_parts(int seeds);
std::vector<Part> proposition1_parts(int seeds);

/// Prints the tables of the parts in `folder`, and writes theorem_*.csv, which draw.py draws, into
/// `curves`.
void report_theorem1(const std::filesystem::path& folder, const std::filesystem::path& curves);
void report_fig2a(const std::filesystem::path& folder);
void report_theorem2(const std::filesystem::path& folder, const std::filesystem::path& curves);
void report_corollary1(const std::filesystem::path& folder);
void report_proposition1(const std::filesystem::path& folder, const std::filesystem::path& curves);

}  // namespace ergocast::studies
