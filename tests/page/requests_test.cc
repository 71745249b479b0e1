// SPDX-License-Identifier: BSD-3-Clause
// What becomes of the page's requests: which operator has control, answers that are late or lost.
#include "tests/page/controlled_page.h"
#include "tests/support/http.h"

namespace ergocast::test {
namespace {

TEST_F(ControlledPage, ShowsEachOrderThatFailedOrIsUnfinishedAndSpeaksItOnce) {
  control();
  js("window.spoken = [];"
     "new MutationObserver(() => spoken.push(document.getElementById('controlSpoken').textContent))"
     ".observe(document.getElementById('controlSpoken'),"
     " { childList: true, characterData: true, subtree: true });"
     "window.act = (number, what, state, over, text) =>"
     " ({ operator: 5, name: 'bert', number, what, at: '', state, over, text });"
     "window.show = acts => ergocast.showControl({ operator: null, acts, refused: [] })");
  // Shown and read in one script: the next message of the real team shows its own orders.
  js("window.texts = acts => { show(acts);"
     " const acted = [...document.querySelectorAll('#controlActs li')].map(li => li.textContent);"
     " return [document.getElementById('controlText').textContent, ...acted].join('|'); }");
  EXPECT_EQ(js("return texts([act(1, 'agent 3 home', 'failed', true, 'agent 3 does not report it'),"
               " act(2, 'pause', 'done', true, 'paused'),"
               " act(3, 'agent 1 home', 'obeyed', false, 'leaves'),"
               " act(4, 'resume', 'sent', false, 'no answer yet')])"),
            "resume by bert: no answer yet|agent 1 home by bert: leaves|"
            "agent 3 home by bert: agent 3 does not report it");
  screenshot("control_acts");
  EXPECT_EQ(js("return texts([act(1, 'agent 3 home', 'failed', true, 'agent 3 does not report it'),"
               " act(4, 'resume', 'sent', false, 'still no answer'),"
               " act(5, 'agent 3 home', 'done', true, 'agent 3 rests')])"),
            "agent 3 home by bert: agent 3 rests|resume by bert: still no answer");
  EXPECT_EQ(js("return spoken.filter(text => text.includes('no answer')).length"), 1);
  EXPECT_EQ(js("return spoken.filter(text => text.includes('agent 3')).length"), 2);
  browser_->click("#stopNow");
  end_with_the_mission();
}

// The server's answers are the test's own; it obeys nothing but a stop.
TEST_F(ControlledPage, SaysWhatBecameOfEachOrder) {
  control();
  take_control();
  js("const real = window.fetch; window.answer = { status: 503 }; window.numbers = [];"
     "window.fetch = (url, options) => {"
     " if (url !== 'control') return real(url, options);"
     " const { act, number, operator } = JSON.parse(options.headers['X-Ergocast-Request']);"
     " if (['here', 'stop-now'].includes(act)) return real(url, options);"
     " numbers.push(number); window.operator = operator;"
     " return answer ? Promise.resolve(new Response('busy', answer)) :"
     "   Promise.reject(new TypeError('lost')); }");
  // Shown and read in one script: the next message of the real team shows its own orders.
  js("window.show = (acts, refused) => {"
     " ergocast.showControl({ operator: { id: operator }, refused: refused.map(one =>"
     "   ({ operator, ...one })), acts: acts.map(one =>"
     "   ({ operator, name: '', at: '', over: true, state: 'done', text: 'yes', ...one })) });"
     " return ['controlText', 'controlNotice'].map(id =>"
     "   document.getElementById(id).textContent).join('|'); }");
  order("pause");
  EXPECT_TRUE(becomes("controlNotice", "^Pause: not sent: busy$"));
  EXPECT_EQ(text("controlText"), "Pause: not sent");

  js("answer = { status: 202 }");
  order("resume");
  EXPECT_EQ(text("controlText"), "Resume: sent");
  EXPECT_EQ(js("return show([], [{ number: numbers[1], what: 'resume', text: 'too late' },"
               " { operator: 5, number: 1, what: 'pause', text: 'bert has control' }])"),
            "Resume: refused|Resume: refused: too late");

  // It is not known whether it was received: the next press repeats it under its number.
  js("answer = null");
  order("pause");
  EXPECT_TRUE(becomes("controlNotice", "^Pause: not answered. Press again: it is obeyed once.$"));
  EXPECT_EQ(text("controlText"), "Pause: not answered");
  js("answer = { status: 503 }");
  order("pause");
  EXPECT_TRUE(becomes("controlNotice", "^Pause: not answered. Press again"));
  js("answer = { status: 202 }");
  order("pause");
  EXPECT_EQ(js("return new Set(numbers.slice(2)).size"), 1);
  EXPECT_TRUE(becomes("controlNotice", "^Pause: not answered. Press again"));  // nor is this one
  EXPECT_EQ(js("return show([{ number: numbers[2], what: 'pause' }], [])"), "pause: yes|");
  order("pause");
  EXPECT_GT(js("return numbers.at(-1)"), js("return numbers[2]"));

  // It can no longer be obeyed, because a later one was.
  order("resume");
  EXPECT_EQ(js("return show([{ number: numbers.at(-1), what: 'resume' }], [])"),
            "resume: yes|Pause: not obeyed, because a later order came first. Press again.");
  browser_->click("#stopNow");
  end_with_the_mission();
}

// A flood of connections, or a page's process that is started again, may cost requests.
TEST_F(ControlledPage, StopNowIsRepeatedByItselfUntilItIsAnswered) {
  control();
  js("const real = window.fetch; window.tries = [];"
     "window.fetch = (url, options) => {"
     " if (url !== 'control') return real(url, options);"
     " tries.push(JSON.parse(options.headers['X-Ergocast-Request']).number);"
     " return tries.length < 4 ? Promise.reject(new TypeError('lost')) : real(url, options); }");
  browser_->click("#stopNow");
  EXPECT_TRUE(becomes("controlText", "no answer yet, sent \\d times|stopped at"));
  EXPECT_TRUE(becomes("controlText", "stopped at tick .*: all stand still"));
  EXPECT_EQ(js("return tries.length >= 4 && new Set(tries).size"), 1);
  end_with_the_mission();
  const std::string text = printed(), asks = "asks for: stop now";
  EXPECT_NE(text.find(asks), text.npos);
  EXPECT_EQ(text.find(asks), text.rfind(asks)) << text;
}

TEST_F(ControlledPage, SignsOfTheBrowserAreNoOrders) {
  control();
  take_control();
  const std::string spoken = text("controlSpoken");
  js("const real = window.fetch; let count = 0;"
     "window.fetch = (...all) => count++ ? real(...all) : Promise.reject(new TypeError('lost'));"
     "window.notices = []; const node = document.getElementById('controlNotice');"
     "new MutationObserver(() => notices.push(node.textContent))"
     ".observe(node, { childList: true, characterData: true, subtree: true })");
  // A slow machine may cause a notice of its own before.
  EXPECT_TRUE(
      browser_->becomes("const lost = notices.findIndex(text => text.startsWith("
                        "'The server does not receive')); return lost >= 0 && "
                        "notices.indexOf('', lost) > lost"));
  EXPECT_EQ(text("controlSpoken"), spoken);
  browser_->click("#stopNow");
  end_with_the_mission();
}

TEST_F(ControlledPage, AnAddressWithoutItsFragmentOnlyShows) {
  control();
  EXPECT_EQ(js("return location.href"), "http://127.0.0.1:8820/");  // the token is in no history
  browser_->open("http://127.0.0.1:8820/");
  EXPECT_TRUE(browser_->becomes("return !document.getElementById('control')?.hidden"));
  for (const char* id : {"#stopNow", "#take", "#orders"}) EXPECT_FALSE(visible(id)) << id;
  EXPECT_TRUE(visible("#readOnly"));
  EXPECT_EQ(js("return fetch('control', { method: 'POST' }).then(r => r.status)"), 403);
  EXPECT_EQ(js("return [document.cookie, localStorage.length, sessionStorage.length].join()"),
            ",0,0");
  mission_->send(SIGINT);
  end_with_the_mission();
}

TEST_F(ControlledPage, AnotherOperatorTakesOverVisibly) {
  control();
  take_control();
  const std::string token = address().substr(address().find('=') + 1);
  const auto post = [&](const nlohmann::json& request) {
    return http(8820, "POST", "/control",
                {"Host: 127.0.0.1:8820", "Origin: http://127.0.0.1:8820",
                 "X-Ergocast-Token: " + token, "X-Ergocast-Request: " + request.dump()})
        .status;
  };
  const Tick tick = js("return ergocast.S.facts.state.world_tick");
  EXPECT_EQ(
      post({{"operator", 5}, {"name", "bert"}, {"number", 1}, {"tick", tick}, {"act", "take"}}),
      202);
  EXPECT_TRUE(becomes("holder", "bert has control"));
  EXPECT_TRUE(becomes("controlNotice", "bert has taken control from you"));
  EXPECT_FALSE(visible("#orders"));
  // Taking over takes control away from somebody, so it needs two presses.
  EXPECT_EQ(
      js("const take = document.getElementById('take'); take.click(); return take.textContent"),
      "Again: Take over");
  // His browser is silent, so he loses it, and the mission goes on.
  EXPECT_TRUE(becomes("holder", "No operator has control"));
  EXPECT_EQ(text("controlNotice"), "bert has taken control from you.");  // it stays
  EXPECT_TRUE(printed("bert loses control at tick")) << printed();
  take_control();
  browser_->click("#release");
  EXPECT_TRUE(becomes("holder", "No operator has control"));
  EXPECT_EQ(js("return ergocast.S.live"), true);
  browser_->click("#stopNow");
  end_with_the_mission();
}

// The connection waits for the process that is started again, or the page says what is unknown.
TEST_F(ControlledPage, APressIsNotLostSilentlyWhenThePagesProcessIsKilled) {
  control();
  take_control();
  js("const { S } = ergocast, ticks = window.ticks = []; let facts = S.facts;"
     "Object.defineProperty(S, 'facts', { get: () => facts, set(value) { facts = value;"
     " ticks.push(value?.state?.world_tick ?? null); } })");
  signal_to({"ergocast run-page"}, SIGSTOP);
  order("pause");
  kill_next({"ergocast run-page"});
  ASSERT_TRUE(
      becomes("control", "4 of 4 stand|[Nn]ot answered|not sent|refused|control from|no longer"))
      << text("control");
  if (text("controlText").find("stand") == std::string::npos) {
    if (text("holder") != "You have control") take_control();
    order("pause");
  }
  EXPECT_TRUE(becomes("controlText", "4 of 4 stand"));
  // After the new connection, too, each order names a tick.
  EXPECT_EQ(js("return ticks.includes(null)"), false) << js("return ticks");
  browser_->click("#stopNow");
  end_with_the_mission();
  EXPECT_EQ(summary()["restarts"], 0);  // the mission has not noticed
}

}  // namespace
}  // namespace ergocast::test
