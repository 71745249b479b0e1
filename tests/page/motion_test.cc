// SPDX-License-Identifier: BSD-3-Clause
// The map shows where agents go, the distance that they keep, and which of them are blocked.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/page/page_in_a_browser.h"

namespace ergocast::test {
namespace {

struct Row {
  double x_m = 0, y_m = 0, vx_mps = 0, vy_mps = 0;
};

class MotionInABrowser : public PageInABrowser {
 protected:
  void open_mission(const std::string& text, const std::string& fragment) {
    std::ofstream(folder_ / "mission.textproto") << text;
    ASSERT_EQ(ergocast({"simulate", folder_ / "mission.textproto", "--event-log", "--out", out()}),
              0)
        << output();
    show_report(fragment);
  }
  /// What the record has of an agent at a tick.
  Row recorded(int tick, int agent) {
    std::ifstream file(out() / "trajectory.csv");
    for (std::string line; std::getline(file, line);) {
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream in(line);
      double t_s = 0;
      int a_tick = 0, an_agent = 0;
      Row row;
      if (in >> a_tick >> t_s >> an_agent >> row.x_m >> row.y_m >> row.vx_mps >> row.vy_mps &&
          a_tick == tick && an_agent == agent)
        return row;
    }
    ADD_FAILURE() << "no tick " << tick << " of agent " << agent;
    return {};
  }
  /// "#rrggbb" of a pixel of the markers at the place of an expression.
  std::string pixel(const std::string& at) {
    wait_for_frame();
    return js(
        "const { view, S, marker, course, block } = ergocast, [x, y] = " + at +
        ", s = devicePixelRatio, { data } = document.getElementById('markers').getContext("
        "'2d').getImageData(Math.round(x * s), Math.round(y * s), 1, 1);"
        "return '#' + [...data].slice(0, 3).map(v => v.toString(16).padStart(2, '0')).join('')"
        " + (data[3] < 128 ? ' (clear)' : '')");
  }
  std::string colour(const std::string& expression) {
    return js("return ergocast.S.colours." + expression);
  }
};

TEST_F(MotionInABrowser, ACourseEndsWhereAPointComesInThatTime) {
  open_report({"--duration", "20"}, "#theme=light&tail=0&t=12");
  ASSERT_EQ(text("courseText"), "10 s");
  for (int agent = 0; agent < 4; ++agent) {
    const std::string id = std::to_string(agent);
    const Row before = recorded(110, agent), now = recorded(120, agent);
    const double dx_m = now.x_m - before.x_m, dy_m = now.y_m - before.y_m;
    const auto end = js("return ergocast.view.metres(...ergocast.course(" + id + ").end)");
    EXPECT_NEAR(end[0].get<double>(), now.x_m + 10 * dx_m, 3) << id;  // ten roundings
    EXPECT_NEAR(end[1].get<double>(), now.y_m + 10 * dy_m, 3) << id;
    ASSERT_GT(js("return ergocast.course(" + id + ").long").get<double>(), 60) << id;
    // The nose shows the same way, and nothing shows the other way.
    const double heading = js("return ergocast.course(" + id + ").heading");
    EXPECT_LT(std::abs(std::remainder(heading - std::atan2(-dy_m, dx_m), 2 * M_PI)), 0.03) << id;
    const auto beside = [&](const std::string& along) {
      return "(({ x, y }, { heading, long }) => [x + " + along + " * Math.cos(heading), y + " +
             along + " * Math.sin(heading)])(marker(" + id + "), course(" + id + "))";
    };
    EXPECT_EQ(pixel(beside("7.5")), colour("agent(" + id + ")"));
    EXPECT_NE(pixel(beside("(-long / 2)")).find("clear"), std::string::npos) << id;
    // The line is 1.4 pixels wide, so it shares its pixels with its casing.
    EXPECT_EQ(pixel(beside("(long - 8)")).find("clear"), std::string::npos) << id;
    EXPECT_NE(pixel(beside("(long + 8)")).find("clear"), std::string::npos) << id;
  }
  screenshot("courses");
  // Without the check mark, headings stay.
  browser_->click("#course");
  EXPECT_NE(pixel("(({ x, y }, { heading }) => [x + 45 * Math.cos(heading), y + 45 * "
                  "Math.sin(heading)])(marker(1), course(1))")
                .find("clear"),
            std::string::npos);
  // A picture has the courses, too.
  const auto pieces = [&] {
    return js("return ergocast.svgText().split('<path').length").get<int>();
  };
  const int without = pieces();
  browser_->click("#course");
  EXPECT_EQ(pieces(), without + 4 * 2);
  expect_no_errors();
}

TEST_F(MotionInABrowser, AVehicleThatTurnsHeadsAlongItsTangent) {
  open_mission(R"(
domain { size_x_m: 1000 size_y_m: 1000 }
target { gaussians { mean_x_m: 500 mean_y_m: 500 sigma_m: 60 } }
basis { modes_x: 6 modes_y: 6 }
law { u_max_mps: 20 }
time { duration_s: 40 }
agents { random_count: 3 }
world { speed_limit_mps: 20 }
vehicle { kind: FIXED_WING max_turn_radps: 1 min_speed_mps: 15 })",
               "#theme=light&tail=0");
  double turned = 0;
  for (const int tick : {150, 200, 250, 300, 399}) {
    js("ergocast.draw(" + std::to_string(tick / 10.0) + ")");
    for (int agent = 0; agent < 3; ++agent) {
      // The command of a tick is the velocity at its end.
      const Row last = recorded(tick - 1, agent), earlier = recorded(tick - 6, agent);
      const double heading =
          js("return ergocast.course(" + std::to_string(agent) + ").heading").get<double>();
      const double true_heading = std::atan2(-last.vy_mps, last.vx_mps);
      EXPECT_LT(std::abs(std::remainder(heading - true_heading, 2 * M_PI)), 0.02)
          << tick << ", agent " << agent;
      turned = std::max(turned,
                        std::abs(std::remainder(
                            std::atan2(-earlier.vy_mps, earlier.vx_mps) - true_heading, 2 * M_PI)));
    }
  }
  EXPECT_GT(turned, 0.3) << "half a second ago the heading was another";
  screenshot("fixed_wings");
  expect_no_errors();
}

TEST_F(MotionInABrowser, AnAgentThatStandsHasNoCourse) {
  open_report({}, "#theme=light&tail=0&t=115", "home_by_dusk");
  for (int agent = 0; agent < 4; ++agent)
    EXPECT_EQ(js("return ergocast.course(" + std::to_string(agent) + ")"), nullptr) << agent;
  js("ergocast.draw(20)");
  EXPECT_NE(js("return ergocast.course(0)"), nullptr);
  expect_no_errors();
}

TEST_F(MotionInABrowser, AUnicycleThatStandsHasItsHeading) {
  open_report({"--set", "vehicle.kind=UNICYCLE", "--set", "vehicle.max_turn_radps=0.5"},
              "#theme=light&tail=0&t=119", "home_by_dusk");
  for (int agent = 0; agent < 4; ++agent) {
    const Row last = recorded(1189, agent);
    const auto course = js("return ergocast.course(" + std::to_string(agent) + ")");
    ASSERT_TRUE(course.is_object()) << agent;
    EXPECT_EQ(course["long"], 0) << agent;
    const double heading = course["heading"];
    EXPECT_LT(std::abs(std::remainder(heading - std::atan2(-last.vy_mps, last.vx_mps), 2 * M_PI)),
              0.02)
        << agent;
  }
  screenshot("standing_unicycles");
  expect_no_errors();
}

TEST_F(MotionInABrowser, ACourseInABoxHasItsHeight) {
  browser_.reset();
  browser_.emplace(folder_, true);
  open_report({"--duration", "20"}, "#theme=light&tail=0&t=10", "cube_corners");
  for (const char* view : {"turn", "xy", "xz", "yz"}) {
    js(std::string("ergocast.showView('") + view + "')");
    wait_for_frame();
    EXPECT_LT(
        js("const { view, S, shown, course } = ergocast, track = S.run.track(5), seconds = "
           "parseFloat(document.getElementById('courseText').textContent);"
           "const place = k => [track.p[2 * k], track.p[2 * k + 1], track.z[k]];"
           "const to = place(100).map((v, i) => v + seconds * (v - place(90)[i]));"
           "const [x, y] = S.view === 'turn' ? view.project(to) : [view.px(to[shown().axes[0]]), "
           "view.py(to[shown().axes[1]])];"
           "const { end } = course(5); return Math.hypot(end[0] - x, end[1] - y)")
            .get<double>(),
        1e-3)
        << view;
    screenshot(std::string("course_") + view);
  }
  expect_no_errors();
}

constexpr const char* kFew = R"(
domain { size_x_m: 20 size_y_m: 20 }
target { gaussians { mean_x_m: 10 mean_y_m: 10 sigma_m: 2 } }
basis { modes_x: 6 modes_y: 6 }
law { u_max_mps: 1 anticipation: 0 }
time { duration_s: 40 }
world { speed_limit_mps: 2 }
separation { distance_m: 3 }
)";

