// SPDX-License-Identifier: BSD-3-Clause
// The disk of a run directory is full for a while: the team continues, and later the record, too.
#include <sys/mount.h>
#include <sys/statvfs.h>

#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

class FullDisk : public RunningMission {
 protected:
  /// Mounts a disk as the run directory. False where that is not possible.
  bool mount_disk(const char* size) {
    if (!may_mount()) return false;
    std::filesystem::create_directory(out());
    return mounted_ = mount("none", out().c_str(), "tmpfs", 0, size) == 0;
  }
  ~FullDisk() override {
    if (mounted_) umount2(out().c_str(), MNT_DETACH);
  }

  bool resize_disk(const std::string& size) const {
    return mount("none", out().c_str(), "tmpfs", MS_REMOUNT, ("size=" + size).c_str()) == 0;
  }
  /// Makes the disk as small as its content, which grows meanwhile.
  bool fill_disk() const {
    return eventually([this] {
      struct statvfs disk {};
      return statvfs(out().c_str(), &disk) == 0 &&
             resize_disk(std::to_string((disk.f_blocks - disk.f_bfree) * disk.f_frsize));
    });
  }

  bool mounted_ = false;
};

/// The team waits at most 5 s for a logger that cannot write.
class FullDiskInEitherPace : public FullDisk, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, FullDiskInEitherPace,
                         ::testing::Values("--lockstep", "--realtime=40"), name_of_pace);

TEST_P(FullDiskInEitherPace, TheTeamGoesOnAndTheRecordResumesWithAGap) {
  // More than any machine writes before the disk is full, or afterwards.
  constexpr const char* kRoomy = "4g";
  if (!mount_disk("size=4g")) GTEST_SKIP() << "the disk this needs cannot be mounted here";
  Child mission = launch_endless(scenario("lockstep_timeout_s: 10 broadcast_period_ticks: 20"),
                                 {GetParam(), "--lcm-url", kUrl});
  ASSERT_TRUE(fill_disk());
  const auto bytes = recorded_bytes();
  const Tick full_at = recorded_rows(out()).rbegin()->first;
  // Twice as many ticks as a recorder buffers: some of them it had not yet tried to write.
  BusObserver observer(kUrl);
  ASSERT_TRUE(observer.observes([&] {
    return observer.answered(observer.member(0)) > full_at + 2200;
  })) << printed();
  EXPECT_LT(recorded_bytes(), bytes + 200000);
  ASSERT_TRUE(resize_disk(kRoomy));
  // The buffered rows are written first; the gap comes after them.
  ASSERT_TRUE(eventually([&] { return recorded_rows(out()).rbegin()->first > full_at + 2200; }))
      << log_of("logger");
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["restarts"], 0) << printed();
  EXPECT_EQ(summary()["interruptions"], 1) << log_of("logger");
  EXPECT_GT(summary()["gaps"], 0);
  EXPECT_NE(log_of("logger").find("written again"), std::string::npos) << log_of("logger");
  const bool lockstep = std::string(GetParam()) == "--lockstep";
  EXPECT_EQ(ergocast({"verify", out()}), lockstep ? 0 : 2) << output();
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
}

TEST_F(FullDisk, ThatStaysFullFailsTheRunAtItsEndAndIsNamed) {
  if (!mount_disk("size=512k")) GTEST_SKIP() << "the small disk this needs cannot be mounted here";
  EXPECT_EQ(
      ergocast({"run", scenario("lockstep_timeout_s: 10"), "--out", out(), "--duration", "60"}), 4);
  EXPECT_NE(output().find("No space left"), std::string::npos) << output();
}

TEST_F(FullDisk, EndsASimulationAndIsNamed) {
  if (!mount_disk("size=2m")) GTEST_SKIP() << "the small disk this needs cannot be mounted here";
  EXPECT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "10000",
                      "--out", out()}),
            4);
  EXPECT_NE(output().find("No space left"), std::string::npos) << output();
}

}  // namespace
}  // namespace ergocast::test
