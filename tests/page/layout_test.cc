// SPDX-License-Identifier: BSD-3-Clause
// Nothing that a person needs is cut off or hidden, on a laptop or on a telephone.
#include "tests/page/page_in_a_browser.h"

namespace ergocast::test {
namespace {

class LayoutInABrowser : public PageInABrowser {
 protected:
  void be(int width, int height) {
    browser_->resize(width, height);
    ASSERT_TRUE(browser_->becomes("return innerWidth === " + std::to_string(width)));
    wait_for_frame();
  }
};

TEST_F(LayoutInABrowser, AStudysControlsAndResultsAreWhole) {
  std::ofstream(folder_ / "mission.textproto") << R"(
domain { size_x_m: 100 size_y_m: 100 }
target { gaussians { mean_x_m: 30 mean_y_m: 60 sigma_m: 12 } }
basis { modes_x: 3 modes_y: 3 }
law { u_max_mps: 5 noise_intensity: 1 }
time { duration_s: 20 }
agents { starts { x_m: 50 y_m: 20 } })";
  ASSERT_EQ(ergocast({"study", folder_ / "mission.textproto", "--vary", "law.u_max_mps=3,10",
                      "--vary", "law.noise_intensity=0.01,1", "--vary",
                      "law.perturbation=CONSTANT,ADAPTIVE", "--seeds", "1:6", "--out", out()}),
            0)
      << output();
  browser_->open("file://" + (out() / "report.html").string() + "#theme=light");
  ASSERT_TRUE(browser_->becomes("return Boolean(window.ergocast)"));
  for (const auto& [width, height] : {std::pair{1280, 800}, {400, 800}, {1920, 1080}}) {
    be(width, height);
    EXPECT_EQ(js("return [...document.querySelectorAll('select')].filter(select => {"
                 "  const whole = select.cloneNode(true), { font } = getComputedStyle(select);"
                 "  Object.assign(whole.style, { position: 'absolute', maxWidth: 'none', font });"
                 "  document.body.append(whole);"
                 "  const cut = whole.offsetWidth > select.offsetWidth + 1;"
                 "  whole.remove();"
                 "  return cut; }).map(select => select.id || select.dataset.number)"),
              nlohmann::json::array())
        << width;
    EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true) << width;
    screenshot("study_" + std::to_string(width));
  }
  // φ² of the best point, where a finger finds it.
  be(400, 800);
  EXPECT_EQ(js("const cell = document.querySelector('#rows tr').children[4];"
               "cell.scrollIntoView({ block: 'center' });"
               "const { left, right, top, bottom } = cell.getBoundingClientRect();"
               "return /\\[.*\\]/.test(cell.textContent) && [left + 2, (left + right) / 2, right - "
               "2].every(x => document.elementFromPoint(x, (top + bottom) / 2) === cell)"),
            true);
  expect_no_errors();
}

TEST_F(LayoutInABrowser, AgentsAndButtonsAreWhole) {
  open_report({"--duration", "20", "--event-log"}, "#theme=light", "office");
  const char* kCut =
      "const box = document.querySelector('.agents .scroll');"
      "return [document.querySelectorAll('#heads th').length, box.scrollWidth - box.clientWidth]";
  for (const auto& [width, height] : {std::pair{1280, 800}, {400, 800}, {1920, 1080}}) {
    be(width, height);
    EXPECT_EQ(js(kCut), nlohmann::json::parse("[8, 0]")) << width;
    EXPECT_EQ(js("return ['detailsButton', 'saveButton', 'theme', 'help'].filter(id => {"
                 "  const { left, right, width } = "
                 "document.getElementById(id).getBoundingClientRect();"
                 "  return !(width > 0 && left >= 0 && right <= innerWidth); })"),
              nlohmann::json::array())
        << width;
    EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true) << width;
    screenshot("report_" + std::to_string(width));
  }
  be(400, 800);
  browser_->click("#help");
  EXPECT_EQ(js("return document.getElementById('keys').open"), true);
  EXPECT_EQ(js("return document.getElementById('keys').scrollTop"), 0);
  screenshot("help_narrow");
  expect_no_errors();
}

}  // namespace
}  // namespace ergocast::test
