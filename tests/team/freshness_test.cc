// SPDX-License-Identifier: BSD-3-Clause
// Only a newer sequence of the same sender and incarnation counts as new, and the memory is
// bounded.
#include "team/freshness.h"

#include <gtest/gtest.h>

namespace ergocast {
namespace {

Header said(AgentId sender, Incarnation life, std::int64_t sequence) {
  return {1, sender, life, sequence, 0};
}

TEST(Freshness, OnlyWhatComesLaterIsNews) {
  Freshness freshness;
  EXPECT_TRUE(freshness.is_news(said(3, 7, 5)));
  EXPECT_FALSE(freshness.is_news(said(3, 7, 5)));
  EXPECT_FALSE(freshness.is_news(said(3, 7, 4)));
  EXPECT_TRUE(freshness.is_news(said(3, 7, 6)));
  EXPECT_FALSE(freshness.is_news(said(3, 7, 5)));
}

TEST(Freshness, LivesAndSendersAreToldApart) {
  Freshness freshness;
  EXPECT_TRUE(freshness.is_news(said(3, 7, 5)));
  EXPECT_TRUE(freshness.is_news(said(3, 8, 1)));
  EXPECT_TRUE(freshness.is_news(said(kWorld, 7, 1)));
  EXPECT_FALSE(freshness.is_news(said(3, 7, 5))) << "a successor does not wake its predecessor";
}

TEST(Freshness, RemembersNoMoreLivesThanItsLimit) {
  Freshness freshness;
  constexpr auto kMost = static_cast<Incarnation>(Freshness::kMostLives);
  for (Incarnation life = 1; life <= kMost; ++life) {
    EXPECT_TRUE(freshness.is_news(said(0, life, 1)));
  }
  EXPECT_FALSE(freshness.is_news(said(0, kMost + 1, 1)));
  EXPECT_TRUE(freshness.is_news(said(0, kMost, 2))) << "whom it knows, it still hears";
}

}  // namespace
}  // namespace ergocast