TEST_F(MotionInABrowser, ARingHasHalfTheDistanceAsItsRadius) {
  open_mission(std::string(kFew) + "agents { random_count: 3 }", "#theme=light&tail=0&t=1");
  const double radius = 1.5 * js("return ergocast.view.scale").get<double>();
  const auto below = [](double away) {
    return "(({ x, y }) => [x, y + " + std::to_string(away) + "])(marker(2))";
  };
  const std::string own = colour("agent(2)");
  // Beyond the ring the picture is clear, and within it nearly.
  EXPECT_EQ(pixel(below(radius)), own);
  EXPECT_NE(pixel(below(radius + 5)).find("clear"), std::string::npos);
  EXPECT_NE(pixel(below(0.7 * radius)).find("clear"), std::string::npos);
  const auto radius_in_svg =
      js("const two = v => Math.round(v * 100) / 100, r = two(ergocast.marker(2).body[0]);"
         "return ergocast.svgText().includes(`A${r} ${r} 0 0 1`) ? ergocast.marker(2).body[0] : 0");
  EXPECT_NEAR(radius_in_svg.get<double>(), radius, 1e-6);
  screenshot("rings");
  browser_->click("#distance");
  EXPECT_EQ(pixel(below(0.7 * radius)), own) << "a disc";
  EXPECT_NE(pixel(below(radius + 5)).find("clear"), std::string::npos);
  expect_no_errors();
}

