// SPDX-License-Identifier: BSD-3-Clause
// Missions whose target changes in flight: their simulation repeats them bit for bit.
#include <algorithm>
#include <optional>

#include "core/basis/basis.h"
#include "core/mission/amendments.h"
#include "plan/amendment_list.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/transport.h"
#include "team/amend_parts.h"
#include "team/mission_follower.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

/// Sends AMEND on the buses of a mission, as `ergocast` does.
class Amender {
 public:
  explicit Amender(const std::string& url)
      : transport_(
            Transport::open(
                LcmUrl::parse(url).value(), 0, {}, {kTypes<MissionPart>, 0, kTypes<RecordAck>},
                {.on_message = [this](const Message& message, Bus, AgentId) { receive(message); }})
                .value()) {}

  /// Waits for the mission.
  const Mission* mission() {
    const bool known = eventually([this] { return follower_.mission().has_value(); }, listen);
    return known ? &*follower_.mission() : nullptr;
  }
  /// Has the team cover another target. Returns the tick from which it holds; nothing if the
  /// coordinator never names it.
  std::optional<Tick> change(const TargetChange& target) {
    const std::vector<std::byte> content = encode_target(target);
    const auto& recent = follower_.amendments().recent;
    const auto ours = [&] {
      return std::ranges::find(recent, target_hash(target), &Amendment::hash);
    };
    const bool named = eventually([&] { return ours() != recent.end(); },
                                  [&] {
                                    send(follower_.amendments().named, content);
                                    listen();
                                  });
    if (!named) return std::nullopt;
    return ours()->from;
  }

 private:
  void receive(const Message& message) {
    if (const auto* part = std::get_if<MissionPart>(&message)) {
      run_ = part->header.run;
      follower_.receive(*part);
    }
    tick_ = std::max(tick_, header_of(message).tick);
  }
  void send(std::int32_t number, const std::vector<std::byte>& content) {
    const Amend wish{.header = {run_, kOperator, 77, ++sequence_, tick_},
                     .number = number,
                     .kind = AmendmentKind::kTarget};
    for (const Amend& part : in_parts(wish, content)) {
      sequence_ = part.header.sequence;
      transport_->publish({Bus::kSwarm, part});
    }
  }

  std::function<void()> listen = [this] {
    transport_->deliver_until(now() + std::chrono::milliseconds(50), -1);
  };
  std::unique_ptr<Transport> transport_;
  MissionFollower follower_;
  RunId run_ = 0;
  Tick tick_ = 0;
  std::int64_t sequence_ = 0;
};

/// The plan's target, mirrored along x, y or both.
TargetChange mirrored(const Mission& mission, bool along_x, bool along_y) {
  TargetChange change;
  change.target = mission.target_coefficients;
  for (int m = 0; m < mission.basis.modes_x; ++m)
    for (int n = 0; n < mission.basis.modes_y; ++n)
      if ((along_x && m % 2 == 1) != (along_y && n % 2 == 1))
        change.target[m * mission.basis.modes_y + n] *= -1;
  return change;
}

class ChangedTargets : public RunningMission {
 protected:
  /// A whole mission in lockstep in which the target changes four times.
  void fly(const std::function<void(int)>& between, const std::string& law = "") {
    // The scenario's own target is its mirror image.
    const auto file = scenario();
    std::string text = text_of(file);
    const std::string first = "mean_x_m: 500   mean_y_m: 500";
    ASSERT_NE(text.find(first), text.npos);
    text.replace(text.find(first), first.size(), "mean_x_m: 300   mean_y_m: 700");
    text.insert(text.find("law {") + 5, " " + law);
    std::ofstream(file) << text;
    Child mission = launch_endless(file, {"--lcm-url", kUrl});
    Amender amender(kUrl);
    const Mission* const plan = amender.mission();
    ASSERT_NE(plan, nullptr) << printed();
    plan_ = *plan;
    for (int i = 0; i < 4; ++i) {
      const auto from = amender.change(mirrored(plan_, i % 2 == 0, i / 2 == 0));
      ASSERT_TRUE(from) << printed();
      from_.push_back(*from);
      between(i);
      ASSERT_TRUE(moves_on());
    }
    ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
    ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  }

