// SPDX-License-Identifier: BSD-3-Clause
// A mission whose target changed: the map shows the target of the chosen time, and φ² counts each
// moment against the target of its time.
#include "core/mission/amendments.h"
#include "lab/simulation.h"
#include "logger/amendments_file.h"
#include "logger/run_data.h"
#include "logger/run_record.h"
#include "plan/amendment_list.h"
#include "plan/plan.h"
#include "target/target.h"
#include "team/amend_parts.h"
#include "tests/page/page_in_a_browser.h"
#include "tests/process/support/stranger.h"

namespace ergocast::test {
namespace {

class AmendedMissionInABrowser : public PageInABrowser {
 protected:
  /// One Gaussian as the mission's target.
  static TargetChange gaussian(const Mission& mission, double x_m, double y_m) {
    const TargetDensity target{
        {plane_gaussian(1, {x_m, y_m}, Eigen::Matrix2d::Identity() * 150 * 150)}};
    TargetChange change;
    change.target = target_coefficients(target, mission.domain, mission.basis).values;
    return change;
  }

  /// A minute in which the target changes after 20 s to the domain's middle, and after 40 s to its
  /// east.
  void open_amended(const std::string& fragment = "", const std::string& law = "history=BY_TIME") {
    open_changed(fragment, law, [](const Mission& mission) {
      Amendments amendments;
      name_target(amendments, 200, gaussian(mission, 1000, 1000));
      name_target(amendments, 400, gaussian(mission, 1700, 1000));
      return amendments;
    });
  }
  /// A minute with the amendments of a function.
  void open_changed(const std::string& fragment, const std::string& law, const auto& changes) {
    ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "60",
                        "--set", "law." + law, "--out", out()}),
              0)
        << output();
    const Mission mission = read_mission(out()).value();
    const Amendments amendments = changes(mission);
    {
      std::ofstream trajectory(out() / kTrajectoryFile), metrics(out() / kMetricsFile);
      lab::Simulation({.plan = encode_plan(mission), .amendments = amendments}, trajectory, metrics)
          .run();
    }
    ReceivedAmendments heard;
    heard.note(amendments);
    std::ofstream(out() / kAmendmentsFile) << amendments_text(heard, mission.timing.dt_s);
    ASSERT_EQ(ergocast({"report", out()}), 0) << output();
    show_report(fragment);
  }

  /// How far the map's colour at a place is from that at the north edge, where no target is.
  double strength_at(double x_m, double y_m) {
    const std::string at = std::to_string(x_m) + ", " + std::to_string(y_m);
    return js(
        "const { view } = ergocast, g = document.getElementById('shading').getContext('2d');"
        "const pixel = (x, y) => [...g.getImageData(Math.round(view.px(x) * devicePixelRatio),"
        "  Math.round(view.py(y) * devicePixelRatio), 1, 1).data];"
        "const empty = pixel(1000, 1990);"
        "return Math.hypot(...pixel(" +
        at + ").map((v, i) => v - empty[i]))");
  }
};

TEST_F(AmendedMissionInABrowser, ShowsTheTargetOfTheChosenTime) {
  open_amended("#theme=light");
  js("ergocast.set('tail', 0)");
  struct Moment {
    double t_s, x_m, y_m;
    const char* text;
  };
  // Forwards, and back again.
  for (const auto& [t_s, x_m, y_m, text] :
       {Moment{10, 500, 500, ""}, Moment{30, 1000, 1000, "amendment 0: target since t = 20 s"},
        Moment{50, 1700, 1000, "amendment 1: target since t = 40 s"}, Moment{19.9, 500, 500, ""}}) {
    js("ergocast.draw(" + std::to_string(t_s) + ")");
    for (const auto& [px, py] : {std::pair{500, 500}, {1000, 1000}, {1700, 1000}}) {
      const bool holds = px == x_m && py == y_m;
      EXPECT_EQ(strength_at(px, py) > 60, holds) << t_s << " s, at " << px << ", " << py;
    }
    EXPECT_EQ(js("const p = document.getElementById('targetText'); return p.hidden ? '' : "
                 "p.textContent"),
              text);
  }
  js("ergocast.draw(30)");
  screenshot("amended");
  expect_no_errors();
}

