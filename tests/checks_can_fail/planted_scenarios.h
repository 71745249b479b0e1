// SPDX-License-Identifier: BSD-3-Clause
// Scenarios with a planted mistake, and what `ergocast check` prints about them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include "tests/checks_can_fail/mistaken_files.h"
#include "tests/checks_can_fail/scenario_mistakes.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {

class PlantedScenarios : public OwnHost {
 protected:
  void write(const std::string& name, const std::string& text) { write_file(folder_ / name, text); }

  void expect_mistake(const Mistake& mistake) {
    std::string text = kGood;
    const std::size_t at = text.find(mistake.from);
    ASSERT_NE(at, text.npos) << mistake.from;
    write("s.textproto", text.replace(at, mistake.from.size(), mistake.to));
    EXPECT_EQ(ergocast({"check", file_}), 2) << mistake.to.substr(0, 200) << output();
    const std::string begin = file_.string() + ":";
    const auto line =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
    bool found = false;
    for (const std::string& said : note(output())) {
      if (said.find(mistake.said) == said.npos) continue;
      const bool in_line = said.starts_with(begin + std::to_string(line) + ":");
      found = found || !mistake.has_line || in_line || mistake.to.find('\n') != mistake.to.npos;
      EXPECT_TRUE(said.ends_with(")") && !said.ends_with("()")) << said;
    }
    EXPECT_TRUE(found) << mistake.said << " is not reported for " << mistake.to.substr(0, 200)
                       << ":\n"
                       << output().substr(0, 2000);
  }

  /// Stores the output line by line.
  std::vector<std::string> note(const std::string& text) {
    std::istringstream lines(text);
    std::vector<std::string> all;
    for (std::string line; std::getline(lines, line);) all.push_back(line);
    said_.insert(said_.end(), all.begin(), all.end());
    return all;
  }

  const std::filesystem::path file_ = folder_ / "s.textproto";
  std::vector<std::string> said_, said_of_flags_;
};

}  // namespace ergocast::test
