// SPDX-License-Identifier: BSD-3-Clause
// The report of a finished mission, opened from disk in a real browser.
#include "tests/page/page_in_a_browser.h"

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

}  // namespace
}  // namespace ergocast::test
