// SPDX-License-Identifier: BSD-3-Clause
// The page from its server, in a real browser: of a running team, and of a record.
#include <algorithm>

#include "tests/page/page_in_a_browser.h"
#include "tests/support/http.h"

namespace ergocast::test {
namespace {

TEST_F(PageInABrowser, AnAgentThatIsKilledComesBackAndTheTeamBecomesARecord) {
  Child mission =
      launch_endless(scenario("pace: REALTIME realtime_factor: 10"), {"--watch", "--port", "8810"});
  browser_->open("http://127.0.0.1:8810/");
  EXPECT_TRUE(
      browser_->becomes("return Boolean(window.ergocast?.S.run) && ergocast.S.run.rows > 50"));
  EXPECT_EQ(js("return [ergocast.S.live, ergocast.S.following]"),
            nlohmann::json::array({true, true}));
  EXPECT_TRUE(browser_->becomes("return document.querySelectorAll('#rows tr').length === 4"));
  EXPECT_TRUE(browser_->becomes("return document.getElementById('log').childElementCount > 0"));

  // The page names its own browser, and nobody else.
  EXPECT_TRUE(
      browser_->becomes("return /shown to\\s*browser 127\\.0\\.0\\.1:\\d+(?![,\\d])/.test("
                        "document.getElementById('facts').textContent)"));

  kill_next(agent(2));
  EXPECT_TRUE(browser_->becomes(
      "return ergocast.S.run.incidents.some(i => i.agent === 2 && /restarted|back/.test(i.text))"));
  EXPECT_TRUE(browser_->becomes(
      "return /killed by SIGKILL/.test(document.getElementById('log').textContent)"));
  // Seeks back in time while the team runs, and returns to the present.
  browser_->press("\uE011");  // Home
  EXPECT_EQ(js("return [ergocast.S.t, ergocast.S.following]"), nlohmann::json::array({0, false}));
  const double end = js("return ergocast.S.run.end");
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.end > " + std::to_string(end)));
  EXPECT_EQ(js("return ergocast.S.t"), 0);
  browser_->press("l");
  EXPECT_TRUE(browser_->becomes("return ergocast.S.t > " + std::to_string(end)));
  screenshot("live");

  mission.send(SIGINT);
  EXPECT_TRUE(browser_->becomes("return !ergocast.S.live && Boolean(ergocast.S.run.summary)"));
  EXPECT_EQ(text("state"), "stopped");
  EXPECT_EQ(js("return ergocast.S.run.incidents.some(i => i.agent === 2)"), true);
  js("ergocast.draw(ergocast.S.run.end / 2)");
  EXPECT_EQ(text("state"), "running");
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 0.02);
  screenshot("live_recorded");
  expect_no_errors();
  close_page_of(mission);

