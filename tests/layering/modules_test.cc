// SPDX-License-Identifier: BSD-3-Clause
// Reads every import of the pages' modules: what is missing, and circles.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/layering/tree.h"

namespace ergocast {
namespace {

/// Modules of JavaScript by their paths, each with the paths that it imports.
using Modules = std::map<std::string, std::vector<std::string>>;

/// The paths that a module in `folder` imports.
std::vector<std::string> imports_in(const std::string& text, const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const std::string_view before : {"from '.", "import '.", "import('."}) {
    for (auto at = text.find(before); at != text.npos; at = text.find(before, at + 1)) {
      const std::size_t name = at + before.size() - 1;
      const std::string path = text.substr(name, text.find('\'', name) - name);
      names.push_back((folder / path).lexically_normal().string());
    }
  }
  return names;
}

Modules modules_of_the_pages() {
  namespace fs = std::filesystem;
  Modules modules;
  const fs::path root(ERGOCAST_SOURCE_DIR "/report/web");
  for (const auto& file : fs::recursive_directory_iterator(root)) {
    if (file.path().extension() != ".js") continue;
    const fs::path path = fs::relative(file.path(), root);
    modules[path.string()] = imports_in(text_of(file.path()), path.parent_path());
  }
  return modules;
}

/// "a.js > b.js > a.js" if modules import each other so; empty if none do.
std::string circle_in(Modules modules) {
  const auto next_of = [&modules](const std::vector<std::string>& imports) {
    return std::find_if(imports.begin(), imports.end(),
                        [&](const std::string& name) { return modules.contains(name); });
  };
  // A module that imports none of the others is in no circle.
  while (std::erase_if(modules, [&](const auto& module) {
           return next_of(module.second) == module.second.end();
         }) > 0) {
  }
  if (modules.empty()) return "";
  std::vector<std::string> path{modules.begin()->first};
  while (std::count(path.begin(), path.end(), path.back()) == 1)
    path.push_back(*next_of(modules.at(path.back())));
  std::string circle;
  for (auto name = std::find(path.begin(), path.end(), path.back()); name != path.end(); ++name)
    circle += (circle.empty() ? "" : " > ") + *name;
  return circle;
}

TEST(Layering, ModulesOfThePagesImportEachOtherInNoCircle) {
  const Modules modules = modules_of_the_pages();
  EXPECT_GE(modules.size(), 40U);
  EXPECT_EQ(circle_in(modules), "");
}

TEST(Layering, ModulesOfThePagesImportWhatIsThere) {
  const Modules modules = modules_of_the_pages();
  for (const auto& [name, imports] : modules) {
    for (const std::string& imported : imports)
      EXPECT_TRUE(modules.contains(imported)) << name << " imports " << imported;
  }
}

/// Whether a module of `folder` may import one of `other`; both are "" for the pages themselves.
bool may_import(const std::string& folder, const std::string& other) {
  static const std::map<std::string, std::set<std::string>> kOthers = {
      {"data", {}}, {"map", {"data"}}, {"panels", {"data", "map"}}, {"study", {}}};
  const bool is_shared = other.empty();
  return folder.empty() || folder == other || is_shared || kOthers.at(folder).contains(other);
}

TEST(Layering, ModulesOfThePagesImportOnlyWhatTheirRoomsMayKnow) {
  for (const auto& [name, imports] : modules_of_the_pages()) {
    const std::string folder = std::filesystem::path(name).parent_path();
    for (const std::string& imported : imports) {
      EXPECT_TRUE(may_import(folder, std::filesystem::path(imported).parent_path()))
          << name << " imports " << imported;
    }
  }
}

TEST(Sources, ModulesBeginWithTheirLicenceAndASentenceOfTheirOwn) {
  std::set<std::string> sentences;
  for (const auto& [name, imports] : modules_of_the_pages()) {
    std::ifstream file(std::filesystem::path(ERGOCAST_SOURCE_DIR "/report/web") / name);
    std::string licence, sentence;
    std::getline(file, licence) && std::getline(file, sentence);
    EXPECT_EQ(licence, "// SPDX-License-Identifier: BSD-3-Clause") << name;
    EXPECT_TRUE(sentence.starts_with("// ") && sentence.ends_with('.'))
        << name << ": write on this line what the module is";
    EXPECT_TRUE(sentences.insert(sentence).second) << name << ": " << sentence;
  }
}

TEST(LayeringChecker, NamesTheModulesOfACircle) {
  const Modules honest = {{"a.js", {"b.js", "c.js"}}, {"b.js", {"c.js"}}, {"c.js", {}}};
  EXPECT_EQ(circle_in(honest), "");
  for (const std::string line :
       {"import { far } from './a.js';", "import {\n  far,\n} from './a.js';", "import './a.js';",
        "export { far } from './a.js';", "await import('./a.js');"}) {
    Modules planted = honest;
    planted["c.js"] = imports_in("// first\n" + line + "\nlet x = 'a.js';\n", "");
    EXPECT_EQ(circle_in(planted), "a.js > b.js > c.js > a.js") << line;
  }
  EXPECT_EQ(circle_in({{"a.js", {"a.js"}}}), "a.js > a.js");
  EXPECT_EQ(circle_in({{"a.js", {"b.js"}}, {"b.js", {"c.js"}}, {"c.js", {"b.js"}}}),
            "b.js > c.js > b.js");
}

}  // namespace
}  // namespace ergocast
