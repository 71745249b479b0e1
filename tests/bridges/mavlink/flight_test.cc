// SPDX-License-Identifier: BSD-3-Clause
// Vehicles with the mock autopilot of reference/autopilot.cjs in a real team, by real clocks. It
// has no time-outs here, because a machine may keep a process waiting for any time. fleet_test.cc
// has the true ones, in virtual time.
#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <limits>
#include <thread>

#include "tests/bridges/order_socket.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

using nlohmann::json;

const std::string kFolder = ERGOCAST_SOURCE_DIR "/tests/bridges/mavlink/";

sockaddr_in loopback(int port) {
  return {AF_INET, htons(static_cast<in_port_t>(port)), {htonl(INADDR_LOOPBACK)}, {}};
}

/// Whether the newest setpoint says so.
bool stands(const json& state) { return state["setpoint"][0] == 0 && state["setpoint"][1] == 0; }

/// The pilot of one mock: sends orders, and reads the vehicle's state.
class Pilot : public OrderSocket {
 public:
  explicit Pilot(int port) : OrderSocket(port, "pilot ") {}
};

class MavlinkVehicles : public ByHand {
 protected:
  static constexpr const char* kOrigin = "47.6535,9.175";
  static constexpr double kDistance_m = 8;

  std::filesystem::path scenario_of_one() const {
    std::string text = text_of(kFolder + "two.textproto");
    const std::string other = " starts { x_m: 80 y_m: 20 }";
    text.erase(text.find(other), other.size());
    const auto file = folder_ / "one.textproto";
    std::ofstream(file) << text;
    return file;
  }
  void mock(int port, const std::vector<std::string>& more) {
    std::vector<std::string> command{"/usr/bin/env",
                                     "node",
                                     kFolder + "reference/autopilot.cjs",
                                     ERGOCAST_NODE_MAVLINK,
                                     std::to_string(port),
                                     "--patience",
                                     "never"};
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
  /// Waits until a driver has printed `part` after its last `before`.
  static bool prints_after(const Program& driver, const std::string& before,
                           const std::string& part) {
    return eventually([&] {
      const std::string text = driver.printed();
      const auto last = text.rfind(before);
      return last != text.npos && text.find(part, last) != text.npos;
    });
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
  Program& one = driver(0, "udp:127.0.0.1:14551", {"--fence", "20"});
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
  EXPECT_TRUE(prints_after(one, "has taken over", "follows its agent")) << one.printed();
  EXPECT_TRUE(first.sees([&](const json& state) { return state["path"] > path_m + 5; }));

  // A dead agent: its vehicle stands.
  signal_to(agent(1), SIGKILL);
  EXPECT_TRUE(second.sees(stands)) << other.printed();
  ASSERT_EQ(ergocast({"stop", "--now", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(one.child), 0) << one.printed();
  EXPECT_EQ(wait_for(other.child), 0) << other.printed();
  for (const Pilot* pilot : {&first, &second}) {
    const json state = pilot->state();
    EXPECT_TRUE(stands(state)) << state;
    EXPECT_EQ(state["fence"], pilot == &first ? 4 : 0) << state;
    EXPECT_EQ(state["refused"], 0) << state;
    EXPECT_EQ(state["orders"].size(), 0U) << "it never arms, takes off or changes modes";
  }
  EXPECT_GE(least_distance_m(), kDistance_m);
}

TEST_F(MavlinkVehicles, TakeOffByThemselvesOnlyIfToldToAndStandAfterAJump) {
  std::filesystem::create_directory(out());
  mock(14551, {"--make", "ardupilot", "--at", "47.65368,9.17527"});
  const Pilot pilot(14551);
  pilot.state();
  ASSERT_EQ(ergocast({"keygen", folder_ / "team"}), 0) << output();
  const std::vector<std::string> key{"--key-file", folder_ / "team.key"};
  hand("ergocast-logger", {"--out", out(), key[0], key[1]});
  pilot.orders("fence shift");
  Program& one =
      driver(0, "udp:127.0.0.1:14551", {"--take-command", "--fence", "0", key[0], key[1]});
  hand("ergocast-agent", {"--id", "0", key[0], key[1]});
  hand("ergocast-coordinator", {scenario_of_one(), key[0], folder_ / "team.coordinator.key"});
  EXPECT_TRUE(one.prints("has no fence: the autopilot has another item 2 than was sent"));
  EXPECT_TRUE(pilot.state()["orders"].empty()) << "it does not take off without its fence";
  pilot.orders("fence as it was sent");
  EXPECT_TRUE(one.prints("follows its agent")) << one.printed();
  std::vector<std::string> orders = pilot.state()["orders"];
  orders.erase(std::unique(orders.begin(), orders.end()), orders.end());  // some may be repeated
  EXPECT_EQ(orders, (std::vector<std::string>{"mode", "arm", "takeoff"}));
  EXPECT_TRUE(pilot.sees([](const json& state) { return state["path"] > 2; })) << one.printed();

  pilot.orders("jump 50");
  EXPECT_TRUE(one.prints("the position jumped by")) << one.printed();
  EXPECT_TRUE(pilot.sees([](const json& state) { return state["stood"] > 0; })) << one.printed();
  EXPECT_TRUE(prints_after(one, "jumped", "follows its agent")) << one.printed();
  pilot.orders("silent");
  EXPECT_TRUE(one.prints("the link is lost")) << one.printed();
  EXPECT_TRUE(pilot.sees(stands)) << "setpoints still arrive at the silent vehicle";
  one.child.send(SIGTERM);
  EXPECT_EQ(wait_for(one.child), 0) << one.printed();
}

TEST_F(MavlinkVehicles, GoHomeByTheirBatteriesAndComeBackOnceTheseAreFull) {
  std::filesystem::create_directory(out());
  const auto scenario = scenario_of_one();
  std::string text = text_of(scenario);
  text.insert(text.find("agents {") + 8,
              " kind { name: \"one\" count: 1 station { x_m: 20 y_m: 20 } "
              "battery { capacity_wh: 100 power_w: 100 } }");
  std::ofstream(scenario) << text;
  mock(14551, {"--make", "ardupilot", "--at", "47.65368,9.17527"});
  const Pilot pilot(14551);
  pilot.orders("battery 100");
  hand("ergocast-logger", {"--out", out()});
  Program& one = driver(0, "udp:127.0.0.1:14551", {"--take-command"});
  hand("ergocast-agent", {"--id", "0"});
  hand("ergocast-coordinator", {scenario});
  const auto apart_m = [&] {
    const RecordedRow row = newest(0);
    return std::hypot(row.x_m - 20, row.y_m - 20);
  };
  ASSERT_TRUE(eventually([&] { return apart_m() > 8; }, one.child.pid())) << one.printed();
  pilot.orders("battery 15");
  EXPECT_TRUE(eventually([&] { return apart_m() < 3; }, one.child.pid())) << one.printed();
  const auto charges = [&] {
    return ergocast({"status", "--lcm-url", kUrl}) == 0 &&
           output().find("charging") != std::string::npos;
  };
  EXPECT_TRUE(eventually(charges, one.child.pid())) << output();
  EXPECT_NE(output().find("15 %"), std::string::npos) << output();
  pilot.orders("battery 97");
  EXPECT_TRUE(eventually([&] { return apart_m() > 8; }, one.child.pid())) << one.printed();
}

bool has_caller(int listener) {
  pollfd waiting{listener, POLLIN, 0};
  return poll(&waiting, 1, 0) > 0;
}

/// Passes bytes between a mock and a link of another kind, as radios do.
class Radio {
 public:
  Radio(int port, int link) : mock_(::socket(AF_INET, SOCK_DGRAM, 0)), link_(link) {
    const sockaddr_in to = loopback(port);
    connect(mock_, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    thread_ = std::thread([this] {
      while (!ends_) pass();
    });
  }
  Radio(const Radio&) = delete;
  Radio& operator=(const Radio&) = delete;
  ~Radio() {
    ends_ = true;
    thread_.join();
    close(mock_);
    close(link_);
  }

 private:
  void pass() const {
    pollfd all[] = {{mock_, POLLIN, 0}, {link_, POLLIN, 0}};
    poll(all, 2, 100);
    std::array<char, 4096> in;
    for (int i = 0; i < 2; ++i) {
      if ((all[i].revents & POLLIN) == 0) continue;
      const auto size = read(all[i].fd, in.data(), in.size());
      if (size > 0 && write(all[1 - i].fd, in.data(), static_cast<std::size_t>(size)) < 0) continue;
    }
  }
  int mock_, link_;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

TEST_F(MavlinkVehicles, AreReachedByEveryLinkAndRefusedIfTheyCannotStopOrHaveADriver) {
  std::signal(SIGHUP, SIG_DFL);  // nohup ignores it
  mock(14551, {"--to", "14561"});
  mock(14552, {"--system", "2", "--body", "wing"});
  Pilot(14551).state();
  Pilot(14552).state();
  int device = -1, end = -1;
  std::array<char, 256> name;
  ASSERT_EQ(openpty(&device, &end, name.data(), nullptr, nullptr), 0);
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in here = loopback(14571);
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&here), sizeof here), 0);
  ASSERT_EQ(listen(listener, 1), 0);

  // A question of TIMESYNC and its answer have passed before a driver waits for the mission.
  Program& first = driver(0, "udpin:14561");
  EXPECT_TRUE(first.prints("system 1: PX4, a multicopter")) << first.printed();
  EXPECT_TRUE(first.prints("waits for the mission")) << first.printed();
  // One of two drivers ends: the second, unless the first one was kept waiting while the second
  // listened. Then it is the one with the greater identity.
  Program& second = driver(0, "udp:127.0.0.1:14551");
  ASSERT_TRUE(eventually([&] { return !first.child.running() || !second.child.running(); }));
  const bool second_ends = !second.child.running();
  Program &ends = second_ends ? second : first, &stays = second_ends ? first : second;
  EXPECT_EQ(wait_for(ends.child), 4) << ends.printed();
  EXPECT_TRUE(ends.prints("another driver is on this vehicle")) << ends.printed();
  stays.child.send(SIGHUP);  // its terminal has gone
  EXPECT_EQ(wait_for(stays.child), 0) << stays.printed();

  Program& wing = driver(1, "udp:127.0.0.1:14552");
  EXPECT_EQ(wait_for(wing.child), 4) << wing.printed();
  EXPECT_TRUE(wing.prints("system 2 is a fixed wing, which cannot be stopped in the air"));

  const json before = Pilot(14551).state();
  Program& other = driver(0, "udp:127.0.0.1:14551", {"--system", "9"});
  EXPECT_TRUE(other.prints("waits for --system 9")) << other.printed();
  other.child.send(SIGTERM);
  EXPECT_EQ(wait_for(other.child), 0) << other.printed();
  EXPECT_EQ(Pilot(14551).state()["setpoints"], before["setpoints"]) << "another vehicle's driver";

  {
    const Radio radio(14551, device);
    Program& serial = driver(0, std::string("serial:") + name.data() + ":57600");
    EXPECT_TRUE(serial.prints("waits for the mission")) << serial.printed();
    serial.child.send(SIGTERM);
    EXPECT_EQ(wait_for(serial.child), 0) << serial.printed();
  }
  close(end);
  Program& tcp = driver(0, "tcp:127.0.0.1:14571");
  ASSERT_TRUE(eventually([&] { return has_caller(listener); }, tcp.child.pid())) << tcp.printed();
  const Radio radio(14551, accept(listener, nullptr, nullptr));
  EXPECT_TRUE(tcp.prints("waits for the mission")) << tcp.printed();
  tcp.child.send(SIGTERM);
  EXPECT_EQ(wait_for(tcp.child), 0) << tcp.printed();
  close(listener);
}

TEST_F(MavlinkVehicles, AreLeftToTheirPilotsIfTheyRefuseOffboard) {
  std::filesystem::create_directory(out());
  mock(14551, {"--make", "px4", "--stubborn", "yes", "--at", "47.65368,9.17527"});
  const Pilot pilot(14551);
  pilot.state();
  hand("ergocast-logger", {"--out", out()});
  Program& one = driver(0, "udp:127.0.0.1:14551", {"--take-command"});
  hand("ergocast-agent", {"--id", "0"});
  hand("ergocast-coordinator", {scenario_of_one()});
  EXPECT_TRUE(one.prints("the autopilot refuses OFFBOARD: DENIED")) << one.printed();
  EXPECT_TRUE(one.prints("leaves it to the pilot")) << one.printed();
  const json state = pilot.state();
  for (const json& order : state["orders"])
    EXPECT_EQ(order, "mode") << "it neither arms nor climbs";
  EXPECT_EQ(state["north"], 0) << state;
  EXPECT_EQ(state["up"], 0) << state;
  take_off(pilot, "OFFBOARD");
  EXPECT_TRUE(one.prints("follows its agent")) << one.printed();
  EXPECT_TRUE(pilot.sees([](const json& now) { return now["path"] > 2; })) << one.printed();
}

TEST_F(MavlinkVehicles, AreSentSetpointsWhileNobodyReadsTheLog) {
  mock(14551, {});
  const Pilot pilot(14551);
  pilot.state();
  const auto log = folder_ / "log";
  ASSERT_EQ(mkfifo(log.c_str(), 0600), 0);
  const int reader = ::open(log.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  const std::array<char, 4096> nothing{};
  while (write(reader, nothing.data(), nothing.size()) > 0) continue;
  Child driver =
      begin({"/bin/sh", "-c", "exec \"$@\" 2>" + log.string(), "sh",
             (program_folder() / "ergocast-driver-mavlink").string(), "--id", "0", "--connect",
             "udp:127.0.0.1:14551", "--origin", kOrigin, "--lcm-url", url_});
  EXPECT_TRUE(pilot.sees([](const json& state) { return state["setpoints"] > 20; }));
  driver.send(SIGTERM);
  EXPECT_EQ(wait_for(driver), 0);
  close(reader);
}

TEST_F(MavlinkVehicles, HaveADriverThatRefusesWrongOptionsInASentence) {
  const auto refused = [&](std::vector<std::string> options, int code = 2) {
    EXPECT_EQ(run("ergocast-driver-mavlink", std::move(options)), code) << output();
    return output();
  };
  const auto says = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  const std::vector<std::string> whole{"--id",     "0",    "--connect", "udp:127.0.0.1:14551",
                                       "--origin", kOrigin};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), whole.begin(), whole.end());
    return more;
  };
  says(refused({"--id", "0", "--connect", "udp:127.0.0.1:1"}), "give the place of the scenario");
  says(refused({"--id", "0", "--connect", "carrier:1", "--origin", kOrigin}), "is no link");
  says(refused({"--id", "0", "--connect", "udp:x", "--origin", "91,0"}), "is no place");
  says(refused(
           {"--id", "0", "--connect", "udp:127.0.0.1:1", "--local-origin", "0,0", "--fence", "5"}),
       "so it needs --origin");
  says(refused(with({"--take-command"})), "needs the height of the take-off");
  says(refused(with({"--lcm-url", "udpm://1.2.3.4:5"})), "is not an LCM URL");
  std::ofstream(folder_ / "key") << std::string(64, 'a');
  std::filesystem::permissions(folder_ / "key", std::filesystem::perms(0644));
  says(refused(with({"--signing-key", folder_ / "key"})), "others may use this key");
  std::filesystem::permissions(folder_ / "key", std::filesystem::perms(0600));
  says(refused(with({"--key-file", folder_ / "key"})), "is no key");
  setenv("ERGOCAST_KEY_FILE", "", 1);
  says(refused(whole), "is set, and empty");
  unsetenv("ERGOCAST_KEY_FILE");
  says(refused({"--id", "0", "--connect", "serial:/dev/null:57", "--origin", kOrigin}, 3),
       "no usual rate");
}

}  // namespace
}  // namespace ergocast::test