TEST_F(MotionInABrowser, OfManyOnlyTheChosenHaveRingsAndBlocksNameTheirBodies) {
  open_mission(std::string(kFew) + "agents { random_count: 14 }", "#theme=light&tail=0&t=1");
  EXPECT_EQ(js("return [2, 5].map(id => ergocast.marker(id).ringed)"),
            nlohmann::json::parse("[false, false]"));
  js("ergocast.pin(5)");
  EXPECT_EQ(js("return [2, 5].map(id => ergocast.marker(id).ringed)"),
            nlohmann::json::parse("[false, true]"));
  js("ergocast.pin(5)");
  // In this crowd somebody waits for a second somewhere.
  const auto block = js(
      "const { history } = ergocast.S.run; for (const { t, team } of history) for (const agent of "
      "team.agents) if (agent.blocked_s >= 1 && typeof agent.blocked_by === 'number') return "
      "[t, agent.id, agent.blocked_by]; return null");
  ASSERT_TRUE(block.is_array());
  js("ergocast.draw(" + block[0].dump() + ")");
  const std::string ids = block[1].dump() + ", " + block[2].dump();
  EXPECT_EQ(js("return [...document.querySelectorAll('#rows tr')].find(row => "
               "row.firstChild.textContent === '" +
               block[1].dump() + "').children[1].textContent"),
            "blocked by " + block[2].dump());
  // A line from the one to the other, with its head there.
  EXPECT_EQ(pixel("(([[a, b], [c, d]]) => [(a + c) / 2, (b + d) / 2])(block(" + ids + "))"),
            colour("ink"));
  EXPECT_TRUE(js("const { block, marker } = ergocast, [from, to] = block(" + ids +
                 "), far = (p, { x, y }) "
                 "=> Math.hypot(p[0] - x, p[1] - y), [one, other] = [" +
                 ids +
                 "].map(marker);"
                 "return far(from, one) < one.body[0] && far(to, other) < other.body[0]"));
  EXPECT_TRUE(js("const [[a, b], [c, d]] = ergocast.block(" + ids +
                 "), two = v => String("
                 "Math.round(v * 100) / 100); return ergocast.svgText().includes(`M${two(a)} "
                 "${two(b)}L${two(c)} ${two(d)}M`)"));
  screenshot("blocked");
  // An edge has no body; the agent gets a sign.
  const std::string one = block[1].dump();
  const std::string sign = "(([x, y]) => [x, y + 3])(block(" + one + ", null))";
  EXPECT_NE(pixel(sign), colour("bad"));
  js("for (const { team } of ergocast.S.run.history) team.byId.get(" + one +
     ").blocked_by = null; ergocast.draw(" + block[0].dump() + ")");
  EXPECT_EQ(pixel(sign), colour("bad"));
  EXPECT_NE(pixel("(([[a, b], [c, d]]) => [(a + c) / 2, (b + d) / 2])(block(" + ids + "))"),
            colour("ink"));
  screenshot("blocked_by_an_edge");
  expect_no_errors();
}

