// SPDX-License-Identifier: BSD-3-Clause
// LCM fragments with crafted headers, which crash programs that read with LCM's library, but not
// ours.
#include <lcm/lcm-cpp.hpp>

#include "runtime/bus/group_socket.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/bus/socket.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

constexpr int kBasePort = 24700;
constexpr const char* kGroup = "239.255.76.67";
constexpr const char* kRules = ERGOCAST_SOURCE_DIR "/packaging/nftables/ergocast.nft";

void append(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(number >> shift));
}

/// The first of two fragments of a message. Its data goes to 64 bytes before the message's
/// beginning, which in 32 bits is 4 GB after it. LCM's check of this overflows.
std::string crafted_fragment(const std::string& channel) {
  std::string bytes = "LC03";
  append(bytes, 1);     // the message's number
  append(bytes, 1000);  // its size
  append(bytes, -64U);  // the fragment's place
  append(bytes, 2);     // fragment 0 of 2
  return bytes + channel + std::string(1 + 64, '\0');
}

void send_to(const std::string& address, Bus bus, const std::string& bytes) {
  const Socket socket(AF_INET, SOCK_DGRAM);
  const sockaddr_in to = address_of(address, kBasePort + static_cast<int>(bus));
  ASSERT_EQ(sendto(socket.fd(), bytes.data(), bytes.size(), 0,
                   reinterpret_cast<const sockaddr*>(&to), sizeof to),
            static_cast<ssize_t>(bytes.size()));
}

class Fragments : public RunningMission {
 protected:
  /// From now on programs start as on a kernel without socket filters.
  void take_socket_filters_away() {
    setenv("LD_PRELOAD", ERGOCAST_NO_SOCKET_FILTER, 1);
    // With AddressSanitizer: a preloaded library is fine.
    setenv("ASAN_OPTIONS", "verify_asan_link_order=0", 1);
  }
  void TearDown() override {
    unsetenv("LD_PRELOAD");
    unsetenv("ASAN_OPTIONS");
    std::system("nft delete table inet ergocast 2>/dev/null");
    RunningMission::TearDown();
  }

  /// Sends fragments to all listening ports; returns how many.
  static int send_to_everybody() {
    int sent = 0;
    for (const Bus bus : {Bus::kSwarm, Bus::kWorld, Bus::kCommand}) {
      for (const char* channel :
           {"ERGOCAST_HELLO", "ERGOCAST_MISSION", "ERGOCAST_STOP", "ERGOCAST_TEAM_STATUS",
            "ERGOCAST_CONTRIBUTION_1", "ERGOCAST_WORLD_STATE", "ERGOCAST_COMMAND_1"}) {
        send_to(kGroup, bus, crafted_fragment(channel));
        ++sent;
      }
    }
    return sent;
  }
  /// The team continues undisturbed.
  void expect_nothing_happens(Child& mission) {
    ASSERT_TRUE(moves_on(100000)) << printed();
    mission.send(SIGTERM);
    EXPECT_EQ(wait_for(mission), 0) << printed();
    EXPECT_EQ(summary()["restarts"], 0) << printed();
    EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  }
  /// The number of packets that the rule has dropped.
  int dropped() {
    const auto file = folder_ / "rules";
    if (std::system(("nft list table inet ergocast > " + file.string()).c_str()) != 0) return -1;
    const std::string text = text_of(file);
    return std::stoi(text.substr(text.find("packets ") + 8));
  }
};

// This shows that the rule is needed against the fragments of this file.
TEST_F(Fragments, CrashLcmsOwnLibrary) {
  const auto read_one = [] {
    signal(SIGSEGV, SIG_DFL);  // also under a sanitizer
    lcm::LCM lcm(LcmUrl::parse(kUrl).value().of(Bus::kSwarm));
    const auto ignore = +[](const lcm::ReceiveBuffer*, const std::string&, int) {};
    lcm.subscribeFunction("ERGOCAST_HELLO", ignore, 0);
    lcm.getFileno();  // starts LCM's reading thread
    for (;;) {
      send_to(kGroup, Bus::kSwarm, crafted_fragment("ERGOCAST_HELLO"));
      lcm.handleTimeout(10);
    }
  };
  EXPECT_EXIT(read_one(), ::testing::KilledBySignal(SIGSEGV), "");
}

TEST_F(Fragments, DoNothingToATeam) {
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  send_to_everybody();
  expect_nothing_happens(mission);
}

TEST_F(Fragments, HaveNoEffectOnATeamWhoseKernelHasNoFilters) {
  take_socket_filters_away();
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  send_to_everybody();
  EXPECT_NE(log_of("agent-0").find("this kernel has no socket filters"), std::string::npos);
  expect_nothing_happens(mission);
}

TEST_F(Fragments, AreDroppedByTheRule) {
  if (std::system((std::string("nft -f ") + kRules).c_str()) != 0) {
    ASSERT_FALSE(is_root());
    GTEST_SKIP() << "needs root";
  }
  const Socket ear(AF_INET, SOCK_DGRAM);  // without a listener, no datagram would arrive
  ASSERT_EQ(listen_to_group(ear, kGroup, kBasePort), std::nullopt);
  const int sent = send_to_everybody();
  EXPECT_TRUE(eventually([&] { return dropped() == sent; })) << dropped();
}

TEST_F(Fragments, TheDoctorReportsWhetherARuleDropsThem) {
  if (!is_root()) GTEST_SKIP() << "needs root";
  const auto finding = [this] {
    ergocast({"doctor", "--json", "--lcm-url", kUrl});
    const auto printed = nlohmann::json::parse(output());
    for (const auto& one : printed["findings"]) {
      if (one["check"] == "LCM fragments") return one;
    }
    return nlohmann::json();
  };
  const auto missing = finding();
  EXPECT_EQ(missing["level"], "note") << missing;
  // The file's folder is named where the programs are installed, or in the tree of their sources.
  const std::string command = missing["remedy"];
  ASSERT_EQ(std::system(("cd " ERGOCAST_SOURCE_DIR "/packaging/nftables && " + command).c_str()), 0)
      << missing;
  EXPECT_EQ(finding()["level"], "ok") << finding();
}

}  // namespace
}  // namespace ergocast::test
