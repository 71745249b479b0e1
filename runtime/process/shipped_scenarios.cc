// SPDX-License-Identifier: BSD-3-Clause
// A CLI11 validator replaces the bare name of a shipped scenario by its path.
#include "runtime/process/shipped_scenarios.h"

#include <filesystem>
#include <set>

#include "runtime/process/shipped_folder.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".textproto";

std::string names_in(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == kExtension) names.insert(entry.path().stem());
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none is installed here" : text;
}

std::string find(std::string& text) {
  std::error_code error;
  if (text.empty() || text.find_first_of("./") != text.npos || fs::exists(text, error)) return "";
  const fs::path folder = shipped_folder("scenarios", "scenarios");
  const fs::path shipped = folder / (text + kExtension);
  if (folder.empty() || !fs::exists(shipped, error)) {
    return "there is no file and no shipped scenario of the name " + text +
           " (give a file, or one of: " + names_in(folder) + ")";
  }
  text = shipped;
  return "";
}

}  // namespace

CLI::Validator shipped_scenario() { return CLI::Validator(find, "", "shipped scenario"); }

}  // namespace ergocast
