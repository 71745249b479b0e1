// SPDX-License-Identifier: BSD-3-Clause
// Vehicles with the mock autopilot of reference/autopilot.cjs in a real team. Its clock counts
// steps of its own, so a slow machine makes no gap between setpoints.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

using nlohmann::json;

const std::string kFolder = ERGOCAST_SOURCE_DIR "/tests/bridges/mavlink/";

/// The pilot of one mock: sends orders, and reads the vehicle's state.
class Pilot {
 public:
  explicit Pilot(int port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    const sockaddr_in to{
        AF_INET, htons(static_cast<in_port_t>(port)), {htonl(INADDR_LOOPBACK)}, {}};
    connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  Pilot(const Pilot&) = delete;
  Pilot& operator=(const Pilot&) = delete;
  ~Pilot() { close(socket_); }

  /// The vehicle's state after the order. An order or an answer may be lost.
  json orders(const std::string& order) const {
    const std::string text = "pilot " + order;
    json state;
    EXPECT_TRUE(eventually([&] {
      send(socket_, text.data(), text.size(), 0);
      pollfd ready{socket_, POLLIN, 0};
      if (poll(&ready, 1, 2000) <= 0) return false;
      std::array<char, 4096> in;
      const auto size = recv(socket_, in.data(), in.size(), 0);
      if (size <= 0) return false;  // the mock does not listen yet
      state = json::parse(in.data(), in.data() + size);
      return true;
    })) << order;
    return state;
  }
  json state() const { return orders("state"); }
  bool sees(const std::function<bool(const json&)>& condition) const {
    return eventually([&] { return condition(state()); });
  }

 private:
  int socket_;
};

class MavlinkVehicles : public ByHand {
 protected:
  static constexpr const char* kOrigin = "47.6535,9.175";
  static constexpr double kDistance_m = 8;

  void mock(int port, const std::vector<std::string>& more) {
    std::vector<std::string> command{"/usr/bin/env", "node", kFolder + "reference/autopilot.cjs",
                                     ERGOCAST_NODE_MAVLINK, std::to_string(port)};
    command.insert(command.end(), more.begin(), more.end());
    mocks_.push_back(begin(command));
  }
  Program& driver(int id, const std::string& link, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"--id",  std::to_string(id), "--connect", link, "--origin",
                                       kOrigin, "--altitude",       "20"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return hand("ergocast-driver-mavlink", arguments);
  }
  void take_off(const Pilot& pilot, const std::string& mode) {
    pilot.orders("arm");
    pilot.orders("takeoff 20");
    EXPECT_TRUE(pilot.sees([](const json& state) { return state["up"] > 19; }));
    EXPECT_TRUE(eventually([&] { return pilot.orders("mode " + mode)["mode"] == mode; }));
  }
  /// Where the record has vehicle `id` at its newest tick.
  RecordedRow newest(AgentId id) const {
    const auto rows = recorded_rows(out());
    for (auto tick = rows.rbegin(); tick != rows.rend(); ++tick) {
      if (const auto row = tick->second.find(id); row != tick->second.end()) return row->second;
    }
    return {};
  }
  double least_distance_m() const {
    double least_m = std::numeric_limits<double>::max();
    for (const auto& [tick, rows] : recorded_rows(out())) {
      if (rows.size() < 2) continue;
      const RecordedRow &one = rows.at(0), &other = rows.at(1);
      least_m = std::min(least_m, std::hypot(one.x_m - other.x_m, one.y_m - other.y_m));
    }
    return least_m;
  }
  static int times(const std::string& text, const std::string& part) {
    int count = 0;
    for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
    return count;
  }

