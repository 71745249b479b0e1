// SPDX-License-Identifier: BSD-3-Clause
// Sightings and dismissals: what a team forgets, in any order of messages, and what then confirms.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/mission/amendments.h"
#include "core/mission/search_note.h"
#include "core/search/confirmations.h"
#include "core/search/contacts.h"
#include "core/search/efforts.h"
#include "tests/core/search/field.h"

namespace ergocast::search_notes {
namespace {

using Eigen::Vector3d;

constexpr Tick kFrom = 200;
const Vector3d kPlace_m(85, 60, 0);
const Author kAuthor{0, 1};

SearchNote dismissal() { return {.number = 0, .from = kFrom, .x_m = kPlace_m.head<2>()}; }

SearchNote sighting() {
  return {.number = 0, .from = kFrom, .x_m = kPlace_m.head<2>(), .sigma_m = 10, .share = 0.5};
}

TileCell at(const Efforts& efforts, const Vector3d& x_m) {
  return efforts.cells().tile_cell(static_cast<std::int32_t>(efforts.cells().cells.cell_of(x_m)));
}

/// Looks and reports at the place, up to a tick.
Efforts searched(const Mission& mission, Tick until) {
  Efforts efforts(mission);
  efforts.add_row(kAuthor);
  const auto cell = static_cast<std::int32_t>(efforts.cells().cells.cell_of(kPlace_m));
  for (Tick tick = 0; tick < until; ++tick) {
    efforts.look(kAuthor, tick, kPlace_m);
    if (tick >= 10 && tick < 13) efforts.report(kAuthor, tick, cell);
  }
  return efforts;
}

void merge_row(Efforts& into, const Efforts& from, Tick sent) {
  const std::vector<EffortTile>& row = *from.row_of(kAuthor);
  for (std::size_t tile = 0; tile < row.size(); ++tile)
    if (row[tile].newest_look >= 0) into.merge(kAuthor, tile, row[tile], sent);
}

TEST(SearchNotes, ADismissalForgetsReportsAndASightingAllCounts) {
  const Mission mission = searched_field();
  for (const SearchNote& note : {dismissal(), sighting()}) {
    Efforts efforts = searched(mission, kFrom);
    const TileCell here = at(efforts, kPlace_m), next = at(efforts, kPlace_m + Vector3d(10, 0, 0)),
                   far = at(efforts, kPlace_m + Vector3d(40, 0, 0));
    const std::uint32_t looks = efforts.looks(here), far_looks = efforts.looks(far);
    ASSERT_EQ(efforts.reports(here), 3u);
    ASSERT_GT(looks, 0u);
    efforts.note({&note, 1}, {});
    EXPECT_FALSE(efforts.set_now(kFrom - 1)) << "not yet";
    EXPECT_EQ(efforts.reports(here), 3u);
    EXPECT_TRUE(efforts.set_now(kFrom));
    EXPECT_EQ(efforts.reports(here), 0u);
    EXPECT_EQ(efforts.looks(here), note.is_sighting() ? 0u : looks);
    EXPECT_EQ(efforts.looks(next) == 0, note.is_sighting());
    EXPECT_EQ(efforts.looks(far), far_looks);
    // What comes afterwards counts, and is forgotten no more.
    const auto cell = static_cast<std::int32_t>(efforts.cells().cells.cell_of(kPlace_m));
    efforts.report(kAuthor, kFrom, cell);
    efforts.note({&note, 1}, {});
    EXPECT_FALSE(efforts.set_now(kFrom + 5));
    EXPECT_EQ(efforts.reports(here), 1u);
  }
}

TEST(SearchNotes, ADismissedContactSteersNoMore) {
  const Mission mission = searched_field();
  Efforts efforts = searched(mission, kFrom);
  Contacts contacts(mission);
  contacts.set_prior(std::vector<double>(efforts.cells().cells.total(), 1.0 / 200));
  const std::size_t cell = efforts.cells().cells.cell_of(kPlace_m);
  const SearchNote note = dismissal();
  efforts.note({&note, 1}, {});
  contacts.renew(efforts);
  EXPECT_TRUE(contacts.nats(cell) > 0 || contacts.confirmed(cell));
  efforts.set_now(kFrom);
  contacts.renew(efforts);
  EXPECT_EQ(contacts.nats(cell), 0);
  EXPECT_FALSE(contacts.confirmed(cell));
  EXPECT_TRUE(contacts.judged().empty());
}

TEST(SearchNotes, ForgettingCommutesWithMerging) {
  const Mission mission = searched_field();
  for (const SearchNote& note : {dismissal(), sighting()}) {
    const Efforts before = searched(mission, kFrom);
    Efforts author = before, early(mission), late(mission);
    author.note({&note, 1}, {});
    author.set_now(kFrom);
    // One holder has the tiles before the note, and the other gets them delayed.
    for (Efforts* holder : {&early, &late}) holder->note({&note, 1}, {});
    merge_row(early, before, kFrom - 1);
    early.set_now(kFrom);
    late.set_now(kFrom);
    merge_row(late, before, kFrom - 1);
    for (double x_m = -15; x_m < 180; x_m += 10) {
      const TileCell cell = at(author, {x_m, 60, 0});
      EXPECT_EQ(early.looks(cell), author.looks(cell)) << x_m;
      EXPECT_EQ(late.looks(cell), author.looks(cell)) << x_m;
      EXPECT_EQ(early.reports(cell), author.reports(cell)) << x_m;
      EXPECT_EQ(late.reports(cell), author.reports(cell)) << x_m;
    }
    // A third one holds what it got before it knew of the note, and repeats that.
    Efforts again(mission), unaware(mission);
    merge_row(unaware, before, kFrom - 1);
    again.note({&note, 1}, {});
    again.set_now(kFrom + 9);
    merge_row(again, unaware, kFrom + 9);
    EXPECT_EQ(again.looks(at(author, kPlace_m)), author.looks(at(author, kPlace_m)));
    EXPECT_EQ(again.reports(at(author, kPlace_m)), 0u);
    merge_row(unaware, author, kFrom);
    EXPECT_EQ(unaware.reports(at(author, kPlace_m)), 0u);
  }
}

/// In lockstep an author may be a tick ahead of a holder.
TEST(SearchNotes, WhatAnAuthorCountedAfterANoteIsNotForgotten) {
  const Mission mission = searched_field();
  const SearchNote note = sighting();
  Efforts author = searched(mission, kFrom), holder(mission);
  author.note({&note, 1}, {});
  Tick now = kFrom;
  for (const TileCell here = at(author, kPlace_m); now == kFrom || author.looks(here) == 0; ++now) {
    author.set_now(now);
    author.look(kAuthor, now, kPlace_m);
  }
  merge_row(holder, author, now);
  holder.note({&note, 1}, {});
  holder.set_now(kFrom);
  EXPECT_EQ(holder.looks(at(author, kPlace_m)), 1u);
}

TEST(SearchNotes, HoldFromTicksThatCount) {
  const Mission mission = searched_field();
  const SearchNote note = dismissal();
  Efforts efforts = searched(mission, kFrom);
  const std::vector<Hold> holds{{100, 150}};  // fewer ticks count by then
  efforts.note({&note, 1}, holds);
  EXPECT_FALSE(efforts.set_now(kFrom - 51));
  EXPECT_TRUE(efforts.set_now(kFrom - 50));
}

TEST(SearchNotes, AreCheckedBeforeTheyAreNamed) {
  Mission mission = searched_field();
  EXPECT_TRUE(is_search_note(dismissal(), mission));
  EXPECT_TRUE(is_search_note(sighting(), mission));
  const auto refused = [&](auto change) {
    SearchNote note = sighting();
    change(note);
    return !is_search_note(note, mission);
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double wrong : {kNan, 1e9, -1e9})
    EXPECT_TRUE(refused([&](SearchNote& note) { note.x_m.x() = wrong; })) << wrong;
  for (const double wrong : {kNan, 0.0, -1.0, 1e8})
    EXPECT_TRUE(refused([&](SearchNote& note) { note.sigma_m = wrong; })) << wrong;
  for (const double wrong : {kNan, 0.0, -1.0, 1.0})
    EXPECT_TRUE(refused([&](SearchNote& note) { note.share = wrong; })) << wrong;
  mission.sensor.false_alarms_per_s = 0;
  EXPECT_FALSE(is_search_note(dismissal(), mission)) << "there are no contacts";
  EXPECT_TRUE(is_search_note(sighting(), mission));
  mission.law.kind = LawKind::kCover;
  EXPECT_FALSE(is_search_note(sighting(), mission)) << "the team does not search";
  mission.law.kind = LawKind::kSearch;
  Mission box = searched_field();
  box.domain.size_m.z() = 10;
  EXPECT_FALSE(is_search_note(sighting(), box)) << "the domain is a box";
  EXPECT_FALSE(is_search_note(dismissal(), box));
  const std::vector<SearchNote> many(kMaxSearchNotes + 1, sighting());
  EXPECT_FALSE(are_search_notes(many, mission));
}

TEST(SearchNotes, ASightingThatIsReplacedBeforeItHoldsLeavesTheList) {
  const Mission mission = searched_field();
  Amendments list;
  name_target(list, kFrom, {.target = mission.target_coefficients, .cosine = {}});
  note_sighting(list, sighting());
  name_dismissal(list, kFrom, dismissal());
  EXPECT_EQ(list.notes[0].number, list.targets[0].number);
  EXPECT_EQ(list.notes[1].number, 1);
  EXPECT_TRUE(are_amendments(list, mission));
  replace_target(list, {.target = mission.target_coefficients, .cosine = {}});
  ASSERT_EQ(list.notes.size(), 1U);
  EXPECT_FALSE(list.notes[0].is_sighting());
  EXPECT_TRUE(are_amendments(list, mission));
}

/// What is known after reports of the place's cell at some ticks, by a sensor that circles.
struct Judged {
  ObjectSet found = 0;
  int wrong = 0;
};
Judged judged(const Mission& mission, const std::vector<std::pair<Tick, ObjectSet>>& reports,
              const std::vector<SearchNote>& notes) {
  Confirmations confirmations(mission);
  confirmations.note(notes, {});
  const auto cell = static_cast<std::int32_t>(SearchCells(mission).cells.cell_of(kPlace_m));
  Judged result;
  Tick done = 0;
  for (const auto& [tick, object] : reports) {
    for (; done < tick; ++done)
      confirmations.see(0, done, kPlace_m + Vector3d(60, 0, 0), 0, kNoCell);
    result.found = confirmations.see(0, done++, kPlace_m + Vector3d(60, 0, 0), object, cell);
  }
  result.wrong = confirmations.wrong();
  return result;
}

TEST(SearchNotes, ADismissedContactDoesNotComeBackFromTheSameReports) {
  const Mission mission = searched_field();
  // The fewest reports that confirm.
  std::vector<std::pair<Tick, ObjectSet>> least;
  while (judged(mission, least, {}).wrong == 0) {
    least.emplace_back(100 + 2 * least.size(), 0);
    ASSERT_LT(least.size(), 12u);
  }
  ASSERT_GT(least.size(), 1u);
  auto across = least;
  across.back().first = kFrom + 5;
  EXPECT_EQ(judged(mission, across, {}).wrong, 1);
  EXPECT_EQ(judged(mission, across, {dismissal()}).wrong, 0) << "old reports count no more";
  // As many new ones confirm again, and make another contact.
  auto twice = least;
  for (const auto& [tick, object] : least) twice.emplace_back(tick + kFrom, 1);
  EXPECT_EQ(judged(mission, twice, {dismissal()}).found, 1u);
  EXPECT_EQ(judged(mission, twice, {dismissal()}).wrong, 1) << "the first one was";
}

TEST(SearchNotes, ContactsAreListedWithWhatIsKnownOfThem) {
  const Mission mission = searched_field();
  Confirmations confirmations(mission);
  const SearchCells cells(mission);
  const auto cell_at = [&](double x_m, double y_m) {
    return static_cast<std::int32_t>(cells.cells.cell_of({x_m, y_m, 0}));
  };
  const Vector3d far_m(150, 30, 0);
  for (Tick tick = 0; tick < 12; ++tick) {
    confirmations.see(0, 2 * tick, far_m, 0, kNoCell);
    confirmations.see(1, 2 * tick, kPlace_m, 1, cell_at(kPlace_m.x(), kPlace_m.y()));
  }
  confirmations.see(0, 30, far_m, 0, cell_at(150, 30));
  confirmations.see(0, 34, far_m, 0, cell_at(160, 30));  // beside it
  const std::vector<Contact> contacts = confirmations.contacts();
  ASSERT_EQ(contacts.size(), 2U);
  EXPECT_TRUE(contacts[0].confirmed);
  EXPECT_EQ(contacts[0].cell, cell_at(kPlace_m.x(), kPlace_m.y()));
  EXPECT_EQ(contacts[0].x_m, cells.middle_m(contacts[0].cell));
  EXPECT_GE(contacts[0].probability, mission.sensor.confirm_at);
  EXPECT_EQ(contacts[0].newest, 22);
  EXPECT_FALSE(contacts[1].confirmed);
  EXPECT_EQ(contacts[1].reports, 2);
  EXPECT_EQ(contacts[1].newest, 34);
  EXPECT_GT(contacts[1].probability, 0);
  EXPECT_LT(contacts[1].probability, mission.sensor.confirm_at);
  const SearchNote note = dismissal();
  confirmations.note({&note, 1}, {});
  confirmations.see(0, kFrom, far_m, 0, kNoCell);
  ASSERT_EQ(confirmations.contacts().size(), 1U);
  EXPECT_FALSE(confirmations.contacts()[0].confirmed);
  EXPECT_TRUE(Confirmations().contacts().empty());
}

TEST(SearchNotes, AnObjectThatHasDriftedAwayExcusesNoContactThere) {
  Mission mission = searched_field();
  mission.law.memory_half_life_s = 20;
  std::vector<std::pair<Tick, ObjectSet>> reports{{50, 1}};  // one detection, which then fades
  for (Tick tick = 450; tick < 466; tick += 2) reports.emplace_back(tick, 0);
  const Judged result = judged(mission, reports, {});
  EXPECT_EQ(result.wrong, 1);
  EXPECT_EQ(result.found, 0u) << "no report that counts was of it";
  mission.law.memory_half_life_s = 0;
  EXPECT_EQ(judged(mission, reports, {}).found, 1u) << "its report still counts";
}

}  // namespace
}  // namespace ergocast::search_notes
