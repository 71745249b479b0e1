// SPDX-License-Identifier: BSD-3-Clause
// The page of a mission in a box: the view that turns, its slices, and the projections.
#include <cmath>
#include <sstream>

#include "tests/page/page_in_a_browser.h"

namespace ergocast::test {
namespace {

/// A place of agent 5's pin that has its colour.
constexpr const char* kBesideNumber =
    "(({ head, r }) => [head[0] - 0.8 * r, head[1]])(ergocast.marker(5))";

class BoxInABrowser : public PageInABrowser {
 protected:
  /// The cube's record in a browser with or without WebGL.
  void open_cube(bool webgl, const std::string& fragment = "#theme=light&tail=7") {
    browser_.reset();
    browser_.emplace(folder_, webgl);
    open_report({"--duration", "20"}, fragment, "cube_corners");
  }
  /// A pixel of a canvas, {red, green, blue}, at the position of an expression in pixels of the
  /// map.
  std::array<int, 3> pixel(const std::string& canvas, const std::string& at) {
    wait_for_frame();
    const auto drawn =
        js("const { view, S } = ergocast, [x, y] = " + at +
           ", s = devicePixelRatio, copy = document.createElement('canvas'), from = "
           "document.getElementById('" +
           canvas +
           "'); copy.width = from.width; copy.height = from.height; const g = "
           "copy.getContext('2d'); g.drawImage(from, 0, 0);"
           "return [...g.getImageData(Math.round(x * s), Math.round(y * s), 1, 1).data]");
    return {drawn[0], drawn[1], drawn[2]};
  }
  static int distance(const std::array<int, 3>& a, const std::array<int, 3>& b) {
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
  }
  /// x, y and z of an agent at a tick, as the record has them.
  std::array<double, 3> recorded_place(const std::string& row) {
    std::ifstream file(out() / "trajectory.csv");
    std::string line;
    while (std::getline(file, line) && !line.starts_with(row)) continue;
    std::array<double, 3> place{};
    std::istringstream(line.substr(row.size())) >> place[0] >> comma_ >> place[1] >> comma_ >>
        place[2];
    return place;
  }

 private:
  char comma_ = 0;
};

TEST_F(BoxInABrowser, ABoxHasItsAgentsTailsAndSlices) {
  open_cube(true);
  EXPECT_EQ(js("return ergocast.S.view"), "turn");
  EXPECT_EQ(js("return document.getElementById('noSpace').hidden"), true);
  // φ² of all modes, up to the rounding of positions to 14 bits.
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 1e-3);

  js("ergocast.draw(10)");
  const auto place = recorded_place("100,10,5,");
  const auto shown = js("const t = ergocast.S.run.track(5); return ergocast.view.placeAt(t, 100)");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(shown[axis].get<double>(), place[axis], 0.05);
  }
  // The tip of its pin is at the projection of its position; the agent's colour is beside the
  // number.
  EXPECT_EQ(js("const { view, S, marker } = ergocast, at = view.placeAt(S.run.track(5), 100);"
               "return String(marker(5).tip) === String(view.project(at).slice(0, 2))"),
            true);
  EXPECT_EQ(pixel("markers", kBesideNumber), (std::array{0x5a, 0x48, 0xb8}));

  // The slices meet at the densest place of the target: one of the eight peaks, darker than
  // between them.
  for (int axis = 0; axis < 3; ++axis) {
    const double share = js("return ergocast.S.slices[" + std::to_string(axis) + "]");
    EXPECT_NEAR(std::min(std::abs(share - 0.25), std::abs(share - 0.75)), 0, 0.03) << axis;
  }
  js("ergocast.set('tail', 0)");
  const std::string peak = "view.project(S.slices.map((u, i) => u * S.run.size[i]))";
  const auto dense = pixel("space", peak);
  for (const char* key : {"x", "y", "z"}) browser_->press(key);
  EXPECT_EQ(js("return ergocast.S.slices"), nlohmann::json::parse("[null, null, null]"));
  const std::string where = "view.project([250, 750, 250])";
  const auto empty = pixel("space", where);
  EXPECT_GT(distance(dense, empty), 60);

  // A slider moves its slice and shows the slice's position.
  browser_->press("z");
  js("const slider = document.querySelectorAll('#slices input[type=range]')[2];"
     "slider.value = 0.75; slider.dispatchEvent(new Event('input'));");
  EXPECT_EQ(js("return document.querySelectorAll('#slices output')[2].textContent"), "750 m");
  EXPECT_GT(distance(pixel("space", "view.project([250, 750, 750])"),
                     pixel("space", "view.project([490, 490, 750])")),
            40);
  // The coverage so far differs from the target: the start of agent 1 was covered.
  const std::string start = "view.project([30, 30, 750])";
  js("ergocast.S.slices[2] = 0.99; ergocast.set('layer', 'target')");
  const auto wanted = pixel("space", "view.project([15, 15, 990])");
  js("ergocast.set('layer', 'achieved')");
  EXPECT_GT(distance(pixel("space", "view.project([15, 15, 990])"), wanted), 30);

