// SPDX-License-Identifier: BSD-3-Clause
// The revisions of MISSION: when each is sent, and which of them a newcomer must know.
#include "coordinator/announcement.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

class Announcing : public ::testing::Test {
 protected:
  /// The revision that is sent at `now`.
  std::int64_t sent_at(Instant now) {
    Outbox out;
    announcement_.publish({MissionState::kRunning, reason_, plan_, members_, {}, -1}, me_, 7, out);
    announcement_.plan_next(false, now);
    return only<MissionPart>(out).at(0).revision;
  }

  Participant me_{Role::kCoordinator, {kRun, kCoordinator, kCoordinatorLife}};
  std::string reason_;
  const std::vector<std::byte> plan_ = encode_plan(small_mission(1));
  Members members_;
  Announcement announcement_;
};

TEST_F(Announcing, IsRepeatedOnceASecondAndSoonerAfterAChange) {
  EXPECT_EQ(announcement_.next(), Instant{});
  EXPECT_EQ(sent_at(at(5s)), 0);
  EXPECT_EQ(announcement_.next(), at(6s));
  announcement_.repeat_soon();
  EXPECT_EQ(announcement_.next(), at(5100ms));
  announcement_.change();
  EXPECT_EQ(announcement_.next(), Instant{}) << "at once";
  EXPECT_EQ(sent_at(at(5010ms)), 1);
}

TEST_F(Announcing, NewcomersMustKnowAChangeAtOnceAndAnAdmissionOnceItWasSent) {
  sent_at(at(0s));
  EXPECT_EQ(announcement_.admits_from(), 0);
  announcement_.note_silence();
  announcement_.note_admission();
  EXPECT_EQ(announcement_.admits_from(), 0);
  EXPECT_EQ(sent_at(at(1s)), 2);
  EXPECT_EQ(announcement_.admits_from(), 2);
  announcement_.note_silence();
  EXPECT_EQ(sent_at(at(2s)), 3);
  EXPECT_EQ(announcement_.admits_from(), 2) << "a silence matters only under its number";
  announcement_.change();
  EXPECT_EQ(announcement_.admits_from(), 4);
  announcement_.exceed(1000);
  EXPECT_EQ(announcement_.revision(), 1001);
  EXPECT_EQ(announcement_.admits_from(), 1001);
}

}  // namespace
}  // namespace ergocast
