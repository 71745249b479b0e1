// SPDX-License-Identifier: BSD-3-Clause
// The page of a study in a real browser.
#include <algorithm>
#include <map>
#include <sstream>

#include "tests/page/page_in_a_browser.h"

namespace ergocast::test {
namespace {

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

}  // namespace
}  // namespace ergocast::test
