#include "runtime/shipped_scenarios.h"

#include <filesystem>
#include <set>

namespace ergocast {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".textproto";

/// Where they are as seen from the program: in an installation, or in the tree of build/*/bin.
/// Empty: nowhere.
fs::path folder_of_scenarios() {
  std::error_code error;
  const fs::path programs = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* way : {"../share/ergocast/scenarios", "../../../scenarios"}) {
    const fs::path folder = (programs / way).lexically_normal();
    if (fs::is_directory(folder, error)) return folder;
  }
  return {};
}

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
  const fs::path folder = folder_of_scenarios();
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