TEST_F(AmendedMissionInABrowser, AddsUpTheMetricOfTheRecord) {
  open_amended();
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 1e-3);
  // In any order of times.
  EXPECT_EQ(js("const { run } = ergocast.S, at = row => run.coverage.metric(row);"
               "const late = at(590); at(100); return late === at(590)"),
            true);
  // The difference is what φ² adds up; it is not that from the newest target.
  EXPECT_EQ(
      js("const { run } = ergocast.S, { weights } = run.mission;"
         "const sum = c => c.reduce((total, v, k) => total + weights[k] * v ** 2, 0);"
         "return Math.abs(sum(run.coefficients('difference', 590)) / run.coverage.metric(590) - 1)"
         "  < 1e-9"),
      true);
  js("ergocast.set('layer', 'difference')");
  screenshot("amended_difference");
  expect_no_errors();
}

/// The sums and counts of each target are halved.
TEST_F(AmendedMissionInABrowser, AddsUpTheMetricOfATeamThatForgets) {
  open_amended("", "memory_half_life_s=15");
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 1e-3);
  EXPECT_EQ(js("const { run } = ergocast.S, at = row => run.coverage.metric(row);"
               "const late = at(590); at(100); return late === at(590)"),
            true);
  expect_no_errors();
}

TEST_F(AmendedMissionInABrowser, AddsUpTheMetricOfAKeptHistory) {
  open_amended("", "history=KEEP");
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 1e-3);
  expect_no_errors();
}

TEST_F(AmendedMissionInABrowser, ACancelledZoneEndsAtItsTick) {
  open_changed("", "history=BY_TIME", [](const Mission&) {
    const Zone zone{.until = 300, .corners_m = {{100, 100}, {400, 100}, {400, 400}}};
    Amendments amendments;
    name_zone(amendments, 0, 50, 50, zone);
    name_zone(amendments, 0, 60, 100, zone);
    name_reopening(amendments, 200, 0);
    name_reopening(amendments, 150, 1);
    return amendments;
  });
  const auto zones_at = [this](int row) {
    return js("return ergocast.S.run.zonesAt(" + std::to_string(row) + ").map(z => z.number)");
  };
  EXPECT_EQ(zones_at(149), nlohmann::json({0, 1}));
  EXPECT_EQ(zones_at(150), nlohmann::json({0}));
  EXPECT_EQ(zones_at(200), nlohmann::json::array());
  EXPECT_EQ(js("return ergocast.S.run.marks.map(({ kind, t, until }) => [kind, t, until ?? 0])"),
            nlohmann::json::parse(R"([["zone", 6, 15], ["zone", 10, 20], ["reopen", 15, 0],
                                      ["reopen", 20, 0]])"));
  EXPECT_EQ(js("const button = [...document.querySelectorAll('#strip button')].at(-1);"
               "return button.title"),
            "amendment 2: zone cancelled at 20.0 s");
  js("ergocast.draw(14)");
  screenshot("cancelled_zones");
  expect_no_errors();
}

TEST_F(AmendedMissionInABrowser, MarksEachAmendment) {
  open_amended();
  EXPECT_EQ(js("return [...document.querySelectorAll('#strip button')].map(mark => mark.title)"),
            nlohmann::json::parse(R"(["amendment 0: new target at 20.0 s",
                                      "amendment 1: new target at 40.0 s"])"));
  browser_->click("#strip button");
  EXPECT_EQ(js("return ergocast.S.t"), 20);
  browser_->press("]");
  EXPECT_EQ(js("return ergocast.S.t"), 40);
  // φ² has a line at each change; other quantities do not depend on the target.
  const std::string lines =
      "return ergocast.svgText().split('stroke-dasharray=\"6 3\"').length - 1";
  EXPECT_EQ(js(lines), 2);
  js("ergocast.set('quantity', 'age')");
  EXPECT_EQ(js(lines), 0);
  browser_->press("i");
  EXPECT_NE(js("return document.getElementById('detailsText').innerText")
                .get<std::string>()
                .find("1\ttarget\t400\t40"),
            std::string::npos);
  screenshot("amended_details");
  expect_no_errors();
}

