// SPDX-License-Identifier: BSD-3-Clause
// Arranges the picture of a team in columns as wide as their widest cells, and colours problems.
#include "cli/team/team_text.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "cli/team/overload.h"
#include "core/mission/mission.h"
#include "text/printable.h"
#include "text/versions.h"

namespace ergocast {
namespace {

/// A shorter block is not shown: bodies that pass each other block briefly.
constexpr double kBlocked_s = 1;

enum class Tint { kPlain, kFaint, kGood, kLook, kBad };

std::string tinted(const std::string& text, Tint tint, bool colour) {
  constexpr const char* kCodes[] = {"", "2", "32", "33", "31;1"};
  if (!colour || tint == Tint::kPlain) return text;
  return std::string("\x1b[") + kCodes[static_cast<int>(tint)] + 'm' + text + "\x1b[0m";
}

std::string number(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// How many columns the UTF-8 text takes on a terminal.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string shortened(const std::string& text, std::size_t width) {
  if (width_of(text) <= width) return text;
  std::size_t size = 0, seen = 0;
  while (size < text.size() && (seen < width - 1 || (text[size] & 0xC0) == 0x80)) {
    seen += (text[size] & 0xC0) == 0x80 ? 0 : 1;
    ++size;
  }
  return text.substr(0, size) + "…";
}

struct Cell {
  std::string text{};
  Tint tint = Tint::kPlain;
};

struct Column {
  const char* title;
  bool right;
};

/// Columns as wide as their widest cell: one space between numbers, two between words.
std::string aligned(const std::vector<Column>& columns, const std::vector<std::vector<Cell>>& rows,
                    bool colour) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    widths.push_back(std::string(columns[c].title).size());
    for (const auto& row : rows) widths[c] = std::max(widths[c], width_of(row[c].text));
  }
  std::string text;
  const auto add_line = [&](const std::vector<Cell>& row) {
    std::string line;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::string blanks(widths[c] - width_of(row[c].text), ' ');
      const std::string cell = row[c].text.empty() ? "" : tinted(row[c].text, row[c].tint, colour);
      line += (c == 0             ? ""
               : columns[c].right ? " "
                                  : "  ") +
              (columns[c].right ? blanks + cell : cell + blanks);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  };
  std::vector<Cell> titles;
  for (const Column& column : columns) titles.push_back({column.title, Tint::kFaint});
  add_line(titles);
  for (const auto& row : rows) add_line(row);
  return text;
}

Tint tint_of(Condition condition) {
  constexpr Tint kTints[] = {Tint::kBad,  Tint::kBad,   Tint::kLook, Tint::kFaint,
                             Tint::kGood, Tint::kFaint, Tint::kFaint};
  return kTints[static_cast<int>(condition)];
}

/// "tag 3 range 1".
std::string refused_text(const RefusalCounts& refused) {
  std::string text;
  for (std::size_t i = 0; i < refused.size(); ++i) {
    if (refused[i] == 0) continue;
    text += (text.empty() ? "" : " ") + std::string(to_string(static_cast<Refusal>(i))) + ' ' +
            std::to_string(refused[i]);
  }
  return text;
}

Cell count_cell(std::int64_t count) {
  return {std::to_string(count), count > 0 ? Tint::kLook : Tint::kPlain};
}

constexpr std::size_t kHostWidth = 14, kLifeDigits = 6;
const std::vector<Column> kColumns = {{"id", true},      {"state", false},   {"host", false},
                                      {"life", false},   {"tick", true},     {"phi^2", true},
                                      {"stale s", true}, {"lag ms", true},   {"lost", true},
                                      {"drops", true},   {"restarts", true}, {"refused", false}};

std::vector<Cell> cells_of(const AgentRow& row) {
  std::vector<Cell> cells(kColumns.size());
  cells[0].text = std::to_string(row.author.agent);
  cells[1] = {condition_text(row), tint_of(row.condition)};
  cells[3].text = to_hex(row.author.incarnation).substr(0, kLifeDigits);
  cells[10] = count_cell(row.restarts);
  if (!row.status) return cells;
  const AgentStatus& status = *row.status;
  cells[2].text = shortened(status.host, kHostWidth);
  cells[4].text = std::to_string(row.tick);
  cells[5].text = status.answered_tick < 0 ? "-" : number("%.3g", status.ergodic_metric);
  cells[6].text = number("%.1f", status.max_staleness_s);
  const double lag_ms = 1000 * status.loop_lag_s;
  cells[7] = {number(lag_ms < 10 ? "%.1f" : "%.0f", lag_ms),
              lag_ms < 100 ? Tint::kPlain : Tint::kLook};
  cells[8] = count_cell(status.contributions_lost);
  cells[9] = count_cell(status.kernel_drops);
  cells[11] = {refused_text(status.refused), Tint::kLook};
  if (status.rate_offender != kUnassigned)
    cells[11].text += " of agent " + std::to_string(status.rate_offender);
  return cells;
}

