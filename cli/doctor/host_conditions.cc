// SPDX-License-Identifier: BSD-3-Clause
// Looks for files and on the path, asks the kernel about the clock, and reads the firewall's
// default policy.
#include "cli/doctor/host_conditions.h"

#include <sys/timex.h>
#include <unistd.h>

#include <sstream>

#include "cli/doctor/command_output.h"

namespace ergocast::doctor {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error);
}

bool on_path(const fs::path& root, std::string_view path, const char* program) {
  std::istringstream folders{std::string(path)};
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (is_there(root / fs::path(folder).relative_path() / program)) return true;
  }
  return false;
}

}  // namespace

Finding spy_finding(const fs::path& root, std::string_view path, bool jar_built) {
  std::vector<std::string> missing, packages;
  const auto need = [&](bool there, const char* what, const char* package) {
    if (there) return;
    missing.emplace_back(what);
    packages.emplace_back(package);
  };
  need(on_path(root, path, "java"), "java", "default-jre");
  need(is_there(root / "usr/share/java/lcm.jar"), "lcm.jar", "liblcm-java");
  need(is_there(root / "usr/share/java/jchart2d.jar"), "jchart2d.jar", "libjchart2d-java");
  if (!jar_built) need(on_path(root, path, "javac"), "javac", "default-jdk");
  std::string remedy = packages.empty() ? "" : "apt-get install " + joined(packages, " ");
  if (!jar_built) {
    missing.emplace_back("ergocast-spy.jar");
    remedy += (remedy.empty() ? "" : "\n") +
              std::string("cmake build/release && cmake --build build/release --target spy");
  }
  if (missing.empty()) return {"lcm-spy", Level::kOk, "Java and its jars are there", "", ""};
  return {"lcm-spy", Level::kNote, "missing: " + joined(missing),
          "Only for watching messages with lcm-spy; teams need no Java.", remedy};
}

std::optional<bool> clock_is_synchronised() {
  timex time{};
  const int state = adjtimex(&time);
  if (state < 0) return std::nullopt;
  return state != TIME_ERROR && (time.status & STA_UNSYNC) == 0;
}

Finding clock_finding(std::optional<bool> synchronised) {
  if (!synchronised) return {"clock", Level::kOk, "the kernel does not report it", "", ""};
  if (*synchronised) return {"clock", Level::kOk, "synchronised", "", ""};
  return {"clock", Level::kNote, "not synchronised",
          "Ergocast itself needs no common clock; only the times in logs of several hosts then do "
          "not match.",
          "apt-get install systemd-timesyncd && timedatectl set-ntp true"};
}

std::string firewall_rules() {
  if (geteuid() != 0) return "";
  return output_of("{ nft list chains || iptables -S INPUT; } 2>/dev/null");
}

std::optional<Finding> firewall_finding(std::string_view rules, const std::string& group) {
  if (rules.empty()) return std::nullopt;
  const auto drops = [](const std::string& accept_group, const std::string& accept_igmp) {
    return Finding{
        "firewall", Level::kNote, "drops incoming traffic that no rule accepts",
        "If nothing arrives from other hosts, or the self test fails, let group and IGMP in "
        "(until the next start; the tool that wrote the rules makes it last).",
        accept_group + "\n" + accept_igmp};
  };
  std::istringstream lines{std::string(rules)};
  std::string table, chain;
  for (std::string line; std::getline(lines, line);) {
    line.erase(0, line.find_first_not_of(" \t"));
    const std::string name = line.substr(line.find(' ') + 1);
    if (line.starts_with("table ")) table = name.substr(0, name.rfind(" {"));
    if (line.starts_with("chain ")) chain = name.substr(0, name.rfind(" {"));
    if (line.starts_with("-P INPUT DROP")) {
      return drops("iptables -I INPUT -d " + group + " -p udp -j ACCEPT",
                   "iptables -I INPUT -p igmp -j ACCEPT");
    }
    const bool drops_input =
        line.find("hook input") != line.npos && line.find("policy drop") != line.npos;
    if (drops_input && !table.starts_with("ip6 ")) {  // LCM uses IPv4 only
      const std::string insert = "nft insert rule " + table + " " + chain;
      return drops(insert + " ip daddr " + group + " accept", insert + " ip protocol igmp accept");
    }
  }
  return Finding{"firewall", Level::kOk, "does not drop by default", "", ""};
}

}  // namespace ergocast::doctor