TEST_F(AmendedMissionInABrowser, ShowsTheTargetOfTheTimeInAViewOfABox) {
  open_report({"--duration", "20"}, "#view=xz", "cube_corners");
  // The only mode of the new target has its crests at the lower and upper end.
  const auto strengths =
      js("const { run } = ergocast.S, [M, N] = run.mission.modes;"
         "const mu = run.mission.target.map((_, k) => (k ? 0 : 1)); mu[2 * M * N] = 0.5;"
         "run.setAmendments([{ number: 0, kind: 'target', from: 100, hash: 'one' }], { one: mu });"
         "return [5, 15].map(t => {"
         "  ergocast.draw(t);"
         "  const { cells, width, height } = ergocast.shown().targetAt(run.rowAt(t)).density;"
         "  const at = up => cells[Math.floor((1 - up) * (height - 1)) * width + (width >> 1)];"
         "  return [at(0), at(0.5), at(1)];"
         "})");
  EXPECT_LT(strengths[0][0], 20) << strengths;  // the plan's: nothing at the end
  EXPECT_GT(strengths[1][0], 200) << strengths;
  EXPECT_LT(strengths[1][1], 20) << strengths;
  EXPECT_GT(strengths[1][2], 200) << strengths;
  screenshot("amended_box");
  expect_no_errors();
}

TEST_F(AmendedMissionInABrowser, DrawsAZoneWhileItIsClosed) {
  std::ofstream(folder_ / "zone.textproto") << R"(
      vertices { x_m: 900 y_m: 900 } vertices { x_m: 1100 y_m: 900 }
      vertices { x_m: 1100 y_m: 1100 } vertices { x_m: 900 y_m: 1100 })";
  open_report({"--duration", "60", "--amend", "30+20:" + (folder_ / "zone.textproto").string()},
              "#theme=light");
  js("ergocast.set('tail', 0)");
  const std::string colours =
      "const g = document.getElementById('shading').getContext('2d'), { view } = ergocast;"
      "const at = (x, y) => [...g.getImageData(Math.round(view.px(x) * devicePixelRatio),"
      "  Math.round(view.py(y) * devicePixelRatio), 1, 1).data].join();"
      "return [5, 29, 40, 55].map(t => {"
      "  ergocast.draw(t); return [at(960, 960), at(800, 960)]; })";
  const auto seen = js(colours);
  EXPECT_NE(seen[1][0], seen[0][0]) << "it is closed";
  EXPECT_EQ(seen[2][0], seen[1][0]);
  EXPECT_EQ(seen[3][0], seen[0][0]) << "it has ended";
  for (const auto& one : seen) EXPECT_EQ(one[1], seen[0][1]) << "beside it";
  EXPECT_EQ(js("return [...document.querySelectorAll('#strip button')].map(mark => mark.title)"),
            nlohmann::json::parse(R"(["amendment 0: zone at 30.0 s, by simulate"])"));
  js("ergocast.draw(40)");
  screenshot("zone");
  expect_no_errors();
}