TEST_F(MotionInABrowser, ALiveTeamHasHeadingsAndBlocks) {
  const auto file = folder_ / "mission.textproto";
  std::ofstream(file) << kFew << "agents { random_count: 6 }";
  Child mission = launch_endless(
      file, {"--set", "vehicle.kind=UNICYCLE", "--set", "vehicle.max_turn_radps=1", "--set",
             "time.pace=REALTIME", "--set", "time.realtime_factor=5", "--watch", "--port", "8816"});
  browser_->open("http://127.0.0.1:8816/");
  EXPECT_TRUE(
      browser_->becomes("return Boolean(window.ergocast?.S.run) && ergocast.S.run.rows > 20 && "
                        "ergocast.S.run.tracks.length === 6"));
  // Unicycles move along their headings: a step of a tick is a chord of the arc.
  const auto angles =
      js("const { run } = ergocast.S, angles = []; for (const { p, h, last } of run.tracks)"
         "  for (let k = 1; k <= last; k++) {"
         "    const dx = p[2 * k] - p[2 * k - 2], dy = p[2 * k + 1] - p[2 * k - 1],"
         "      off = Math.atan2(dy, dx) - (2 * Math.PI * h[k]) / 256;"
         "    if (Math.hypot(dx, dy) > 0.05) angles.push(Math.abs(Math.sin(off / 2))); }"
         "return angles.length ? [angles.length, Math.max(...angles)] : [0, 1]");
  EXPECT_GT(angles[0].get<int>(), 10);
  EXPECT_LT(angles[1].get<double>(), 0.08);
  EXPECT_TRUE(browser_->becomes(
      "const { S, block, svgText } = ergocast, two = v => Math.round(v * 100) / 100;"
      "return S.run.tracks.some(({ id }) => {"
      "  const said = S.run.teamAt(S.t)?.byId.get(id);"
      "  if (!(said?.blocked_s >= 1 && typeof said.blocked_by === 'number')) return false;"
      "  const [[a, b], [c, d]] = block(id, said.blocked_by);"
      "  return svgText().includes(`M${two(a)} ${two(b)}L${two(c)} ${two(d)}M`); })"));
  screenshot("live_motion");
  expect_no_errors();
  mission.send(SIGINT);
  EXPECT_TRUE(browser_->becomes("return !ergocast.S.live && Boolean(ergocast.S.run.summary)"));
  close_page_of(mission);
}

}  // namespace
}  // namespace ergocast::test
