// Floods on the buses of a team that goes on flying.
#include "core/messages.h"
#include "runtime/socket.h"
#include "tests/process/mission.h"
#include "tests/process/stranger.h"

namespace ergocast::test {
namespace {

/// Resident memory of a process [kB].
long resident_kb(pid_t pid) {
  const std::string status = text_of("/proc/" + std::to_string(pid) + "/status");
  const auto at = status.find("VmRSS:");
  return at == status.npos ? 0 : std::stol(status.substr(at + 6));
}

class Flood : public FlyingMission {
 protected:
  /// Short LCM messages under 100 000 names that nobody has heard, on one bus.
  static void send_foreign_names(Bus bus, const std::string& stem) {
    const LcmUrl url = std::get<LcmUrl>(LcmUrl::parse(kUrl));
    const Socket socket(AF_INET, SOCK_DGRAM);
    const sockaddr_in to = address_of(url.group, url.base_port + static_cast<int>(bus));
    for (int i = 0; i < 100000; ++i) {
      const std::string bytes = std::string("LC02\0\0\0\1", 8) + stem + std::to_string(i) + std::string(20, '\0');
      sendto(socket.fd(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
      if (i % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));  // so that all are heard
    }
  }
};

TEST_F(Flood, NamesOfChannelsThatAreNobodysCostNoMemory) {
  constexpr long kGrowth_kb = 2000;
  Child mission = launch_endless(scenario(), {"--realtime=5", "--lcm-url", kUrl});
  const pid_t who[] = {pids(agent(0)).front(), pids({"ergocast-logger"}).front()};
  const long before[] = {resident_kb(who[0]), resident_kb(who[1])};
  send_foreign_names(Bus::kSwarm, "ERGOCAST_CONTRIBUTION_X");
  send_foreign_names(Bus::kWorld, "SOMEBODY_ELSES_");
  for (const int i : {0, 1}) {
    const long grown_kb = resident_kb(who[i]) - before[i];
    RecordProperty(i == 0 ? "agent_grown_kb" : "logger_grown_kb", std::to_string(grown_kb));
    EXPECT_LT(grown_kb, kGrowth_kb) << (i == 0 ? "agent" : "logger");
  }
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << said();
  EXPECT_EQ(summary()["restarts"], 0);
}

}  // namespace
}  // namespace ergocast::test