TEST_F(AmendedMissionInABrowser, MarksAnotherLawAndNamesItsOperator) {
  open_report({"--duration", "60", "--law", "30:u_max_mps=5"});
  EXPECT_EQ(js("return [...document.querySelectorAll('#strip button')].map(mark => mark.title)"),
            nlohmann::json::parse(
                R"(["amendment 0: another law (u_max_mps 5) at 30.0 s, by simulate"])"));
  browser_->press("i");
  EXPECT_NE(js("return document.getElementById('detailsText').innerText")
                .get<std::string>()
                .find("0\tlaw\t300\t30\tu_max_mps 5\tsimulate"),
            std::string::npos);
  expect_no_errors();
}

// A page that connects late does not receive all targets.
TEST_F(AmendedMissionInABrowser, SaysThatItLacksATarget) {
  open_amended();
  js("const { run } = ergocast.S;"
     "run.received.delete(run.amendments[0].hash); run.setAmendments(run.amendments);"
     "ergocast.draw(30)");
  EXPECT_EQ(text("targetText"), "amendment 0: target since t = 20 s, not received");
  EXPECT_EQ(js("return ergocast.S.run.knowsTargets"), false);
  EXPECT_EQ(strength_at(1000, 1000), 0);
  expect_no_errors();
}

/// The parts of AMEND that ask for a target.
std::vector<Amend> asking_for(const TargetChange& target, RunId run, Tick tick) {
  return in_parts({.header = {run, kOperator, 77, 1, tick}, .kind = AmendmentKind::kTarget},
                  encode_target(target));
}

TEST_F(AmendedMissionInABrowser, ShowsANewTargetOfARunningTeam) {
  Child mission = launch_endless(scenario("pace: REALTIME realtime_factor: 10"),
                                 {"--watch", "--port", "8817", "--lcm-url", kUrl});
  browser_->open("http://127.0.0.1:8817/");
  ASSERT_TRUE(browser_->becomes("return window.ergocast?.S.facts?.state?.world_tick > 50"));
  const TargetChange target = gaussian(read_mission(out()).value(), 1000, 1000);
  const RunId run = std::stoull(js("return ergocast.S.facts.run").get<std::string>(), nullptr, 16);
  Stranger sender(kUrl);
  EXPECT_TRUE(eventually([&] { return js("return ergocast.S.run.amendments.length") == 1; },
                         [&] {
                           const Tick tick = js("return ergocast.S.facts.state.world_tick");
                           for (const Amend& part : asking_for(target, run, tick))
                             sender.send(Bus::kSwarm, part);
                         }));
  EXPECT_TRUE(browser_->becomes("return !document.getElementById('targetText').hidden"));
  EXPECT_TRUE(text("targetText").starts_with("amendment 0: target since t = "))
      << text("targetText");
  EXPECT_TRUE(
      browser_->becomes("return [...document.querySelectorAll('#strip button')].some(mark => "
                        "mark.title.startsWith('amendment 0: new target at '))"));
  EXPECT_EQ(js("return /^new target at/.test(document.getElementById('spoken').textContent)"),
            true);
  // The page adds up the positions, the agents report the same sum. An agent that learned late of
  // the target has counted some ticks against the old one for good: the averages differ by a few
  // positions, which is much of a small φ² and little of its root.
  EXPECT_TRUE(
      browser_->becomes("const { run, facts } = ergocast.S, now = Math.sqrt(run.metricAt(run.end));"
                        "return run.end > run.targets[1].from * run.mission.dt_s + 60"
                        "  && Math.abs(now - Math.sqrt(facts.state.ergodic_metric)) < 0.01"));
  screenshot("amended_live");
  // A browser that connects later gets the same.
  browser_->open("about:blank");
  browser_->open("http://127.0.0.1:8817/");
  EXPECT_TRUE(browser_->becomes(
      "return window.ergocast?.S.run?.targets.length === 2 && ergocast.S.run.knowsTargets"));
  js("ergocast.seek(0)");
  wait_for_frame();
  EXPECT_EQ(js("return document.getElementById('targetText').hidden"), true);
  expect_no_errors();
  mission.send(SIGINT);
  close_page_of(mission);
}

}  // namespace
}  // namespace ergocast::test
