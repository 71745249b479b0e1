// SPDX-License-Identifier: BSD-3-Clause
// Quantises positions on arrival, and codes the runs between gaps as second differences.
#include "report/track_grid.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "report/base64.h"

namespace ergocast {
namespace {

constexpr std::size_t kSmallTeam = 12;
constexpr double kHeadings = 256;

int axes_of(const Box& domain) { return domain.planar() ? 2 : 3; }

std::int32_t heading_of(const Eigen::Vector3d& v_mps) {
  const double turns = std::atan2(v_mps.y(), v_mps.x()) / (2 * std::numbers::pi);
  return static_cast<std::int32_t>(std::lround(kHeadings * (turns < 0 ? turns + 1 : turns)));
}

void append_number(std::string& bytes, std::int64_t value) {
  auto zigzag = static_cast<std::uint64_t>(value) << 1 ^ (value < 0 ? ~std::uint64_t{0} : 0);
  for (; zigzag > 127; zigzag >>= 7) bytes += static_cast<char>(zigzag | 128);
  bytes += static_cast<char>(zigzag);
}

}  // namespace

TrackGrid::TrackGrid(const Box& domain, std::size_t agents, bool headings)
    : domain_(domain),
      headings_(headings && domain.planar()),
      bits_(agents > kSmallTeam ? 13 : 14) {}

std::size_t TrackGrid::numbers() const {
  return static_cast<std::size_t>(axes_of(domain_)) + (headings_ ? 1 : 0);
}

void TrackGrid::coarsen() {
  stride_ *= 2;
  rows_ = (rows_ + 1) / 2;
  for (auto& [agent, track] : tracks_) {
    for (std::size_t row = 0; 2 * row < track.size(); ++row) track[row] = track[2 * row];
    track.resize((track.size() + 1) / 2);
  }
}

void TrackGrid::put(AgentId agent, Tick tick, const Eigen::Vector3d& x_m,
                    const Eigen::Vector3d& v_mps) {
  if (tick < 0) return;
  const auto agents = static_cast<std::int64_t>(tracks_.size() + (tracks_.contains(agent) ? 0 : 1));
  // Checked before the tracks grow, because a damaged record may name any tick.
  while (tick / stride_ >= kMostPositions / agents) coarsen();
  if (tick % stride_ != 0) return;
  const std::int64_t row = tick / stride_, full = (1 << bits_) - 1;
  std::vector<Cell>& track = tracks_[agent];
  if (std::ssize(track) <= row) track.resize(static_cast<std::size_t>(row) + 1, {kNothing, 0, 0});
  Cell& cell = track[static_cast<std::size_t>(row)];
  for (int axis = 0; axis < axes_of(domain_); ++axis) {
    // A record may contain any position; one far outside is drawn at the edge of twice the domain.
    const double share = (x_m[axis] - domain_.origin_m[axis]) / domain_.size_m[axis];
    cell[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(
        std::lround(std::clamp(share, -1.0, 2.0) * static_cast<double>(full)));
  }
  if (headings_) cell[2] = heading_of(v_mps);
  rows_ = std::max(rows_, row + 1);
}

nlohmann::ordered_json TrackGrid::encode(std::int64_t from, std::int64_t to) const {
  auto agents = nlohmann::ordered_json::array();
  std::string bytes;
  for (const auto& [agent, track] : tracks_) {
    auto runs = nlohmann::ordered_json::array();
    const std::int64_t end = std::min<std::int64_t>(to, std::ssize(track));
    const auto at = [&track = track](std::int64_t row) {
      return track[static_cast<std::size_t>(row)];
    };
    for (std::int64_t row = from; row < end; ++row) {
      if (at(row)[0] == kNothing) continue;
      const std::int64_t first = row;
      while (row < end && at(row)[0] != kNothing) ++row;
      runs.push_back(first);
      runs.push_back(row - first);
      for (std::size_t number = 0; number < numbers(); ++number) {
        std::int64_t before = 0, before_that = 0;
        for (std::int64_t k = first; k < row; ++k) {
          const std::int64_t value = at(k)[number];
          append_number(bytes, value - 2 * before + before_that);
          before_that = before;
          before = value;
        }
      }
    }
    if (!runs.empty()) agents.push_back({{"id", agent}, {"runs", std::move(runs)}});
  }
  nlohmann::ordered_json json = {{"bits", bits_}};
  if (headings_) json["headings"] = true;
  json["agents"] = std::move(agents);
  json["data"] = base64(bytes);
  return json;
}

}  // namespace ergocast
