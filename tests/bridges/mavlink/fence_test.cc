// SPDX-License-Identifier: BSD-3-Clause
// The fence of an autopilot: what it is made of, and what can go wrong on its way.
#include "bridges/mavlink/fence.h"

#include <functional>

#include "tests/bridges/mavlink/vehicle_flight.h"

namespace ergocast::mavlink {
namespace {

Box domain_of(double width_m, double length_m) {
  Box domain;
  domain.origin_m = {100, 200, 0};
  domain.size_m = {width_m, length_m, 0};
  return domain;
}

const EarthPlace kOrigin{47.6535, 9.175, 0, false};

TEST(MavlinkFence, IsTheDomainWithAMarginAndEachWall) {
  const IndexedRings walls{{{110, 210}, {120, 210}, {115, 220}}};
  const auto made = fence_items(kOrigin, domain_of(80, 60), 5, walls);
  ASSERT_TRUE(made) << made.error();
  const auto& items = *made;
  ASSERT_EQ(items.size(), 7U);
  const double corners_m[][2] = {{95, 195},  {185, 195}, {185, 265}, {95, 265},
                                 {110, 210}, {120, 210}, {115, 220}};
  for (std::size_t i = 0; i < items.size(); ++i) {
    EXPECT_EQ(items[i].seq, i);
    EXPECT_EQ(items[i].command, i < 4 ? 5001 : 5002);
    EXPECT_EQ(items[i].param1, i < 4 ? 4 : 3) << "corners of its polygon";
    EXPECT_EQ(items[i].mission_type, 1);
    EXPECT_EQ(items[i].frame, 0);
    const auto at_m = local_m(kOrigin, {items[i].x * 1e-7, items[i].y * 1e-7, 0});
    EXPECT_NEAR(at_m->x(), corners_m[i][0], 0.01) << i;
    EXPECT_NEAR(at_m->y(), corners_m[i][1], 0.01) << i;
  }
}

TEST(MavlinkFence, IsRefusedForAWallWithARoom) {
  const IndexedRings walls{{{110, 210}, {140, 210}, {140, 240}, {110, 240}},
                           {{115, 215}, {135, 215}, {135, 235}, {115, 235}}};
  const auto made = fence_items(kOrigin, domain_of(80, 60), 5, walls);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().find("has a room"), std::string::npos);
}

/// An autopilot's side of the protocol, with a link that drops what `loses` names.
class Keeper {
 public:
  explicit Keeper(std::vector<MissionItemInt> items) { fence.begin(std::move(items)); }

  void pass(double seconds_passed) {
    for (int i = 0; i < std::lround(seconds_passed * 10); ++i) {
      now += 100ms;
      std::vector<Packet> out;
      fence.advance(now, out);
      for (const Packet& packet : out) {
        ++sent;
        if (!lost()) std::visit([this](const auto& m) { take(m); }, packet);
      }
    }
  }

  Fence fence;
  Instant now{100s};
  std::function<bool(int)> loses = [](int) { return false; };  // the n-th message of either side
  std::function<void(std::vector<MissionItemInt>&)> changes = [](auto&) {};  // what it keeps
  std::uint8_t result = 0;                                                   // of an upload
  bool answers = true;
  std::vector<MissionItemInt> kept;
  int sent = 0, uploads = 0;

