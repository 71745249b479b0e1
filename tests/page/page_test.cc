// SPDX-License-Identifier: BSD-3-Clause
// The page in a real browser: a report from disk, a served record, and a running team.
#include <algorithm>
#include <map>
#include <sstream>

#include "tests/page/page_in_a_browser.h"
#include "tests/support/http.h"

namespace ergocast::test {
namespace {

constexpr const char* kRight = "\uE014";
constexpr const char* kHome = "\uE011";
constexpr const char* kShift = "\uE008";
constexpr const char* kEscape = "\uE00C";

TEST_F(PageInABrowser, AReportFromDiskShowsAnyTick) {
  open_report();
  EXPECT_EQ(js("return document.title"), "quadrimodal_corners – Ergocast");
  // The sums of the browser are those of the record, up to the rounding of positions to 14 bits.
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 1e-3);
  EXPECT_EQ(text("state"), "done");
  EXPECT_EQ(text("nowTime"), "59.9");

  js("ergocast.draw(30)");
  EXPECT_EQ(text("nowTime"), "30.0");
  EXPECT_EQ(text("state"), "running");
  const auto rows =
      js("const t = ergocast.S.run.track(2), r = ergocast.S.run.rowAt(30);"
         "return [t.p[2 * r], t.p[2 * r + 1]]");
  std::ifstream file(out() / "trajectory.csv");
  std::string line;
  while (std::getline(file, line) && !line.starts_with("300,30,2,")) continue;
  double x = 0, y = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "300,30,2,%lf,%lf", &x, &y), 2) << line;
  EXPECT_NEAR(rows[0].get<double>(), x, 0.1);  // 2000 m in 14 bits
  EXPECT_NEAR(rows[1].get<double>(), y, 0.1);

  // The agent is drawn at its position.
  const auto drawn =
      js("const { head: [x, y], r } = ergocast.marker(2), s = devicePixelRatio;"
         "const g = document.getElementById('markers').getContext('2d');"
         "return [...g.getImageData(Math.round((x - 0.8 * r) * s), Math.round(y * s), 1, 1).data]");
  EXPECT_EQ(drawn, nlohmann::json::parse("[0, 112, 90, 255]"));  // its colour on a light page
  EXPECT_EQ(js("const v = ergocast.view, t = ergocast.S.run.track(2), r = ergocast.S.run.rowAt(30);"
               "return String(ergocast.marker(2).tip) === String(v.at(t, r))"),
            true);
  screenshot("report");
  expect_no_errors();
}

TEST_F(PageInABrowser, KeysAndButtonsMoveThroughTheMission) {
  open_report();
  browser_->press(kHome);
  EXPECT_EQ(js("return ergocast.S.t"), 0);
  browser_->press(kRight);
  EXPECT_NEAR(js("return ergocast.S.t").get<double>(), 0.1, 1e-9);
  browser_->click("#on");
  EXPECT_NEAR(js("return ergocast.S.t").get<double>(), 0.2, 1e-9);
  browser_->press(kRight, kShift);
  EXPECT_NEAR(js("return ergocast.S.t").get<double>(), 10.2, 1e-9);
  browser_->click("#play");
  EXPECT_TRUE(
      browser_->becomes("return !ergocast.S.playing && ergocast.S.t >= ergocast.S.run.end"));
  browser_->press("c");
  EXPECT_EQ(js("return ergocast.S.layer"), "achieved");
  browser_->press("d");
  EXPECT_EQ(js("return document.documentElement.dataset.theme"), "dark");
  browser_->press("+");
  EXPECT_EQ(js("return document.getElementById('fit').hidden"), false);
  browser_->press("0");
  EXPECT_EQ(js("return document.getElementById('fit').hidden"), true);
  browser_->click("#rows tr");
  EXPECT_EQ(js("return [...ergocast.S.pins]"), nlohmann::json::array({0}));
  browser_->press(kEscape);
  EXPECT_EQ(js("return ergocast.S.pins.size"), 0);
  browser_->press("?");
  EXPECT_EQ(js("return document.getElementById('keys').open"), true);
  expect_no_errors();
}

TEST_F(PageInABrowser, CoverageLeavesOutThePlacesOfAPause) {
  open_report();
  const auto left_out = js(
      "const { run } = ergocast.S, { coverage } = run; coverage.at(200); const all = "
      "coverage.count;"
      "run.holds = [[100, 150]]; coverage.reset(0); coverage.at(200); return all - coverage.count");
  EXPECT_EQ(left_out, 4 * 50) << "four agents, 50 ticks";
  expect_no_errors();
}

