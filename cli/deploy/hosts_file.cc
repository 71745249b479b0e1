// SPDX-License-Identifier: BSD-3-Clause
// Splits each line into words with their columns and reports every word that is no host, address or
// role.
#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "cli/deploy/deploy.h"
#include "core/base/ids.h"
#include "text/read_number.h"

namespace ergocast {
namespace {

constexpr std::size_t kLongestName = 63;
constexpr const char* kRoles =
    "coordinator, logger, sim, driver, agent N…, agents=COUNT, relay or hub=HOST:PORT";

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// Letters, digits, dots, hyphens and underscores, beginning with a letter or digit. Such a name is
/// no option of ssh, no path, and nothing that a shell would interpret.
bool is_plain(std::string_view text) {
  return !text.empty() && text.size() <= kLongestName && is_letter_or_digit(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return is_letter_or_digit(c) || c == '.' || c == '-' || c == '_';
         });
}

bool is_address(std::string_view text) {
  const auto at = text.find('@');
  return at == text.npos ? is_plain(text)
                         : is_plain(text.substr(0, at)) && is_plain(text.substr(at + 1));
}

constexpr std::string_view kHub = "hub=", kRate = "relay=";

/// HOST:PORT, where HOST is plain, or an IPv6 address in brackets.
bool is_hub(std::string_view text) {
  const auto colon = text.rfind(':');
  if (colon == text.npos) return false;
  std::string_view host = text.substr(0, colon);
  const auto port = read_number<int>(text.substr(colon + 1));
  if (!port || *port < 1 || *port > 65535) return false;
  if (!host.starts_with('[') || !host.ends_with(']')) return is_plain(host);
  host = host.substr(1, host.size() - 2);
  constexpr std::string_view kOfIpv6 = "0123456789abcdefABCDEF:.";
  return host.size() >= 2 && host.find_first_not_of(kOfIpv6) == host.npos;
}

struct Word {
  std::string_view text;
  std::size_t column;
};

std::vector<Word> words_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<Word> words;
  constexpr std::string_view kSpace = " \t\r";
  for (std::size_t begin = line.find_first_not_of(kSpace); begin != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(kSpace, begin), line.size());
    words.push_back({line.substr(begin, end - begin), begin + 1});
    begin = line.find_first_not_of(kSpace, end);
  }
  return words;
}

class HostsReader {
 public:
  explicit HostsReader(std::string file) : file_(std::move(file)) {}