  // Opened from disk, the record also shows the incidents and the agents' knowledge over time.
  show_report();
  EXPECT_EQ(js("return ergocast.S.run.incidents.some(i => i.agent === 2 && "
               "/restarted|back/.test(i.text))"),
            true);
  EXPECT_GT(js("return ergocast.S.run.history.length").get<int>(), 3);
  js("ergocast.draw(ergocast.S.run.end / 2)");
  EXPECT_EQ(
      js("const heads = [...document.querySelectorAll('#heads th')].map(h => h.textContent),"
         "row = document.querySelector('#rows tr');"
         "return /^[0-9.]+ s$/.test(row.children[heads.indexOf('Oldest update')].textContent)"),
      true);
}

// The page has no table of these modes, so it cannot compute the curve from positions.
TEST_F(PageInABrowser, ALateBrowserGetsTheWholeCurveOfAFreeDomain) {
  Child mission = launch_endless(scenario_file("two_rooms"),
                                 {"--set", "basis.free_domain=true", "--set", "basis.modes_x=5",
                                  "--set", "basis.modes_y=5", "--set", "time.pace=REALTIME",
                                  "--set", "time.realtime_factor=10", "--watch", "--port", "8815"});
  browser_->open("http://127.0.0.1:8815/");
  EXPECT_TRUE(browser_->becomes(
      "return Boolean(window.ergocast?.S.run) && ergocast.S.run.metrics.t.length > 5"));
  const double first = js("return ergocast.S.run.metrics.t[0]");
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.end > " + std::to_string(first + 30)));
  const std::size_t rows = js("return ergocast.S.run.metrics.t.length");
  browser_->open("about:blank");
  browser_->open("http://127.0.0.1:8815/");
  EXPECT_TRUE(browser_->becomes(
      "return Boolean(window.ergocast?.S.run) && ergocast.S.run.metrics.t.length > 0"));
  EXPECT_LE(js("return ergocast.S.run.metrics.t[0]").get<double>(), first);
  EXPECT_GE(js("return ergocast.S.run.metrics.t.length").get<std::size_t>(), rows);
  EXPECT_EQ(js("const { t, phi, age, spread, received } = ergocast.S.run.metrics;"
               "return t.every((at, i) => (!i || at > t[i - 1]) && phi[i] > 0 && age[i] >= 0 && "
               "spread[i] >= 0 && received[i] >= 0)"),
            true);
  screenshot("late_browser");
  expect_no_errors();
  mission.send(SIGINT);
  EXPECT_TRUE(browser_->becomes("return !ergocast.S.live && Boolean(ergocast.S.run.summary)"));
  close_page_of(mission);
}

TEST_F(PageInABrowser, ALateBrowserShowsHowTheAgentsWereBefore) {
  Child mission =
      launch_endless(scenario("pace: REALTIME realtime_factor: 10"), {"--watch", "--port", "8816"});
  browser_->open("http://127.0.0.1:8816/");
  const std::string knows_two =
      "return Boolean(window.ergocast?.S.run) && ergocast.S.run.teamAt(ergocast.S.run.end)"
      "?.byId.get(2)?.state === 'ok'";
  EXPECT_TRUE(browser_->becomes(knows_two));
  signal_to(agent(2), SIGSTOP);
  EXPECT_TRUE(browser_->becomes(
      "return ergocast.S.run.teamAt(ergocast.S.run.end).byId.get(2).state === 'silent'"));
  const std::string times =
      "return [ergocast.S.run.history.findIndex(({ team }) => "
      "team.byId.get(2)?.state === 'ok'), ergocast.S.run.history.findIndex("
      "({ team }) => team.byId.get(2)?.state === 'silent')].map(i => "
      "ergocast.S.run.times[i])";
  signal_to(agent(2), SIGCONT);
  EXPECT_TRUE(browser_->becomes(knows_two));
  const double seen_until = js("return ergocast.S.run.times.at(-1)");
  browser_->open("about:blank");
  browser_->open("http://127.0.0.1:8816/");
  EXPECT_TRUE(browser_->becomes(knows_two));
  const auto late = js(times);
  ASSERT_TRUE(late[0].is_number() && late[1].is_number()) << late;
  EXPECT_LT(late[0], late[1]);
  EXPECT_LT(late[1], seen_until);
  const std::string text_at =
      "ergocast.draw(" + std::to_string(late[1].get<double>()) +
      "); return document.querySelectorAll('#rows .condition.silent').length";
  EXPECT_EQ(js(text_at), 1);
  expect_no_errors();
  mission.send(SIGINT);
  close_page_of(mission);
}

TEST_F(PageInABrowser, ConnectsAgainWhenTheProcessOfThePageHasEnded) {
  Child mission =
      launch_endless(scenario("pace: REALTIME realtime_factor: 10"), {"--watch", "--port", "8813"});
  browser_->open("http://127.0.0.1:8813/");
  EXPECT_TRUE(
      browser_->becomes("return Boolean(window.ergocast?.S.run) && ergocast.S.run.rows > 50"));
  kill_next({"ergocast run-page"});
  EXPECT_TRUE(browser_->becomes(
      "return /page .* is started again/.test(document.getElementById('log').textContent)"));
  const double end = js("return ergocast.S.run.end");
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.end > " + std::to_string(end)));
  mission.send(SIGINT);
  EXPECT_TRUE(browser_->becomes("return !ergocast.S.live && Boolean(ergocast.S.run.summary)"));
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 0.02);  // for the whole mission
  close_page_of(mission);
}

