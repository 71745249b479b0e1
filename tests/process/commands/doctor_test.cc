// SPDX-License-Identifier: BSD-3-Clause
// `ergocast doctor` on this host: its findings; it disturbs no team.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

using nlohmann::json;

constexpr const char* kUrl = "udpm://239.255.76.67:24000?ttl=0";

/// A socket on a port of this host.
class Squatter {
 public:
  Squatter(int port, bool shares) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    const int yes = shares;
    setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ip_mreq membership{};
    inet_pton(AF_INET, "239.255.76.67", &membership.imr_multiaddr);
    EXPECT_EQ(setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership), 0);
  }
  Squatter(const Squatter&) = delete;
  Squatter& operator=(const Squatter&) = delete;
  ~Squatter() { close(fd_); }

  int datagrams_received() const {
    int count = 0;
    for (char byte; recv(fd_, &byte, 1, 0) >= 0;) ++count;
    return count;
  }

 private:
  int fd_;
};

class Doctor : public OwnHost {
 protected:
  int doctor(std::vector<std::string> more, const char* url = kUrl) {
    std::vector<std::string> arguments = {"doctor", "--json", "--lcm-url", url};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const int code = ergocast(arguments);
    report_ = json::parse(output(), nullptr, false);
    EXPECT_FALSE(report_.is_discarded()) << output();
    return code;
  }
  json finding(const std::string& check) const {
    for (const json& one : report_["findings"]) {
      if (one["check"] == check) return one;
    }
    return {};
  }
  bool prints(const std::string& check, const std::string& part) const {
    return finding(check).dump().find(part) != std::string::npos;
  }
  json report_;
};

TEST_F(Doctor, AHostThatIsAllRightGetsNothingWorseThanNotes) {
  EXPECT_EQ(doctor({}), 0) << output();
  EXPECT_EQ(finding("route")["found"], "239.255.76.67 goes over lo (127.0.0.1)");
  EXPECT_EQ(finding("TTL")["level"], "note");
  EXPECT_EQ(finding("self test")["level"], "ok");
  EXPECT_EQ(finding("ports")["level"], "ok");
  EXPECT_EQ(finding("swarm bus")["level"], "ok");
  EXPECT_EQ(ergocast({"doctor", "--lcm-url", kUrl}), 0);
  EXPECT_NE(output().find("ok       route "), std::string::npos) << output();
  EXPECT_NE(output().find("0 problems"), std::string::npos) << output();
}

TEST_F(Doctor, WithoutARouteItsOwnCommandMendsTheHost) {
  ASSERT_EQ(std::system("ip route del 224.0.0.0/4 dev lo"), 0);
  EXPECT_EQ(doctor({}), 3) << output();
  EXPECT_EQ(finding("route")["level"], "problem");
  EXPECT_EQ(finding("self test")["level"], "problem");
  EXPECT_EQ(doctor({"--peer", "1"}), 3) << output();
  EXPECT_TRUE(prints("peers", "not tried"));
  ASSERT_EQ(std::system(finding("route")["remedy"].get<std::string>().c_str()), 0);
  EXPECT_EQ(doctor({}), 0) << output();
}

TEST_F(Doctor, LoopbackAndATtlThatMeansOthersDoNotFit) {
  EXPECT_EQ(doctor({}, "udpm://239.255.76.67:24000?ttl=1"), 1);
  EXPECT_EQ(finding("route")["level"], "problem");
}

TEST_F(Doctor, TheProgramOnAPortIsNamed) {
  const Squatter shares(24001, true);
  EXPECT_EQ(doctor({}), 1);
  EXPECT_EQ(finding("ports")["level"], "warning");
  EXPECT_TRUE(prints("ports", "24001: process_tests (pid " + std::to_string(getpid()) + ")"))
      << output();
}

TEST_F(Doctor, ASocketThatIsClosedMeanwhileBelongsToNoOtherUser) {
  const std::jthread opens([](const std::stop_token& stop) {
    while (!stop.stop_requested()) const Squatter brief(24001, true);
  });
  for (int k = 0; k < 5; ++k) {
    doctor({});
    EXPECT_FALSE(prints("ports", "another user's program")) << output();
  }
}

TEST_F(Doctor, APortThatAProgramDoesNotShareIsAProblem) {
  const Squatter alone(24000, false);
  EXPECT_EQ(doctor({"--peer", "1"}), 1);
  EXPECT_EQ(finding("ports")["level"], "problem");
  EXPECT_TRUE(prints("ports", "process_tests")) << output();
}

TEST_F(Doctor, NothingIsSentToARunsPorts) {
  const Squatter swarm(24000, true), world(24001, true), command(24002, true);
  doctor({});
  doctor({"--peer", "1"});  // the port is in use
  EXPECT_TRUE(prints("peers", "not tried")) << output();
  EXPECT_EQ(swarm.datagrams_received(), 0);
  EXPECT_EQ(world.datagrams_received(), 0);
  EXPECT_EQ(command.datagrams_received(), 0);
}

TEST_F(Doctor, ARunIsFoundAndNotDisturbed) {
  Child run = start("ergocast", {"run", scenario_file("quadrimodal_corners"), "--realtime", "--out",
                                 out(), "--lcm-url", kUrl});
  ASSERT_TRUE(recorded(1000));
  EXPECT_EQ(doctor({"--peer", "1"}), 1);  // because --peer is not tried
  EXPECT_TRUE(prints("swarm bus", "run ")) << output();
  EXPECT_TRUE(prints("swarm bus", "running")) << output();
  EXPECT_EQ(finding("ports")["level"], "note") << finding("ports");
  EXPECT_TRUE(prints("ports", "ergocast-")) << output();
  EXPECT_TRUE(prints("peers", "not tried")) << output();
  run.send(SIGTERM);
  wait_for(run);
}

TEST_F(Doctor, TwoOnOneHostReceiveEachOther) {
  Child other = start("ergocast", {"doctor", "--peer", "600", "--lcm-url", kUrl});
  ASSERT_TRUE(eventually([] {
    return text_of("/proc/net/udp").find(":5DC0 ") != std::string::npos;
  })) << "no program listens to port 24000";
  // The other one first listens to the bus, which takes long on a busy machine.
  ASSERT_TRUE(eventually([&] {
    doctor({"--peer", "3"});
    return report_["peers"].size() == 1 && report_["peers"][0]["hears_this_host"] == true;
  })) << output();
  EXPECT_EQ(finding("TTL")["level"], "problem");  // no other host would receive messages
  other.send(SIGKILL);
}

TEST_F(Doctor, BadArgumentsAreRefused) {
  EXPECT_EQ(ergocast({"doctor", "--peer", "0"}), 2);
  EXPECT_EQ(ergocast({"doctor", "--peer", "601"}), 2);
  EXPECT_EQ(ergocast({"doctor", "--peer", "long"}), 2);
  EXPECT_EQ(ergocast({"doctor", "--lcm-url", "udpm://10.0.0.1:7667"}), 2);
  EXPECT_NE(output().find("multicast"), std::string::npos) << output();
  EXPECT_EQ(ergocast({"doctor", "--help"}), 0);
  EXPECT_NE(output().find("Changes nothing"), std::string::npos) << output();
}

}  // namespace
}  // namespace ergocast::test