  void TearDown() override {
    forget_watched();
    for (Child& mock : mocks_) mock.send(SIGTERM);
    for (Child& mock : mocks_) wait_for(mock);
    ByHand::TearDown();
  }
  std::deque<Child> mocks_;
};

TEST_F(MavlinkVehicles, FlyOnlyWhileTheirPilotsAllowIt) {
  std::filesystem::create_directory(out());
  mock(14551, {"--system", "1", "--make", "px4", "--at", "47.65368,9.17527"});
  mock(14552, {"--system", "2", "--make", "ardupilot", "--at", "47.65368,9.17606"});
  const Pilot first(14551), second(14552);
  first.state();
  second.state();
  hand("ergocast-logger", {"--out", out()});
  Program& one = driver(0, "udp:127.0.0.1:14551");
  Program& other = driver(1, "udp:127.0.0.1:14552", {"--system", "2"});
  for (const char* id : {"0", "1"}) hand("ergocast-agent", {"--id", id});
  hand("ergocast-coordinator", {kFolder + "two.textproto"});

  // Before the pilots allow it the team knows where they are, and nothing moves.
  EXPECT_TRUE(one.prints("waits until the pilot chooses OFFBOARD (now POSCTL)"));
  EXPECT_TRUE(other.prints("waits until the pilot chooses GUIDED (now STABILIZE)"));
  ASSERT_TRUE(recorded(2000));
  EXPECT_NEAR(newest(0).x_m, 20.3, 0.3);
  EXPECT_NEAR(newest(1).x_m, 79.6, 0.3);
  EXPECT_EQ(second.state()["setpoints"], 0) << "they would disturb the take-off";
  for (const Pilot* pilot : {&first, &second}) {
    const json state = pilot->state();
    EXPECT_EQ(state["disobeyed"], 0) << state;
    EXPECT_EQ(state["orders"].size(), 0U) << state;
    EXPECT_EQ(state["north"], 0) << state;
  }

  take_off(first, "OFFBOARD");
  take_off(second, "GUIDED");
  EXPECT_TRUE(one.prints("follows its agent")) << one.printed();
  EXPECT_TRUE(other.prints("follows its agent")) << other.printed();
  const auto has_flown = [](const json& state) { return state["path"] > 10; };
  EXPECT_TRUE(first.sees(has_flown)) << one.printed();
  EXPECT_TRUE(second.sees(has_flown)) << other.printed();

  // The first pilot takes over, and flies by hand; the record has what is really flown.
  first.orders("fly 0 -1");
  first.orders("mode POSCTL");
  EXPECT_TRUE(one.prints("the pilot or a failsafe has taken over (POSCTL)")) << one.printed();
  const double path_m = first.state()["path"], east_m = first.state()["east"];
  const double before_m = newest(0).x_m;
  EXPECT_TRUE(first.sees([&](const json& state) { return state["east"] < east_m - 3; }));
  EXPECT_TRUE(eventually([&] { return newest(0).x_m < before_m - 2; }));
  const json by_hand = first.orders("fly 0 0");
  EXPECT_EQ(by_hand["path"], path_m);
  EXPECT_EQ(by_hand["disobeyed"], 0) << by_hand;

  // The pilot gives it back.
  EXPECT_TRUE(eventually([&] { return first.orders("mode OFFBOARD")["mode"] == "OFFBOARD"; }));
  EXPECT_TRUE(eventually([&] { return times(one.printed(), "follows its agent") == 2; }))
      << one.printed();
  EXPECT_TRUE(first.sees([&](const json& state) { return state["path"] > path_m + 5; }));

  // A dead agent: its vehicle stands.
  signal_to(agent(1), SIGKILL);
  const auto stands = [](const json& state) {
    return state["setpoint"][0] == 0 && state["setpoint"][1] == 0;
  };
  EXPECT_TRUE(second.sees(stands)) << other.printed();
  EXPECT_EQ(first.state()["timeouts"], 0) << "PX4 waits 0.5 s for a setpoint";
  ASSERT_EQ(ergocast({"stop", "--now", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(one.child), 0) << one.printed();
  EXPECT_EQ(wait_for(other.child), 0) << other.printed();
  for (const Pilot* pilot : {&first, &second}) {
    const json state = pilot->state();
    EXPECT_TRUE(stands(state)) << state;
    EXPECT_EQ(state["refused"], 0) << state;
    EXPECT_EQ(state["orders"].size(), 0U) << "it never arms, takes off or changes modes";
  }
  EXPECT_LE(second.state()["gap"], 150) << "ArduPilot waits 3 s";
  EXPECT_GE(least_distance_m(), kDistance_m);
}

}  // namespace
}  // namespace ergocast::test
