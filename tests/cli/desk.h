// SPDX-License-Identifier: BSD-3-Clause
// A control desk for a team of two, and the requests of its operators.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/operate/control_desk.h"
#include "tests/support/team.h"

namespace ergocast::cli {

using namespace test;
using nlohmann::json;

class Desk : public ::testing::Test {
 protected:
  Desk() {
    Mission mission = small_mission(2);
    mission.timing.tick_count = 10'000;
    announce(mission);
    give(team_, mission_part(0, MissionState::kRunning, roster_of(2)), now_);
    move(100, 1);
  }
  /// The world's state: both vehicles at that speed.
  void move(Tick tick, double speed_mps) {
    WorldState state = world_state(tick, {{1, 1, 0}, {2, 2, 0}});
    for (Vehicle& vehicle : state.vehicles_in_part()) vehicle.velocity_mps = {speed_mps, 0, 0};
    give(team_, state, now_);
    advance();
  }
  void pause_from(Tick tick, const std::string& by = {}) {
    Amendments list = only_pauses({{tick, -1}});
    list.recent.back().by = by;
    name(list);
  }
  /// MISSION with this list.
  void name(const Amendments& list) {
    MissionPart part = mission_part(++revision_, MissionState::kRunning, roster_of(2));
    part.amendments = encode_amendments(list);
    part.content_hash = hash_of(part);
    give(team_, part, now_);
  }
  void ask(ControlAct act, std::uint32_t operator_id = 1, std::optional<Tick> tick = {}) {
    ControlRequest request;
    request.operator_id = operator_id;
    request.name = operator_id == 1 ? "anna" : "bert";
    request.number = ++numbers_;
    request.tick = tick.value_or(team_.tick());
    request.act = act;
    if (act == ControlAct::kTarget) {
      request.target.emplace();
      request.target->peaks = {{300, 400, 50, {}}};
      request.target->uniform = 0.5;
    }
    if (act == ControlAct::kZone) request.zone = {{{0, 0}, {4, 0}, {4, 4}}, 600, {}};
    ask(request);
  }
  void ask(const ControlRequest& request) {
    last_ = request;
    desk_.receive(request, team_, now_);
    advance();
  }
  /// Anna cancels a zone.
  void cancel(std::int32_t amendment) {
    ask({.operator_id = 1,
         .name = "anna",
         .number = ++numbers_,
         .tick = team_.tick(),
         .act = ControlAct::kReopen,
         .amendment = amendment});
  }
  /// Anna sends another state of a drawn zone.
  void send_instead_of(std::int64_t number) {
    ControlRequest changed = last_;
    changed.number = ++numbers_;
    changed.instead_of = number;
    ask(changed);
  }
  void advance() {
    sent_.clear();
    desk_.advance(team_, now_, sent_);
    for (std::string& line : desk_.take_lines()) lines_.push_back(std::move(line));
  }
  json state() const { return json::parse(desk_.state().dump()); }
  json operator_name() const { return state()["operator"]; }
  std::string refusal() const {
    const json refused = state()["refused"];
    return refused.empty() ? "" : refused.back()["text"].get<std::string>();
  }
  template <class M>
  int sent() const {
    return static_cast<int>(std::count_if(sent_.begin(), sent_.end(), [](const Outgoing& one) {
      return std::holds_alternative<M>(one.message);
    }));
  }

  /// An order whose report the test sets.
  struct Drawn final : Order {
    explicit Drawn(const OrderReport& reported) : now(reported) {}
    void send(const MonitoredRun&, Instant, Outbox&) override {}
    OrderReport report(const MonitoredRun&, Instant) const override { return now; }
    const OrderReport& now;
  };

  OrderReport drawn_report_;
  std::vector<std::string> drawn_;  // the texts of drawn targets and zones
  std::string drawn_by_;            // the operator of the last one
  Instant now_ = at(1s);
  MonitoredRun team_{kRun, at(0s)};
  ControlDesk desk_{
      "here", true, [this](const ControlRequest& request, const std::string& by) {
        drawn_.push_back(request.zone ? request.zone->text() : request.target->text());
        drawn_by_ = by;
        return std::make_unique<Drawn>(drawn_report_);
      }};
  Outbox sent_;
  std::vector<std::string> lines_;
  ControlRequest last_;
  std::int64_t numbers_ = 0, revision_ = 0;
};

}  // namespace ergocast::cli
