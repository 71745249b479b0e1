// The disk of a run directory is full for a while: the team goes on, and later so does the record.
#include <fcntl.h>
#include <sys/mount.h>

#include "tests/process/mission.h"
#include "tests/process/witness.h"

namespace ergocast::test {
namespace {

class FullDisk : public FlyingMission {
 protected:
  /// Mounts a small disk as the run directory. False where that is not possible.
  bool mount_disk(const char* size) {
    if (!may_mount()) return false;
    std::filesystem::create_directory(out());
    return mounted_ = mount("none", out().c_str(), "tmpfs", 0, size) == 0;
  }
  ~FullDisk() override {
    if (mounted_) umount2(out().c_str(), MNT_DETACH);
  }

  /// Takes all the space that is left.
  void fill_disk() const {
    std::ofstream file(ballast());
    const std::string piece(4096, 'x');
    while (file << piece << std::flush) {
    }
  }
  void empty_disk() const { std::filesystem::remove(ballast()); }

  bool mounted_ = false;

 private:
  std::filesystem::path ballast() const { return out() / "ballast"; }
};

/// A logger that cannot write is given up after 2 s.
class FullDiskInEitherPace : public FullDisk, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, FullDiskInEitherPace,
                         ::testing::Values("--lockstep", "--realtime=40"), [](const auto& pace) {
                           return pace.index == 0 ? "Lockstep" : "Realtime";
                         });

TEST_P(FullDiskInEitherPace, TheTeamGoesOnAndTheRecordResumesWithAGap) {
  if (!mount_disk("size=96m")) GTEST_SKIP() << "the small disk this needs cannot be mounted here";
  Child mission = launch_endless(scenario("lockstep_timeout_s: 4 broadcast_period_ticks: 20"),
                                 {GetParam(), "--lcm-url", kUrl});
  Witness witness(kUrl);
  ASSERT_TRUE(witness.hears([&] { return witness.answered(witness.member(0)) > 0; }));
  fill_disk();
  const auto bytes = recorded_bytes();
  // Twice as many ticks as a recorder keeps for later: once those that it had not yet tried to write.
  ASSERT_TRUE(witness.hears([&] {
    return witness.answered(witness.member(0)) > witness.recorded() + 2200;
  })) << said();
  EXPECT_LT(recorded_bytes(), bytes + 200000);
  empty_disk();
  ASSERT_TRUE(recorded(recorded_bytes() + 300000)) << log_of("logger");
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << said();
  EXPECT_EQ(summary()["restarts"], 0) << said();
  EXPECT_EQ(summary()["interruptions"], 1) << log_of("logger");
  EXPECT_GT(summary()["gaps"], 0);
  EXPECT_NE(log_of("logger").find("written again"), std::string::npos) << log_of("logger");
  const bool lockstep = std::string(GetParam()) == "--lockstep";
  EXPECT_EQ(ergocast({"verify", out()}), lockstep ? 0 : 2) << output();
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
}

TEST_F(FullDisk, ThatStaysFullFailsTheRunAtItsEndAndIsNamed) {
  if (!mount_disk("size=2m")) GTEST_SKIP() << "the small disk this needs cannot be mounted here";
  EXPECT_EQ(
      ergocast({"run", scenario("lockstep_timeout_s: 4"), "--out", out(), "--duration", "200"}), 4);
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
