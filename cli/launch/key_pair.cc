// SPDX-License-Identifier: BSD-3-Clause
// Reads the two files of one key name, and refuses them unless they are the two halves of one key.
#include "cli/launch/key_pair.h"

#include <filesystem>

#include "runtime/process/key_file.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {

std::string team_key_file(const std::string& name) { return name + ".key"; }
std::string coordinator_key_file(const std::string& name) { return name + ".coordinator.key"; }

std::optional<std::string> problem_of_key_pair(const std::string& name) {
  const std::string team = team_key_file(name), coordinator = coordinator_key_file(name);
  MissionKey keys[2];
  for (const std::string& file : {team, coordinator}) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
      return file + ": there is no such file; `ergocast keygen " + name + "` makes both";
    }
    const auto read = read_key_file(file);
    if (!read) return read.error();
    keys[file == coordinator] = *read;
  }
  if (keys[0].signing) {
    return team + ": with this key every host could begin and end missions; leave that to " +
           coordinator + ", as `ergocast keygen` does";
  }
  if (!keys[1].signing) return cannot_sign(coordinator);
  if (keys[0].shared != keys[1].shared || keys[0].coordinator != keys[1].coordinator) {
    return team + " and " + coordinator +
           " are of different keys; take two that `ergocast keygen` has written together";
  }
  return std::nullopt;
}

}  // namespace ergocast::cli