 private:
  bool lost() { return loses(messages_++); }
  template <class M>
  void give(M message) {
    message.mission_type = Fence::kType;
    if (answers && !lost()) fence.receive(message, now);
  }
  void ask(std::size_t seq) {
    MissionRequestInt question;
    question.seq = static_cast<std::uint16_t>(seq);
    give(question);
  }
  void end(std::uint8_t type) {
    MissionAck ack;
    ack.type = type;
    give(ack);
  }
  void take(const auto&) {}
  void take(const MissionCount& count) {
    ++uploads;
    coming_.clear();
    expected_ = count.count;
    if (result != 0) return end(result);
    ask(0);
  }
  void take(const MissionItemInt& item) {
    if (expected_ == 0) return end(0);  // its answer was lost
    if (item.seq != coming_.size()) return ask(coming_.size());
    coming_.push_back(item);
    if (coming_.size() < expected_) return ask(coming_.size());
    kept = coming_;
    changes(kept);
    expected_ = 0;
    end(0);
  }
  void take(const MissionRequestList&) {
    MissionCount count;
    count.count = static_cast<std::uint16_t>(kept.size());
    give(count);
  }
  void take(const MissionRequestInt& question) {
    if (question.seq < kept.size()) give(kept[question.seq]);
  }
  int messages_ = 0;
  std::size_t expected_ = 0;
  std::vector<MissionItemInt> coming_;
};

std::vector<MissionItemInt> items() { return *fence_items(kOrigin, domain_of(80, 60), 5, {}); }

TEST(MavlinkFence, HoldsOnceItWasReadBackAsItWasSent) {
  Keeper keeper(items());
  EXPECT_FALSE(keeper.fence.why_not().empty());
  keeper.pass(2);
  EXPECT_EQ(keeper.fence.why_not(), "");
  EXPECT_EQ(keeper.kept.size(), 4U);
  const int sent = keeper.sent;
  keeper.pass(30);
  EXPECT_EQ(keeper.sent, sent) << "nothing more is sent";
  keeper.fence.begin_anew();
  EXPECT_FALSE(keeper.fence.why_not().empty()) << "the autopilot has started anew";
  keeper.pass(2);
  EXPECT_EQ(keeper.fence.why_not(), "");
}

TEST(MavlinkFence, ArrivesInSpiteOfLoss) {
  for (int one = 0; one < 26; ++one) {  // each message of an exchange
    Keeper keeper(items());
    keeper.loses = [one](int n) { return n == one; };
    keeper.pass(5);
    EXPECT_EQ(keeper.fence.why_not(), "") << one;
    EXPECT_EQ(keeper.uploads, one < 2 ? 2 - (one == 0) : 1)
        << one << ": it was repeated, not begun anew";
  }
  Keeper third(items());
  third.loses = [](int n) { return n % 3 == 1; };
  third.pass(60);
  EXPECT_EQ(third.fence.why_not(), "");
}

TEST(MavlinkFence, ThatIsRefusedOrAnotherOneIsToldAndTriedAgain) {
  using Kept = std::vector<MissionItemInt>;
  const std::pair<const char*, std::function<void(Keeper&)>> faults[] = {
      {"the autopilot refuses it: NO_SPACE", [](Keeper& k) { k.result = 4; }},
      {"the autopilot refuses it: DENIED", [](Keeper& k) { k.result = 14; }},
      {"the autopilot refuses it: 77", [](Keeper& k) { k.result = 77; }},
      {"the autopilot does not answer", [](Keeper& k) { k.answers = false; }},
      {"the autopilot has 3 of its 4 items",
       [](Keeper& k) { k.changes = [](Kept& kept) { kept.pop_back(); }; }},
      {"the autopilot has another item 2 than was sent",
       [](Keeper& k) { k.changes = [](Kept& kept) { kept[2].x += 3; }; }},
      {"the autopilot has another item 1 than was sent",
       [](Keeper& k) { k.changes = [](Kept& kept) { kept[1].command = 5002; }; }},
      {"the autopilot has another item 0 than was sent",
       [](Keeper& k) { k.changes = [](Kept& kept) { kept[0].param1 = 5; }; }}};
  for (const auto& [problem, plant] : faults) {
    Keeper keeper(items());
    plant(keeper);
    keeper.pass(8);
    EXPECT_EQ(keeper.fence.why_not(), std::string("has no fence: ") + problem);
    EXPECT_TRUE(keeper.fence.failed());
    keeper.result = 0;
    keeper.answers = true;
    keeper.changes = [](Kept& kept) { kept[3].y -= 1; };  // rounded
    keeper.pass(12);
    EXPECT_EQ(keeper.fence.why_not(), "") << problem;
    EXPECT_FALSE(keeper.fence.failed());
  }
}

TEST(MavlinkFence, IsNoBusinessOfOtherLists) {
  Keeper keeper(items());
  keeper.answers = false;
  keeper.pass(0.1);
  const int sent = keeper.sent;
  MissionRequestInt question;  // for a mission
  keeper.fence.receive(question, keeper.now);
  MissionAck refusal;
  refusal.type = 4;
  keeper.fence.receive(refusal, keeper.now);
  MissionAck early;
  early.mission_type = Fence::kType;
  keeper.fence.receive(early, keeper.now);
  keeper.pass(0.1);
  EXPECT_EQ(keeper.sent, sent) << "nothing was answered";
  EXPECT_FALSE(keeper.fence.failed());
  question.mission_type = Fence::kType;
  question.seq = 4;
  keeper.fence.receive(question, keeper.now);
  EXPECT_TRUE(keeper.fence.failed()) << "there are 4 items";
}

TEST(MavlinkVehicle, StandsUntilItsAutopilotHasTheFence) {
  VehicleOptions fenced = options();
  fenced.fence_margin_m = 5;
  Flight flight(fenced);
  flight.pass(4);
  EXPECT_TRUE(flight.sent_of<MissionCount>().empty()) << "the mission is not known yet";
  flight.begin();
  flight.pass(1);
  EXPECT_TRUE(flight.stands());
  EXPECT_TRUE(flight.said("gives the autopilot its fence")) << flight.log;
  const auto counts = flight.sent_of<MissionCount>();
  ASSERT_FALSE(counts.empty());
  EXPECT_EQ(counts[0].count, 4);
  EXPECT_EQ(counts[0].target_system, 1);
  EXPECT_EQ(counts[0].target_component, 1);
  const auto answer = [&](auto message) {
    message.mission_type = Fence::kType;
    message.target_system = 1;
    message.target_component = 191;
    flight.hear(message);
    flight.turn();
  };
  MissionAck refusal;
  refusal.mission_type = Fence::kType;
  refusal.type = 4;
  refusal.target_system = 255;
  flight.hear(refusal);  // to a ground station
  for (std::uint16_t i = 0; i < 4; ++i) {
    MissionRequestInt question;
    question.seq = i;
    answer(question);
  }
  const auto sent = flight.sent_of<MissionItemInt>();
  ASSERT_EQ(sent.size(), 4U);
  answer(MissionAck());
  MissionCount count;
  count.count = 4;
  answer(count);
  for (const MissionItemInt& item : sent) {
    EXPECT_TRUE(flight.stands());
    answer(item);
  }
  flight.pass(0.1);
  EXPECT_TRUE(flight.follows()) << flight.log;
  EXPECT_EQ(flight.sent_of<MissionAck>().size(), 1U);
}

}  // namespace
}  // namespace ergocast::mavlink
