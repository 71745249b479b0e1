// SPDX-License-Identifier: BSD-3-Clause
// Draws what happens to a team of sites, and counts how often each agent counts each sample.
#include "tests/core/sites/site_history.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace ergocast::test {
namespace {

constexpr Tick kSplitFrom = 12, kSplitUntil = 26;

}  // namespace

std::uint64_t SiteHistory::below(std::uint64_t limit) {
  return random_words(number_, Purpose::kFault, 2, ++throws_).first % limit;
}

SiteHistory::SiteHistory(std::uint64_t number, SiteFlaw flaw) : number_(number), flaw_(flaw) {
  roster_.revision = 1;
  roster_.parents.resize(kSites);
  for (int i = 0; i < kAgents; ++i) roster_.members.push_back({{i, 1}, i % kSites, 1});
  for (int s = 0; s < kSites; ++s) roster_.parents[static_cast<std::size_t>(s)] = {{s, 1}, 1};
  for (const Member& member : roster_.members) {
    agents_.push_back(
        {member.author, roster_, name_of(member), {}, SiteTable(kSites, member.site, kModes, 1)});
    agents_.back().rows[name_of(member)] = {member.site, 0, std::vector<double>(kModes)};
  }
}

MemberRowName SiteHistory::name_of(const Member& member) const {
  return {member.author, flaw_ == SiteFlaw::kOneNameForAllSites ? 0 : member.revision};
}

/// In every second history the network falls into two for some ticks. The coordinator is on side 0.
int SiteHistory::side_of(int agent, Tick tick) const {
  const bool split = number_ % 2 == 1 && tick >= kSplitFrom && tick < kSplitUntil;
  return split && (agent + static_cast<int>(number_ / 2)) % 3 == 0 ? 1 : 0;
}

// ---- the coordinator ----

void SiteHistory::name_parent(int site) {
  std::vector<Author> candidates;
  for (const Member& member : roster_.members) {
    if (member.site == site) candidates.push_back(member.author);
  }
  Parent& parent = roster_.parents[static_cast<std::size_t>(site)];
  parent.author = candidates[below(candidates.size())];
  parent.revision = flaw_ == SiteFlaw::kParentsShareRevision ? 1 : roster_.revision;
}

void SiteHistory::move(int agent) {
  Member& member = roster_.members[static_cast<std::size_t>(agent)];
  const int from = member.site;
  const auto members = std::ranges::count(roster_.members, from, &Member::site);
  if (members == 1) return;
  member.site = (from + 1 + static_cast<int>(below(kSites - 1))) % kSites;
  member.revision = roster_.revision;
  if (roster_.parents[static_cast<std::size_t>(from)].author == member.author) name_parent(from);
}

void SiteHistory::restart(int agent) {
  Member& member = roster_.members[static_cast<std::size_t>(agent)];
  const Author former = member.author;
  ++member.author.incarnation;
  member.revision = roster_.revision;
  if (roster_.parents[static_cast<std::size_t>(member.site)].author == former)
    name_parent(member.site);
  Agent& process = agents_[static_cast<std::size_t>(agent)];
  Held first{member.site, 0, std::vector<double>(kModes)};
  if (flaw_ == SiteFlaw::kRestartsWithSums) first = process.rows[process.current];
  process = {
      member.author, roster_, name_of(member), {}, SiteTable(kSites, member.site, kModes, 1)};
  process.rows[process.current] = first;
}

void SiteHistory::change_roster() {
  ++roster_.revision;
  const int agent = static_cast<int>(below(kAgents));
  switch (below(3)) {
    case 0:
      return move(agent);
    case 1:
      return restart(agent);
    default:
      return name_parent(static_cast<int>(below(kSites)));
  }
}

// ---- members ----

void SiteHistory::learn(Agent& agent) {
  agent.known = roster_;
  const Member& self = roster_.members[static_cast<std::size_t>(agent.author.agent)];
  if (self.site == agent.table.own_site()) return;
  const Held former = agent.rows[agent.current];
  agent.current = name_of(self);
  agent.table.set_own_site(self.site);
  Held first{self.site, 0, std::vector<double>(kModes)};
  const bool goes_on = flaw_ == SiteFlaw::kMovesWithSums || flaw_ == SiteFlaw::kOneNameForAllSites;
  if (goes_on) first = {self.site, former.steps, former.sums};
  // It may have been at this site before, by the same name only if a name lacks the revision.
  agent.rows[agent.current] = first;
}

void SiteHistory::sample(Agent& agent, Tick tick) {
  const auto k = static_cast<std::size_t>(agent.author.agent * kTicks + tick);
  for (auto& [name, held] : agent.rows) {
    const bool grows = name == agent.current ||
                       (flaw_ == SiteFlaw::kSamplesInBothRows && name.author == agent.author);
    if (!grows) continue;
    ++held.steps;
    held.sums[k] += 1;
  }
}

SiteRow SiteHistory::summed_up(const Agent& agent, Tick tick) const {
  const int site = agent.table.own_site();
  SiteRow row(site, kModes);
  row.restart(agent.known.parents[static_cast<std::size_t>(site)].revision, agent.author, tick);
  for (const auto& [name, held] : agent.rows) {
    if (held.site != site && flaw_ != SiteFlaw::kParentSumsAllItHolds) continue;
    row.add({.name = name,
             .steps = held.steps,
             .elapsed_s = static_cast<double>(held.steps),
             .sums = held.sums.data()});
  }
  return row;
}

