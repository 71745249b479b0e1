// SPDX-License-Identifier: BSD-3-Clause
// The page describes in words the states of agents and mission, and explains its labels.
#include "tests/page/page_in_a_browser.h"

namespace ergocast::test {
namespace {

/// The words in the table's second column, the agents in the order of their numbers.
constexpr const char* kStates =
    "return [...document.querySelectorAll('#rows tr')].sort((a, b) => a.firstChild.textContent - "
    "b.firstChild.textContent).map(row => row.children[1].textContent)";

class WordsInABrowser : public PageInABrowser {
 protected:
  nlohmann::json states(double t_s) {
    js("ergocast.draw(" + std::to_string(t_s) + ")");
    return js(kStates);
  }
  bool becomes_all(const std::string& word) {
    return browser_->becomes(
        "const states = [...document.querySelectorAll('#rows .condition')].map(node => "
        "node.textContent); return states.length === 4 && states.every(state => state === '" +
        word + "')");
  }
  bool is_shown(const std::string& id) {
    return js("return !document.getElementById('" + id + "').hidden");
  }
};

TEST_F(WordsInABrowser, EveryLabelHasAMeaning) {
  open_report({"--duration", "20", "--event-log"});
  wait_for_frame();
  EXPECT_EQ(js("return [...document.querySelectorAll('#heads th')].map(th => th.textContent)"),
            nlohmann::json::parse(R"(["#", "State", "Speed", "Oldest update", "φ² vs team", "Lag",
                                      "Lost", "Dropped"])"));
  EXPECT_EQ(js("return [...document.querySelectorAll('#heads th, #facts > div, .now > div, header "
               "button, .bar button, .bar select, .bar label, .scale')].filter(node => "
               "!node.closest('#saveMenu') && !node.title).map(node => node.id || "
               "node.textContent)"),
            nlohmann::json::array());
  // For a screen without a pointer the same is in the help.
  browser_->press("?");
  for (const char* label : {"φ² vs team", "Oldest update", "slope, last decade"})
    EXPECT_NE(text("words").find(label), std::string::npos) << label;
  expect_no_errors();
}

TEST_F(WordsInABrowser, AgentsGoHomeAndRest) {
  const auto all = [](const char* word) {
    return nlohmann::json(std::vector<std::string>(4, word));
  };
  for (const char* log : {"", "--event-log"}) {
    std::vector<std::string> options{"--out", (folder_ / (std::string("run") + log)).string()};
    if (*log != '\0') options.emplace_back(log);
    options.insert(options.begin(), {"simulate", scenario_file("home_by_dusk")});
    ASSERT_EQ(ergocast(options), 0) << output();
    browser_->open("file://" + options[3] + "/report.html");
    ASSERT_TRUE(browser_->becomes("return Boolean(window.ergocast && ergocast.S.run.ready)"));
    EXPECT_EQ(states(20), all("ok")) << log;
    EXPECT_EQ(states(107), all("goes home")) << log;
    EXPECT_EQ(states(115), all("rests")) << log;
  }
  screenshot("rests");
  expect_no_errors();
}

TEST_F(WordsInABrowser, AgentsGoHomeAndAreCharged) {
  const std::string run = (folder_ / "run").string();
  ASSERT_EQ(ergocast({"simulate", scenario_file("recharge"), "--duration", "250", "--event-log",
                      "--out", run}),
            0)
      << output();
  browser_->open("file://" + run + "/report.html");
  ASSERT_TRUE(browser_->becomes("return Boolean(window.ergocast && ergocast.S.run.ready)"));
  std::set<std::string> all;
  for (int t_s = 2; t_s < 236; t_s += 2) {
    for (const auto& state : states(t_s)) all.insert(state.get<std::string>());
  }
  EXPECT_EQ(all, (std::set<std::string>{"charging", "goes home", "ok"}));
  expect_no_errors();
}

TEST_F(WordsInABrowser, ALiveTeamPausesAndRests) {
  // They rest from tick 2000 of 10^8 on.
  const auto file = scenario(
      "", "kind { name: \"robots\" count: 4 station { x_m: 500 y_m: 400 } reserve_s: 9999800 }\n");
  Child mission = launch_endless(file, {"--watch", "--port", "8813", "--lcm-url", kUrl});
  browser_->open("http://127.0.0.1:8813/");
  ASSERT_TRUE(becomes_all("rests"));
  EXPECT_FALSE(is_shown("pause"));
  ASSERT_EQ(ergocast({"pause", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(
      browser_->becomes("return document.getElementById('state').textContent === 'paused'"));
  EXPECT_TRUE(becomes_all("paused"));
  EXPECT_TRUE(browser_->becomes("return !document.getElementById('pause').hidden"));
  EXPECT_NE(text("pause").find("ergocast resume"), std::string::npos) << text("pause");
  screenshot("paused");
  ASSERT_EQ(ergocast({"resume", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(becomes_all("rests"));
  EXPECT_TRUE(browser_->becomes("return document.getElementById('pause').hidden"));
  expect_no_errors();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(browser_->becomes("return !ergocast.S.live && Boolean(ergocast.S.run.summary)"));
  // The record has the times of the pause.
  js("const { S } = ergocast, [from] = S.run.holds[0]; ergocast.draw(from * S.run.mission.dt_s)");
  EXPECT_EQ(js(kStates), nlohmann::json(std::vector<std::string>(4, "paused")));
  EXPECT_TRUE(is_shown("pause"));
  EXPECT_EQ(js("return ergocast.S.run.incidents.filter(one => one.kind === 'paused').length"), 1);
  // The mission's time stands still meanwhile.
  EXPECT_TRUE(
      js("const { run } = ergocast.S, [from, until] = run.holds[0], dt = run.mission.dt_s;"
         "return Math.abs(run.counted((from + until) / 2 * dt) - from * dt) < 1e-6"));
  close_page_of(mission);
}

// An agent that stands still misses every tick, on machines of any speed.
TEST_F(WordsInABrowser, LateCommandsAreAWarning) {
  Child mission =
      launch_endless(scenario("pace: REALTIME realtime_factor: 10"), {"--watch", "--port", "8814"});
  browser_->open("http://127.0.0.1:8814/");
  ASSERT_TRUE(becomes_all("ok"));
  // The way of an agent follows rows that come after it was asked for.
  js("const track = ergocast.S.run.track(0); window.row = track.last + 30; track.distance(row)");
  ASSERT_TRUE(browser_->becomes("return ergocast.S.run.track(0).last >= window.row"));
  EXPECT_TRUE(
      js("const track = ergocast.S.run.track(0); let way = 0;"
         "for (let k = track.first + 1; k <= row; k++) way += track.between(k - 1, k) || 0;"
         "return way > 0 && Math.abs(track.distance(row) - way) < 1e-6 * way"));
  signal_to(agent(3), SIGSTOP);
  EXPECT_TRUE(browser_->becomes("return !document.getElementById('overload')?.hidden"));
  EXPECT_NE(text("overload").find("% of the latest commands come too late"), std::string::npos)
      << text("overload");
  EXPECT_NE(text("overload").find("realtime_factor"), std::string::npos);
  EXPECT_TRUE(browser_->becomes(
      "const late = [...document.querySelectorAll('#facts dd.late')].map(dd => dd.textContent);"
      "return late.length === 1 && /\\([0-9.]+ %\\)$/.test(late[0])"));
  screenshot("overload");
  expect_no_errors();
  signal_to(agent(3), SIGCONT);
  mission.send(SIGINT);
  EXPECT_TRUE(browser_->becomes("return !ergocast.S.live && Boolean(ergocast.S.run.summary)"));
  EXPECT_TRUE(browser_->becomes(
      "return /% of all commands came/.test(document.getElementById('overload').textContent)"));
  close_page_of(mission);
}

}  // namespace
}  // namespace ergocast::test
