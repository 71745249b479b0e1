// SPDX-License-Identifier: BSD-3-Clause
// Divides the mission into parts, and sends those that PartSchedule names.
#include "coordinator/announcement.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <numeric>

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kMissionPeriod = 1s;
constexpr auto kMissionGap = 100ms;

/// How many parts a mission has.
std::size_t part_count(const MissionContent& mission) {
  const auto ceil_div = [](std::size_t a, std::size_t b) { return (a + b - 1) / b; };
  return std::max(
      {std::size_t{1},
       ceil_div(mission.plan.size() + mission.amendments.size(), kMaxPlanBytesPerMessage),
       ceil_div(mission.members.roster().size(), kMaxRosterEntriesPerMessage)});
}

/// The bytes from `first` on, at most `most`, as far as there are any.
std::vector<std::byte> share(std::span<const std::byte> bytes, std::size_t first,
                             std::size_t most) {
  const auto rest = bytes.subspan(std::min(first, bytes.size()));
  const auto taken = rest.first(std::min(most, rest.size()));
  return {taken.begin(), taken.end()};
}

}  // namespace

void Announcement::note_silence() {
  ++revision_;
  next_ = Instant{};
}

void Announcement::note_admission() {
  ++revision_;
  next_ = Instant{};
  who_may_join_ = revision_;
}

void Announcement::change() {
  note_admission();
  admits_from_ = revision_;
}

void Announcement::exceed(std::int64_t revision) {
  revision_ = revision;
  change();
}

void Announcement::continue_from(std::int64_t revision) {
  revision_ = revision;
  who_may_join_ = revision;
}

void Announcement::repeat_soon() { next_ = std::min(next_, last_ + kMissionGap); }

void Announcement::plan_next(bool over, Instant now) {
  last_ = now;
  next_ = now + (over || schedule_.behind() ? kMissionGap : kMissionPeriod);
}

std::vector<MissionPart> Announcement::parts_of(const MissionContent& mission) const {
  const std::size_t parts = part_count(mission);
  std::vector<MissionPart> whole(parts);
  for (std::size_t p = 0; p < parts; ++p) {
    MissionPart& part = whole[p];
    part.revision = revision_;
    part.state = mission.state;
    part.part = static_cast<std::int32_t>(p);
    part.parts = static_cast<std::int32_t>(parts);
    part.reason = mission.reason;
    part.stand_by_revision = mission.stand_by_revision;
    // The list follows the plan, so an amendment changes no part of the plan but the last.
    const std::size_t first = p * kMaxPlanBytesPerMessage, size = mission.plan.size();
    part.plan = share(mission.plan, first, kMaxPlanBytesPerMessage);
    part.amendments = share(mission.amendments, std::max(first, size) - size,
                            kMaxPlanBytesPerMessage - part.plan.size());
  }
  // Entries stay in the order of admission, so that a newcomer changes only one part.
  for (const RosterEntry& entry : mission.members.roster()) {
    const std::size_t place = mission.members.at(entry.author).place;
    whole[place / kMaxRosterEntriesPerMessage].roster.push_back(entry);
  }
  return whole;
}

void Announcement::publish(const MissionContent& mission, Participant& me, Tick tick, Outbox& out) {
  admits_from_ = who_may_join_;
  std::vector<MissionPart> parts = parts_of(mission);
  std::vector<std::uint64_t> hashes;
  std::transform(parts.begin(), parts.end(), std::back_inserter(hashes), hash_of);
  const std::uint64_t sum = std::accumulate(hashes.begin(), hashes.end(), std::uint64_t{0});
  for (const std::size_t p : schedule_.next(hashes)) {
    parts[p].content_hash = sum;
    for (const Bus bus : {Bus::kSwarm, Bus::kCommand}) me.publish(bus, parts[p], tick, out);
  }
}

}  // namespace ergocast
