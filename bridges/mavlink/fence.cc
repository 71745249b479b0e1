// SPDX-License-Identifier: BSD-3-Clause
// The numbers of commands, frames and results are those of mavlink.io.
#include "bridges/mavlink/fence.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>

namespace ergocast::mavlink {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kStayIn = 5001, kStayOut = 5002;  // MAV_CMD_NAV_FENCE_POLYGON_VERTEX_…
constexpr std::uint8_t kMissionAccepted = 0;
constexpr const char* kMissionResults[] = {"ACCEPTED",
                                           "ERROR",
                                           "UNSUPPORTED_FRAME",
                                           "UNSUPPORTED",
                                           "NO_SPACE",
                                           "INVALID",
                                           "INVALID_PARAM1",
                                           "INVALID_PARAM2",
                                           "INVALID_PARAM3",
                                           "INVALID_PARAM4",
                                           "INVALID_PARAM5_X",
                                           "INVALID_PARAM6_Y",
                                           "INVALID_PARAM7",
                                           "INVALID_SEQUENCE",
                                           "DENIED",
                                           "OPERATION_CANCELLED"};

constexpr auto kRepeat = 1s, kBeginAgain = 10s;
/// How often a message is sent before the autopilot counts as silent.
constexpr int kMostTries = 6;
/// Autopilots keep places in other units: so much may be lost [1e-7 degrees].
constexpr std::int64_t kRounding = 2;

std::int32_t degrees_e7(double degrees) {
  return static_cast<std::int32_t>(std::lround(degrees * 1e7));
}

void add(std::vector<MissionItemInt>& items, const EarthPlace& origin, const Ring& ring,
         std::uint16_t command) {
  for (const Eigen::Vector2d& corner_m : ring) {
    const EarthPlace place = place_at(origin, corner_m);
    MissionItemInt item;
    item.command = command;
    item.param1 = static_cast<float>(ring.size());
    item.x = degrees_e7(place.latitude_deg);
    item.y = degrees_e7(place.longitude_deg);
    item.seq = static_cast<std::uint16_t>(items.size());
    item.mission_type = Fence::kType;
    items.push_back(item);
  }
}

bool same(const MissionItemInt& one, const MissionItemInt& other) {
  const auto near = [](std::int64_t a, std::int64_t b) { return std::abs(a - b) <= kRounding; };
  return one.command == other.command && one.param1 == other.param1 && near(one.x, other.x) &&
         near(one.y, other.y);
}

}  // namespace

Result<std::vector<MissionItemInt>> fence_items(const EarthPlace& origin, const Box& domain,
                                                double margin_m, const IndexedRings& walls) {
  const Eigen::Vector2d margin(margin_m, margin_m);
  const Eigen::Vector2d low = domain.origin_m.head<2>() - margin;
  const Eigen::Vector2d high = domain.origin_m.head<2>() + domain.size_m.head<2>() + margin;
  const auto around = depths(walls);
  if (std::ranges::any_of(around, [](auto depth) { return depth > 0; }))
    return failure(
        "a wall has a room, and an autopilot knows no polygon within a polygon: leave out --fence");
  std::vector<MissionItemInt> items;
  add(items, origin, {low, {high.x(), low.y()}, high, {low.x(), high.y()}}, kStayIn);
  for (const Ring& ring : walls) add(items, origin, ring, kStayOut);
  return items;
}

void Fence::begin(std::vector<MissionItemInt> items) {
  items_ = std::move(items);
  phase_ = Phase::kBegins;
}

void Fence::begin_anew() {
  if (phase_ != Phase::kNone) phase_ = Phase::kBegins;
}

void Fence::send(const Packet& packet, Instant now) {
  last_ = packet;
  tries_ = 1;
  next_ = now + kRepeat;
  out_.push_back(packet);
}

void Fence::fail(std::string problem, Instant now) {
  phase_ = Phase::kFailed;
  next_ = now + kBeginAgain;
  problem_ = std::move(problem);
}

void Fence::give(std::size_t seq, Instant now) {
  if (phase_ != Phase::kUploads) return;
  if (seq >= items_.size())
    return fail("the autopilot asks for an item that it does not have", now);
  // A request that was overtaken is answered, but the newest item is the one to repeat.
  if (seq + 1 < given_) return out_.push_back(items_[seq]);
  given_ = seq + 1;
  send(items_[seq], now);
}

void Fence::receive(const MissionAck& ack, Instant now) {
  if (ack.mission_type != kType || (phase_ != Phase::kUploads && phase_ != Phase::kChecks)) return;
  if (ack.type != kMissionAccepted) {
    const std::string result = ack.type < std::size(kMissionResults) ? kMissionResults[ack.type]
                                                                     : std::to_string(ack.type);
    return fail("the autopilot refuses it: " + result, now);
  }
  if (phase_ == Phase::kChecks || given_ < items_.size()) return;  // of an upload before
  phase_ = Phase::kChecks;
  read_ = 0;
  MissionRequestList question;
  question.mission_type = kType;
  send(question, now);
}

void Fence::receive(const MissionCount& count, Instant now) {
  if (phase_ != Phase::kChecks || count.mission_type != kType || read_ > 0) return;
  if (count.count != items_.size())
    return fail("the autopilot has " + std::to_string(count.count) + " of its " +
                    std::to_string(items_.size()) + " items",
                now);
  MissionRequestInt question;
  question.mission_type = kType;
  send(question, now);
}

void Fence::receive(const MissionItemInt& item, Instant now) {
  const bool awaited = std::holds_alternative<MissionRequestInt>(last_);
  if (phase_ != Phase::kChecks || item.mission_type != kType || !awaited || item.seq != read_)
    return;
  if (!same(item, items_[read_]))
    return fail("the autopilot has another item " + std::to_string(read_) + " than was sent", now);
  if (++read_ == items_.size()) {
    MissionAck end;
    end.mission_type = kType;
    out_.emplace_back(end);
    phase_ = Phase::kHolds;
    problem_.clear();
    return;
  }
  MissionRequestInt question;
  question.mission_type = kType;
  question.seq = static_cast<std::uint16_t>(read_);
  send(question, now);
}

void Fence::advance(Instant now, std::vector<Packet>& out) {
  const bool repeats = phase_ == Phase::kUploads || phase_ == Phase::kChecks;
  if (phase_ == Phase::kBegins || (phase_ == Phase::kFailed && now >= next_)) {
    phase_ = Phase::kUploads;
    given_ = 0;
    MissionCount count;
    count.count = static_cast<std::uint16_t>(items_.size());
    count.mission_type = kType;
    send(count, now);
  } else if (repeats && now >= next_) {
    if (++tries_ > kMostTries) {
      fail("the autopilot does not answer", now);
    } else {
      next_ = now + kRepeat;
      out_.push_back(last_);
    }
  }
  out.insert(out.end(), out_.begin(), out_.end());
  out_.clear();
}

std::string Fence::why_not() const {
  if (phase_ == Phase::kNone || phase_ == Phase::kHolds) return "";
  if (!problem_.empty()) return "has no fence: " + problem_;
  return "gives the autopilot its fence";
}

}  // namespace ergocast::mavlink