  Mission plan_;
  std::vector<Tick> from_;
};

TEST_F(ChangedTargets, AreRepeatedBySimulationWhateverProcessesStop) {
  fly([this](int i) {
    if (i == 0) {
      ASSERT_EQ(ergocast({"pause", "--lcm-url", kUrl}), 0) << output();
      ASSERT_EQ(ergocast({"resume", "--lcm-url", kUrl}), 0) << output();
    }
    if (i == 1) kill_next({"ergocast-logger"});
    if (i == 2) kill_next({"ergocast-coordinator"});
  });
  if (HasFatalFailure()) return;
  const auto amendments = summary()["amendments"];
  ASSERT_EQ(amendments.size(), 6U);
  EXPECT_EQ(amendments[0]["from_tick"], from_[0]);
  EXPECT_EQ(amendments[5]["from_tick"], from_[3]);
  const auto targets = summary()["targets"];
  ASSERT_EQ(targets.size(), 5U) << "the plan's, and four";
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(targets[i]["until_tick"], from_[i]);
    EXPECT_EQ(targets[i + 1]["from_tick"], from_[i]);
    EXPECT_GT(targets[i]["ergodic_metric"].get<double>(), 0);
  }
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(answered("identical to its simulation")) << output();
  for (const char* format : {"csv", "mcap"})
    EXPECT_EQ(ergocast({"export", out(), "--to", format}), 0) << output();

  const auto file = out() / "amendments.json";
  const std::string text = text_of(file);
  const auto without_targets = [&] {
    std::filesystem::remove(file);
    return ergocast({"verify", out()});
  };
  EXPECT_EQ(without_targets(), 2);
  EXPECT_TRUE(answered("amendments.json is missing")) << output();
  auto changed = nlohmann::ordered_json::parse(text);
  auto& last = changed["amendments"][5];
  last["target"] = changed["amendments"][0]["target"];
  std::ofstream(file) << changed.dump();
  EXPECT_EQ(ergocast({"verify", out()}), 2);
  EXPECT_TRUE(answered("its target has another hash")) << output();
  last["hash"] = changed["amendments"][0]["hash"];
  std::ofstream(file) << changed.dump();
  EXPECT_EQ(ergocast({"verify", out()}), 1) << output();
  EXPECT_TRUE(answered("differs from its simulation, first at")) << output();
}

TEST_F(ChangedTargets, AreRepeatedBySimulationWhereTheTeamForgets) {
  fly(
      [this](int i) {
        if (i == 1) kill_next({"ergocast-logger"});
      },
      "memory_half_life_s: 1.3");
  if (HasFatalFailure()) return;
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(answered("identical to its simulation")) << output();
}

TEST_F(ChangedTargets, AreComparedWithAllTimeWhereTheHistoryIsKept) {
  fly([](int) {}, "history: KEEP");
  if (HasFatalFailure()) return;
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(answered("identical to its simulation")) << output();
  // The last target is the plan's, mirrored along neither axis.
  Coefficients c = Coefficients::Zero(plan_.basis.mode_count());
  double samples = 0;
  const RecordedRows rows = recorded_rows(out());
  const Tick until = rows.rbegin()->first / 10 * 10;  // φ² is that of the last whole second
  for (const auto& [tick, row] : rows) {
    for (const auto& [id, one] : row) {
      if (tick > until) continue;
      c += basis_values({one.x_m, one.y_m, 0}, plan_.domain, plan_.basis);
      ++samples;
    }
  }
  const double metric = ergodic_metric(c / samples, plan_.target_coefficients,
                                       sobolev_weights(plan_.basis, plan_.domain));
  const double recorded = summary()["ergodic_metric"]["last"];
  EXPECT_NEAR(recorded / metric, 1, 1e-6);
}

}  // namespace
}  // namespace ergocast::test
