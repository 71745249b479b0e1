// SPDX-License-Identifier: BSD-3-Clause
// Keeps what it has sent last, because in lockstep repeats must have the same content.
#include "agent/search_exchange.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace ergocast {
namespace {

constexpr double kPeriod_s = 2;
/// At most this many messages wait for a halving. Others are lost; they are sent again.
constexpr std::size_t kMostEarly = 512;

/// Adds a tile to the last part, or to a new one.
void add(std::vector<Effort>& parts, std::size_t number, const EffortTile& content) {
  if (parts.back().tile_count == kMaxTilesPerMessage) parts.emplace_back();
  Effort& part = parts.back();
  part.tiles[static_cast<std::size_t>(part.tile_count++)] = {static_cast<std::int32_t>(number),
                                                             content};
}

bool has(const Effort& effort, std::size_t number) {
  const auto tiles = std::span(effort.tiles).first(static_cast<std::size_t>(effort.tile_count));
  return std::ranges::any_of(tiles, [&](const SentTile& tile) {
    return tile.number == static_cast<std::int32_t>(number);
  });
}

}  // namespace

SearchExchange::SearchExchange(const Mission& mission, const RosterEntry& self)
    : self_(self.author),
      efforts_(mission),
      period_ticks_(std::max<Tick>(1, std::llround(kPeriod_s / mission.timing.dt_s))) {
  efforts_.add_row(self_);
}

/// The last tick by `counted` at which `agent` sends; agents take turns within the period.
Tick SearchExchange::last_due(AgentId agent, Tick counted) const {
  const Tick turn = (counted - agent) % period_ticks_;
  return counted - (turn + period_ticks_) % period_ticks_;
}

void SearchExchange::begin(const AgentStep& step, bool covers, Participant& me, Outbox& out) {
  efforts_.set_now(step.counted);
  merge_early(me);
  if (covers) {
    efforts_.look(self_, step.counted, step.x_m);
    efforts_.report(self_, step.counted, step.reported_cell);
  }
  if (last_due(self_.agent, step.counted) <= sent_at_) return;
  send_own(step, me, out);
  relay_one_row(step.counted, me, out);
}

void SearchExchange::send_own(const AgentStep& step, Participant& me, Outbox& out) {
  const std::vector<EffortTile>& row = *efforts_.row_of(self_);
  sent_.assign(1, {});
  for (std::size_t tile = 0; tile < row.size(); ++tile) {
    if (row[tile].newest_look > sent_at_) add(sent_, tile, row[tile]);
  }
  fill(sent_.back(), row, own_turn_);
  for (std::size_t part = 0; part < sent_.size(); ++part) {
    sent_[part].header.tick = step.counted;
    sent_[part].part = static_cast<std::int32_t>(part);
    sent_[part].parts = static_cast<std::int32_t>(sent_.size());
  }
  sent_at_ = step.counted;
  repeat(me, out);
}

void SearchExchange::repeat(Participant& me, Outbox& out) const {
  for (const Effort& part : sent_) me.publish(Bus::kSwarm, part, part.header.tick, out);
}

void SearchExchange::fill(Effort& effort, const std::vector<EffortTile>& row,
                          std::size_t& turn) const {
  for (std::size_t i = 0; i < row.size() && effort.tile_count < kMaxTilesPerMessage; ++i) {
    const std::size_t tile = turn++ % row.size();
    if (row[tile].newest_look < 0 || has(effort, tile)) continue;
    effort.tiles[static_cast<std::size_t>(effort.tile_count++)] = {static_cast<std::int32_t>(tile),
                                                                   row[tile]};
  }
}

/// One message of each row in turn: all its tiles, then those of the next row.
void SearchExchange::relay_one_row(Tick counted, Participant& me, Outbox& out) {
  if (efforts_.row_count() < 2) return;
  row_turn_ %= efforts_.row_count();
  if (efforts_.author(row_turn_) == self_) row_turn_ = (row_turn_ + 1) % efforts_.row_count();
  const Author author = efforts_.author(row_turn_);
  const std::vector<EffortTile>& row = *efforts_.row_of(author);
  Effort effort;
  effort.header = {0, author.agent, author.incarnation, 0, counted};
  fill(effort, row, tile_turn_);
  if (tile_turn_ >= row.size()) {
    tile_turn_ = 0;
    ++row_turn_;
  }
  // The author may be ahead of us.
  for (const SentTile& tile : effort.tiles)
    effort.header.tick = std::max(effort.header.tick, tile.content.newest_look);
  if (effort.tile_count > 0) me.relay(Bus::kSwarm, effort, out);
}

void SearchExchange::note_received(const Effort& theirs) {
  Arrived& arrived = arrived_[theirs.author()];
  if (theirs.header.tick < arrived.tick) return;
  // A forged message may have named another number of parts: the newest one decides.
  if (theirs.header.tick > arrived.tick || theirs.parts != arrived.parts)
    arrived = {theirs.header.tick, theirs.parts, (std::uint32_t{1} << theirs.parts) - 1};
  arrived.missing &= ~(std::uint32_t{1} << theirs.part);
}

std::optional<Refusal> SearchExchange::receive(const Effort& theirs, Tick newest, bool by_author) {
  if (theirs.author() == self_ || theirs.header.tick > newest) return Refusal::kRange;
  if (!efforts_.is_early(theirs.header.tick)) return merge(theirs, by_author);
  if (early_.size() < kMostEarly) early_.push_back({theirs, by_author});
  return std::nullopt;
}

void SearchExchange::merge_early(Participant& me) {
  std::erase_if(early_, [&](const Early& one) {
    if (efforts_.is_early(one.tiles.header.tick)) return false;
    if (const auto refusal = merge(one.tiles, one.by_author)) me.count_refused(*refusal);
    return true;
  });
}

std::optional<Refusal> SearchExchange::merge(const Effort& theirs, bool by_author) {
  const auto tiles = std::span(theirs.tiles).first(static_cast<std::size_t>(theirs.tile_count));
  for (const SentTile& tile : tiles) {
    const auto number = static_cast<std::size_t>(tile.number);
    if (number >= efforts_.cells().tile_count() ||
        !efforts_.merge(theirs.author(), number, tile.content, theirs.header.tick))
      return Refusal::kRange;
  }
  if (by_author) note_received(theirs);
  return std::nullopt;
}

AgentId SearchExchange::awaited(const AgentStep& step, const RadioRange& radio,
                                const Participant& me) const {
  for (const RosterEntry& entry : me.follower().roster()) {
    if (entry.author == self_ || !entry.active_at(step.tick)) continue;
    if (!radio.receives(self_.agent, entry.author.agent)) continue;
    const Tick due = last_due(entry.author.agent, step.counted);
    if (due < std::max<Tick>(0, me.counted(entry.active_from))) continue;
    const Arrived* const arrived = arrived_.find(entry.author);
    // An author is never ahead in lockstep, so a later tick is forged, and nothing waits for it.
    if (arrived == nullptr || arrived->tick < due ||
        (arrived->tick == due && arrived->missing != 0))
      return entry.author.agent;
  }
  return kUnassigned;
}

}  // namespace ergocast