std::string charge_text(std::int32_t charge_ppm) {
  return charge_ppm == kNoCharge ? "" : number("%.0f %%", 100 * share_of(charge_ppm));
}

std::string headline(const TeamPicture& at) {
  std::string text = at.replay ? "replay of " : "";
  text += at.scenario.empty() ? "a mission not received yet" : at.scenario;
  text += ", run " + to_hex(at.run) + ", ";
  text += at.paused ? "paused" : at.state ? to_string(*at.state) : "no coordinator found";
  text += ", tick " + std::to_string(at.counted);
  if (at.tick_count > 0) {
    text += " of " + std::to_string(at.tick_count) +
            number(" (%.0f %%)",
                   100.0 * static_cast<double>(at.counted) / static_cast<double>(at.tick_count));
  }
  if (at.dt_s > 0) text += number(", t = %.1f s", static_cast<double>(at.counted) * at.dt_s);
  return text;
}

/// "target of amendment 3 since t = 120.0 s", in mission time.
std::string target_text(const TeamPicture& at) {
  const Tick from = counted_ticks(at.holds, at.target->from);
  return "target of amendment " + std::to_string(at.target->number) +
         number(" since t = %.1f s", static_cast<double>(from) * at.dt_s);
}

/// "zone of amendment 3 until t = 120.0 s", in mission time if no pause begins.
std::string zone_text(const TeamPicture& at, const Zone& zone) {
  const Tick until = counted_ticks(at.holds, zone.end());
  return "zone of amendment " + std::to_string(zone.number) +
         number(" until t = %.1f s", static_cast<double>(until) * at.dt_s);
}

std::string second_line(const TeamPicture& at) {
  std::string text = at.over ? "the mission is over"
                             : std::to_string(at.agents_alive) + " of " +
                                   std::to_string(at.agents_expected) + " agents alive";
  if (at.ergodic_metric) {
    text += number(", phi^2 %.4g", *at.ergodic_metric);
    text += at.free_domain ? " in modes of the free domain (median)" : " (median)";
  }
  if (at.detection_probability)
    text += number(", found %.1f %%", 100 * *at.detection_probability) +
            " of objects drawn from the target";
  if (at.objects > 0)
    text += ", " + std::to_string(at.finds.size()) + " of " + std::to_string(at.objects) +
            " hidden objects found";
  if (at.wrong_confirmations.value_or(0) > 0)
    text += ", " + wrong_confirmations_text(*at.wrong_confirmations);
  if (!at.finds.empty()) text += ", the newest: " + to_text(at.finds.back());
  if (at.target) text += ", " + target_text(at);
  if (at.end)
    text += ", end of amendment " + std::to_string(at.end->number) +
            number(" at t = %.1f s", static_cast<double>(at.tick_count) * at.dt_s);
  for (const Zone& zone : at.zones) text += ", " + zone_text(at, zone);
  if (at.law)
    text += ", law of amendment " + std::to_string(at.law->number) + " (" + at.law_text + ")";
  if (at.missed_deadlines > 0)
    text += ", " + std::to_string(at.missed_deadlines) + " commands late";
  if (at.skipped_ticks > 0) text += ", " + std::to_string(at.skipped_ticks) + " ticks skipped";
  if (at.clamped_commands > 0)
    text += ", " + std::to_string(at.clamped_commands) + " commands cut to the speed limit";
  for (std::size_t i = 0; i < at.forgotten.size(); ++i) {
    text += (i == 0 ? ", forgotten: coverage of " : ", ") + std::to_string(at.forgotten[i]);
  }
  text += at.authenticated ? ", authenticated" : ", unauthenticated";
  return text;
}

/// Why the agents of a host cannot join, and the remedy.
std::string other_version_text(const std::string& ours, const std::string& host,
                               const std::string& version) {
  const std::string there = printable(host), theirs = printable(version);
  return "an agent on " + there + " cannot join: it has version " + theirs + " and this host has " +
         ours + "; " + update_of_hosts(there, theirs, "this host", ours);
}