/// A browser closes a stream of events for good when its request is refused.
TEST_F(PageInABrowser, ConnectsAgainAfterARefusal) {
  browser_->run_first(
      "window.streams = [];"
      "window.EventSource = class extends EventSource {"
      "  constructor(url) { super(streams.length ? url : 'no-such-page'); streams.push(this); } }");
  Child mission =
      launch_endless(scenario("pace: REALTIME"), {"--watch", "--port", "8819", "--lcm-url", kUrl});
  browser_->open("http://127.0.0.1:8819/");
  EXPECT_TRUE(browser_->becomes("return window.ergocast?.S.run?.end > 1"));
  EXPECT_EQ(js("return streams.map(({ readyState }) => readyState)"), nlohmann::json({2, 1}));
  EXPECT_TRUE(js("return document.getElementById('banner').hidden"));
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  close_page_of(mission);
}

// A φ² of the positions that arrived would be another one.
TEST_F(PageInABrowser, ShowsWhatTheAgentsReportIfPositionsWereLost) {
  Child mission = launch_endless(scenario("pace: REALTIME realtime_factor: 10"),
                                 {"--watch", "--port", "8818", "--lcm-url",
                                  "udpm://239.255.76.67:24701?ttl=0&recv_buf_size=20000"});
  browser_->open("http://127.0.0.1:8818/");
  EXPECT_TRUE(browser_->becomes("return window.ergocast?.S.facts?.state?.world_tick > 300"));
  const std::vector<std::string> page = {"ergocast run-page"};
  const std::string lacks_rows =
      "const [{ last, p }] = ergocast.S.run.tracks;"
      "return p.slice(0, 2 * last).some(Number.isNaN)";
  EXPECT_TRUE(eventually([&] {
    signal_to(page, SIGSTOP);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    signal_to(page, SIGCONT);
    return js(lacks_rows) == true;
  }));
  EXPECT_TRUE(browser_->becomes(
      "const { run, facts } = ergocast.S;"
      "return Math.abs(run.metricAt(run.end) / facts.state.ergodic_metric - 1) < 0.01"));
  expect_no_errors();
  mission.send(SIGINT);
  close_page_of(mission);
}

TEST_F(PageInABrowser, AnotherSitesPageGetsNothing) {
  ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "5", "--out",
                      out()}),
            0);
  Child server = start("ergocast", {"watch", out(), "--port", "8811"});
  ASSERT_TRUE(eventually([] { return get(8811, "/").status == 200; }));
  browser_->open("http://127.0.0.1:8811/");
  EXPECT_TRUE(browser_->becomes("return Boolean(window.ergocast?.S.run)"));
  // A site whose name resolves to this host.
  browser_->open("http://evil.example:8811/");
  EXPECT_EQ(js("return document.body.textContent.trim()"), "this server does not have that name");
  // A foreign page, here from a file, because browsers themselves keep pages of the network from
  // this host. It may neither read an answer, nor use one unread, nor show it.
  std::ofstream(folder_ / "evil.html") << "<!DOCTYPE html><title>evil</title>";
  browser_->open("file://" + (folder_ / "evil.html").string());
  browser_->errors();
  EXPECT_EQ(js("return fetch('http://127.0.0.1:8811/').then(r => r.text(), () => 'refused')"),
            "refused");
  EXPECT_EQ(js("return fetch('http://127.0.0.1:8811/', { mode: 'no-cors' })"
               ".then(r => r.type, () => 'refused')"),
            "refused");
  EXPECT_EQ(js("return new Promise(done => { const f = document.createElement('iframe');"
               "f.onload = () => done('loaded');"
               "f.src = 'http://127.0.0.1:8811/'; document.body.append(f); })"),
            "loaded");
  const auto errors = browser_->errors();
  EXPECT_TRUE(std::any_of(errors.begin(), errors.end(), [](const std::string& line) {
    return line.find("frame-ancestors") != line.npos || line.find("X-Frame-Options") != line.npos;
  })) << nlohmann::json(errors);
  server.send(SIGINT);
  EXPECT_EQ(wait_for(server), 0);
}

}  // namespace
}  // namespace ergocast::test
