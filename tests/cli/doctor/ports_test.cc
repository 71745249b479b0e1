// SPDX-License-Identifier: BSD-3-Clause
// An artificial /proc lists the processes that hold each port, and hostile names in it reach no
// terminal.
#include "cli/doctor/ports.h"

#include "tests/cli/doctor/fixture.h"

namespace ergocast::doctor {
namespace {

/// A socket as /proc/net/udp has it.
std::string socket_at(const std::string& hex_port, const std::string& inode) {
  return " 1028: 00000000:" + hex_port +
         " 00000000:0000 07 00000000:00000000 00:00000000 00000000" + "     0        0 " + inode +
         " 2 0000000000000000 0\n";
}

/// A table with the ports 24000, 24002 and 24003.
const std::string kTable = "  sl  local_address rem_address\n" + socket_at("5DC0", "111") +
                           socket_at("5DC2", "222") + socket_at("5DC3", "333");

class Ports : public Folder {
 protected:
  void process(int pid, const std::string& command, const std::string& inode) {
    const std::string folder = std::to_string(pid);
    write(folder + "/cmdline", command + '\0' + "--option" + '\0');
    std::filesystem::create_directories(root_ / folder / "fd");
    std::filesystem::create_symlink("socket:[" + inode + "]", root_ / folder / "fd/7");
  }
};

TEST_F(Ports, HoldersOfTheThreePortsAreFound) {
  write("net/udp", kTable);
  process(12, "/usr/bin/ergocast-agent", "111");
  process(13, "/opt/strange\033[2J", "333");  // the port after ours
  const auto found = holders(root_, url_of("ttl=0"));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].port, 24000);
  EXPECT_EQ(found[0].program, "ergocast-agent");
  EXPECT_EQ(found[0].pid, 12);
  EXPECT_EQ(found[1].port, 24002);
  EXPECT_EQ(found[1].program, "");  // a process whose sockets we may not see
}

TEST_F(Ports, NamesThatOthersChoseCannotSteerTheTerminal) {
  write("net/udp", kTable);
  process(13, "/opt/strange\033[2J", "111");
  EXPECT_EQ(holders(root_, url_of("ttl=0"))[0].program, "strange?[2J");
}

TEST(PortsFinding, OurOwnAreANoteAndStrangersAWarning) {
  const LcmUrl url = url_of("ttl=1");
  EXPECT_EQ(ports_finding(url, {}, "", {}).level, Level::kOk);
  const Finding ours = ports_finding(url, {{24000, "ergocast-sim", 5}}, "", 24009);
  EXPECT_EQ(ours.level, Level::kNote);
  EXPECT_TRUE(contains(ours.remedy, ":24009?ttl=1")) << ours.remedy;
  const Finding shared =
      ports_finding(url, {{24000, "ergocast-sim", 5}, {24001, "vlc", 6}}, "", 24009);
  EXPECT_EQ(shared.level, Level::kWarning);
  EXPECT_EQ(shared.found, "24001: vlc (pid 6)");
  const Finding closed = ports_finding(url, {{24000, "vlc", 6}}, "cannot open the port", 24009);
  EXPECT_EQ(closed.level, Level::kProblem);
  EXPECT_TRUE(contains(closed.found, "vlc (pid 6)")) << closed.found;
}

}  // namespace
}  // namespace ergocast::doctor
