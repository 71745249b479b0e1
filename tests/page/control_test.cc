// SPDX-License-Identifier: BSD-3-Clause
// An operator gives orders on the page, and the team obeys. The page shows what each order
// achieves.
#include "tests/page/controlled_page.h"
#include "tests/support/tls.h"

namespace ergocast::test {
namespace {

TEST_F(ControlledPage, PausesResumesAndStopsATeamFromAPhonesWindow) {
  control();
  EXPECT_FALSE(visible(button("pause")));  // no operator has control yet
  take_control();
  screenshot("control_phone");
  EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true);

  browser_->click(button("pause"));
  EXPECT_TRUE(becomes("controlSpoken", "Press again within 3 seconds: Pause"));
  order("pause");
  EXPECT_TRUE(becomes("controlText", "paused at tick .*: 4 of 4 stand"));
  EXPECT_TRUE(becomes("controlSpoken", "4 of 4 stand"));
  EXPECT_TRUE(becomes("state", "paused"));
  screenshot("control_paused");
  order("resume");
  EXPECT_TRUE(becomes("controlText", "the mission goes on at tick"));
  EXPECT_TRUE(becomes("state", "running"));

  order("stop");
  EXPECT_TRUE(becomes("holder", "The mission has ended"));
  for (const char* id : {"controlText", "controlSpoken"})
    EXPECT_TRUE(becomes(id, "^stop by anna: the mission has ended at tick \\d+.*stopped by anna"))
        << text(id);
  for (const char* id : {"#stopNow", "#take", "#orders"}) EXPECT_FALSE(visible(id)) << id;
  end_with_the_mission();
  EXPECT_EQ(summary()["result"], "stopped");
  EXPECT_TRUE(summary()["reason"].get<std::string>().starts_with("stopped by anna on the page of"))
      << summary()["reason"];
  EXPECT_EQ(summary()["holds"].size(), 1U) << summary()["holds"];
  for (const char* line :
       {"control: anna takes control at tick", "control: anna asks for: pause, at",
        "control: pause of anna, asked for at", ": 4 of 4 stand", "control: resume of anna",
        "control: stop of anna"}) {
    EXPECT_NE(text_of(out() / "log/run.log").find(line), std::string::npos) << line;
  }
  expect_no_errors();
}

TEST_F(ControlledPage, SendsOneAgentHomeAndAnotherOneOut) {
  control();
  take_control();
  // The agent that is pinned is the one that is chosen.
  EXPECT_TRUE(
      browser_->becomes("return document.querySelectorAll('#orderedAgent option').length === 4"));
  js("ergocast.pin(2)");
  EXPECT_TRUE(browser_->becomes("return document.getElementById('orderedAgent').value === '2'"));
  order("home");
  EXPECT_TRUE(becomes("controlText", "^agent 2 (is on its way|rests at) home"));
  js("ergocast.pin(-1); document.getElementById('orderedAgent').value = 1");
  order("out");
  EXPECT_TRUE(becomes("controlText", "^agent 1 has left the mission"));
  EXPECT_TRUE(
      browser_->becomes("return ergocast.S.facts.state.agents.some(a => a.id === 2 && "
                        "/home|rest/.test(a.phase))"))
      << js("return ergocast.S.facts.state.agents");
  screenshot("control_recalled");
  order("stop");
  end_with_the_mission();
  EXPECT_EQ(summary()["recalls"].size(), 2U) << summary()["recalls"];
  EXPECT_EQ(summary()["result"], "stopped");
}

TEST_F(ControlledPage, StopsAtOnceWithOnePressThatIsAlwaysInSight) {
  control();
  js("scrollTo(0, document.body.scrollHeight)");
  const auto in_sight =
      js("const box = document.getElementById('stopNow').getBoundingClientRect();"
         "return box.top >= 0 && box.bottom <= innerHeight && box.left >= 0 && "
         "box.right <= innerWidth && box.height >= 40");
  EXPECT_EQ(in_sight, true);
  js("document.getElementById('operatorName').value = 'anna'");
  browser_->click("#stopNow");  // also without control
  // What it has achieved stays on the page of the record, too.
  EXPECT_TRUE(browser_->becomes("return ergocast.S.live === false"));
  for (const char* id : {"controlText", "controlSpoken"})
    EXPECT_TRUE(becomes(id, "^stop now by anna: stopped at tick \\d+.*: all stand still"))
        << text(id);
  EXPECT_TRUE(visible("#controlText"));
  EXPECT_EQ(js("return ergocast.S.run.tracks.map(({ id }) => ergocast.course(id)).every(c => c === "
               "null)"),
            true);
  EXPECT_EQ(js("return [...new Set([...document.querySelectorAll('#rows td:nth-child(3)')].map("
               "td => td.textContent))].join()"),
            "0.0 m/s");
  js("scrollTo(0, 0)");
  screenshot("control_stopped");
  end_with_the_mission();
  EXPECT_TRUE(summary()["reason"].get<std::string>().starts_with("stopped at once by "))
      << summary()["reason"];
  EXPECT_TRUE(printed(": all stand still")) << printed();
}

// The address has two tokens: one becomes a cookie and the other stays in the browser.
TEST_F(ControlledPage, GivesOrdersByHttpsWhereOtherHostsReachIt) {
  const auto [certificate, key] = make_certificate(folder_, "page");
  control({"--listen", "127.0.0.2", "--tls-cert", certificate, "--tls-key", key});
  EXPECT_TRUE(address().starts_with("https://127.0.0.2:8820/?token=")) << address();
  EXPECT_EQ(js("return location.href"), "https://127.0.0.2:8820/");
  take_control();
  order("pause");
  EXPECT_TRUE(becomes("controlText", "paused at tick .*: 4 of 4 stand"));
  browser_->click("#stopNow");
  EXPECT_TRUE(becomes("controlText", "stopped at tick"));
  end_with_the_mission();
  expect_no_errors();
}

// As a command of another operator does, of which this page knows nothing.
TEST_F(ControlledPage, ShowsWhatWasOrderedElsewhere) {
  control();
  take_control();
  const std::string other = "by [^ ]+@[^ ]+, on another page or by a command: ";
  EXPECT_EQ(ergocast({"pause"}), 0) << output();
  EXPECT_TRUE(becomes("controlText", "^pause " + other + "from tick \\d+")) << text("controlText");
  EXPECT_TRUE(becomes("pause", "“Resume” lets it go on"));
  order("resume");
  EXPECT_TRUE(becomes("controlText", "^resume: the mission goes on at tick"))
      << text("controlText");
  EXPECT_EQ(ergocast({"recall", "2"}), 0) << output();
  EXPECT_TRUE(becomes("controlText",
                      "^agent 2 home by another operator, on another page or by a command: "))
      << text("controlText");
  EXPECT_FALSE(printed("resume by ")) << printed();
  browser_->click("#stopNow");
  end_with_the_mission();
}

// A vehicle with inertia moves for seconds after the pause.
TEST_F(ControlledPage, ShowsCommandsAndWhatStillMovesInAPause) {
  control(
      {},
      "world { speed_limit_mps: 25 }\nvehicle { kind: ACCELERATION max_acceleration_mps2: 0.7 }\n",
      2);  // vehicles brake for a quarter of a minute, in which a slow browser sees them
  take_control();
  EXPECT_TRUE(
      browser_->becomes("const { tracks } = ergocast.S.run; return tracks.length === 4 && "
                        "tracks.every(({ id }) => ergocast.command(id)?.long > 0)"));
  screenshot("control_commands");
  js("window.moving = false; const rows = document.getElementById('rows');"
     "new MutationObserver(() => { moving ||= rows.textContent.includes('paused: still moves'); })"
     ".observe(rows, { childList: true, characterData: true, subtree: true })");
  order("pause");
  EXPECT_TRUE(browser_->becomes("return moving"));
  EXPECT_TRUE(browser_->becomes(
      "return ergocast.S.run.tracks.every(({ id }) => ergocast.command(id) === null)"));
  screenshot("control_moving");
  EXPECT_TRUE(becomes("controlText", "4 of 4 stand$"));
  EXPECT_TRUE(
      browser_->becomes("return [...document.querySelectorAll('#rows td')].every(td => "
                        "td.textContent !== 'paused: still moves')"));
  browser_->click("#stopNow");
  end_with_the_mission();
}

}  // namespace
}  // namespace ergocast::test
