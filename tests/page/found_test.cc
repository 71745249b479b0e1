// SPDX-License-Identifier: BSD-3-Clause
// The page computes from positions what the record says the team has found, and shows where an
// object may still be.
#include "tests/page/page_in_a_browser.h"

namespace ergocast::test {
namespace {

/// Between a probability by the record's positions and one by the page's, which are rounded to 14
/// bits. Few cells are that near to the rim of a sensor's circle, and each has little mass.
constexpr double kTolerance = 5e-4;

class FoundInABrowser : public PageInABrowser {
 protected:
  double worst() { return js("return ergocast.worstFound()"); }
  /// The same number after times in any order.
  bool depends_on_the_way() {
    return js(
        "const { run } = ergocast.S, at = row => run.detection.probability(row);"
        "const rows = [0.9, 0.2, 0.6, 0.61, 0.59, 0.1, 0.9].map(u => Math.round(u * run.rows));"
        "const first = new Map(rows.map(row => [row, at(row)]));"
        "return rows.reverse().some(row => Math.abs(at(row) - first.get(row)) > 1e-12)");
  }
  double recorded(const char* key) { return summary()["detection"][key]; }
};

TEST_F(FoundInABrowser, IsThatOfTheRecord) {
  open_report({});
  EXPECT_GT(recorded("probability"), 0.8);
  EXPECT_LT(worst(), kTolerance);
  EXPECT_FALSE(depends_on_the_way());
  // A look, four ticks, more or less.
  const auto times = js("const { run } = ergocast.S; return run.detection.at(run.rows - 1).times");
  EXPECT_NEAR(times[0].get<double>(), recorded("time_to_half_s"), 0.5);
  EXPECT_NEAR(times[1].get<double>(), recorded("time_to_four_fifths_s"), 0.5);
  // A long record is counted in slices.
  EXPECT_EQ(js("const { detection, rows } = ergocast.S.run; detection.reset();"
               "return detection.build(rows - 1, 0)"),
            false);
  js("ergocast.set('layer', 'missed')");
  EXPECT_TRUE(
      browser_->becomes("const { run } = ergocast.S; return run.detection.build(run.rows - 1, 0)"));
  EXPECT_LT(worst(), kTolerance);
  expect_no_errors();
}

TEST_F(FoundInABrowser, IsThatOfTheRecordInRoomsWithModesOfTheFreeDomain) {
  open_report({"--duration", "120", "--set", "basis.free_domain=true", "--set", "basis.modes_x=6",
               "--set", "basis.modes_y=6"},
              "", "two_rooms");
  EXPECT_GT(recorded("probability"), 0.1);
  EXPECT_LT(worst(), kTolerance);
  expect_no_errors();
}

TEST_F(FoundInABrowser, IsThatOfTheRecordInABox) {
  open_report({"--duration", "120", "--set", "sensor.radius_m=80"}, "#view=xz&layer=missed",
              "cube_corners");
  EXPECT_GT(recorded("probability"), 0.2);
  EXPECT_LT(worst(), kTolerance);
  EXPECT_FALSE(depends_on_the_way());
  // What is left has the same mass in the average along any axis, and over all slices.
  const auto sums =
      js("const { run } = ergocast.S, row = run.rows - 1;"
         "const mean = values => values.reduce((sum, v) => sum + v, 0) / values.length;"
         "const slices = Array.from({ length: run.mission.sensor.cells[2] }, (_, l, n) =>"
         "  mean(run.missed(row, 2, (l + 0.5) / run.mission.sensor.cells[2]).values));"
         "return [0, 1, 2].map(axis => mean(run.missed(row, axis).values)).concat(mean(slices))");
  for (const auto& sum : sums) EXPECT_NEAR(sum.get<double>(), 1, 1e-4);
  screenshot("missed_in_a_box");
  expect_no_errors();
}

/// Agents that rest at their stations find nothing, and cover nothing.
TEST_F(FoundInABrowser, IsThatOfTheRecordWhereAgentsRest) {
  open_report({}, "", "home_by_dusk");
  EXPECT_LT(worst(), kTolerance);
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 1e-3);
  EXPECT_GT(js("const { run } = ergocast.S, at = row => run.detection.probability(row);"
               "const rested = at(run.rows - 1); run.restFrom.clear(); run.forget(0);"
               "return at(run.rows - 1) - rested")
                .get<double>(),
            1e-4)
      << "at their stations they would have found more";
  expect_no_errors();
}

/// The same while their batteries are charged there.
TEST_F(FoundInABrowser, IsThatOfTheRecordWhereBatteriesAreCharged) {
  open_report({"--duration", "250"}, "", "recharge");
  EXPECT_LT(js("return ergocast.worstMetric()").get<double>(), 1e-3);
  EXPECT_GT(js("const { run } = ergocast.S;"
               "return run.tracks.reduce((sum, track) => sum + Array.from({ length: run.rows },"
               "  (_, row) => run.charges(track, row)).filter(Boolean).length, 0)")
                .get<int>(),
            200);
  expect_no_errors();
}

/// The page has every second tick. Agents hardly find anything in a look, so that much is left.
TEST_F(FoundInABrowser, IsNearThatOfTheRecordOnAPageWithFewerTicks) {
  open_report({"--duration", "4000", "--set", "time.dt_s=0.02", "--set", "law.u_max_mps=5", "--set",
               "sensor.detections_per_s=0.02", "--set", "basis.modes_x=4", "--set",
               "basis.modes_y=4"});
  ASSERT_GT(js("return ergocast.S.run.stride").get<int>(), 1);
  EXPECT_LT(recorded("probability"), 0.95);
  EXPECT_LT(worst(), 5e-3);
  expect_no_errors();
}

TEST_F(FoundInABrowser, BeginsAgainWithANewTarget) {
  std::ofstream(folder_ / "middle.textproto")
      << "target { gaussians { mean_x_m: 1000 mean_y_m: 1000 sigma_m: 150 } }";
  open_report({"--duration", "120", "--amend", "40:" + (folder_ / "middle.textproto").string()},
              "#theme=light&layer=missed&quantity=found");
  const auto found = js("return [39, 41, 119].map(t => ergocast.S.run.foundAt(t))");
  EXPECT_GT(found[0], 0.05);
  EXPECT_LT(found[1], 0.01);
  EXPECT_GT(found[2], 0.1);
  EXPECT_LT(worst(), kTolerance);
  EXPECT_FALSE(depends_on_the_way());
  // The chart has a line at the change, as that of φ².
  EXPECT_EQ(js("return ergocast.svgText().split('stroke-dasharray=\"6 3\"').length - 1"), 1);
  screenshot("missed_amended");
  // A target that the page never received has no probability.
  js("const { run } = ergocast.S; run.received.clear(); run.setAmendments(run.amendments)");
  EXPECT_EQ(js("return String(ergocast.S.run.detection.probability(1000))"), "NaN");
  EXPECT_GT(js("return ergocast.S.run.detection.probability(390)"), 0.05);
  expect_no_errors();
}

TEST_F(FoundInABrowser, TheMapShowsWhereAnObjectMayStillBe) {
  open_report({"--duration", "60"}, "#theme=light&tail=0&quantity=found");
  // The strength of the shading at a place over that of an empty one.
  const std::string strength =
      "const { view, S } = ergocast, g = document.getElementById('shading').getContext('2d');"
      "const pixel = (x, y) => [...g.getImageData(Math.round(view.px(x) * devicePixelRatio),"
      "  Math.round(view.py(y) * devicePixelRatio), 1, 1).data];"
      "const strength = (x, y) => Math.hypot(...pixel(x, y).map((v, i) => v - pixel(1000, "
      "1990)[i]));";
  // At the start this is the target.
  EXPECT_LT(
      js(strength + "const both = ['target', 'missed'].map(layer => { ergocast.set('layer', layer);"
                    "  ergocast.draw(0); return strength(500, 500); });"
                    "return Math.abs(both[1] - both[0])")
          .get<double>(),
      12);
  // The place of the target where agent 0 has been longest, and one that no agent was near.
  js("ergocast.set('layer', 'missed'); ergocast.draw(ergocast.S.run.end)");
  const auto seen = js(strength +
                       "const { run } = S, row = run.rows - 1; let least = null, most = null;"
                       "for (let x = 350; x <= 650; x += 10) for (let y = 350; y <= 650; y += 10) {"
                       "  const p = run.detection.missedAt(row, x, y);"
                       "  if (!least || p < least.p) least = { p, x, y };"
                       "  if (p === 1 && (!most || Math.hypot(x - 500, y - 500) < "
                       "      Math.hypot(most.x - 500, most.y - 500))) most = { p, x, y }; }"
                       "return [least, most].flatMap(({ p, x, y }) => [p, strength(x, y)])");
  EXPECT_LT(seen[0], 0.3);
  EXPECT_LT(seen[1], 60) << seen;
  EXPECT_EQ(seen[2], 1);
  EXPECT_GT(seen[3], 150) << seen;
  // In words, and in figures.
  EXPECT_EQ(text("scaleHigh"), "may still be here");
  EXPECT_NE(js("return document.getElementById('scale').title").get<std::string>().find("may be"),
            std::string::npos);
  std::string percent = text("nowFound");
  EXPECT_NEAR(std::stod(percent), 100 * recorded("probability"), 0.1) << percent;
  EXPECT_TRUE(percent.ends_with("%")) << percent;
  EXPECT_NE(text("facts").find("chance to have found an object" + percent), std::string::npos)
      << text("facts");
  EXPECT_NE(js("return document.getElementById('chart').getAttribute('aria-label')")
                .get<std::string>()
                .find(percent),
            std::string::npos);
  js("ergocast.draw(0)");
  EXPECT_EQ(std::stod(text("nowFound")), 0);
  EXPECT_EQ(js("return document.querySelectorAll('parsererror').length"), 0);
  screenshot("missed");
  expect_no_errors();
}

/// Objects close to each other, and how the page says how many of them were found.
TEST_F(FoundInABrowser, FindsHaveLabelsOfTheirOwn) {
  open_report(
      {"--duration", "120", "--set", "sensor.radius_m=150", "--set", "world.objects.count=12"},
      "#theme=light");
  const nlohmann::json objects = summary()["objects"];
  ASSERT_GT(objects["found"].get<int>(), 4);
  const std::string found = objects["found"].dump() + " of 12";
  EXPECT_NE(text("facts").find("hidden objects found" + found), std::string::npos) << text("facts");
  EXPECT_EQ(js("return ergocast.S.run.marks.filter(mark => mark.kind === 'find').length"),
            objects["found"]);
  // Two at one place, and two whose labels would overlap.
  const auto overlaps =
      js("const places = [[100, 100], [100, 100], [140, 103], [95, 108], [300, 300]];"
         "const boxes = ergocast.labelBoxes(places, places.map(() => 60)); let n = 0;"
         "for (let i = 0; i < boxes.length; i++) for (let k = 0; k < i; k++) {"
         "  const a = boxes[i], b = boxes[k];"
         "  if (a.x < b.x + b.w && b.x < a.x + a.w && a.y < b.y + b.h && b.y < a.y + a.h) n++; }"
         "return [n, boxes[4].x > 300]");
  EXPECT_EQ(overlaps[0], 0);
  EXPECT_EQ(overlaps[1], true);
  EXPECT_LE(js("const [box] = ergocast.labelBoxes([[380, 50]], [60], 400); return box.x + box.w")
                .get<double>(),
            380)
      << "it stays on the picture";
  screenshot("finds");
  expect_no_errors();
}

TEST_F(FoundInABrowser, ContactsAreListedTheLikeliestFirst) {
  open_report(
      {"--seed", "4", "--set", "sensor.false_alarms_per_s=0.02", "--set", "sensor.radius_m=60"},
      "#theme=light", "mine_line");
  const nlohmann::json contacts = summary()["contacts"];
  ASSERT_GT(contacts.size(), 1U);
  const nlohmann::json rows =
      js("return [...document.getElementById('contacts').rows].map(row =>"
         "  [...row.cells].map(cell => cell.textContent))");
  ASSERT_EQ(rows.size(), contacts.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(std::stod(rows[i][0].get<std::string>()), contacts[i]["x_m"], 0.06) << rows[i];
    EXPECT_NEAR(std::stod(rows[i][1].get<std::string>()), contacts[i]["y_m"], 0.06) << rows[i];
    EXPECT_EQ(rows[i][3], contacts[i]["reports"].dump());
    EXPECT_EQ(rows[i][5], contacts[i]["confirmed"] ? "confirmed" : "");
  }
  EXPECT_FALSE(js("return document.getElementById('contactBox').hidden").get<bool>());
  EXPECT_EQ(text("contactNote"), "") << "a record has all";
  screenshot("contacts");
  expect_no_errors();
}

/// Each contact and each find of the summary has a sign where it is, on the page and in the picture
/// that the page saves.
TEST_F(FoundInABrowser, ContactsAndFindsHaveSignsOnTheMapAndInPictures) {
  open_report(
      {"--seed", "4", "--set", "sensor.false_alarms_per_s=0.02", "--set", "sensor.radius_m=60"},
      "#theme=light&tail=0", "mine_line");
  const nlohmann::json contacts = summary()["contacts"], finds = summary()["objects"]["finds"];
  const auto confirmed =
      std::count_if(contacts.begin(), contacts.end(),
                    [](const nlohmann::json& one) { return one["confirmed"].get<bool>(); });
  ASSERT_GT(confirmed, 0);
  ASSERT_LT(confirmed, static_cast<std::ptrdiff_t>(contacts.size()));
  ASSERT_GT(finds.size(), 0U);
  wait_for_frame();
  // Place, label, filled, and the pixel in the middle of each sign.
  const std::string signs =
      "const g = document.getElementById('markers').getContext('2d'), dpr = devicePixelRatio;"
      "return ergocast.signs().map(({ at: [x, y], label, filled }) => [x, y, label, filled,"
      "  [...g.getImageData(Math.round(x * dpr), Math.round(y * dpr), 1, 1).data]])";
  const nlohmann::json shown = js(signs);
  ASSERT_EQ(shown.size(), finds.size() + contacts.size());
  const nlohmann::json svg =
      js("const svg = new DOMParser().parseFromString(ergocast.svgText(), 'image/svg+xml');"
         "return [...svg.querySelectorAll('text')].map(node => node.textContent)");
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const bool find = i < finds.size();
    const nlohmann::json& one = find ? finds[i] : contacts[i - finds.size()];
    const nlohmann::json at = js("return [ergocast.view.px(" + one["x_m"].dump() +
                                 "), ergocast.view.py(" + one["y_m"].dump() + ")]");
    EXPECT_NEAR(shown[i][0].get<double>(), at[0].get<double>(), 1e-6);
    EXPECT_NEAR(shown[i][1].get<double>(), at[1].get<double>(), 1e-6);
    const std::string label = shown[i][2];
    if (find) {
      EXPECT_EQ(label.find(one["object"].dump() + ": "), 0U) << label;
    } else {
      const double percent = 100 * one["probability"].get<double>();
      EXPECT_NE(label.find('%'), std::string::npos) << label;
      EXPECT_TRUE(percent > 99.9 || std::abs(std::stod(label) - percent) < 0.051) << label;
    }
    EXPECT_EQ(shown[i][3], find || one["confirmed"].get<bool>()) << label;
    EXPECT_NE(std::find(svg.begin(), svg.end(), label), svg.end()) << label << svg;
  }
  // Open signs show the panel's colour, filled ones the ink's: where no other sign is near. The
  // canvas rounds colours of faint signs.
  constexpr std::array<int, 3> kInk{23, 32, 43}, kPanel{255, 255, 255};
  const auto apart = [&](std::size_t i) {
    for (std::size_t k = 0; k < shown.size(); ++k)
      if (k != i && std::hypot(shown[i][0].get<double>() - shown[k][0].get<double>(),
                               shown[i][1].get<double>() - shown[k][1].get<double>()) < 24)
        return false;
    return true;
  };
  std::set<bool> seen;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (!apart(i)) continue;
    const bool filled = shown[i][3];
    seen.insert(filled);
    const nlohmann::json& pixel = shown[i][4];
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(pixel[k].get<int>(), (filled ? kInk : kPanel)[k], 3) << shown[i];
    EXPECT_GT(pixel[3].get<int>(), filled ? 250 : 90) << shown[i];
  }
  EXPECT_EQ(seen.size(), 2U) << shown;
  screenshot("contacts_on_the_map");
  js("ergocast.setTheme('dark')");
  screenshot("contacts_on_the_map_dark");
  // What is not known of an earlier time is not shown there.
  js("ergocast.draw(0)");
  EXPECT_EQ(js("return ergocast.signs().length"), 0);
  js("ergocast.draw(ergocast.S.run.end);"
     "ergocast.S.run.contacts = [{}, { x_m: 'a', y_m: 1, t_s: 1 }, { x_m: 5, y_m: 5, t_s: 1 }];"
     "ergocast.draw(ergocast.S.run.end)");
  EXPECT_EQ(js("return ergocast.signs().length").get<std::size_t>(), finds.size() + 1);
  browser_->press("?");
  EXPECT_NE(text("words").find("triangle"), std::string::npos);
  expect_no_errors();
}

