// SPDX-License-Identifier: BSD-3-Clause
// A page of a run in a real browser.
//
// With ERGOCAST_SCREENSHOTS=FOLDER the tests save their screenshots there.
#pragma once

#include <cstdlib>
#include <iostream>
#include <optional>

#include "tests/process/support/mission.h"
#include "tests/support/browser.h"

namespace ergocast::test {

class PageInABrowser : public RunningMission {
 protected:
  /// A finished mission, its report open in the browser.
  void open_report(std::vector<std::string> mission = {"--duration", "60"},
                   const std::string& fragment = "", const char* name = "quadrimodal_corners") {
    mission.insert(mission.begin(), {"simulate", scenario_file(name), "--out", out()});
    ASSERT_EQ(ergocast(mission), 0) << output();
    show_report(fragment);
  }
  void show_report(const std::string& fragment = "") {
    browser_->open("file://" + (out() / "report.html").string() + fragment);
    ASSERT_TRUE(browser_->becomes("return Boolean(window.ergocast && ergocast.S.run.ready)"));
    wait_for_frame();  // the first one is drawn after the run is ready
  }
  /// Waits for two frames; the second one shows the requested change.
  void wait_for_frame() {
    js("return new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))");
  }
  void screenshot(const std::string& name) {
    wait_for_frame();
    const char* folder = std::getenv("ERGOCAST_SCREENSHOTS");
    if (folder != nullptr)
      browser_->save_screenshot(std::filesystem::path(folder) / (name + ".png"));
  }
  void expect_no_errors() { EXPECT_EQ(browser_->errors(), std::vector<std::string>()); }
  nlohmann::json js(const std::string& script) { return browser_->run(script); }
  /// Ends the page of a mission that has ended.
  void close_page_of(Child& mission) {
    ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
    mission.send(SIGINT);
    EXPECT_EQ(wait_for(mission), 0);
  }
  std::string text(const std::string& id) {
    return js("return document.getElementById('" + id + "').textContent");
  }
  /// What a live page knew when a test failed.
  void describe_page() {
    const auto state = js(
        "const s = window.ergocast?.S; if (!s?.run) return document.body.innerText.slice(0, 300);"
        "const { run, facts } = s, last = list => list[list.length - 1];"
        "return { banner: document.getElementById('banner').textContent, rows: run.rows,"
        "  stride: run.stride, end_s: run.end, counted_s: run.counted(run.end), holds: run.holds,"
        "  recalled: [...run.recalledFrom], metric_t: last(run.metrics.t),"
        "  metrics: run.metrics.t.length, found: run.metrics.found.length,"
        "  last_found: last(run.metrics.found), curve: run.foundCurve.values.length,"
        "  looks_done: run.foundCurve.detection.done, amendments: run.amendments,"
        "  tracks: run.tracks.map(t => [t.id, t.first, t.last, t.hasGaps, String(t.member)]),"
        "  world_tick: facts?.state?.world_tick, live: s.live }");
    std::cerr << "the page at the end: " << state.dump() << "\n";
    for (const std::string& error : browser_->errors())
      std::cerr << "its console: " << error << "\n";
  }
  void TearDown() override {
    if (HasFailure()) {
      screenshot("failed");
      describe_page();
    }
    browser_.reset();  // its processes are on this host, too
    RunningMission::TearDown();
  }

  std::optional<Browser> browser_{std::in_place, folder_};
};

}  // namespace ergocast::test
