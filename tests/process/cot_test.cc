// SPDX-License-Identifier: BSD-3-Clause
// --cot of `ergocast watch` and `run`: the events of a real team come as datagrams, at one place
// and in a group.
#include <arpa/inet.h>

#include <map>
#include <pugixml.hpp>
#include <set>

#include "runtime/bus/socket.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

/// Keeps the newest event of each uid.
class Receiver {
 public:
  /// At any free port of this host, or at one port of a group.
  explicit Receiver(const std::string& group = "", int port = 0)
      : socket_(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK) {
    sockaddr_in at = address_of(group.empty() ? "127.0.0.1" : group, port);
    EXPECT_EQ(bind(socket_.fd(), reinterpret_cast<sockaddr*>(&at), sizeof at), 0);
    socklen_t size = sizeof at;
    getsockname(socket_.fd(), reinterpret_cast<sockaddr*>(&at), &size);
    port_ = ntohs(at.sin_port);
    if (group.empty()) return;
    ip_mreq joined{at.sin_addr, {htonl(INADDR_ANY)}};
    EXPECT_EQ(setsockopt(socket_.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &joined, sizeof joined), 0);
  }
  std::string url() const { return "udp://127.0.0.1:" + std::to_string(port_); }

  const std::map<std::string, std::string>& events() {
    std::string space(65536, '\0');
    for (ssize_t size; (size = recv(socket_.fd(), space.data(), space.size(), 0)) > 0;) {
      const std::string text = space.substr(0, static_cast<std::size_t>(size));
      pugi::xml_document document;
      EXPECT_TRUE(document.load_string(text.c_str())) << text;
      events_[document.child("event").attribute("uid").value()] = text;
    }
    return events_;
  }
  void forget() { events_.clear(); }
  /// The newest event whose uid ends so; empty: none.
  std::string of(const std::string& end) {
    for (const auto& [uid, text] : events())
      if (uid.ends_with(end)) return text;
    return {};
  }

 private:
  Socket socket_;
  int port_ = 0;
  std::map<std::string, std::string> events_;
};

class SentToTak : public RunningMission {
 protected:
  std::filesystem::path there() {
    const auto file = scenario();
    std::ofstream(file, std::ios::app) << "\norigin { latitude_deg: 47.5 longitude_deg: 9.2 }\n";
    return file;
  }
  Child watch(const std::string& to, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"watch", "--cot", to};
    words.insert(words.end(), more.begin(), more.end());
    return start("ergocast", words);
  }
  void end(Child& child) {
    child.send(SIGINT);
    EXPECT_EQ(wait_for(child), 0) << output();
  }
  static bool all_agents(Receiver& receiver) {
    for (const char* agent : {"-agent-0", "-agent-1", "-agent-2", "-agent-3"})
      if (receiver.of(agent).empty()) return false;
    return true;
  }
  static std::set<std::string> uids(Receiver& receiver) {
    std::set<std::string> uids;
    for (const auto& [uid, text] : receiver.events()) uids.insert(uid);
    return uids;
  }
};

TEST_F(SentToTak, HasRobotsWithTheSameNamesAfterRestarts) {
  Child mission = launch_endless(there(), {"--realtime=10"});
  Receiver receiver;
  Child shown = watch(receiver.url());
  ASSERT_TRUE(eventually([&] { return all_agents(receiver); }, shown.pid())) << output();
  const auto names = uids(receiver);
  EXPECT_EQ(names.size(), 4U) << ::testing::PrintToString(names);
  pugi::xml_document document;
  document.load_string(receiver.of("-agent-3").c_str());
  const pugi::xml_node event = document.child("event");
  EXPECT_STREQ(event.attribute("type").value(), "a-f-G");
  EXPECT_STREQ(event.child("detail").child("contact").attribute("callsign").value(),
               "quadrimodal_corners 3");
  // The domain is 2000 m wide: it ends 0.018° in the north and 0.0266° in the east of the origin.
  const pugi::xml_node point = event.child("point");
  EXPECT_GE(point.attribute("lat").as_double(), 47.5);
  EXPECT_LE(point.attribute("lat").as_double(), 47.518);
  EXPECT_GE(point.attribute("lon").as_double(), 9.2);
  EXPECT_LE(point.attribute("lon").as_double(), 9.2266);
  end(shown);
  kill_next(agent(3));
  receiver.forget();
  Child again = watch(receiver.url());
  ASSERT_TRUE(eventually([&] { return all_agents(receiver); }, again.pid())) << output();
  EXPECT_EQ(uids(receiver), names);
  end(again);
  end(mission);
}