// ---- the network ----

void SiteHistory::send_all(Tick tick) {
  for (const Agent& agent : agents_) {
    for (const auto& [name, held] : agent.rows) {
      // Own rows are broadcast; all others are repaired now and then.
      if (name.author == agent.author || tick >= kTicks || one_in(4))
        in_flight_.push_back({.sender = agent.author.agent, .row = {{name, held}}, .sum = {}});
    }
    const int site = agent.table.own_site();
    if (agent.known.parents[static_cast<std::size_t>(site)].author != agent.author) continue;
    in_flight_.push_back(
        {.sender = agent.author.agent, .row = {}, .sum = {summed_up(agent, tick)}});
  }
}

void SiteHistory::deliver(const Message& message, Agent& to) {
  for (const SiteRow& sum : message.sum) to.table.merge(sum);
  for (const auto& [name, held] : message.row) {
    if (held.site != to.table.own_site()) continue;
    const auto [mine, is_new] = to.rows.try_emplace(name, held);
    if (!is_new && mine->second.steps < held.steps) mine->second = held;
  }
}

/// Each message reaches each agent at once, never, or in some later tick also.
void SiteHistory::deliver_some(Tick tick) {
  for (std::size_t i = in_flight_.size(); i > 1; --i)
    std::swap(in_flight_[i - 1], in_flight_[below(i)]);
  std::vector<Message> late;
  for (Message& message : in_flight_) {
    for (Agent& agent : agents_) {
      const bool cut = side_of(message.sender, tick) != side_of(agent.author.agent, tick);
      if (!cut && one_in(3)) deliver(message, agent);
    }
    if (one_in(8)) late.push_back(std::move(message));
  }
  in_flight_ = std::move(late);
}

// ---- what is checked ----

/// How often the agent counts each sample. Returns the time that it counts.
double SiteHistory::count(const Agent& agent, std::vector<double>& sums) const {
  double elapsed_s = 0;
  sums.assign(kModes, 0);
  for (const auto& [name, held] : agent.rows) {
    const bool counts = held.site == agent.table.own_site() ||
                        (flaw_ == SiteFlaw::kOwnRowsOfOtherSites && name.author == agent.author);
    if (!counts) continue;
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += held.sums[k];
    elapsed_s += static_cast<double>(held.steps);
  }
  SiteTable table = agent.table;
  if (flaw_ == SiteFlaw::kOwnSiteByRowToo) table.set_own_site(-1);
  return elapsed_s + table.add_coverage(sums.data());
}

std::string SiteHistory::check(const Agent& agent) const {
  const std::string who = "agent " + std::to_string(agent.author.agent);
  std::vector<double> sums;
  const double elapsed_s = count(agent, sums);
  const auto twice = std::ranges::find_if(sums, [](double sum) { return sum != 0 && sum != 1; });
  if (twice != sums.end())
    return who + " counts sample " + std::to_string(twice - sums.begin()) + ' ' +
           std::to_string(*twice) + " times";
  if (std::accumulate(sums.begin(), sums.end(), 0.0) != elapsed_s)
    return who + " counts other time";
  return "";
}

void SiteHistory::come_to_rest() {
  for (Agent& agent : agents_) learn(agent);
  for (int round = 0; round < 3; ++round) {
    send_all(kTicks + round);
    for (std::size_t i = in_flight_.size(); i > 1; --i)
      std::swap(in_flight_[i - 1], in_flight_[below(i)]);
    for (const Message& message : in_flight_) {
      for (Agent& agent : agents_) deliver(message, agent);
    }
    in_flight_.clear();
  }
}

/// All that any agent holds of a site to which it belongs, or of itself, counts once at each agent.
std::string SiteHistory::check_at_rest() const {
  Rows best;
  for (const Agent& agent : agents_) {
    for (const auto& [name, held] : agent.rows) {
      const auto [mine, is_new] = best.try_emplace(name, held);
      if (!is_new && mine->second.steps < held.steps) mine->second = held;
    }
  }
  std::vector<double> sums(kModes);
  for (const auto& [name, held] : best) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += held.sums[k];
  }
  std::vector<double> counted;
  for (const Agent& agent : agents_) {
    count(agent, counted);
    if (counted != sums)
      return "at rest agent " + std::to_string(agent.author.agent) + " lacks coverage, or has more";
  }
  return "";
}

std::string SiteHistory::run() {
  for (Tick tick = 0; tick < kTicks; ++tick) {
    if (one_in(3)) change_roster();
    for (Agent& agent : agents_) {
      if (side_of(agent.author.agent, tick) == 0 && one_in(2)) learn(agent);
    }
    for (Agent& agent : agents_) sample(agent, tick);
    send_all(tick);
    deliver_some(tick);
    for (const Agent& agent : agents_) {
      if (const std::string wrong = check(agent); !wrong.empty())
        return "tick " + std::to_string(tick) + ": " + wrong;
    }
  }
  come_to_rest();
  return check_at_rest();
}

}  // namespace ergocast::test
