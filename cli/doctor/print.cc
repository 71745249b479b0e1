// SPDX-License-Identifier: BSD-3-Clause
// Sorts findings by level, wraps their text to the width of the terminal, and writes them as JSON.
#include "cli/doctor/print.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "runtime/process/program_options.h"

namespace ergocast::doctor {
namespace {

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

std::string coloured(const std::string& text, Level level, const Look& look) {
  if (!look.coloured) return text;
  const char* colour = level == Level::kOk        ? "\033[32m"
                       : level == Level::kNote    ? "\033[36m"
                       : level == Level::kWarning ? "\033[33m"
                                                  : "\033[1;31m";
  return colour + text + "\033[0m";
}

/// Each line after `indent` spaces, broken between words.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t columns) {
  std::string lines, line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!line.empty() && indent + line.size() + 1 + word.size() > columns) {
      lines += std::string(indent, ' ') + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return line.empty() ? lines : lines + std::string(indent, ' ') + line + "\n";
}

std::string commands(const std::string& remedy, std::size_t indent) {
  std::string text;
  std::istringstream lines(remedy);
  for (std::string line; std::getline(lines, line);) {
    text += std::string(indent + 4, ' ') + line + "\n";
  }
  return text;
}

std::string verdict(const Findings& findings) {
  const auto count = [&findings](Level level) {
    return static_cast<long>(std::count_if(findings.begin(), findings.end(),
                                           [&](const Finding& one) { return one.level == level; }));
  };
  return counted(count(Level::kProblem), "problem") + ", " +
         counted(count(Level::kWarning), "warning") + ", " + counted(count(Level::kNote), "note") +
         "; " + std::to_string(count(Level::kOk)) + " of " + std::to_string(findings.size()) +
         " checks found nothing to report.\n";
}

std::string loss_text(const Loss& loss) {
  return fixed(loss.small_percent(), 1) + " / " + fixed(loss.large_percent(), 1);
}

std::string round_trip_text(const Peer& peer) {
  if (peer.round_trips_s.empty()) return "-";
  std::string text;
  for (const double quantile : {0.5, 0.99, 1.0}) {
    text += (text.empty() ? "" : " / ") + fixed(1e3 * peer.round_trip_s(quantile), 2);
  }
  return text;
}

nlohmann::json json_of(const Loss& loss) {
  return {{"probes", loss.expected.all()},
          {"lost_percent", loss.percent()},
          {"lost_small_percent", loss.small_percent()},
          {"lost_large_percent", loss.large_percent()}};
}

nlohmann::json json_of(const Peer& peer) {
  nlohmann::json json = {{"host", peer.host},
                         {"address", peer.address},
                         {"version", peer.version},
                         {"hears_this_host", peer.to_it.has_value()},
                         {"from_it", json_of(peer.from_it)},
                         {"to_it", nullptr},
                         {"round_trip_ms", nullptr},
                         {"duplicates", peer.duplicates}};
  if (peer.to_it) json["to_it"] = json_of(*peer.to_it);
  if (!peer.round_trips_s.empty()) {
    json["round_trip_ms"] = {{"p50", 1e3 * peer.round_trip_s(0.5)},
                             {"p99", 1e3 * peer.round_trip_s(0.99)},
                             {"max", 1e3 * peer.round_trip_s(1.0)}};
  }
  return json;
}

}  // namespace

std::string text_of(const LcmUrl& url, Findings findings, const Look& look) {
  std::stable_sort(findings.begin(), findings.end(),
                   [](const Finding& a, const Finding& b) { return a.level > b.level; });
  std::size_t check_width = 0;
  for (const Finding& finding : findings) check_width = std::max(check_width, finding.check.size());
  constexpr std::size_t kLevelWidth = 7;
  const std::size_t indent = kLevelWidth + 2 + check_width + 2;
  std::string text = "ergocast doctor on " + printable(host_name()) + ", " + url.base() + "\n\n";
  for (const Finding& finding : findings) {
    text += coloured(padded(to_string(finding.level), kLevelWidth), finding.level, look) + "  " +
            padded(finding.check, check_width) + "  " + finding.found + "\n" +
            wrapped(finding.why, indent, static_cast<std::size_t>(look.columns)) +
            commands(finding.remedy, indent);
  }
  return text + "\n" + verdict(findings);
}

std::string text_of(const std::vector<Peer>& peers) {
  if (peers.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"host", "address", "receives us", "lost from it %", "lost to it %", "round trip ms",
       "twice"},
      {"", "", "", "short / long", "short / long", "p50 / p99 / max", ""}};
  for (const Peer& peer : peers) {
    rows.push_back({peer.host, peer.address,
                    peer.to_it      ? "yes"
                    : peer.judged() ? "NO"
                                    : "?",
                    loss_text(peer.from_it), peer.to_it ? loss_text(*peer.to_it) : "-",
                    round_trip_text(peer), std::to_string(peer.duplicates)});
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t column = 0; column < row.size(); ++column) {
      std::size_t width = 0;
      for (const auto& other : rows) width = std::max(width, other[column].size());
      line += padded(row[column], width + 2);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string json_of(const LcmUrl& url, const Findings& findings, const std::vector<Peer>& peers) {
  nlohmann::json json = {{"url", url.base()},
                         {"host", printable(host_name())},
                         {"findings", nlohmann::json::array()},
                         {"peers", nlohmann::json::array()}};
  for (const Finding& one : findings) {
    json["findings"].push_back({{"check", one.check},
                                {"level", to_string(one.level)},
                                {"found", one.found},
                                {"why", one.why},
                                {"remedy", one.remedy}});
  }
  for (const Peer& peer : peers) json["peers"].push_back(json_of(peer));
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace ergocast::doctor