TEST_F(PageInABrowser, IsATableForScreenReadersAndFitsANarrowScreen) {
  open_report({"--duration", "60"}, "#theme=dark");
  EXPECT_EQ(js("return document.documentElement.dataset.theme"), "dark");
  EXPECT_EQ(js("return document.querySelectorAll('#rows tr').length"), 4);
  EXPECT_EQ(js("return document.querySelectorAll('#heads th[scope=col]').length >= 5"), true);
  EXPECT_EQ(js("return document.querySelectorAll('#rows th[scope=row]').length"), 4);
  EXPECT_NE(js("return document.getElementById('markers').getAttribute('aria-label')")
                .get<std::string>()
                .find("4 of 4 agents"),
            std::string::npos);
  EXPECT_EQ(
      js("return [...document.querySelectorAll('button, input, select, canvas[role]')].filter("
         "e => !(e.textContent.trim() || e.getAttribute('aria-label') || e.labels?.length)).map(e "
         "=> e.id)"),
      nlohmann::json::array());
  screenshot("report_dark");
  browser_->resize(400, 800);
  ASSERT_TRUE(browser_->becomes("return innerWidth === 400"));
  screenshot("report_narrow");
  EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true);
}

TEST_F(PageInABrowser, SavesAPictureAsLinesAndText) {
  open_report();
  const std::string svg = js("return ergocast.svgText()");
  EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_EQ(js("const d = new DOMParser().parseFromString(ergocast.svgText(), 'image/svg+xml');"
               "return d.querySelectorAll('parsererror').length"),
            0);
  EXPECT_EQ(svg.find("NaN"), std::string::npos);
  EXPECT_NE(svg.find("quadrimodal_corners, 4 agents"), std::string::npos);
  js("window.saved = []; HTMLAnchorElement.prototype.click = function () { "
     "saved.push(this.download); };"
     "document.getElementById('savePng').click(); document.getElementById('saveSvg').click();");
  EXPECT_TRUE(browser_->becomes("return saved.length === 2"));
  js("ergocast.S.speed = 100; document.getElementById('saveVideo').click();");
  EXPECT_TRUE(browser_->becomes("return saved.length === 3"));
  EXPECT_EQ(js("return saved.sort()"),
            nlohmann::json::parse(R"(["quadrimodal_corners-60s.png", "quadrimodal_corners-60s.svg",
                                      "quadrimodal_corners-60s.webm"])"));
  expect_no_errors();
}

TEST_F(PageInABrowser, TextOfARecordIsTextOnly) {
  ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "5", "--out",
                      out()}),
            0);
  auto changed = summary();
  const std::string attack =
      "</script><script>window.broken = 1</script><img src=x onerror='window.broken = 2'>";
  for (const char* key : {"reason", "result", "version", "build", "mode"}) changed[key] = attack;
  changed["agents"][0]["host"] = attack;
  std::ofstream(out() / "summary.json") << changed.dump();
  ASSERT_EQ(ergocast({"report", out()}), 0);
  // Two scripts, the data and the program: no text ends one of them.
  const std::string html = text_of(out() / "report.html"), end = "</script";
  std::size_t ends = 0;
  for (auto at = html.find(end); at != html.npos; at = html.find(end, at + 1)) ++ends;
  ASSERT_EQ(ends, 2U);
  show_report();
  browser_->press("i");
  EXPECT_NE(text("detailsText").find("onerror='window.broken = 2'"), std::string::npos);
  EXPECT_EQ(js("return window.broken === undefined && document.images.length === 0"), true);
  // The policy blocks code that a mistake would let through.
  js("document.body.insertAdjacentHTML('beforeend', '<img src=x onerror=\"window.broken = 3\">');"
     "const s = document.createElement('script'); s.textContent = 'window.broken = 4'; "
     "document.body.append(s);");
  EXPECT_EQ(js("return window.broken === undefined"), true);
}

