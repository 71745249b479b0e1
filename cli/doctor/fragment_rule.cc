// SPDX-License-Identifier: BSD-3-Clause
// Reads nft's rules as JSON and follows the input chains in order until a rule drops the
// fragments.
#include "cli/doctor/fragment_rule.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/doctor/command_output.h"
#include "team/messages.h"

namespace ergocast::doctor {
namespace {

using nlohmann::json;

constexpr int kFragmentMagic = 0x4c433033;  // "LC03"

/// Family, table and name.
using Chain = std::array<std::string, 3>;

/// @param entry  a chain, or one of its rules
Chain chain_of(const json& entry, const char* name) {
  return {entry.at("family").get<std::string>(), entry.at("table").get<std::string>(),
          entry.at(name).get<std::string>()};
}

/// The chains that packets to this host pass.
std::set<Chain> input_chains(const json& ruleset) {
  std::set<Chain> chains;
  for (const json& entry : ruleset.at("nftables")) {
    if (!entry.contains("chain")) continue;
    const json& chain = entry["chain"];
    const std::string hook = chain.value("hook", "");
    if ((hook != "input" && hook != "prerouting") || chain.value("type", "") != "filter") continue;
    chains.insert(chain_of(chain, "name"));
  }
  return chains;
}

/// Whether `right`, a port, a range or a set of those, contains `port`.
bool has_port(const json& right, int port) {
  if (right.is_number_integer()) return right == port;
  if (right.contains("range")) return right["range"].at(0) <= port && port <= right["range"].at(1);
  if (!right.contains("set")) return false;
  return std::any_of(right["set"].begin(), right["set"].end(),
                     [port](const json& one) { return has_port(one, port); });
}

/// Whether the rule has no statements other than `statements`.
bool consists_of(const json& rule, const std::set<std::string>& statements) {
  const json& parts = rule.at("expr");
  return std::all_of(parts.begin(), parts.end(), [&](const json& part) {
    return part.is_object() && part.size() == 1 && statements.contains(part.begin().key());
  });
}

/// Whether the rule drops every fragment of LCM's that is sent to `port`.
bool drops_fragments(const json& rule, int port) {
  if (!consists_of(rule, {"match", "counter", "drop"})) return false;
  bool fragments = false, drops = false, here = true;
  for (const json& part : rule.at("expr")) {
    drops = drops || part.contains("drop");
    if (!part.contains("match")) continue;
    const json& match = part["match"];
    const json payload = match.at("left").value("payload", json::object());
    const bool equals = match.value("op", "==") == "==";
    if (equals && payload == json{{"base", "th"}, {"offset", 64}, {"len", 32}}) {
      fragments = match.at("right") == kFragmentMagic;
    } else if (equals && payload.value("field", "") == "dport" &&
               payload.value("protocol", "") == "udp") {
      here = here && has_port(match.at("right"), port);
    } else {
      here = false;  // drops only some of them
    }
  }
  return fragments && drops && here;
}

/// Whether one of the chains drops fragments to `port` before any other rule in it can accept them.
bool is_covered(const json& ruleset, std::set<Chain> chains, int port) {
  for (const json& entry : ruleset.at("nftables")) {
    if (!entry.contains("rule")) continue;
    const json& rule = entry["rule"];
    const Chain chain = chain_of(rule, "chain");
    if (chains.contains(chain) && drops_fragments(rule, port)) return true;
    if (!consists_of(rule, {"match", "counter", "limit", "log", "drop", "reject"})) {
      chains.erase(chain);
    }
  }
  return false;
}

/// How many of the URL's ports are covered.
int covered_ports(const json& ruleset, const LcmUrl& url) {
  const std::set<Chain> chains = input_chains(ruleset);
  int covered = 0;
  for (int port = url.base_port; port < url.base_port + kBusCount; ++port) {
    covered += is_covered(ruleset, chains, port) ? 1 : 0;
  }
  return covered;
}

/// The command that loads the rule. The shipped file covers LCM's default ports and those that runs
/// choose for themselves.
std::string command_that_loads(const LcmUrl& url, const std::filesystem::path& rules) {
  const bool named = url.base_port == LcmUrl{}.base_port ||
                     (url.base_port >= kFirstBasePort && url.base_port <= kLastBasePort);
  if (named) return "nft -f " + rules.string();
  const std::string ports =
      std::to_string(url.base_port) + "-" + std::to_string(url.base_port + kBusCount - 1);
  return "sed 's/^define.*{/& " + ports + ",/' " + rules.string() + " | nft -f -";
}

}  // namespace

std::optional<std::string> nft_ruleset() {
  if (geteuid() != 0) return std::nullopt;
  const std::string text = output_of("nft -j list ruleset 2>/dev/null");
  return text.empty() ? std::nullopt : std::optional(text);
}

Finding fragment_rule_finding(const LcmUrl& url, const std::optional<std::string>& ruleset,
                              const std::filesystem::path& rules) {
  const char* check = "LCM fragments";
  const std::string why =
      "One crafted fragment crashes a program that reads with LCM's library, such as lcm-spy and "
      "lcm-logger. Ours do not. As root, until the next start:";
  const Finding missing{check, Level::kNote, "no rule drops them", why,
                        command_that_loads(url, rules)};
  if (!ruleset) {
    Finding unknown = missing;
    unknown.found = "only root can see whether a rule drops them (nft list ruleset)";
    return unknown;
  }
  try {
    const int covered = covered_ports(json::parse(*ruleset), url);
    if (covered == kBusCount) return {check, Level::kOk, "dropped at our ports", "", ""};
    Finding partly = missing;
    if (covered > 0)
      partly.found = "a rule drops them at " + std::to_string(covered) + " of our 3 ports";
    return partly;
  } catch (const json::exception&) {
    return missing;
  }
}

}  // namespace ergocast::doctor