  // A tail: where agent 5 was four seconds ago.
  js("ergocast.S.slices[2] = null; ergocast.set('tail', 0)");
  const std::string tail = "view.project(view.placeAt(S.run.track(5), 60))";
  const auto without = pixel("space", tail);
  js("ergocast.set('tail', 1)");
  EXPECT_GT(distance(pixel("space", tail), without), 60);
  js("ergocast.set('tail', 7); ergocast.S.slices = [0.25, 0.75, 0.25]; ergocast.set('layer', "
     "'target')");
  screenshot("box");
  expect_no_errors();
}

TEST_F(BoxInABrowser, ABoxTurnsByMouseKeysAndWheel) {
  open_cube(true, "#theme=dark");
  // The corner nearest to the eye follows the mouse.
  const std::string nearest =
      "const { view } = ergocast; return view.project([0, 1, 2].map(i => view.forward[i] > 0 ? 0 "
      ": view.size[i]))";
  const auto before = js(nearest);
  browser_->drag("#markers", 40, 0);
  EXPECT_NEAR(js("return ergocast.view.azimuth").get<double>(), -0.55 + 0.32, 1e-9);
  EXPECT_GT(js(nearest)[0].get<double>(), before[0].get<double>() + 40);
  browser_->drag("#markers", 0, 25);
  EXPECT_NEAR(js("return ergocast.view.elevation").get<double>(), 0.42 + 0.2, 1e-9);
  EXPECT_GT(js(nearest)[1].get<double>(), before[1].get<double>());
  EXPECT_EQ(js("return document.getElementById('fit').hidden"), false);
  for (const char* key : {"q", "f"}) browser_->press(key);
  EXPECT_NEAR(js("return ergocast.view.azimuth").get<double>(), -0.23 - M_PI / 24, 1e-9);
  EXPECT_NEAR(js("return ergocast.view.elevation").get<double>(), 0.62 - M_PI / 24, 1e-9);

  js("document.getElementById('markers').dispatchEvent(new WheelEvent('wheel', { deltaY: -300, "
     "clientX: 300, clientY: 400 }))");
  EXPECT_NEAR(js("return ergocast.view.zoom").get<double>(), std::exp(0.48), 1e-9);
  screenshot("box_near");
  browser_->press("0");
  EXPECT_EQ(js("return [ergocast.view.zoom, ergocast.view.azimuth]"),
            nlohmann::json::parse("[1, -0.55]"));
  EXPECT_EQ(js("return document.getElementById('fit').hidden"), true);
  browser_->press("v");
  EXPECT_EQ(js("return ergocast.S.view"), "xy");
  screenshot("box_from_above");

  // The whole picture with its numbers is inside the canvas from every direction.
  js("ergocast.showView('turn'); ergocast.draw(10)");
  EXPECT_EQ(js("const { view, S } = ergocast; let out = 0;"
               "for (let a = 0; a < 6.3; a += 0.1) for (let e = -1.5; e < 1.6; e += 0.25) {"
               "  Object.assign(view, { azimuth: a, elevation: e }); view.place(S.run.size);"
               "  for (let c = 0; c < 8; c++) {"
               "    const [x, y] = view.project([c & 1, c >> 1 & 1, c >> 2].map(b => 1000 * b));"
               "    if (x < 10 || y < 10 || x > view.width - 10 || y > view.height - 10) out++;"
               "  } } return out"),
            0);
  // As a picture of lines and text it holds the box as an image.
  const std::string svg = js("return ergocast.svgText()");
  EXPECT_NE(svg.find("<image href=\"data:image/png"), std::string::npos);
  EXPECT_NE(svg.find("z [m]"), std::string::npos);
  EXPECT_EQ(js("return ergocast.svgText().replace(/base64,[^\"]*/g, '').includes('NaN')"), false);
  browser_->resize(400, 800);
  ASSERT_TRUE(browser_->becomes("return innerWidth === 400"));
  EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true);
  screenshot("box_narrow");
  expect_no_errors();
}