TEST_F(PageInABrowser, KeepOutsAreOutlined) {
  open_report({"--duration", "5"}, "#theme=light", "harbour_patrol");
  // The reddest pixel at the middle of the first piece of an outline.
  const auto drawn = js(
      "const { view, S } = ergocast, pieces = S.run.targetAt(0).nowhere.outline, s = "
      "devicePixelRatio;"
      "const [a, b, c, d] = pieces[0], x = view.px((a + c) / 2) * s, y = view.py((b + d) / 2) * s;"
      "const { data } = document.getElementById('shading').getContext('2d').getImageData("
      "Math.round(x) - 1, Math.round(y) - 1, 3, 3);"
      "const pixels = Array.from({ length: 9 }, (_, i) => [...data.slice(4 * i, 4 * i + 3)]);"
      "return [pieces.length, ...pixels.sort((p, q) => p[1] - q[1])[0]]");
  EXPECT_GT(drawn[0].get<int>(), 100);                       // pieces as long as a cell
  EXPECT_GT(drawn[1].get<int>(), drawn[2].get<int>() + 40);  // red
  EXPECT_GT(drawn[1].get<int>(), drawn[3].get<int>() + 40);
  screenshot("keep_outs");
  expect_no_errors();
}

TEST_F(PageInABrowser, TheMetricOfAFreeDomainNamesItsModes) {
  open_report({"--duration", "20", "--set", "basis.free_domain=true", "--set", "basis.modes_x=6",
               "--set", "basis.modes_y=6"},
              "#theme=light", "two_rooms");
  const auto shown = [&](const std::string& expression) {
    return js("return " + expression).get<std::string>();
  };
  const auto text_of = [&](const std::string& id) {
    return shown("document.getElementById('" + id + "').textContent");
  };
  EXPECT_EQ(text_of("metricName"), "φ² in modes of the free domain");
  EXPECT_NE(text_of("quantity").find("φ² in modes of the free domain"), std::string::npos);
  EXPECT_NE(text_of("quantity").find("Disagreement on φ² in modes of the free domain"),
            std::string::npos);
  EXPECT_NE(text_of("facts").find("φ² in modes ofthe free domain"), std::string::npos)
      << text_of("facts");
  EXPECT_NE(shown("document.getElementById('heads').innerHTML")
                .find("it knew at the end in modes of the free domain"),
            std::string::npos);
  EXPECT_NE(
      shown("document.getElementById('markers').ariaLabel").find("φ² in modes of the free domain"),
      std::string::npos);
  screenshot("free_domain");
  expect_no_errors();
}

