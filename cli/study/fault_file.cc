// SPDX-License-Identifier: BSD-3-Clause
// Reads an INI file with CLI11's parser and looks each name up in the table of fault fields.
#include "cli/study/fault_file.h"

#include <CLI/CLI.hpp>
#include <sstream>

#include "text/input_file.h"
#include "text/read_number.h"

namespace ergocast::cli {
namespace {

/// Limit (Studies): length of a list of faults [bytes]. Beyond it: the command refuses it.
constexpr std::size_t kMostFaultBytes = std::size_t{1} << 20;

std::string known_names() {
  std::string names;
  for (const lab::FaultField& field : lab::fault_fields()) {
    names += (names.empty() ? "" : ", ") + std::string(field.name);
  }
  return names;
}

/// Writes the value of one line into `faults`; returns the line's problem, or an empty text.
std::string take(const CLI::ConfigItem& item, lab::Faults& faults) {
  for (const lab::FaultField& field : lab::fault_fields()) {
    if (item.fullname() != field.name) continue;
    const std::string text = item.inputs.size() == 1 ? item.inputs.front() : "";
    const auto value = read_number<double>(text);
    if (value >= 0.0 && value <= field.most) {
      faults.*field.value = *value;
      return "";
    }
    char range[64];
    std::snprintf(range, sizeof range, "0 to %g", field.most);
    return item.fullname() + ": \"" + text + "\" is not a number in range (write one from " +
           range + ")";
  }
  return item.fullname() + ": there is no such fault (write one of " + known_names() + ")";
}

}  // namespace

Result<lab::Faults, std::vector<std::string>> read_faults(const std::filesystem::path& file) {
  const std::string where = file.string() + ": ";
  const auto read = read_whole(file, kMostFaultBytes);
  if (!read) {
    return failure(
        std::vector{where + read.error().what + " (give the name of a file, or \"swarm\")"});
  }
  std::istringstream stream(*read);
  lab::Faults faults;
  std::vector<std::string> problems;
  try {
    for (const CLI::ConfigItem& item : CLI::ConfigINI().from_config(stream)) {
      const std::string problem = take(item, faults);
      if (!problem.empty()) problems.push_back(where + problem);
    }
  } catch (const CLI::Error& error) {
    problems.push_back(where + error.what());
  }
  if (!problems.empty()) return failure(problems);
  return faults;
}

}  // namespace ergocast::cli
