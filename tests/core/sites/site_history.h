// SPDX-License-Identifier: BSD-3-Clause
// A team of sites with everything that can happen to it: loss, delay, repetition and splits of the
// network, moves, restarts, new parents, and members that learn late of all this.
//
// Each sample adds 1 to a sum of its own, so an agent's coverage shows how often it counts each. A
// flaw is a mistake of a member or parent. Each must be seen to break what is checked, else the
// check would prove nothing.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/noise.h"
#include "core/law/site_row.h"
#include "core/law/site_table.h"

namespace ergocast::test {

enum class SiteFlaw {
  kNone,
  kMovesWithSums,         ///< the row at a new site begins with the sums of the former row
  kOneNameForAllSites,    ///< a row's name lacks the revision that gave the site
  kRestartsWithSums,      ///< a new incarnation begins with what the former one had covered
  kSamplesInBothRows,     ///< after a move the former row grows, too
  kParentSumsAllItHolds,  ///< also members' rows of a site where the parent was before
  kParentsShareRevision,  ///< a new parent's rows are no newer than those of the former one
  kOwnSiteByRowToo,       ///< an agent counts its own site's row beside the members' rows
  kOwnRowsOfOtherSites,   ///< an agent that has moved counts its former row beside that site's
};
inline constexpr int kSiteFlaws = 9;

class SiteHistory {
 public:
  static constexpr int kAgents = 6, kSites = 3, kTicks = 40, kModes = kAgents * kTicks;

  explicit SiteHistory(std::uint64_t number, SiteFlaw flaw = SiteFlaw::kNone);

  /// Runs all ticks, and then delivers everything until nothing changes.
  /// @return the first thing that was wrong; empty if all was right
  std::string run();

 private:
  /// A member's row as an agent holds it.
  struct Held {
    int site = 0;
    std::int64_t steps = 0;
    std::vector<double> sums;
  };
  using Rows = std::map<MemberRowName, Held>;
  struct Parent {
    Author author;
    std::int64_t revision = 0;
  };
  struct Member {
    Author author;
    int site = 0;
    std::int64_t revision = 0;  ///< that gave it the site
  };
  struct Roster {
    std::int64_t revision = 0;
    std::vector<Member> members;  ///< by agent
    std::vector<Parent> parents;  ///< by site
  };
  struct Agent {
    Author author;
    Roster known;
    MemberRowName current;
    Rows rows;
    SiteTable table;
  };
  /// One member's row, or a site's row.
  struct Message {
    int sender = 0;
    Rows row;
    std::vector<SiteRow> sum;
  };

  std::uint64_t below(std::uint64_t limit);
  bool one_in(std::uint64_t n) { return below(n) == 0; }
  int side_of(int agent, Tick tick) const;

  void name_parent(int site);
  void move(int agent);
  void restart(int agent);
  void change_roster();
  void learn(Agent& agent);
  MemberRowName name_of(const Member& member) const;
  void sample(Agent& agent, Tick tick);
  SiteRow summed_up(const Agent& agent, Tick tick) const;
  void send_all(Tick tick);
  void deliver(const Message& message, Agent& to);
  void deliver_some(Tick tick);
  double count(const Agent& agent, std::vector<double>& sums) const;
  std::string check(const Agent& agent) const;
  void come_to_rest();
  std::string check_at_rest() const;

  std::uint64_t number_, throws_ = 0;
  SiteFlaw flaw_;
  Roster roster_;
  std::vector<Agent> agents_;
  std::vector<Message> in_flight_;
};

}  // namespace ergocast::test