std::string process_line(const ProcessRow& row, bool over, bool colour) {
  std::string state = !row.heard ? "no message" : over ? "ended" : "alive";
  if (row.trouble) state = number("silent %.0f s", row.silent_s);
  if (row.trouble && !row.heard) state = "no message";
  const Tint tint = row.trouble ? Tint::kBad : row.heard && !over ? Tint::kGood : Tint::kFaint;
  std::string line = row.name + std::string(13 - std::min<std::size_t>(12, row.name.size()), ' ');
  line += tinted(state, tint, colour);
  if (row.heard) line += "  life " + to_hex(row.incarnation).substr(0, kLifeDigits);
  if (row.heard)
    line += row.name == "logger" ? "  recorded to tick " + std::to_string(row.tick)
                                 : "  tick " + std::to_string(row.tick);
  if (!row.host.empty()) line += "  on " + row.host;
  return line + '\n';
}

}  // namespace

std::string name_of(AgentId sender) {
  if (sender == kWorld) return "world";
  if (sender == kCoordinator) return "coordinator";
  return sender == kLogger ? "logger" : std::to_string(sender);
}

std::string condition_text(const AgentRow& row) {
  switch (row.condition) {
    case Condition::kSilent:
      return number("silent %.0f s", row.silent_s);
    case Condition::kWaiting:
      return "waiting for " + name_of(row.status->waiting_for);
    case Condition::kLate:
      return "late";
    case Condition::kUnheard:
      return "no message yet";
    case Condition::kFinished:
      return "finished";
    case Condition::kGone:
      return "gone";
    case Condition::kOk:
      break;
  }
  if (row.blocked_s >= kBlocked_s) {
    const AgentId by = row.status->blocked_by;
    return "blocked by " + (by < 0 ? "an edge" : "agent " + std::to_string(by)) +
           number(" for %.0f s", row.blocked_s);
  }
  if (!row.status) return "ok";
  switch (row.status->phase) {
    case AgentPhase::kWaiting:
      return "ready";
    case AgentPhase::kReturning:
      return row.charges ? "charging" : "goes home";
    case AgentPhase::kResting:
      return "rests";
    default:
      return "ok";
  }
}

namespace {

std::string contact_lines(const TeamPicture& picture, bool colour) {
  constexpr std::size_t kMost = 8;
  const std::vector<Contact>& contacts = picture.contacts;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, contacts.size()); ++i)
    text += '\n' + tinted("contact", Tint::kFaint, colour) + "  " + to_text(contacts[i]);
  if (contacts.size() > kMost)
    text += "\nand " + std::to_string(contacts.size() - kMost) +
            (picture.more_contacts ? " or more less likely ones" : " less likely ones");
  return text.empty() ? text : text + '\n';
}

}  // namespace

std::string team_table(const TeamPicture& picture, bool colour) {
  std::string text = headline(picture) + '\n' + second_line(picture) + '\n';
  const auto warning =
      overload_warning(picture.missed_deadlines, picture.tick, picture.agents_expected);
  if (warning) text += tinted("warning: " + *warning, Tint::kLook, colour) + '\n';
  for (const auto& [host, version] : picture.other_versions)
    text += tinted(other_version_text(picture.version, host, version), Tint::kBad, colour) + '\n';
  if (!picture.reason.empty()) text += tinted(picture.reason, Tint::kLook, colour) + '\n';
  std::vector<std::vector<Cell>> rows;
  for (const AgentRow& row : picture.agents) rows.push_back(cells_of(row));
  text += '\n';
  for (const ProcessRow& row : picture.processes) text += process_line(row, picture.over, colour);
  std::vector<Column> columns = kColumns;
  if (std::ranges::any_of(picture.agents,
                          [](const AgentRow& row) { return row.charge_ppm != kNoCharge; })) {
    columns.insert(columns.begin() + 2, {"battery", true});
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i].insert(rows[i].begin() + 2, Cell{charge_text(picture.agents[i].charge_ppm)});
  }
  if (std::ranges::any_of(picture.agents, [](const AgentRow& row) { return !row.kind.empty(); })) {
    columns.insert(columns.begin() + 1, {"kind", false});
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i].insert(rows[i].begin() + 1, Cell{picture.agents[i].kind});
  }
  if (!rows.empty()) text += '\n' + aligned(columns, rows, colour);
  text += contact_lines(picture, colour);
  if (!picture.clients.empty()) text += '\n';
  for (const std::string& client : picture.clients)
    text += tinted("shown to", Tint::kFaint, colour) + "  " + printable(client) + '\n';
  return text;
}

std::string cut_to_height(const std::string& text, std::size_t rows) {
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  if (lines <= rows || rows < 2) return text;
  std::size_t end = 0;
  for (std::size_t line = 0; line + 1 < rows; ++line) end = text.find('\n', end) + 1;
  return text.substr(0, end) + "… and " + std::to_string(lines - rows + 1) + " more\n";
}

}  // namespace ergocast