TEST_F(SentToTak, HasZonesContactsAndFoundObjects) {
  Child mission =
      launch_endless(there(), {"--realtime=10", "--set", "world.objects.count=8", "--set",
                               "sensor.radius_m=300", "--set", "sensor.false_alarms_per_s=0.01"});
  Receiver receiver;
  Child shown = watch(receiver.url());
  const auto log = log_;
  std::ofstream(folder_ / "zone.textproto")
      << "vertices { x_m: 900 y_m: 900 } vertices { x_m: 1100 y_m: 900 } "
         "vertices { x_m: 1000 y_m: 1100 }\n";
  ergocast({"amend", "--zone", folder_ / "zone.textproto", "--for", "1000000s"});
  ASSERT_TRUE(eventually([&] { return !receiver.of("-zone-0").empty(); }, shown.pid()))
      << text_of(log);
  EXPECT_NE(receiver.of("-zone-0").find("type=\"u-d-f\""), std::string::npos);
  ASSERT_TRUE(eventually(
      [&] {
        const auto names = uids(receiver);
        const auto has = [&](const std::string& part) {
          return std::ranges::any_of(
              names, [&](const std::string& uid) { return uid.find(part) != uid.npos; });
        };
        return has("-contact-") && has("-object-");
      },
      shown.pid()))
      << text_of(log);
  end(shown);
  end(mission);
}

TEST_F(SentToTak, ReachesAMulticastGroup) {
  Child mission = launch_endless(there(), {"--realtime=10"});
  Receiver receiver("239.2.3.1", 6969);
  Child shown = watch("udp://239.2.3.1:6969");
  EXPECT_TRUE(eventually([&] { return all_agents(receiver); }, shown.pid())) << output();
  end(shown);
  end(mission);
}

TEST_F(SentToTak, LosesEventsThatNobodyReceivesAndSaysSoOnce) {
  Child mission = launch_endless(there(), {"--realtime=10"});
  const std::string to = Receiver().url();  // closed again
  Child shown = watch(to);
  const std::string lost = "events to " + to + " are lost: Connection refused";
  ASSERT_TRUE(eventually([&] { return answered(lost); }, shown.pid())) << output();
  EXPECT_TRUE(moves_on(60000)) << printed();
  end(shown);
  EXPECT_EQ(output().find(lost), output().rfind(lost)) << output();
  EXPECT_TRUE(answered(" events to " + to + " were lost")) << output();
  end(mission);
}

/// The page's process sends, and its successor if it is killed.
TEST_F(SentToTak, ComesFromThePageOfARun) {
  Receiver receiver;
  EXPECT_EQ(ergocast({"run", scenario(), "--watch", "--cot", receiver.url(), "--out", out()}), 2);
  EXPECT_TRUE(answered("add origin { latitude_deg: … longitude_deg: … }")) << output();
  std::filesystem::remove_all(out());
  Child mission = launch_endless(there(), {"--realtime=10", "--watch", "--cot", receiver.url()});
  ASSERT_TRUE(eventually([&] { return all_agents(receiver); }, mission.pid())) << printed();
  EXPECT_TRUE(logs("page", "TAK at " + receiver.url() + " is connected")) << log_of("page");
  ASSERT_EQ(ergocast({"status"}), 0) << output();
  EXPECT_TRUE(answered("shown to  TAK at " + receiver.url())) << output();
  kill_next({"ergocast run-page"});
  receiver.forget();
  ASSERT_TRUE(eventually([&] { return all_agents(receiver); }, mission.pid())) << printed();
  mission.send(SIGINT);
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); }, mission.pid())) << printed();
  end(mission);
}

TEST_F(SentToTak, ComesFromAPageWithControl) {
  Child mission = launch_endless(scenario(), {"--realtime=10"});
  Receiver receiver;
  EXPECT_EQ(ergocast({"watch", "--control", "--cot", receiver.url()}), 2);
  EXPECT_TRUE(answered("add origin { latitude_deg: … longitude_deg: … }")) << output();
  Child shown = watch(receiver.url(), {"--control", "--origin", "-33.9,18.4"});
  ASSERT_TRUE(eventually([&] { return all_agents(receiver); }, shown.pid())) << output();
  EXPECT_NE(receiver.of("-agent-0").find(" lat=\"-33."), std::string::npos);
  end(shown);
  end(mission);
}

TEST_F(SentToTak, NeedsAnOrigin) {
  Child mission = launch_endless(scenario(), {"--realtime=10"});
  Receiver receiver;
  EXPECT_EQ(ergocast({"watch", "--cot", receiver.url()}), 2);
  EXPECT_TRUE(answered("add origin { latitude_deg: … longitude_deg: … }")) << output();
  EXPECT_EQ(ergocast({"watch", "--cot", receiver.url(), "--lcm-url", kUrl}), 2);
  EXPECT_TRUE(answered("the scenario of this team is not on this host")) << output();
  for (const char* wrong : {"239.2.3.1:6969", "udp://239.2.3.1", "tcp://a:1", "udp://:6969"}) {
    EXPECT_EQ(ergocast({"watch", "--cot", wrong}), 2) << wrong;
    EXPECT_TRUE(answered("is no udp://HOST:PORT")) << output();
  }
  Child shown = watch(receiver.url(), {"--origin", "-33.9,18.4"});
  ASSERT_TRUE(eventually([&] { return all_agents(receiver); }, shown.pid())) << output();
  EXPECT_NE(receiver.of("-agent-0").find(" lat=\"-33."), std::string::npos);
  end(shown);
  end(mission);
}

}  // namespace
}  // namespace ergocast::test
