// SPDX-License-Identifier: BSD-3-Clause
// Reads parents, start times and command lines from /proc each time, because a restarted process
// has another id.
#include "cli/watch/run_processes.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "text/read_number.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

std::string contents_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The words of a command line, each ended by a zero byte.
std::vector<std::string> command_line_of(const fs::path& process) {
  std::istringstream text(contents_of(process / "cmdline"));
  std::vector<std::string> words;
  for (std::string word; std::getline(text, word, '\0');) words.push_back(word);
  return words;
}

/// The name that `ergocast run` uses. A program that replaces the simulated world is "world".
std::string name_in(const std::vector<std::string>& command) {
  const std::string program = fs::path(command.front()).filename();
  for (const char* name : {"logger", "sim", "coordinator"}) {
    if (program == std::string("ergocast-") + name) return name;
  }
  if (program != "ergocast-agent") return "world";
  const auto id = std::find(command.begin(), command.end(), "--id");
  return id == command.end() || id + 1 == command.end() ? "agent" : "agent-" + *(id + 1);
}

struct Stat {
  char state = 'Z';
  int parent = 0;
  unsigned long long started = 0;  // since boot, in ticks of the kernel's clock
};

/// The fields after the name. The name may contain blanks and brackets.
std::optional<Stat> stat_of(const fs::path& process) {
  const std::string text = contents_of(process / "stat");
  const std::size_t name_end = text.rfind(')');
  if (name_end == text.npos) return std::nullopt;
  std::istringstream fields(text.substr(name_end + 1));
  Stat stat;
  fields >> stat.state >> stat.parent;
  std::string skipped;
  for (int field = 5; field < 22; ++field) fields >> skipped;
  fields >> stat.started;
  return fields ? std::optional(stat) : std::nullopt;
}

}  // namespace

std::vector<std::pair<std::string, int>> processes_of_run(int launcher) {
  struct Found {
    unsigned long long started;
    int pid;
    std::string name;
  };
  std::vector<Found> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator("/proc", none)) {
    const auto pid = read_number<int>(entry.path().filename().string());
    if (!pid) continue;
    const auto stat = stat_of(entry.path());
    if (!stat || stat->parent != launcher || stat->state == 'Z') continue;
    const auto command = command_line_of(entry.path());
    if (!command.empty()) found.push_back({stat->started, *pid, name_in(command)});
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return a.started != b.started ? a.started < b.started : a.pid < b.pid;
  });
  std::vector<std::pair<std::string, int>> processes;
  for (const Found& one : found) processes.emplace_back(one.name, one.pid);
  return processes;
}

}  // namespace ergocast::cli
