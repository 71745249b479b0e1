// SPDX-License-Identifier: BSD-3-Clause
// Clients of `ergocast run --watch` that try to harm the mission, or to make its page unavailable.
// None has the token.
#include <algorithm>
#include <atomic>
#include <memory>
#include <sstream>
#include <thread>

#include "tests/process/support/mission.h"
#include "tests/support/http.h"

namespace ergocast::test {
namespace {

constexpr int kPort = 8765;

class AttackedPage : public RunningMission {
 protected:
  static std::vector<std::string> page() { return {"ergocast run-page"}; }

  /// The maximum memory of the run and its page so far.
  static double peak_mib() {
    double peak = 0;
    for (const pid_t pid : pids({"ergocast run"})) {
      std::istringstream status(text_of("/proc/" + std::to_string(pid) + "/status"));
      for (std::string word; status >> word;) {
        double kib = 0;
        if (word == "VmHWM:" && status >> kib) peak = std::max(peak, kib / 1024);
      }
    }
    return peak;
  }
  /// The allocation limit of a process, in bytes or "unlimited".
  static std::string memory_limit(pid_t pid) {
    const std::string limits = text_of("/proc/" + std::to_string(pid) + "/limits");
    const std::string name = "Max data size";
    std::istringstream values(limits.substr(std::min(limits.find(name), limits.size())));
    values.ignore(static_cast<std::streamsize>(name.size()));
    std::string soft;
    values >> soft;
    return soft;
  }
  void end_in_order(Child& mission) {
    release();
    ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
    EXPECT_EQ(summary()["result"], "done") << printed();
    mission.send(SIGINT);
    EXPECT_EQ(wait_for(mission), 0) << printed();
  }
};

std::unique_ptr<HttpConnection> connected(const std::string& bytes) {
  auto connection = std::make_unique<HttpConnection>(kPort);
  connection->send(bytes);
  return connection;
}

const std::string kHost = "Host: 127.0.0.1:8765\r\n";
const std::string kEvents = "GET /events HTTP/1.1\r\n" + kHost + "\r\n";

bool shows_the_mission(HttpConnection& stream) {
  const auto comes = [](const std::string& text) {
    return text.find("event: mission") != text.npos;
  };
  return comes(stream.read_until(comes));
}

TEST_F(AttackedPage, EndlessHeadersTakeNoMemory) {
  Child mission = launch_held(scenario("duration_s: 60"), {"--watch"});
  ASSERT_EQ(get(kPort, "/").status, 200);
  const double before_mib = peak_mib();
  std::string headers;
  while (headers.size() < 10 << 20) headers += "X-" + std::to_string(headers.size()) + ": x\r\n";
  for (int i = 0; i < 20; ++i) connected("GET / HTTP/1.1\r\n" + kHost + headers);
  EXPECT_EQ(get(kPort, "/").status, 200);
  EXPECT_LT(peak_mib() - before_mib, 60);
  end_in_order(mission);
}

TEST_F(AttackedPage, IsBackWhenItsProcessWasKilledAndTheMissionGoesOn) {
  Child mission = launch_held(scenario("duration_s: 60"), {"--watch"});
  for (int i = 0; i < 3; ++i) {
    const auto watching = connected(kEvents);
    EXPECT_TRUE(shows_the_mission(*watching));
    ASSERT_NO_FATAL_FAILURE(kill_next(page()));
    EXPECT_EQ(get(kPort, "/").status, 200);
  }
  EXPECT_TRUE(printed("killed by SIGKILL, and is started again")) << printed();
  end_in_order(mission);
  EXPECT_EQ(summary()["restarts"], 0);  // of the team's processes
}

TEST_F(AttackedPage, MayAllocateLittleUntilTheMissionEnds) {
  Child mission = launch_held(scenario("duration_s: 60"), {"--watch"});
  ASSERT_EQ(get(kPort, "/").status, 200);
  const std::string own = memory_limit(mission.pid());
  EXPECT_NE(memory_limit(pids(page()).front()), own);
  release();
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  EXPECT_TRUE(eventually([&] { return memory_limit(pids(page()).front()) == own; }));
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(AttackedPage, IsBackAfterTheMissionToo) {
  Child mission = start_mission(scenario("duration_s: 5"), {"--watch"});
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  kill_next(page());
  EXPECT_TRUE(eventually([] { return get(kPort, "/record.json").status == 200; }));
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(AttackedPage, KeepsItsAddressAndTokenAndDoesNotRevealIt) {
  Child mission = launch_held(scenario("duration_s: 60"),
                              {"--watch", "--listen", "127.0.0.2", "--port", "8801"});
  const std::string text = printed(), begin = "http://127.0.0.2:8801/?token=";
  const auto at = text.find(begin);
  ASSERT_NE(at, text.npos) << text;
  const std::string token = text.substr(at + begin.size(), 32);
  const auto status = [&](const std::string& cookie) {
    return http(8801, "GET", "/", {"Host: 127.0.0.2:8801", "Cookie: ergocast-8801=" + cookie}, "",
                "127.0.0.2")
        .status;
  };
  EXPECT_EQ(status(token), 200);
  EXPECT_TRUE(pids({token}).empty());  // other users read command lines
  kill_next(page());
  EXPECT_EQ(status(token), 200);
  EXPECT_EQ(status(std::string(32, '0')), 403);
  end_in_order(mission);
}

TEST_F(AttackedPage, EndsWithARunThatIsKilled) {
  Child mission = launch_endless(scenario(), {"--watch"});
  ASSERT_EQ(get(kPort, "/").status, 200);
  mission.send(SIGKILL);
  wait_for(mission);
  EXPECT_TRUE(eventually([] { return pids(page()).empty(); }));
}

TEST_F(AttackedPage, IdleClientsOfEventsDoNotKeepItFromTheUser) {
  Child mission = launch_held(scenario("duration_s: 60"), {"--watch"});
  std::vector<std::unique_ptr<HttpConnection>> idle;
  for (int i = 0; i < 118; ++i) idle.push_back(connected(kEvents));
  EXPECT_EQ(get(kPort, "/").status, 200);
  const auto users = connected(kEvents);
  EXPECT_TRUE(shows_the_mission(*users));
  end_in_order(mission);
}

TEST_F(AttackedPage, RequestsThatNeverEndDoNotKeepItFromTheUser) {
  Child mission = launch_held(scenario("duration_s: 60"), {"--watch"});
  std::vector<std::unique_ptr<HttpConnection>> half;
  for (int i = 0; i < 191; ++i) half.push_back(connected("GET / HTTP/1.1\r\n" + kHost + "X: "));
  std::atomic<bool> done = false;
  std::thread trickle([&] {  // each of them continues
    for (; !done; std::this_thread::sleep_for(std::chrono::milliseconds(100))) {
      for (const auto& one : half) one->send("x");
    }
  });
  EXPECT_EQ(get(kPort, "/").status, 200);
  EXPECT_TRUE(shows_the_mission(*connected(kEvents)));
  done = true;
  trickle.join();
  end_in_order(mission);
}

TEST_F(AttackedPage, IsNotSentManyTimesAtOnce) {
  Child mission = launch_held(scenario("duration_s: 60"), {"--watch"});
  const HttpAnswer whole = get(kPort, "/");
  std::string ranges = "Range: bytes=0-";
  for (int i = 0; i < 500; ++i) ranges += ",0-";
  for (const std::string& range :
       {ranges, std::string("rAnGe: bytes=0-9"), "Range: bytes=" + std::string(6000, '0') + "-"}) {
    const HttpAnswer answer = get(kPort, "/", {range});
    EXPECT_EQ(answer.status, 200) << range;
    EXPECT_EQ(answer.body.size(), whole.body.size()) << range;
  }
  end_in_order(mission);
}

}  // namespace
}  // namespace ergocast::test
