// SPDX-License-Identifier: BSD-3-Clause
// Each finding of `ergocast doctor` on a host that has it. Some thirty hosts on one network, each
// with another fault, are examined at once.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <deque>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <set>

#include "cli/doctor/probe.h"
#include "cli/doctor/socket_table.h"
#include "runtime/bus/socket.h"
#include "runtime/process/key_file.h"
#include "runtime/process/program_options.h"
#include "tests/checks_can_fail/expect_said.h"
#include "tests/checks_can_fail/pretended_peer.h"
#include "tests/hosts/team_on_hosts.h"
#include "tests/process/support/stranger.h"

namespace ergocast::test {
namespace {

using nlohmann::json;

/// A sender on another host that sends repeatedly while the doctor listens.
using Speaker = std::function<void()>;

/// One host and what is wrong with it.
struct Plant {
  std::string check = "", found = "";  ///< of the finding
  std::string level = "";
  int exit_code = 1;
  std::string set_up = "";  ///< a shell's command on the host
  std::string url_options = "ttl=1";
  std::vector<std::string> arguments = {};
  std::string wrapper = "";                       ///< a shell's command before the program's
  std::vector<int> held_ports = {};               ///< by a socket of the test, after the URL's port
  bool alone = false;                             ///< which uses the ports exclusively
  std::function<Speaker(int port)> speaker = {};  ///< made on another host
  int agents = 0;                                 ///< ours, at the same ports, without a mission
  bool as_nobody = false, on_a_terminal = false;
  int port = 0;  ///< if it matters
};

class DoctorCanFail : public OnHosts {
 protected:
  void SetUp() override {
    if (!is_root()) GTEST_SKIP() << "needs root";
  }

  std::vector<Plant> plants();
  std::vector<Plant> plants_of_routes();
  std::vector<Plant> plants_of_kernels();
  std::vector<Plant> plants_on_the_bus();
  std::vector<Plant> plants_of_peers();

  std::filesystem::path key_file(const char* name) const { return folder_ / name; }
  MessageAuthenticator authenticator(const char* name) const {
    return MessageAuthenticator(read_key_file(key_file(name)).value());
  }

  /// Sends `message` while the doctor listens.
  template <class M>
  std::function<Speaker(int)> says(M message, const MessageAuthenticator& authenticator = {}) {
    return [message, authenticator](int port) -> Speaker {
      const auto url = "udpm://" + std::string(kTeamsGroup) + ":" + std::to_string(port) + "?ttl=1";
      return [stranger = std::make_shared<Stranger>(url, authenticator), message] {
        stranger->send(Bus::kSwarm, message);
      };
    };
  }
  static std::function<Speaker(int)> peer(PretendedPeer::Manners manners) {
    return [manners](int port) -> Speaker {
      return [one = std::make_shared<PretendedPeer>(port, manners)] { one->turn(); };
    };
  }

  static int port_of(std::size_t i, const Plant& plant) {
    return plant.port > 0 ? plant.port : 24000 + 3 * static_cast<int>(i);
  }
  static std::string url_of(std::size_t i, const Plant& plant) {
    return "udpm://" + std::string(kTeamsGroup) + ":" + std::to_string(port_of(i, plant)) + "?" +
           plant.url_options;
  }

  /// Makes the host's fault.
  void set_up(std::size_t i, const Plant& plant) {
    const int host = static_cast<int>(i), port = port_of(i, plant);
    std::string set_up = plant.set_up;
    if (const auto at = set_up.find("$PORT"); at != set_up.npos)
      set_up.replace(at, 5, std::to_string(port));
    if (!set_up.empty()) lan_->on_host(host, set_up);
    if (plant.speaker) {
      const auto elsewhere = lan_->visit(lan_->hosts() - 1);
      speakers_.push_back(plant.speaker(port));
    }
    const auto there = lan_->visit(host);
    for (const int offset : plant.held_ports) hold(port + offset, !plant.alone);
    url_ = url_of(i, plant);
    for (int agent = 0; agent < plant.agents; ++agent) hand("ergocast-agent");
    const auto open = [&] {
      const auto sockets = doctor::parse_socket_table(text_of("/proc/thread-self/net/udp"));
      return std::ranges::count_if(sockets, [&](const doctor::UdpSocket& socket) {
        return socket.port >= port && socket.port < port + kBusCount;
      });
    };
    EXPECT_TRUE(eventually([&] { return open() >= 2 * plant.agents; }));
  }