TEST_F(FoundInABrowser, ARunningTeamShowsItsFinds) {
  Child mission = launch_endless(scenario("pace: REALTIME realtime_factor: 10"),
                                 {"--set", "world.objects.count=6", "--set", "sensor.radius_m=150",
                                  "--watch", "--port", "8819", "--lcm-url", kUrl});
  browser_->open("http://127.0.0.1:8819/");
  ASSERT_TRUE(browser_->becomes("return window.ergocast?.S.run?.finds.length > 1"));
  EXPECT_TRUE(
      browser_->becomes("return /hidden objects found[0-9] of 6/.test("
                        "document.getElementById('facts').textContent)"))
      << text("facts");
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.marks.some(({ kind }) => kind === 'find')"));
  EXPECT_TRUE(eventually([&] { return printed("found by agent "); })) << printed();
  ASSERT_EQ(ergocast({"status", "--lcm-url", kUrl}), 0) << output();
  EXPECT_NE(output().find(" of 6 hidden objects found, the newest: object "), std::string::npos)
      << output();
  screenshot("finds_live");
  expect_no_errors();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(browser_->becomes("return !ergocast.S.live && Boolean(ergocast.S.run.summary)"));
  close_page_of(mission);
}

/// The logger names 16 contacts.
TEST_F(FoundInABrowser, ARunningTeamWithManyContactsShowsTheLikeliest) {
  Child mission =
      launch_endless(scenario("pace: REALTIME realtime_factor: 10"),
                     {"--set", "sensor.radius_m=100", "--set", "sensor.false_alarms_per_s=0.5",
                      "--watch", "--port", "8819", "--lcm-url", kUrl});
  browser_->open("http://127.0.0.1:8819/");
  EXPECT_TRUE(
      browser_->becomes("return document.getElementById('contactNote')?.textContent === "
                        "'the 16 likeliest; there may be more'"));
  EXPECT_TRUE(browser_->becomes("return ergocast.signs().length === 16")) << "on the map, too";
  EXPECT_EQ(js("return document.getElementById('contacts').rows.length"), 16);
  screenshot("contacts_live");
  expect_no_errors();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(browser_->becomes("return !ergocast.S.live && Boolean(ergocast.S.run.summary)"));
  EXPECT_EQ(text("contactNote"), "");
  EXPECT_GT(js("return document.getElementById('contacts').rows.length"), 16) << "the record";
  close_page_of(mission);
}

