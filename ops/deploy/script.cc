// SPDX-License-Identifier: BSD-3-Clause
// Replaces marks in script texts with values that are quoted for the shell.
#include "ops/deploy/script.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace ergocast {
namespace {

std::string with(std::string text, const std::string& mark, const std::string& value) {
  for (auto at = text.find(mark); at != text.npos; at = text.find(mark, at + value.size())) {
    text.replace(at, mark.size(), value);
  }
  return text;
}

std::string array(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "(" : " ") + shell_word(word);
  return text + ')';
}

}  // namespace

std::string shell_word(std::string_view text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return c < 128 && (std::isalnum(c) != 0 || std::strchr("./_-@:+", c) != nullptr);
  });
  if (plain) return std::string(text);
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + '\'';
}

std::string script_head(std::string head, const std::string& name, const DeployMission& mission) {
  return with(with(std::move(head), "%SCRIPT%", "./" + name), "%GROUP%", mission.url.group);
}

std::string script_settings(const std::vector<DeployHost>& hosts, const DeployMission& mission) {
  std::vector<std::string> addresses;
  std::string coordinator;
  for (const DeployHost& host : hosts) {
    addresses.push_back(host.address);
    if (host.coordinator) coordinator = host.address;
  }
  return "\nmission=" + shell_word(mission.name) + "\nurl=" + shell_word(mission.url.base()) +
         "\nscenario_folder=" + shell_word(mission.folder.string()) +
         "\nscenario_files=" + array(mission.files) +
         "\nkeys=" + shell_word(mission.keys.string()) + "\nmodes=" + shell_word(mission.modes) +
         "\ncoordinator=" + shell_word(coordinator) + "\nhosts=" + array(addresses) + '\n';
}

}  // namespace ergocast