  void start_doctor(std::size_t i, const Plant& plant) {
    const auto there = lan_->visit(static_cast<int>(i));
    const auto program = plant.as_nobody ? folder_ / "ergocast" : program_folder() / "ergocast";
    std::string command =
        plant.wrapper + " " + program.string() + " doctor --lcm-url '" + url_of(i, plant) + "'";
    for (const std::string& argument : plant.arguments) command += " " + argument;
    command =
        plant.on_a_terminal ? "script -qefc \"" + command + "\" /dev/null" : command + " --json";
    const auto log = folder_ / ("doctor-" + std::to_string(++started_doctors_));
    const Child::Program examiner{{"/bin/sh", "-c", "exec " + command}, log, SIGKILL};
    doctors_.insert_or_assign(i, Doctor{Child::start(examiner).value(), log});
  }

  void hold(int port, bool shared) {
    Socket& socket = held_.emplace_back(AF_INET, SOCK_DGRAM);
    const int yes = shared;
    setsockopt(socket.fd(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    const sockaddr_in address = address_of("0.0.0.0", port);
    EXPECT_EQ(bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }

  /// Examines the hosts in `pending` at once. Meanwhile all senders send.
  void examine(const std::vector<Plant>& plants, const std::set<std::size_t>& pending) {
    for (const std::size_t i : pending) start_doctor(i, plants[i]);
    EXPECT_TRUE(eventually([&] {
      for (const Speaker& speak : speakers_) speak();
      return std::ranges::none_of(pending, [&](auto i) { return doctors_.at(i).child.running(); });
    }));
    for (const std::size_t i : pending) said_.push_back(text_of(doctors_.at(i).log));
  }

  /// Whether the doctor found the fault of `plant`, and ended with its exit code.
  bool has_found(std::size_t i, const Plant& plant) {
    const json report = json::parse(text_of(doctors_.at(i).log), nullptr, false);
    const bool as_expected = doctors_.at(i).child.exit_code().value_or(-1) == plant.exit_code;
    if (report.is_discarded()) return as_expected;  // for people
    bool found = false;
    for (const json& one : report["findings"]) {
      const std::string check = one["check"], what = one["found"], why = one["why"],
                        remedy = one["remedy"];
      said_.push_back(check + "\n" + what + "\n" + why + "\n" + remedy);
      found = found || (check == plant.check && one["level"] == plant.level &&
                        what.find(plant.found) != what.npos);
    }
    return as_expected && found;
  }

  /// The doctor listens for a given time; on a busy machine a sender may miss it. So a host is
  /// examined again if its fault was not found.
  void expect_each_to_be_found(const std::vector<Plant>& plants) {
    constexpr int kExaminations = 5;
    std::set<std::size_t> pending;
    for (std::size_t i = 0; i < plants.size(); ++i) pending.insert(i);
    for (int n = 0; n < kExaminations && !pending.empty(); ++n) {
      examine(plants, pending);
      std::erase_if(pending, [&](std::size_t i) { return has_found(i, plants[i]); });
    }
    for (const std::size_t i : pending) {
      ADD_FAILURE() << plants[i].level << " " << plants[i].check << ": " << plants[i].found
                    << ", exit code " << plants[i].exit_code << ": not in\n"
                    << text_of(doctors_.at(i).log) << "exit code "
                    << doctors_.at(i).child.exit_code().value_or(-1);
    }
  }

  struct Doctor {
    Child child;
    std::filesystem::path log;
  };
  std::deque<Socket> held_;
  std::vector<Speaker> speakers_;
  std::map<std::size_t, Doctor> doctors_;  ///< the last one on each host
  int started_doctors_ = 0;
  std::vector<std::string> said_;
};

constexpr const char* kAsNobody = "setpriv --reuid=65534 --regid=65534 --clear-groups";
constexpr const char* kSecondInterface =
    "ip link add br1 type bridge && ip addr add 10.0.9.1/24 dev br1 && ip link set br1 up";

std::vector<Plant> DoctorCanFail::plants_of_routes() {
  const std::string no_route = "ip route del 224.0.0.0/4";
  const std::string to_lo = "ip route replace 224.0.0.0/4 dev lo";
  return {
      {"route", "no route to", "problem", 3, no_route, "ttl=0"},
      {"route", "no route to", "problem", 3, std::string(kSecondInterface) + "; " + no_route},
      {"route", "no route to", "problem", 3, "ip link set eth0 down"},
      {"route", "goes to lo, yet", "problem", 1, to_lo},
      {"route", "goes to lo, yet", "problem", 1, "ip link set eth0 down; " + to_lo},
      {"route", ", and not over br1", "note", 0, kSecondInterface},
      {"interface", "is not set to multicast", "problem", 1, "ip link set eth0 multicast off"},
      {"interface", "has no carrier", "problem", 1,
       "ip link add v0 type veth peer name v1 && ip addr add 10.0.9.1/24 dev v0 && ip link set v0 "
       "up && "
       "ip route replace 224.0.0.0/4 dev v0"},
      {"MTU", "eth0: 1000 bytes", "warning", 1, "ip link set eth0 mtu 1000"},
      {"TTL", "never leaves this host", "note", 0, "", "ttl=0"},
      {"self test", "did not come back", "problem", 3,
       "nft 'add table inet wall; add chain inet wall in { type filter hook input priority 0; "
       "policy drop; }'"},
      {"firewall",
       "drops incoming traffic",
       "note",
       0,
       "",
       "ttl=1",
       {},
       "env PATH=" + (folder_ / "iptables").string() + ":$PATH"},
  };
}

std::vector<Plant> DoctorCanFail::plants_of_kernels() {
  const std::string sysctl = "/proc/sys/net/ipv4/";
  const std::string drop =
      "nft 'add table inet t; add chain inet t i { type filter hook input priority 0; }'";
  return {
      {"receive buffer", "the kernel grants", "warning", 1, "", "ttl=1&recv_buf_size=1073741823"},
      {"receive buffer", "holds about", "note", 0, "", "ttl=1&recv_buf_size=65536"},
      {"fragments", "20000 bytes for fragments", "note", 0,
       "echo 10000 > " + sysctl + "ipfrag_low_thresh; echo 20000 > " + sysctl +
           "ipfrag_high_thresh"},
      {"source check", "rp_filter=1 (strict)", "note", 0,
       "echo 0 > " + sysctl + "conf/all/rp_filter; echo 1 > " + sysctl + "conf/eth0/rp_filter"},
      {"bridges",
       "br1: snooping without a querier",
       "note",
       0,
       kSecondInterface,
       "ttl=1",
       {},
       "unshare -m sh -c 'mount -t sysfs sysfs /sys && exec \"$@\"' _"},
      {"LCM fragments", "no rule drops them", "note", 0},
      {.check = "LCM fragments",
       .found = "no rule drops them",
       .level = "note",
       .exit_code = 0,
       .port = 30000},
      {"LCM fragments", "at 1 of our 3 ports", "note", 0,
       drop + "; nft 'add rule inet t i udp dport $PORT @th,64,32 0x4c433033 drop'"},
      {"LCM fragments",
       "only root can see",
       "note",
       0,
       "",
       "ttl=1",
       {},
       kAsNobody,
       {},
       false,
       {},
       0,
       true},
      {"clock",
       "not synchronised",
       "note",
       0,
       "",
       "ttl=1",
       {},
       std::string("env LD_PRELOAD=") + ERGOCAST_UNSYNCHRONISED_CLOCK},
      {"lcm-spy", "missing: java", "note", 0, "", "ttl=1", {}, "env PATH=/nowhere"},
  };
}

std::vector<Plant> DoctorCanFail::plants_on_the_bus() {
  const Hello hello{{77, 3, 5, 0, 0}, 3, "elsewhere", "9.9"};
  const auto foreign = [](int port) -> Speaker {
    const auto url = "udpm://" + std::string(kTeamsGroup) + ":" + std::to_string(port) + "?ttl=1";
    return [bus = std::make_shared<lcm::LCM>(url)] { bus->publish("LIDAR", "scan", 4); };
  };
  const std::vector<std::string> with_key = {"--key-file", key_file("ours")};
  return {
      {"ports", ": hosts_tests (pid ", "warning", 1, "", "ttl=1", {}, "", {0, 1, 2}},
      {.check = "ports", .found = " and 2 more", .level = "note", .exit_code = 0, .agents = 3},
      {"ports", "cannot open the port", "problem", 1, "", "ttl=1", {}, "", {0}, true},
      {"ports",
       "another user's program",
       "warning",
       1,
       "",
       "ttl=1",
       {},
       kAsNobody,
       {1},
       false,
       {},
       0,
       true},
      {"swarm bus",
       "run 000000000000004d, 1 agent on elsewhere, version 9.9",
       "note",
       0,
       "",
       "ttl=1",
       {},
       "",
       {},
       false,
       says(hello)},
      {"swarm bus",
       "a team without a mission key",
       "warning",
       1,
       "",
       "ttl=1",
       with_key,
       "",
       {},
       false,
       says(hello)},
      {"swarm bus",
       "messages that this key does not open",
       "warning",
       1,
       "",
       "ttl=1",
       with_key,
       "",
       {},
       false,
       says(hello, authenticator("other"))},
      {"swarm bus",
       "a team with a mission key",
       "note",
       0,
       "",
       "ttl=1",
       {},
       "",
       {},
       false,
       says(hello, authenticator("ours"))},
      {"swarm bus",
       "other LCM traffic: LIDAR",
       "warning",
       1,
       "",
       "ttl=1",
       {},
       "",
       {},
       false,
       foreign},
      {"mission key", "none: unauthenticated", "note", 0},
  };
}

std::vector<Plant> DoctorCanFail::plants_of_peers() {
  const std::vector<std::string> test = {"--peer", "3"};
  const std::vector<std::string> keyed = {"--peer", "3", "--key-file", key_file("ours")};
  const auto plant = [&](const char* check, const char* found, const char* level,
                         PretendedPeer::Manners manners,
                         const std::vector<std::string>& arguments) {
    return Plant{check,
                 found,
                 level,
                 std::string(level) == "note" ? 0 : 1,
                 "",
                 "ttl=1",
                 arguments,
                 "",
                 {},
                 false,
                 peer(std::move(manners))};
  };
  const auto every_fourth = [](std::uint32_t sequence) { return doctor::is_large(sequence); };
  const auto every_fifth = [](std::uint32_t sequence) { return sequence % 5 == 2; };
  return {
      {"peers", "no probe of another host arrived", "problem", 1, "", "ttl=1", test},
      {"peers", "cannot send: ", "problem", 1,
       "nft 'add table inet w; add chain inet w o { type filter hook output priority 0; }; "
       "add rule inet w o udp dport $PORT drop'",
       "ttl=1", test},
      {"peers", "not tried: LCM cannot be used", "problem", 3, "ip route del 224.0.0.0/4", "ttl=1",
       test},
      {"peers", "not tried: the port is in use", "warning", 1, "", "ttl=1", test, "", {0}},
      {"relay",
       "no answer: it does not run there",
       "problem",
       1,
       "",
       "ttl=1",
       {"--relay", "127.0.0.1:9"}},
      plant("peer stranger", "one-way", "problem", {.answers = false}, test),
      plant("peer stranger", "received too briefly", "note", {.answers = false, .most = 3}, test),
      plant("peer stranger", "only short datagrams arrive", "problem", {.leaves_out = every_fourth},
            test),
      plant("peer stranger", "it has version 9.9", "warning", {.version = "9.9"}, test),
      plant("peer stranger", "it has a mission key and this host has none", "warning", {.key = 5},
            test),
      plant("peer stranger", "it has another mission key", "warning", {.key = 5}, keyed),
      plant("peer stranger", "it has no mission key and this host has one", "warning", {}, keyed),
      plant("peer stranger", ", lost: ", "warning", {.leaves_out = every_fifth}, test),
      plant("peer stranger", "probes came twice", "note", {.twice = true}, test),
      plant("peers", "1 more whose probes reach others, but not this host", "problem",
            {.gossips = true}, test),
      // The output for people, on a terminal.
      {.arguments = {"--peer", "1"}, .wrapper = "env NO_COLOR=1", .on_a_terminal = true},
  };
}

std::vector<Plant> DoctorCanFail::plants() {
  std::vector<Plant> all;
  for (const auto& some :
       {plants_of_routes(), plants_of_kernels(), plants_on_the_bus(), plants_of_peers()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

const std::vector<Unsayable> kUnsayable = {
    {"cli/doctor/ports.cc", "ss -ulpn", "a thousand ports would have to be taken"},
};

TEST_F(DoctorCanFail, InEachOfItsFindings) {
  namespace fs = std::filesystem;
  for (const char* name : {"ours", "other"}) {
    ASSERT_EQ(write_key_file(key_file(name), key_text(make_mission_key(), false)), std::nullopt);
  }
  // If only root may read the folder, the build may be in such a folder, too.
  fs::permissions(folder_, fs::perms::group_exec | fs::perms::others_exec, fs::perm_options::add);
  fs::copy_file(program_folder() / "ergocast", folder_ / "ergocast");
  // A host without nft, whose iptables drops.
  fs::create_directory(folder_ / "iptables");
  for (const auto& [tool, does] :
       {std::pair("nft", "exit 1"), std::pair("iptables", "echo '-P INPUT DROP'")}) {
    std::ofstream(folder_ / "iptables" / tool) << "#!/bin/sh\n" << does << "\n";
    fs::permissions(folder_ / "iptables" / tool, fs::perms::owner_all);
  }

  const std::vector<Plant> all = plants();
  lan_.emplace(static_cast<int>(all.size()) + 1);
  for (std::size_t i = 0; i < all.size(); ++i) set_up(i, all[i]);
  expect_each_to_be_found(all);
  EXPECT_EQ(ergocast({"doctor", "--help"}), 0);
  said_.push_back(output());

  std::vector<std::string> sources =
      sources_in("cli/doctor", {"cli/doctor/command_output.cc", "cli/doctor/print.cc"});
  expect_all_said(sources, said_, kUnsayable);
}

}  // namespace
}  // namespace ergocast::test
