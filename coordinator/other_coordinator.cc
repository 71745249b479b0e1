// SPDX-License-Identifier: BSD-3-Clause
// Judges by the newest TEAM_STATUS, and by the revisions that the world names.
#include "coordinator/other_coordinator.h"

#include <algorithm>

namespace ergocast {

bool OtherCoordinator::alive(const SignsOfLife& signs) const {
  return status_ && !signs.silent({kCoordinator, status_->header.incarnation});
}

bool OtherCoordinator::alive_as(Incarnation incarnation, const SignsOfLife& signs) const {
  return alive(signs) && status_->header.incarnation == incarnation;
}

bool OtherCoordinator::leads(const SignsOfLife& signs) const {
  if (!alive(signs)) return false;
  const MissionState state = status_->state;
  const bool leading = state == MissionState::kWaiting || state == MissionState::kRunning;
  return leading && (signs.me.run() == 0 || status_->header.run == signs.me.run());
}

std::string OtherCoordinator::why_not_ours() const {
  return "run " + to_hex(status_->header.run) + " is led by the coordinator on " + status_->host +
         ": leave it to that one, choose another URL, or take the mission over with --resume";
}

void OtherCoordinator::note_world(std::int64_t revision, std::int64_t own, Instant now) {
  if (revision <= own) return;
  newest_of_world_ = std::max(newest_of_world_, revision);
  if (!newer_since_) newer_since_ = now;
}

std::optional<std::int64_t> OtherCoordinator::revision_to_exceed(std::int64_t own,
                                                                 const SignsOfLife& signs) {
  if (newest_of_world_ <= own) {
    newer_since_.reset();
    return std::nullopt;
  }
  if (alive(signs) || signs.now - *newer_since_ <= silence_of(kCoordinator)) return std::nullopt;
  newer_since_.reset();
  return newest_of_world_;
}

}  // namespace ergocast
