// SPDX-License-Identifier: BSD-3-Clause
// The logs of the processes of a failed test.
#pragma once

#include <filesystem>
#include <iterator>
#include <map>
#include <string>

#include "runtime/process/child.h"

namespace ergocast::test {

/// The last lines of the logs below a folder, each under its name: outputs of programs that a test
/// started, and the logs of `ergocast run` ("run/log/sim.log").
/// @param commands  of those programs, by the names of their outputs
inline std::string ends_of_logs(const std::filesystem::path& folder,
                                const std::map<std::string, std::string>& commands) {
  constexpr int kLines = 25;
  std::map<std::filesystem::path, std::string> ends;  // in the order of their names
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    const std::string name = at->path().filename();
    const bool is_tool = name.starts_with("tool-");  // a test may start hundreds of silent ones
    const bool is_log = commands.contains(name) || is_tool || name.ends_with(".log");
    if (is_log && at->is_regular_file(error) && !(is_tool && at->file_size(error) == 0)) {
      ends[at->path().lexically_relative(folder)] = last_lines(at->path(), kLines);
    }
  }
  std::string text;
  for (const auto& [file, end] : ends) {
    const auto command = commands.find(file.filename());
    text += "---- the end of " + file.string() +
            (command == commands.end() ? "" : " (" + command->second + ")") + ":\n" +
            (end.empty() ? "    (nothing was logged)\n" : end);
  }
  return text;
}

}  // namespace ergocast::test