TEST_F(BoxInABrowser, WithoutWebGlThereAreProjections) {
  open_cube(false);
  EXPECT_EQ(js("return ergocast.S.view"), "xy");
  EXPECT_NE(text("noSpace").find("no WebGL"), std::string::npos);
  EXPECT_EQ(js("return document.getElementById('noSpace').hidden"), false);
  EXPECT_EQ(js("return document.querySelector('#view [data-value=turn]').disabled"), true);
  js("ergocast.draw(10)");
  const auto place = recorded_place("100,10,5,");
  for (const auto& [name, a, b] : {std::tuple{"xz", 0U, 2U}, {"yz", 1U, 2U}, {"xy", 0U, 1U}}) {
    browser_->click(std::string("#view [data-value=") + name + "]");
    EXPECT_EQ(js("return ergocast.S.view"), name);
    const auto at =
        js("const t = ergocast.shown().tracks.find(t => t.id === 5);"
           "return [t.p[200], t.p[201]]");
    EXPECT_NEAR(at[0].get<double>(), place[a], 0.05) << name;
    EXPECT_NEAR(at[1].get<double>(), place[b], 0.05) << name;
    const auto off =
        js("const { view, marker } = ergocast, [x, y] = marker(5).tip;"
           "return [x - view.px(" +
           std::to_string(place[a]) + "), y - view.py(" + std::to_string(place[b]) + ")]");
    EXPECT_NEAR(off[0].get<double>(), 0, 0.1) << name;
    EXPECT_NEAR(off[1].get<double>(), 0, 0.1) << name;
    EXPECT_EQ(pixel("markers", kBesideNumber), (std::array{0x5a, 0x48, 0xb8})) << name;
    // Four pairs of peaks, one behind the other.
    js("ergocast.set('tail', 0)");
    EXPECT_GT(distance(pixel("shading", "[view.px(250), view.py(750)]"),
                       pixel("shading", "[view.px(500), view.py(500)]")),
              100)
        << name;
    screenshot(std::string("box_") + name);
  }
  expect_no_errors();
}

TEST_F(BoxInABrowser, AFlatBoxIsDrawnHigher) {
  open_report({"--duration", "60"}, "#view=xz", "water_column");
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 1e-3);
  EXPECT_EQ(js("return ergocast.shown().stretch"), nlohmann::json::parse("[1, 5]"));
  EXPECT_NE(js("return ergocast.svgText()").get<std::string>().find("z [m] × 5"),
            std::string::npos);
  // The target is larger at the surface than at the bottom, and zero at the land in the west.
  const auto cells =
      js("const { cells, width, height } = ergocast.shown().targetAt(0).density, at = (u, v) => "
         "cells[Math.floor(v * height) * width + Math.floor(u * width)];"
         "return [at(0.5, 0.02), at(0.5, 0.9), at(0.03, 0.02)]");
  EXPECT_GT(cells[0].get<int>(), 2 * cells[1].get<int>());
  EXPECT_GT(cells[0].get<int>(), 2 * cells[2].get<int>());
  // Heights of the record, above the box's floor at -60 m.
  const auto place = recorded_place("100,10,1,");
  EXPECT_NEAR(js("const t = ergocast.S.run.track(1); return t.z[100]").get<double>(), place[2] + 60,
              0.01);
  js("ergocast.draw(10)");
  const auto drawn =
      js("const { view, shown } = ergocast, t = shown().tracks.find(t => t.id === 1);"
         "return view.at(t, 100)[1] - view.py(0)");
  EXPECT_NEAR(drawn.get<double>(),
              -js("return ergocast.view.scale").get<double>() * 5 * (place[2] + 60), 1);
  screenshot("flat_xz");
  expect_no_errors();
}

TEST_F(BoxInABrowser, ABoxGrowsLive) {
  browser_.reset();
  browser_.emplace(folder_, true);
  Child mission =
      launch_endless(scenario_file("cube_corners"), {"--realtime=10", "--watch", "--port", "8812"});
  browser_->open("http://127.0.0.1:8812/");
  EXPECT_TRUE(browser_->becomes(
      "return Boolean(window.ergocast?.S.run) && ergocast.S.run.rows > 50 && ergocast.S.live"));
  EXPECT_EQ(js("return ergocast.S.view"), "turn");
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.tracks.length === 8"));
  EXPECT_TRUE(browser_->becomes(
      "const t = ergocast.S.run.track(3); return t.z[t.last] < 1000 && t.z[t.first] === 1000"));
  // A moving agent has a tail behind it.
  js("ergocast.set('tail', 7); ergocast.S.slices = [null, null, null]");
  EXPECT_TRUE(browser_->becomes(
      "const { view, S } = ergocast, t = S.run.track(3), from = document.getElementById('space'), "
      "copy = document.createElement('canvas'); copy.width = from.width; copy.height = "
      "from.height; const g = copy.getContext('2d'); g.drawImage(from, 0, 0);"
      "const [x, y] = view.project(view.placeAt(t, Math.max(t.first, S.run.rowAt(S.t) - 25)));"
      "const [r, gr, b] = g.getImageData(Math.round(x), Math.round(y), 1, 1).data;"
      "return r - gr > 20 && b - gr > 10"));  // its magenta
  screenshot("box_live");
  expect_no_errors();
  mission.send(SIGINT);
  EXPECT_TRUE(browser_->becomes("return !ergocast.S.live && Boolean(ergocast.S.run.summary)"));
  EXPECT_EQ(js("return ergocast.S.view"), "turn");
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 0.02);
  close_page_of(mission);
}

}  // namespace
}  // namespace ergocast::test
