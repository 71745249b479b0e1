// SPDX-License-Identifier: BSD-3-Clause
// Keeps the operator with control, each operator's last number, and the newest orders.
#include "cli/operate/control_desk.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/operate/amend_order.h"
#include "cli/operate/pause_order.h"
#include "cli/operate/recall_order.h"
#include "cli/operate/stop_order.h"
#include "core/mission/zones.h"

namespace ergocast::cli {
namespace {

using State = OrderReport::State;

constexpr std::chrono::seconds kSecond{1};

/// No page has this number: the act was given elsewhere.
constexpr std::uint32_t kElsewhere = 0;
constexpr const char* kOnAnotherPage = ", on another page or by a command";

std::string called(const ControlRequest& request) {
  return request.name.empty() ? "an operator without a name" : request.name;
}

/// "pause", "agent 2 home".
std::string what(const ControlRequest& request) {
  switch (request.act) {
    case ControlAct::kStopNow:
      return "stop now";
    case ControlAct::kHome:
      return "agent " + std::to_string(request.agent) + " home";
    case ControlAct::kOut:
      return "agent " + std::to_string(request.agent) + " out of the mission";
    case ControlAct::kTarget:
      return "new target";
    case ControlAct::kZone:
      return "new zone";
    case ControlAct::kReopen:
      return "cancel zone " + std::to_string(request.amendment);
    case ControlAct::kTake:
      return "take control";
    case ControlAct::kRelease:
      return "give control back";
    default:
      return to_string(request.act);
  }
}

const char* word_of(State state) {
  constexpr const char* kWords[] = {"sent", "answered", "obeyed", "done", "failed"};
  return kWords[static_cast<int>(state)];
}

bool pauses_or_resumes(ControlAct act) {
  return act == ControlAct::kPause || act == ControlAct::kResume;
}

bool is_drawn(ControlAct act) { return act == ControlAct::kTarget || act == ControlAct::kZone; }

bool amends(ControlAct act) { return is_drawn(act) || act == ControlAct::kReopen; }

bool recalls(ControlAct act) { return act == ControlAct::kHome || act == ControlAct::kOut; }

bool needs_number(ControlAct act) {
  return act != ControlAct::kStopNow && act != ControlAct::kHere;
}

/// Why `ergocast amend --cancel` would not end this zone; nothing if it would.
std::optional<std::string> why_not_cancelled(const MonitoredRun& team, std::int32_t zone) {
  if (!team.knows_mission()) return "the mission is not known yet: give the order again";
  const auto wish = wish_to_cancel(team, zone);
  if (!wish) return wish.error();
  if (wish->kind != AmendmentKind::kReopen)
    return "amendment " + std::to_string(zone) + " is no zone: use ergocast amend --cancel";
  return std::nullopt;
}

bool are_one(const ControlRequest& one, const ControlRequest& other) {
  return one.operator_id == other.operator_id && one.number == other.number && one.act == other.act;
}

}  // namespace

bool ControlDesk::Numbers::is_new(const ControlRequest& request) {
  const auto known = std::find_if(last.begin(), last.end(), [&request](const auto& one) {
    return one.first == request.operator_id;
  });
  if (known == last.end()) {
    if (last.size() == kMost) last.pop_front();
    last.emplace_back(request.operator_id, request.number);
    return true;
  }
  if (request.number <= known->second) return false;
  known->second = request.number;
  return true;
}

// ---- requests ----

void ControlDesk::receive(const ControlRequest& request, const MonitoredRun& team, Instant now) {
  if (needs_number(request.act) && !numbers_.is_new(request)) {
    if (!is_answered(request))
      refuse(request, "a later request of this page came first: give the order again");
    return;
  }
  if (const auto why = why_refused(request, team, now)) {
    // The sign that a browser is still there is no order.
    if (request.act == ControlAct::kHere) return;
    refuse(request, *why);
    if (over_rate_ <= 1)
      note(called(request) + " asks for: " + what(request) + ": refused: " + *why);
    return;
  }
  if (is_held_by(request)) operator_->last_sign = now;
  if (request.act == ControlAct::kHere) return;
  if (request.act == ControlAct::kTake || request.act == ControlAct::kRelease)
    return change_operator(request, team, now);
  give(request, team, now);
}

void ControlDesk::receive_late(const ControlRequest& request, const MonitoredRun& team,
                               Instant now) {
  if (request.act == ControlAct::kStopNow) return receive(request, team, now);
  if (request.act == ControlAct::kHere) return;
  if (numbers_.is_new(request))
    refuse(request, "the process that gives the orders has slept: give the order again");
}

/// Whether the state has the answer to an earlier copy of a request.
bool ControlDesk::is_answered(const ControlRequest& request) const {
  if (request.act == ControlAct::kTake && is_held_by(request)) return true;
  if (request.act == ControlAct::kRelease && !is_held_by(request)) return true;
  return std::ranges::any_of(
             acts_, [&request](const Act& act) { return are_one(act.request, request); }) ||
         std::ranges::any_of(refused_,
                             [&request](const auto& one) { return are_one(one.first, request); });
}

void ControlDesk::refuse(const ControlRequest& request, std::string why) {
  if (refused_.size() == kMostRefused) refused_.pop_front();
  refused_.emplace_back(request, std::move(why));
}

std::optional<std::string> ControlDesk::why_refused(const ControlRequest& request,
                                                    const MonitoredRun& team, Instant now) {
  if (request.act == ControlAct::kStopNow) return std::nullopt;
  if (!within_rate(now)) return "too many requests in a second";
  if (request.act != ControlAct::kTake && !is_held_by(request)) {
    return operator_ ? operator_->name + " has control now" : "no operator has control: take it";
  }
  if (request.act == ControlAct::kHere || request.act == ControlAct::kRelease) return std::nullopt;
  if (!window_.admits(request.tick))
    return "the page has shown nothing new for several seconds: look at the team again";
  if (!window_.foresees(request.tick))
    return "the page names a tick that the team has not reached: reload it";
  if (request.act == ControlAct::kTake) return std::nullopt;
  if (team.unheard()) return "no message of the team arrives";
  if (amends(request.act)) return why_not_amended(request, team);
  const auto unanswered = std::ranges::count_if(
      acts_, [](const Act& act) { return !act.over() && act.report.state < State::kObeyed; });
  if (recalls(request.act) && unanswered >= static_cast<std::ptrdiff_t>(kMostActs))
    return "too many orders wait for an answer";
  return std::nullopt;
}

/// Two amendments at the same time would take the same number, and one of them would fail.
std::optional<std::string> ControlDesk::why_not_amended(const ControlRequest& request,
                                                        const MonitoredRun& team) const {
  const ControlAct wanted = request.act;
  if (is_replaced_in_vain(request))
    return "an earlier drawing has arrived: see what becomes of it, then send this "
           "one if it is still wanted";
  std::size_t zones = 0;
  for (const Act& act : acts_) {
    if (act.over() || !amends(act.request.act)) continue;
    if (act.request.act == ControlAct::kTarget && wanted == ControlAct::kTarget)
      return "the last new target does not hold yet: send this one then";
    if (act.report.state < State::kAnswered)
      return "the last amendment has no answer yet: send this one then";
    zones += act.request.act == ControlAct::kZone ? 1 : 0;
  }
  if (wanted == ControlAct::kZone && zones >= kMaxZones)
    return "agents still leave " + std::to_string(zones) + " zones: send this one then";
  return wanted == ControlAct::kReopen ? why_not_cancelled(team, request.amendment) : std::nullopt;
}

/// Whether an earlier state of the same drawing has become an order that may still be obeyed.
bool ControlDesk::is_replaced_in_vain(const ControlRequest& request) const {
  return request.instead_of > 0 && std::ranges::any_of(acts_, [&request](const Act& act) {
           return act.request.operator_id == request.operator_id &&
                  act.request.act == request.act && act.request.number >= request.instead_of &&
                  act.report.state != State::kFailed;
         });
}

bool ControlDesk::within_rate(Instant now) {
  if (now - second_ >= kSecond) {
    if (over_rate_ > 1)
      note(std::to_string(over_rate_) + " requests were refused: too many in a second");
    second_ = now;
    in_this_second_ = over_rate_ = 0;
  }
  if (in_this_second_ < kMostInASecond) {
    ++in_this_second_;
    return true;
  }
  ++over_rate_;
  return false;
}

bool ControlDesk::is_held_by(const ControlRequest& request) const {
  return operator_ && operator_->id == request.operator_id;
}

void ControlDesk::change_operator(const ControlRequest& request, const MonitoredRun& team,
                                  Instant now) {
  const std::string when = " at " + team.mission_time(team.tick());
  if (request.act == ControlAct::kRelease) {
    note(called(request) + " gives control back" + when);
    operator_.reset();
    return;
  }
  const bool other = operator_ && !is_held_by(request);
  if (!operator_ || other)
    note(called(request) + " takes control" + (other ? " from " + operator_->name : "") + when);
  operator_ = {request.operator_id, called(request), now};
}

// ---- orders ----

void ControlDesk::give(const ControlRequest& request, const MonitoredRun& team, Instant now) {
  const bool is_known = std::ranges::any_of(acts_, [&request](const Act& act) {
    const bool stands = act.request.act == ControlAct::kStopNow && act.report.state == State::kDone;
    // A page repeats a stop at once, under its number, until it sees the answer.
    return (!act.over() || stands || are_one(act.request, request)) &&
           act.request.act == request.act && act.request.agent == request.agent;
  });
  if (is_known && !amends(request.act)) {
    if (request.act != ControlAct::kStopNow) refuse(request, "it is being carried out already");
    return;
  }
  end_contradicted(request);
  make_room();
  note(called(request) + " asks for: " + what(request) + ", at " + team.mission_time(team.tick()));
  acts_.push_back(
      {request, what(request), team.mission_time(team.tick()), order_for(request, team, now)});
}

/// A change is ours if one of our orders of its kind and operator has not been named yet. A
/// recall has no operator in MISSION.
void ControlDesk::note_changes(const MonitoredRun& team) {
  for (NamedChange& change : changes_.take(team)) {
    const auto ours = std::ranges::find_if(acts_, [&change](const Act& act) {
      return !act.named && !act.report.ended() && act.request.act != ControlAct::kStopNow &&
             to_string(act.request.act) == change.act && act.request.agent == change.agent &&
             (recalls(act.request.act) || change.by == operator_name_of(called(act.request)));
    });
    if (ours != acts_.end()) {
      ours->named = true;
      continue;
    }
    const std::string by = (change.by.empty() ? "another operator" : change.by) + kOnAnotherPage;
    note(change.what + " by " + by + ": " + change.text);
    make_room();
    ControlRequest request{.operator_id = kElsewhere, .name = by, .number = ++elsewhere_};
    acts_.push_back({std::move(request),
                     std::move(change.what),
                     team.mission_time(team.tick()),
                     nullptr,
                     {State::kDone, std::move(change.text)},
                     true});
  }
}

/// Removes the oldest order that has ended, if there are too many. If none has, an agent on its way
/// home needs no more messages.
void ControlDesk::make_room() {
  if (acts_.size() < kMostActs) return;
  auto oldest = std::ranges::find_if(acts_, [](const Act& act) { return act.over(); });
  if (oldest == acts_.end()) {
    oldest = std::ranges::find_if(acts_, [](const Act& act) {
      return recalls(act.request.act) && act.report.state == State::kObeyed;
    });
    if (oldest != acts_.end()) note_end(*oldest, "");
  }
  if (oldest != acts_.end()) acts_.erase(oldest);
}

void ControlDesk::note_end(const Act& act, const std::string& then) {
  note(act.what + " of " + called(act.request) + ", asked for at " + act.at + ": " +
       act.report.text + then);
}

void ControlDesk::wake(Instant now) {
  if (operator_) operator_->last_sign = now;
  note("this process has slept: requests that came meanwhile do not count");
}

std::unique_ptr<Order> ControlDesk::order_for(const ControlRequest& request,
                                              const MonitoredRun& team, Instant now) const {
  const auto stop = [&](bool at_once) {
    return std::make_unique<StopOrder>(
        team.run(), at_once,
        std::string(at_once ? "stopped at once by " : "stopped by ") + called(request) +
            " on the page of " + host_,
        keyed_, now);
  };
  const std::string by = operator_name_of(called(request));
  switch (request.act) {
    case ControlAct::kPause:
      return std::make_unique<PauseOrder>(true, now, by);
    case ControlAct::kResume:
      return std::make_unique<PauseOrder>(false, now, by);
    case ControlAct::kStop:
      return stop(false);
    case ControlAct::kStopNow:
      return stop(true);
    case ControlAct::kHome:
    case ControlAct::kOut:
      return std::make_unique<RecallOrder>(request.agent, request.act == ControlAct::kOut, now);
    case ControlAct::kTarget:
    case ControlAct::kZone:
      return amend_with_(request, by);
    case ControlAct::kReopen:
      return std::make_unique<AmendOrder>(wish_of_reopening(request.amendment), 0, now, by);
    default:
      return nullptr;
  }
}

/// A resumption ends a pause that still waits for robots to stand, and a pause ends a resumption.
/// So do Home and Out of one agent.
void ControlDesk::end_contradicted(const ControlRequest& request) {
  for (Act& act : acts_) {
    const bool of_one_kind =
        (pauses_or_resumes(act.request.act) && pauses_or_resumes(request.act)) ||
        (recalls(act.request.act) && recalls(request.act) && act.request.agent == request.agent);
    if (act.over() || !of_one_kind || act.request.act == request.act) continue;
    note_end(act, "; then " + called(request) + " asks for: " + what(request));
    act.order.reset();
  }
}

void ControlDesk::advance(const MonitoredRun& team, Instant now, Outbox& out) {
  window_.note(team.tick(), true, now);
  if (operator_ && now - operator_->last_sign > kSilence) {
    note(operator_->name + " loses control at " + team.mission_time(team.tick()) +
         ": the browser has been silent for " + std::to_string(kSilence.count()) + " s");
    operator_.reset();
  }
  note_changes(team);
  for (Act& act : acts_) {
    if (act.over()) continue;
    act.order->send(team, now, out);
    act.report = act.order->report(team, now);
    if (!act.report.ended()) continue;
    note_end(act, "");
    act.order.reset();
  }
}

void ControlDesk::end(const MonitoredRun& team, Instant now) {
  for (Act& act : acts_) {
    if (act.over()) continue;
    act.report = act.order->report_at_end(team, now);
    note_end(act, "");
    act.order.reset();
  }
  operator_.reset();
  ended_ = true;
}

bool ControlDesk::is_settled() const {
  return std::ranges::all_of(acts_, [](const Act& act) { return act.over(); });
}

nlohmann::ordered_json ControlDesk::state() const {
  using Json = nlohmann::ordered_json;
  Json state;
  if (ended_) state["over"] = true;  // the first key, as kControlOver has it
  state["operator"] =
      operator_ ? Json{{"id", operator_->id}, {"name", operator_->name}} : Json(nullptr);
  Json acts = Json::array();
  for (const Act& act : acts_) {
    acts.push_back({{"operator", act.request.operator_id},
                    {"name", called(act.request)},
                    {"number", act.request.number},
                    {"what", act.what},
                    {"at", act.at},
                    {"over", act.over()},
                    {"state", word_of(act.report.state)},
                    {"text", act.report.text}});
  }
  state["acts"] = std::move(acts);
  Json refused = Json::array();
  for (const auto& [request, why] : refused_)
    refused.push_back({{"operator", request.operator_id},
                       {"number", request.number},
                       {"what", what(request)},
                       {"text", why}});
  state["refused"] = std::move(refused);
  return state;
}

}  // namespace ergocast::cli
