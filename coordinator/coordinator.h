// SPDX-License-Identifier: BSD-3-Clause
// Admits agents, distributes the mission, starts, monitors and ends it. It never steers.
//
// It repeats its whole state once a second; a large state is repeated in turn. So none of its
// messages needs an acknowledgement. A restarted coordinator takes the mission over from the
// agents, which repeat it on request.
//
// The class passes messages and time on to its parts. Each part decides one matter, and has a
// header of its own. Parts get what they need of others as arguments.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/admission.h"
#include "coordinator/amending.h"
#include "coordinator/announcement.h"
#include "coordinator/members.h"
#include "coordinator/mission_end.h"
#include "coordinator/other_coordinator.h"
#include "coordinator/silence_watch.h"
#include "coordinator/takeover.h"
#include "coordinator/team_places.h"
#include "coordinator/tick_watch.h"
#include "core/base/ids.h"
#include "core/mission/amendments.h"
#include "core/mission/mission.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

/// The state of a present or former member of the roster.
enum class MemberState { kAlive, kSilent, kGone };
const char* to_string(MemberState member_state);

struct CoordinatorIdentity {
  /// The run of its mission. 0: the run that it finds, or `incarnation` if it finds none. With
  /// kNever it is not 0.
  RunId run = 0;
  Incarnation incarnation = 0;
  std::string host;
  std::string version;
};

class Coordinator {
 public:
  static constexpr Role kRole = Role::kCoordinator;

  /// @param plan  the encoded plan; may be empty with kMust, which accepts any mission
  Coordinator(CoordinatorIdentity identity, std::vector<std::byte> plan,
              Takeover takeover = Takeover::kNever);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;

  /// Ends the mission in order; `failed` makes it a failure with that reason.
  void end(bool failed, std::string reason, Instant now);

  /// Plans amendments of the mission from its beginning on. A simulation repeats a
  /// recorded mission in this way.
  /// @pre are_amendments(list), and it has not advanced
  void plan_amendments(Amendments list) { amending_.plan(std::move(list)); }
  const Amendments& amendments() const { return amending_.list(); }
  const std::vector<Hold>& holds() const { return amendments().holds; }
  /// Whether the newest tick that it knows is held.
  bool paused() const { return is_held(holds(), tick()); }

  /// True once all others have reported that they leave, or the end has been repeated for 1 s.
  bool finished() const { return ending_.finished(); }
  RunId run() const { return me_.run(); }
  /// Null until it has a mission; a takeover needs a moment to find one.
  const Mission* mission() const { return mission_ ? &*mission_ : nullptr; }
  /// Whether it still searches for a mission to take over.
  bool looking() const { return search_.looking(); }
  /// Whether it took the mission over from a predecessor.
  bool took_over() const { return taken_over_; }
  /// Whether it has finished without ending the mission: another coordinator leads the mission, or
  /// the mission cannot be taken over. reason() has which.
  bool left() const { return ending_.left(); }
  MissionState state() const { return state_; }
  const std::string& reason() const { return ending_.reason(); }
  const std::vector<RosterEntry>& roster() const { return members_.roster(); }
  MemberState member_state(const RosterEntry& entry, Instant now) const;
  /// Hosts and versions of agents that were refused because their version differs from ours.
  const std::set<std::pair<std::string, std::string>>& version_mismatches() const {
    return admission_.version_mismatches();
  }
  /// Hosts of agents that were refused because the mission does not have their kind, and the
  /// sentence that says so.
  const std::set<std::pair<std::string, std::string>>& unknown_kinds() const {
    return admission_.unknown_kinds();
  }
  Tick tick() const { return ticks_.tick(); }
  /// The operator's commands that were refused because their ticks are old.
  std::int64_t late_commands() const { return me_.refused(Refusal::kLate); }

 private:
  template <class M>
  void on(const M&, const Arrival&) {}  // the other types need no action
  void on(const Hello& hello, const Arrival& arrival);
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const WorldState& world, const Arrival& arrival);
  void on(const RecordAck& ack, const Arrival& arrival);
  void on(const TeamStatus& theirs, const Arrival& arrival);
  void on(const Stop& stop, const Arrival& arrival);
  void on(const Amend& amend, const Arrival& arrival);
  void on(const Recall& recall, const Arrival& arrival);

  const Timing& timing() const { return mission_->timing; }
  Tick end_tick() const { return tick_after(holds(), tick_count()); }
  Tick tick_count() const { return tick_count_of(timing(), amendments().ends); }
  Amending::Team team_at(const SignsOfLife& signs) const {
    return {signs, places_, members_.roster()};
  }
  SignsOfLife signs_at(Instant now) const { return {me_, now}; }

  bool learns_run(const Message& message);
  void look_for_mission(Instant now, Outbox& out);
  void take_over(Instant now);
  void begin_own();
  void leave(std::string reason, Instant now);

  void lead(Instant now, Outbox& out);
  void admit(const Newcomer& newcomer, Instant now);
  void check_admission(Instant now);
  void check_tick(Instant now);
  void start_with_quorum(Instant now);
  void publish_due(Instant now, Outbox& out);
  void publish_mission(Outbox& out);
  void publish_team_status(Instant now, Outbox& out);

  Participant me_;
  std::string host_;
  std::vector<std::byte> plan_;     // as encoded
  std::optional<Mission> mission_;  // the one that it leads or will lead
  MissionState state_ = MissionState::kWaiting;
  bool taken_over_ = false;
  MissionSearch search_;
  OtherCoordinator other_coordinator_;
  Members members_;
  Admission admission_;
  TickWatch ticks_;
  CoverageReview coverage_review_;
  TeamPlaces places_;
  ObjectSet found_ = 0;  // as world and logger have reported
  Amending amending_;
  MissionEnd ending_;
  Announcement announcement_;
  std::optional<Instant> leads_since_;
  Instant next_team_status_{};
};

}  // namespace ergocast
