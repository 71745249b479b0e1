// SPDX-License-Identifier: BSD-3-Clause
// Reads both tables in the order of their keys, so that a missing row does not shift the
// comparison.
#include "cli/record/trajectory_comparison.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "logger/recorder.h"
#include "logger/run_record.h"
#include "text/read_number.h"

namespace ergocast::cli {
namespace {

/// Tick and agent of a row of trajectory.csv, by which its rows ascend; nothing if it has none.
using RowKey = std::pair<Tick, AgentId>;
std::optional<RowKey> key_of(std::string_view row) {
  std::string_view cells[3];  // tick, time, agent
  for (std::string_view& cell : cells) {
    const std::size_t comma = row.find(',');
    if (comma == row.npos) return {};
    cell = row.substr(0, comma);
    row.remove_prefix(comma + 1);
  }
  const auto tick = read_number<Tick>(cells[0]);
  const auto agent = read_number<AgentId>(cells[2]);
  return tick && agent ? std::optional(RowKey(*tick, *agent)) : std::nullopt;
}

std::string place_of(const RowKey& key) {
  return "tick " + std::to_string(key.first) + ", agent " + std::to_string(key.second);
}

/// Removes the first cell of a row and returns it.
std::string_view take_cell(std::string_view& row) {
  const std::size_t comma = std::min(row.find(','), row.size());
  const std::string_view cell = row.substr(0, comma);
  row.remove_prefix(std::min(comma + 1, row.size()));
  return cell;
}

}  // namespace

std::string first_difference(std::string place, const std::string& header,
                             const std::string& recorded, const std::string& simulated) {
  place.resize(place.find_last_not_of(": ") + 1);
  std::string_view names = header, left = recorded, right = simulated;
  while (!names.empty()) {
    const std::string_view name = take_cell(names);
    if (take_cell(left) == take_cell(right)) continue;
    place += ", column " + std::string(name);
    break;
  }
  return place + "\nrecorded:  " + recorded + "\nsimulated: " + simulated + '\n';
}

TrajectoryComparison::TrajectoryComparison(const std::filesystem::path& run_dir)
    : lines_(run_dir, kTrajectoryFile, trajectory_headers()) {
  read_next();
}

bool TrajectoryComparison::compare(std::istream& simulated) {
  for (std::string line; same_ && !recorded_over_ && std::getline(simulated, line);) {
    if (key_of(line)) compare_row(line);  // the header has none
  }
  return same_ && !recorded_over_;
}

std::string TrajectoryComparison::place() const {
  return place_of(key_of(first_).value_or(RowKey{}));
}

void TrajectoryComparison::read_next() {
  std::string line;
  recorded_ = lines_.next(line) ? std::optional(line) : std::nullopt;
  if (recorded_) recorded_place_ = lines_.place();
}

void TrajectoryComparison::compare_row(const std::string& simulated) {
  const auto key = key_of(simulated), last = key_of(last_);
  const bool same_tick = last && last->first == key->first;
  if (!recorded_ || (emergency_stopped_ && !same_tick)) {
    recorded_over_ = true;
    amid_tick_ = same_tick;
    return;
  }
  const bool stands =
      emergency_stop_expected_ && *recorded_ != simulated && stands_where(simulated);
  if (*recorded_ == simulated || stands) {
    emergency_stopped_ = emergency_stopped_ || stands;
    last_ = simulated;
    ++rows_;
    return read_next();
  }
  if (key_of(*recorded_) > key) return miss(simulated);
  same_ = false;
  difference_ = first_difference(recorded_place_, lines_.header(), *recorded_, simulated);
  first_ = simulated;
}

void TrajectoryComparison::miss(const std::string& simulated) {
  const RowKey key = *key_of(simulated);
  const Tick tick = key.first;
  if (missing_ == 0) first_missing_ = place_of(key);
  if (tick != last_missing_) ++missing_;
  last_missing_ = tick;
}

/// Whether the recorded row is the simulated one, except for a velocity of zero.
bool TrajectoryComparison::stands_where(const std::string& simulated) const {
  const std::string& header = lines_.header();
  const std::size_t seen = std::min(header.find(",detected"), header.size());
  const auto commas = [&](std::size_t from, std::size_t to) {
    return std::count(header.begin() + static_cast<std::ptrdiff_t>(from),
                      header.begin() + static_cast<std::ptrdiff_t>(to), ',');
  };
  const auto axes = commas(header.find(",vx_mps"), seen);
  std::size_t behind = simulated.size();
  for (auto column = commas(seen, header.size()); column > 0; --column)
    behind = simulated.rfind(',', behind - 1);
  std::size_t end = behind;
  std::string none;
  for (auto axis = axes; axis > 0; --axis, none += ",0") end = simulated.rfind(',', end - 1);
  return *recorded_ == simulated.substr(0, end) + none + simulated.substr(behind);
}

}  // namespace ergocast::cli
