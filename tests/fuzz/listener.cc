// SPDX-License-Identifier: BSD-3-Clause
// One core that only receives messages of an attacker with its run id: it does not crash, has no
// impossible state, and sends no message that would be refused.
//
// The first byte of the input is Features, the second selects the core.
#include <sstream>

#include "cli/team/team_text.h"
#include "lcmtypes/codec.h"
#include "plan/plan.h"
#include "tests/fuzz/support/small_team.h"
#include "tests/fuzz/support/turns.h"
#include "tests/fuzz/target.h"
#include "tests/support/team.h"

namespace ergocast::fuzz {
namespace {

/// A core's messages are valid, whatever it received.
void check_sent(const Outbox& sent) {
  static std::vector<std::byte> bytes;
  for (const Outgoing& outgoing : sent) {
    encode(outgoing.message, bytes);
    ERGOCAST_REQUIRE(decode(bytes, test::kRun).has_value());
  }
}

/// Plays `input` to `core`, which starts a second after the clock.
template <class Core, class Receive>
Instant listen(Input input, Core& core, const Receive& receive) {
  Instant now = test::at(std::chrono::seconds(1));
  const auto act = [&] {
    Outbox out;
    core.advance(now, out);
    check_sent(out);
  };
  act();
  play(
      input,
      [&](std::chrono::nanoseconds time) {
        now += time;
        act();
      },
      [&](std::span<const std::byte> datagram, AgentId transmitter) {
        const auto decoded = decode(datagram, test::kRun);
        if (decoded) receive(*decoded, now, transmitter_in(*decoded, transmitter));
      });
  act();
  return now;
}

void agent_listens(Input input) {
  Agent agent({test::kRun, 0, test::incarnation_of(0), "here", "1"});
  listen(input, agent, [&agent](const Message& message, Instant now, AgentId transmitter) {
    test::give(agent, message, now, transmitter);
  });
  check(agent);
}

void coordinator_listens(Input input) {
  const bool takes_over = (input[0] & kCoordinatorTakesOver) != 0;
  Coordinator coordinator({test::kRun, test::kCoordinatorLife, "base", "1"},
                          encode_plan(mission_with(input[0])),
                          takes_over ? Takeover::kIfRunning : Takeover::kNever);
  listen(input, coordinator, [&coordinator](const Message& message, Instant now, AgentId) {
    test::give(coordinator, message, now);
  });
}

void world_listens(Input input) {
  World world(test::kRun, test::kWorldLife);
  listen(input, world, [&world](const Message& message, Instant now, AgentId) {
    test::give(world, message, now);
  });
  ERGOCAST_REQUIRE(world.tick() >= 0);
}

void recorder_listens(Input input) {
  std::ostringstream trajectory, metrics;
  Recorder recorder(test::kRun, test::kLoggerLife, trajectory, metrics);
  listen(input, recorder, [&recorder](const Message& message, Instant now, AgentId) {
    test::give(recorder, message, now);
  });
  check_table(trajectory.view());
  check_table(metrics.view());
}

/// `ergocast status` as a core that sends nothing.
struct Viewer : TeamView {
  using TeamView::TeamView;
  void advance(Instant, Outbox&) {}
};

void viewer_listens(Input input) {
  Viewer view(test::kRun, test::at(std::chrono::seconds(1)));
  const Instant now = listen(input, view, [&view](const Message& message, Instant at, AgentId) {
    test::give(view, message, at);
  });
  check(view.picture(now));
}

}  // namespace

FUZZ_TARGET_WITH(listener, &mutate_turns) {
  if (input.size() < kPrefixBytes) return;
  constexpr void (*kListeners[])(Input) = {&agent_listens, &coordinator_listens, &world_listens,
                                           &recorder_listens, &viewer_listens};
  kListeners[input[1] % std::size(kListeners)](input);
}

}  // namespace ergocast::fuzz