TEST_F(PageInABrowser, AStudyIsSortedFilteredAndItsBestCellNamed) {
  std::ofstream(folder_ / "mission.textproto") << R"(
domain { size_x_m: 100 size_y_m: 100 }
target { gaussians { mean_x_m: 30 mean_y_m: 60 sigma_m: 12 } }
basis { modes_x: 5 modes_y: 5 }
law { u_max_mps: 5 noise_intensity: 1 }
time { duration_s: 40 }
agents { starts { x_m: 50 y_m: 20 } random_count: 1 })";
  ASSERT_EQ(ergocast({"study", folder_ / "mission.textproto", "--vary", "law.u_max_mps=0.1,10,3",
                      "--vary", "law.noise_intensity=0.01,1", "--seeds", "1:6", "--out", out()}),
            0)
      << output();
  browser_->open("file://" + (out() / "report.html").string());
  ASSERT_TRUE(browser_->becomes("return Boolean(window.ergocast)"));
  const auto rows = [this] {
    wait_for_frame();  // the page draws the request in its next frame
    return js(
        "return [...document.querySelectorAll('#rows > tr')].map(r => "
        "[r.children[0].textContent, r.children[1].textContent].join())");
  };

  // The table begins with the least φ², and the sentence names it.
  std::map<std::string, std::vector<double>>
      metrics;  // by the fields' values, as the page has them
  std::ifstream table(out() / "study.csv");
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream in(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    metrics[cells[1] + ',' + cells[2]].push_back(std::stod(cells[6]));
  }
  ASSERT_EQ(metrics.size(), 6U);
  std::vector<std::pair<double, std::string>> medians;
  for (auto& [name, values] : metrics) {
    std::sort(values.begin(), values.end());
    medians.emplace_back((values[2] + values[3]) / 2, name);
  }
  std::sort(medians.begin(), medians.end());
  nlohmann::json expected = nlohmann::json::array();
  for (const auto& [median, name] : medians) expected.push_back(name);
  EXPECT_EQ(rows(), expected);
  const std::string best = medians[0].second, speed = best.substr(0, best.find(','));
  EXPECT_NE(text("best").find("law.u_max_mps = " + speed +
                              ", law.noise_intensity = " + best.substr(best.find(',') + 1)),
            std::string::npos)
      << text("best");
  const auto& of_best = metrics[best];
  EXPECT_NEAR(js("return ergocast.shown().best.metric[1]").get<double>(), of_best[0],
              1e-3 * of_best[0]);
  EXPECT_NEAR(js("return ergocast.shown().best.metric[2]").get<double>(), of_best[5],
              1e-3 * of_best[5]);

  // The map: numbers ascend, the best cell is the strongest.
  EXPECT_EQ(js("return ergocast.S.across.values"), nlohmann::json::parse(R"(["0.1", "3", "10"])"));
  EXPECT_EQ(js("return ergocast.shown().cells.length"), 6);
  EXPECT_EQ(js("const p = document.getElementById('picture'), g = p.getContext('2d'), colours = {};"
               "for (const cell of ergocast.shown().cells) {"
               "  const [x, y] = ergocast.middleOf(cell), s = p.width / p.clientWidth;"
               "  colours[[...g.getImageData(x * s, (y + 24) * s, 1, 1).data].join()] = cell.point;"
               "}"
               "return colours['10,79,156,255'] === ergocast.shown().best"),
            true);
  screenshot("study");

  // The probability of detection is one of its quantities; the more, the better.
  js("ergocast.set({ quantity: 'found' })");
  wait_for_frame();
  EXPECT_NE(text("best").find(". Chance to have found an object "), std::string::npos)
      << text("best");
  EXPECT_EQ(js("const { points, best } = ergocast.shown();"
               "return points.every(p => p.found[0] <= best.found[0])"),
            true);
  EXPECT_EQ(js("return ergocast.S.study.quantities.includes('halfFound')"), true);
  js("ergocast.set({ quantity: 'metric' })");
  wait_for_frame();

  browser_->click("#heads th:nth-child(1) button");  // sorted by number, not by letters
  EXPECT_EQ(rows()[0].get<std::string>().substr(0, 4), "0.1,");
  EXPECT_EQ(rows()[2].get<std::string>().substr(0, 2), "3,");
  EXPECT_EQ(rows()[4].get<std::string>().substr(0, 3), "10,");
  browser_->click("#heads th:nth-child(1) button");
  EXPECT_EQ(rows()[0].get<std::string>().substr(0, 3), "10,");
  EXPECT_EQ(js("return document.querySelector('#heads th').getAttribute('aria-sort')"),
            "descending");

  js("ergocast.filter(ergocast.S.across.number, '3')");
  wait_for_frame();
  EXPECT_EQ(js("return document.querySelectorAll('#rows > tr').length"), 2);
  EXPECT_TRUE(text("best").starts_with("Best of what is shown: law.u_max_mps = 3"));
  js("ergocast.filter(ergocast.S.across.number, '')");
  browser_->click("#words");
  for (const char* key : {"m", "p", "s", "=", "1", "0"}) browser_->press(key);
  wait_for_frame();
  EXPECT_EQ(js("return document.querySelectorAll('#rows > tr').length"), 2);
  EXPECT_EQ(rows()[0].get<std::string>().substr(0, 3), "10,");

  // The points of the bands come from the table's columns.
  EXPECT_EQ(js("return ergocast.shown().curves[0].over_time.map(p => p[0])"),
            nlohmann::json::parse(
                "[1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.3, 8, 10, 12.5, 16, 20, 25, 32, 40]"));
  // The row's command runs that point.
  browser_->click("#rows tr td:last-child button");
  EXPECT_NE(js("return document.querySelector('.how pre').textContent")
                .get<std::string>()
                .find("law.u_max_mps=10"),
            std::string::npos);
  EXPECT_EQ(js("return new DOMParser().parseFromString(ergocast.svgText(), 'image/svg+xml')"
               ".querySelectorAll('parsererror').length"),
            0);
  browser_->resize(400, 800);
  ASSERT_TRUE(browser_->becomes("return innerWidth === 400"));
  EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true);
  screenshot("study_narrow");
  expect_no_errors();
}

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

  kill_next(agent(2));
  EXPECT_TRUE(browser_->becomes(
      "return ergocast.S.run.incidents.some(i => i.agent === 2 && /restarted|back/.test(i.text))"));
  EXPECT_TRUE(browser_->becomes(
      "return /killed by SIGKILL/.test(document.getElementById('log').textContent)"));
  // Seeks back in time while the team runs, and returns to the present.
  browser_->press(kHome);
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
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0);

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
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0);
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
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0);
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
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0);
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
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0);
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