  Result<std::vector<DeployHost>, std::vector<Problem>> read(std::string_view text) {
    while (!text.empty()) {
      ++line_;
      const std::size_t end = std::min(text.find('\n'), text.size());
      const auto words = words_of(text.substr(0, end));
      if (!words.empty()) read_host(words);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (hosts_.empty() && problems_.empty()) {
      problems_.push_back(
          {file_, "names no host", "write one host a line: name user@computer roles"});
    }
    if (problems_.empty()) {
      number_agents();
      tell_hubs();
    }
    if (!problems_.empty()) return failure(std::move(problems_));
    return std::move(hosts_);
  }

 private:
  void object(const Word& word, const std::string& what, const std::string& remedy) {
    problems_.push_back(
        {file_ + ':' + std::to_string(line_) + ':' + std::to_string(word.column), what, remedy});
  }

  void read_host(const std::vector<Word>& words) {
    DeployHost host;
    host.name = words[0].text;
    if (!is_plain(words[0].text)) {
      object(words[0], '"' + host.name + "\" is no host name",
             "use up to 63 letters, digits, dots, hyphens and underscores");
    } else if (const auto [first, is_new] = lines_.emplace(host.name, line_); !is_new) {
      object(words[0], '"' + host.name + "\" is already in line " + std::to_string(first->second),
             "put all roles of a host on one line");
    }
    std::size_t next = 1;
    host.address = host.name;
    if (words.size() > 1 && !words[1].text.starts_with(kHub) &&
        words[1].text.find_first_of("@.") != std::string_view::npos) {
      host.address = words[next++].text;
      if (!is_address(host.address)) {
        object(words[1], '"' + host.address + "\" is no address", "write user@computer");
      }
    }
    if (next == words.size())
      object(words[0], '"' + host.name + "\" has no role", std::string("give it ") + kRoles);
    wanted_.push_back(0);
    while (next < words.size()) next = read_role(words, next, host);
    hosts_.push_back(std::move(host));
  }

  /// Reads the role at `at` and returns where the next one is.
  std::size_t read_role(const std::vector<Word>& words, std::size_t at, DeployHost& host) {
    const Word& word = words[at];
    const std::map<std::string_view, bool*> flags = {{"coordinator", &host.coordinator},
                                                     {"logger", &host.logger},
                                                     {"sim", &host.sim},
                                                     {"driver", &host.driver},
                                                     {"relay", &host.relay}};
    constexpr std::string_view kCount = "agents=";
    if (const auto flag = flags.find(word.text); flag != flags.end()) {
      *flag->second = true;
    } else if (word.text == "agent") {
      return read_agents(words, at, host);
    } else if (word.text.starts_with(kCount)) {
      const auto count = read_number<int>(word.text.substr(kCount.size()));
      if (!count || *count < 1 || *count > kMaxAgents) {
        object(word,
               '"' + std::string(word.text) + "\" has no count from 1 to " +
                   std::to_string(kMaxAgents),
               "write agents=2");
      } else {
        wanted_.back() += *count;
      }
    } else if (word.text.starts_with(kRate)) {
      read_rate(word, host);
    } else if (word.text.starts_with(kHub)) {
      host.hub = word.text.substr(kHub.size());
      if (!is_hub(host.hub)) {
        object(word, '"' + host.hub + "\" is no place where sites can join",
               "write hub=HOST:PORT, such as hub=hub.example.org:7700");
      }
    } else {
      object(word, '"' + std::string(word.text) + "\" is no role",
             std::string("write ") + kRoles + (at == 1 ? "; an address has an @ or a dot" : ""));
    }
    return at + 1;
  }

  void read_rate(const Word& word, DeployHost& host) {
    constexpr int kLeast = 8, kMost = 10'000'000;  // of ergocast-relay --max-rate
    const auto rate = read_number<int>(word.text.substr(kRate.size()));
    host.relay = true;
    host.relay_kbit_per_s = rate.value_or(0);
    if (host.relay_kbit_per_s >= kLeast && host.relay_kbit_per_s <= kMost) return;
    object(word,
           '"' + std::string(word.text) + "\" has no rate from " + std::to_string(kLeast) + " to " +
               std::to_string(kMost) + " kbit/s",
           "write relay=1000, or relay for one without a limit");
  }

  std::size_t read_agents(const std::vector<Word>& words, std::size_t at, DeployHost& host) {
    std::size_t next = at + 1;
    for (; next < words.size(); ++next) {
      const auto id = read_number<int>(words[next].text);
      if (!id) break;
      if (*id < 0 || *id >= kMaxAgents) {
        object(words[next], "agent " + std::to_string(*id) + " cannot be",
               "number agents from 0 to " + std::to_string(kMaxAgents - 1));
      } else if (!taken_.insert(*id).second) {
        object(words[next], "agent " + std::to_string(*id) + " is named twice",
               "give every agent a number of its own");
      } else {
        host.agents.push_back(*id);
      }
    }
    if (next == at + 1)
      object(words[at], "\"agent\" without a number", "write agent 0, or agents=1");
    return next;
  }

  /// Gives agents without a number the lowest free numbers, in the order of the file.
  void number_agents() {
    int id = 0;
    for (std::size_t i = 0; i < hosts_.size(); ++i) {
      for (int k = 0; k < wanted_[i]; ++k) {
        while (taken_.contains(id)) ++id;
        taken_.insert(id);
        hosts_[i].agents.push_back(id);
      }
      std::sort(hosts_[i].agents.begin(), hosts_[i].agents.end());
    }
    if (!taken_.empty() && *taken_.rbegin() >= kMaxAgents) {
      problems_.push_back(
          {file_, "there are more agents than " + std::to_string(kMaxAgents), "leave some out"});
    }
  }

  void tell_hubs() {
    std::vector<std::string> hubs;
    for (const DeployHost& host : hosts_) {
      if (!host.hub.empty()) hubs.push_back(host.hub);
    }
    for (DeployHost& host : hosts_) host.hubs = hubs;
  }

  std::string file_;
  int line_ = 0;
  std::vector<DeployHost> hosts_;
  std::vector<int> wanted_;  ///< agents without a number, host by host
  std::map<std::string, int> lines_;
  std::set<int> taken_;
  std::vector<Problem> problems_;
};

}  // namespace

Result<std::vector<DeployHost>, std::vector<Problem>> parse_hosts(std::string_view text,
                                                                  const std::string& file) {
  return HostsReader(file).read(text);
}

}  // namespace ergocast