TEST_F(FoundInABrowser, ARunningTeamHasTheProbabilityOfItsRecord) {
  Child mission = launch_endless(scenario("pace: REALTIME realtime_factor: 10"),
                                 {"--watch", "--port", "8819", "--lcm-url", kUrl});
  browser_->open("http://127.0.0.1:8819/");
  ASSERT_TRUE(browser_->becomes("return window.ergocast?.S.run?.end > 60"));
  // Ticks of a pause find nothing.
  ASSERT_EQ(ergocast({"pause", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.holds.length === 1"));
  ASSERT_EQ(ergocast({"resume", "--lcm-url", kUrl}), 0) << output();
  js("window.found = ergocast.S.run.metrics.found");
  // An agent at rest finds nothing.
  ASSERT_EQ(ergocast({"recall", "2", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.recalledFrom.has(2)"));
  EXPECT_TRUE(
      browser_->becomes("const { run } = ergocast.S; return run.counted(run.end) > 120 && "
                        "run.foundAt(run.end) > 0.1"));
  js("ergocast.set('layer', 'missed'); ergocast.set('quantity', 'found')");
  screenshot("missed_live");
  EXPECT_NE(text("facts").find("chance to have found an object"), std::string::npos);
  expect_no_errors();
  js("window.live = ergocast.S.run");
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(browser_->becomes("return !ergocast.S.live && Boolean(ergocast.S.run.summary)"));
  // While it ran, the page computed what the record has. It may have lost some messages.
  const auto compared =
      js("const { t, found } = ergocast.S.run.metrics, known = t.filter(at => at <= live.end);"
         "return [known.length, Math.max(...known.map((at, i) => "
         "  Math.abs(live.foundCurve.at(live.rowAt(at)) - found[i])))]");
  EXPECT_GT(compared[0].get<int>(), 100);
  // Each position that did not arrive is a look that the page lacks.
  const bool lacks = js("return live.tracks.some(({ hasGaps }) => hasGaps)").get<bool>();
  EXPECT_LT(compared[1].get<double>(), lacks ? 0.1 : 2e-3);
  const auto recalls =
      js("return [live, ergocast.S.run].map(({ recalledFrom }) => recalledFrom.get(2))");
  EXPECT_TRUE(recalls[0] <= recalls[1] || lacks) << "the logger may learn of it later: " << recalls;
  // It has kept its list, and computed what is new.
  EXPECT_TRUE(lacks || js("return live.metrics.found === window.found").get<bool>());
  EXPECT_LT(js("const { t, found } = live.metrics;"
               "return Math.max(...found.map((p, i) => Math.abs(p - "
               "live.foundCurve.at(live.rowAt(t[i])))))")
                .get<double>(),
            1e-12);
  EXPECT_LT(worst(), kTolerance);
  expect_no_errors();
  close_page_of(mission);
}

}  // namespace
}  // namespace ergocast::test
