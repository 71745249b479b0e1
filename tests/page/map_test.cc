// SPDX-License-Identifier: BSD-3-Clause
// The map shows the size of bodies and the place of the target.
#include "tests/page/page_in_a_browser.h"

namespace ergocast::test {
namespace {

/// The number of pixels within ten of agent 0's place that have exactly its colour.
constexpr const char* kOwnPixels =
    "const { view, S, shown } = ergocast, track = shown().track(0);"
    "const [x, y] = view.at(track, S.run.rowAt(S.t)), [r, g, b] = [1, 3, 5].map(i => "
    "parseInt(S.colours.agent(0).slice(i, i + 2), 16));"
    "const { data } = document.getElementById('markers').getContext('2d').getImageData("
    "Math.round(x) - 10, Math.round(y) - 10, 21, 21);"
    "let count = 0;"
    "for (let i = 0; i < data.length; i += 4)"
    "  if (data[i] === r && data[i + 1] === g && data[i + 2] === b) count++;"
    "return count";

/// The distance of two colours in OKLab; 1 is that of black and white.
constexpr const char* kDistance =
    "const linear = v => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);"
    "const lab = rgb => { const [r, g, b] = rgb.map(v => linear(v / 255));"
    "  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);"
    "  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);"
    "  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);"
    "  return [0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,"
    "    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,"
    "    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s]; };"
    "const distance = (p, q) => Math.hypot(...lab(p).map((v, i) => v - lab(q)[i]));"
    // Finds the first cell whose density is between `low` and `high` of 255, and reads the
    // shading's pixel in its middle.
    "const { S, view } = ergocast, { size } = S.run, { width, height, cells } = "
    "S.run.targetAt(0).density;"
    "const pixel = (low, high) => { const i = cells.findIndex(v => v >= low && v <= high);"
    "  const x = view.px((i % width + 0.5) / width * size[0]);"
    "  const y = view.py((1 - (Math.floor(i / width) + 0.5) / height) * size[1]);"
    "  return [...document.getElementById('shading').getContext('2d').getImageData("
    "    Math.round(x), Math.round(y), 1, 1).data].slice(0, 3); };";

TEST_F(PageInABrowser, BodiesAreDrawnToScale) {
  open_report({"--duration", "40"}, "#theme=light&tail=0&t=30", "office");
  browser_->click("#distance");  // discs, no rings
  wait_for_frame();
  // Half of the 0.45 m that bodies keep, at 15 to 30 pixels a metre.
  const double radius = 0.225 * js("return ergocast.view.scale").get<double>();
  ASSERT_LT(radius, 7);
  EXPECT_LT(js(kOwnPixels), 160) << "a drop of its size before had twice as many";
  EXPECT_GT(js(kOwnPixels), 3 * radius * radius - 15);
  screenshot("bodies");
  // At high zoom the body is large, and the number is inside.
  js("const { view, S, shown } = ergocast, track = shown().track(0);"
     "view.zoomAt(8, ...view.at(track, S.run.rowAt(S.t)), shown().size); ergocast.set('tail', 0)");
  wait_for_frame();
  const auto marker =
      js("const { body, inside } = ergocast.marker(0); return [...body, inside, "
         "ergocast.view.scale]");
  EXPECT_NEAR(marker[0].get<double>(), 0.225 * marker[3].get<double>(), 1e-6);
  EXPECT_EQ(marker[0], marker[1]);
  EXPECT_EQ(marker[2], true);
  screenshot("bodies_near");
  expect_no_errors();
}

TEST_F(PageInABrowser, APinPointsToThePlaceOfAnAgentWithoutABody) {
  open_report({"--duration", "10"}, "#theme=light&tail=0&t=5");
  wait_for_frame();
  EXPECT_EQ(js("return ergocast.marker(0).body"), nlohmann::json::parse("[0, 0]"));
  EXPECT_EQ(js("const { view, S, marker } = ergocast, { tip } = marker(0);"
               "return String(tip) === String(view.at(S.run.track(0), S.run.rowAt(S.t)))"),
            true);
  expect_no_errors();
}

TEST_F(PageInABrowser, TheTargetIsSeenAndTrailsAboveIt) {
  open_report({"--duration", "10"}, "#theme=light&tail=0");
  for (const char* theme : {"light", "dark"}) {
    js(std::string("ergocast.setTheme('") + theme + "')");
    wait_for_frame();
    const auto seen = js(std::string(kDistance) + "return distance(pixel(0, 3), pixel(150, 158))");
    EXPECT_GT(seen.get<double>(), 0.185) << theme << ": a place of 60 % of the scale";
    const auto trails =
        js(std::string(kDistance) +
           "const peak = pixel(252, 255), rgb = hex => [1, 3, 5].map(i => parseInt(hex.slice(i, i "
           "+ 2), 16));"
           "return Math.min(...Array.from({ length: 8 }, (_, i) => "
           "distance(rgb(S.colours.agent(i)), peak)))");
    EXPECT_GT(trails.get<double>(), 0.18) << theme << ": the agents' colours over the peak";
  }
  expect_no_errors();
}

}  // namespace
}  // namespace ergocast::test
