#include "lab/invariants.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "core/noise.h"
#include "core/perturbation.h"
#include "sim/world.h"

namespace ergocast::lab {
namespace {

constexpr Tick kTicksBetweenAverages = 10;
/// Two digests, 1 s apart, the first up to 1 s after the admission; the answer waits up to 0.25 s.
constexpr double kDigests_s = 2.25;
/// Whoever learns a row late passes it on late: one more round.
constexpr int kRounds = 2;

/// How far a sum of so many terms ≤ dt may be from the exact one, relative.
double rounding(std::int64_t steps) { return 1e-12 + static_cast<double>(steps) * 0x1p-53; }

std::string name_of(const Author& author) {
  return "agent " + std::to_string(author.agent) + " (" + to_hex(author.incarnation) + ")";
}

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  out.precision(17);
  (out << ... << parts);
  return out.str();
}

std::int64_t steps_of(const CoverageTable& table, const Author& author) {
  return table.steps_held(author).value_or(0);
}

const RosterEntry* entry_of(const std::vector<RosterEntry>& roster, const Author& author) {
  const auto at = std::find_if(roster.begin(), roster.end(),
                               [&](const RosterEntry& entry) { return entry.author == author; });
  return at == roster.end() ? nullptr : &*at;
}

/// Its own row an agent counts whatever others have heard of it.
bool is_forgotten(const RosterEntry& entry, const Holder& by) {
  return entry.author != by.self && entry.forgotten_at(by.answered, by.roster_revision);
}

}  // namespace

std::string to_string(const Violation& v) {
  char t_text[32];
  std::snprintf(t_text, sizeof t_text, "%.4f", v.t_s);
  return std::string(name_of(v.invariant)) + ": " + v.who + " at t = " + t_text + " s: " + v.numbers;
}

double recovery_bound_s(const Mission& mission, const Faults& faults) {
  // A restarted coordinator asks (0.25 s), an agent answers (0.05 s, but 0.5 s after its last
  // answer), other opinions are awaited (0.2 s).
  constexpr double kTakeover_s = 1;
  // It takes all members for living; then a predecessor must be silent for 3 s, its successor says
  // hello (0.25 s) and hears MISSION (0.1 s). A restarted world needs as long: it waits 1.5 s and
  // 0.55 s for the mission and 2 s for commands.
  constexpr double kAdmission_s = 4.05;
  // Who was forgotten, it may be a moment before, is remembered with as much notice in real time.
  const double notices_s = mission.forget_silent_after_s > 0 ? 4 : 0;
  const Timing& timing = mission.timing;
  const double period_s = std::max<double>(timing.broadcast_period_ticks,
                                           timing.broadcast_error_budget > 0
                                               ? timing.broadcast_heartbeat_ticks
                                               : 0) *
                          timing.dt_s / timing.realtime_factor;
  return (kTakeover_s + kAdmission_s + kRounds * kDigests_s + notices_s + 2 * period_s) /
         (1 - faults.clock_rate_error);
}

Invariants::Invariants(const Mission& mission)
    : mission_(mission),
      weights_(sobolev_weights(mission.basis, mission.domain)),
      block_count_((mission.basis.mode_count() + kBlockSize - 1) / kBlockSize) {}

void Invariants::violate(double t_s, Invariant invariant, const std::string& who,
                         std::string numbers) {
  if (!violation_) violation_ = {invariant, who, t_s, std::move(numbers)};
}

void Invariants::born(const Author& author) {
  authors_.push_back(author);
  std::sort(authors_.begin(), authors_.end());
  ++lives_[author.agent];
}

// ---- safety: what is said ------------------------------------------------------------------------

void Invariants::sent(double t_s, const Outgoing& outgoing, const Holder* speaker) {
  if (const auto* world = std::get_if<WorldState>(&outgoing.message)) return check(t_s, *world);
  if (const auto* command = std::get_if<Command>(&outgoing.message)) return check(t_s, *command);
  if (const auto* block = std::get_if<Contribution>(&outgoing.message)) {
    return check(t_s, *block, outgoing.relayer, speaker);
  }
  const auto* digest = std::get_if<Digest>(&outgoing.message);
  if (digest != nullptr && speaker != nullptr) check(t_s, *digest, *speaker);
}

void Invariants::check(double t_s, const WorldState& world) {
  if (mission_.radio_range_m > 0 && world.header.tick >= last_tick_) note_positions(t_s, world);
  last_tick_ = std::max(last_tick_, world.header.tick);
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    if (mission_.domain.contains(vehicle.position_m.head<2>())) continue;
    violate(t_s, Invariant::kPositionsInTheDomain, "vehicle " + std::to_string(vehicle.id),
            text("x = (", vehicle.position_m.x(), ", ", vehicle.position_m.y(), ") m"));
  }
}

void Invariants::note_positions(double t_s, const WorldState& world) {
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    positions_m_[vehicle.id] = vehicle.position_m.head<2>();
  }
  for (auto a = positions_m_.begin(); a != positions_m_.end(); ++a) {
    for (auto b = std::next(a); b != positions_m_.end(); ++b) {
      if ((a->second - b->second).norm() <= mission_.radio_range_m) continue;
      last_apart_t_s_[{a->first, b->first}] = t_s;
    }
  }
}

void Invariants::check(double t_s, const Command& command) {
  if (command.header.tick < 0) return;
  const ControlLaw& law = mission_.law;
  const Eigen::Vector2d contraction_mps =
      law.contraction_gain_per_s *
      (command.position_m.head<2>() - law.contraction_center_m);
  const double root_dt = std::sqrt(mission_.timing.dt_s);
  const Eigen::Vector2d xi = normal_pair(mission_.seed, Purpose::kPerturbation,
                                         static_cast<std::uint32_t>(command.header.sender),
                                         static_cast<std::uint64_t>(command.header.tick));
  const Eigen::Vector2d noise_mps = law.noise_intensity / root_dt * xi;
  // What an adaptive law may add to that, in a direction that only the agent knows.
  double push_mps = 0;
  if (law.perturbation == Perturbation::kAdaptive) {
    const double dt_s = mission_.timing.dt_s;
    push_mps = greatest_push_mps(law, dt_s) *
               normal_pair(mission_.seed, Purpose::kPush,
                           static_cast<std::uint32_t>(command.header.sender),
                           static_cast<std::uint64_t>(command.header.tick / push_ticks(law, dt_s)))
                   .norm();
  }
  const Eigen::Vector2d v_mps = command.velocity_mps.head<2>();
  const double u_mps = (v_mps + contraction_mps - noise_mps).norm();
  // Each of the three was rounded when v was put together.
  const double margin_mps =
      8 * 0x1p-53 * (v_mps.norm() + contraction_mps.norm() + noise_mps.norm());
  if (u_mps <= (law.u_max_mps + push_mps) * (1 + 1e-12) + margin_mps) return;
  violate(t_s, Invariant::kInputsBounded, "agent " + std::to_string(command.header.sender),
          text("|u| = ", u_mps, " m/s > ", law.u_max_mps, " m/s at tick ", command.header.tick));
}

void Invariants::check(double t_s, const Contribution& block, AgentId relayer,
                       const Holder* speaker) {
  const double covered_s = static_cast<double>(block.steps) * mission_.timing.dt_s;
  const double most_s = covered_s * (1 + 1e-9 + rounding(block.steps));
  double largest_s = 0;
  for (const double sum_s : block.sums) largest_s = std::max(largest_s, std::abs(sum_s));
  const bool zeroth_is_off =
      block.block == 0 && std::abs(block.sums[0] - covered_s) > covered_s * rounding(block.steps);
  if (!(largest_s <= most_s) || zeroth_is_off) {
    violate(t_s, Invariant::kSumsBounded, name_of(block.author()),
            text("largest |S| = ", largest_s, " s, S_00 = ", block.sums[0], " s, steps dt = ",
                 covered_s, " s, block ", block.block));
  }
  if (relayer == kUnassigned || speaker == nullptr) return;
  ++relayed_;
  if (--relays_allowed_[speaker->self] >= 0) return;
  violate(t_s, Invariant::kRelaysAnswerDigests, name_of(speaker->self),
          text("has relayed more blocks than the digests it heard could ask for; the last one of ",
               name_of(block.author())));
}

void Invariants::check(double t_s, const Digest& digest, const Holder& speaker) {
  for (int i = 0; i < digest.entry_count; ++i) {
    const DigestEntry& entry = digest.entries[static_cast<std::size_t>(i)];
    const std::int64_t held = steps_of(*speaker.table, entry.author);
    if (entry.steps == held) continue;
    violate(t_s, Invariant::kDigestsSayWhatIsHeld, name_of(speaker.self),
            text("says ", entry.steps, " steps of ", name_of(entry.author), ", holds ", held));
  }
}

void Invariants::heard(const Author& listener, const Digest& digest) {
  relays_allowed_[listener] += static_cast<std::int64_t>(digest.entry_count) * block_count_;
}

void Invariants::decoded(double t_s, const std::variant<Message, Refusal>& result, bool damaged) {
  const auto* refusal = std::get_if<Refusal>(&result);
  if (!damaged && refusal != nullptr) {
    violate(t_s, Invariant::kWholeMessagesAccepted, "the codec", to_string(*refusal));
  }
  if (damaged && refusal == nullptr) {
    violate(t_s, Invariant::kDamagedMessagesRefused, "the codec",
            text("a message of type ", std::get<Message>(result).index()));
  }
}

// ---- safety: what is known -----------------------------------------------------------------------

void Invariants::answered(double t_s, const Holder& holder) {
  check_steps(t_s, holder);
  // Costs as much as the control step itself: now and then is enough to find what is wrong for good.
  if (holder.answered % kTicksBetweenAverages == 0) check_average(t_s, holder);
}

void Invariants::check_steps(double t_s, const Holder& holder) {
  auto& held_before = held_[holder.self];
  std::map<AgentId, std::int64_t> steps_of_id;
  for (const Author& author : authors_) {
    const std::int64_t steps = steps_of(*holder.table, author);
    std::int64_t& before = held_before[author];
    if (steps < before) {
      violate(t_s, Invariant::kHeldNeverShrinks, name_of(holder.self),
              text(before, " steps of ", name_of(author), " became ", steps));
    }
    before = steps;
    steps_of_id[author.agent] += steps;
  }
  for (const auto& [id, steps] : steps_of_id) {
    // A process that is replaced within a tick may have sampled it, too.
    const std::int64_t most = last_tick_ + 1 + lives_[id] - 1;
    if (steps <= most) continue;
    violate(t_s, Invariant::kNoStepCountsTwice, name_of(holder.self),
            text("holds ", steps, " steps of agent ", id, " in all, ", most, " are possible"));
  }
}

void Invariants::check_average(double t_s, const Holder& holder) {
  const Coefficients expected = average_of(best_of({holder}));
  const double error = (*holder.coverage - expected).cwiseAbs().maxCoeff();
  if (error > rounding(last_tick_ * static_cast<std::int64_t>(authors_.size()))) {
    violate(t_s, Invariant::kAverageOfWhatIsHeld, name_of(holder.self),
            text("differs by ", error, " at tick ", holder.answered));
  }
  // Before its own first tick, where a restarted world may stand, a newcomer covers nothing itself.
  const RosterEntry* own = entry_of(*holder.roster, holder.self);
  if (own != nullptr && holder.answered < own->active_from) return;
  const double c_00 = (*holder.coverage)(0, 0);
  if (std::abs(c_00 - 1) > rounding(last_tick_)) {
    violate(t_s, Invariant::kZerothIsOne, name_of(holder.self), text("c_00 = ", c_00));
  }
}

void Invariants::refused(double t_s, const Author& who, const RefusalCounts& counts) {
  for (std::size_t kind = 0; kind < counts.size(); ++kind) {
    if (counts[kind] == 0) continue;
    violate(t_s, Invariant::kHonestMessagesAccepted, name_of(who),
            text(counts[kind], " refused: ", to_string(static_cast<Refusal>(kind))));
  }
}

void Invariants::finished(double t_s, const Author& who, const std::string& reason,
                          bool mission_over) {
  if (mission_over) return;
  violate(t_s, Invariant::kNoEarlyEnd, name_of(who), reason);
}

void Invariants::wakeup(double t_s, const std::string& who, bool in_the_past) {
  if (in_the_past) violate(t_s, Invariant::kNoWakeupInThePast, who, "next_wakeup() <= now");
}

void Invariants::gave_up_logger(double t_s, std::optional<Tick> acknowledged, Tick tick) {
  if (!acknowledged || tick - *acknowledged > kRecordWindowTicks) return;
  violate(t_s, Invariant::kHeardLoggerIsKept, "the world",
          text("gives up at tick ", tick, " a logger whose word of tick ", *acknowledged,
               " has reached it"));
}

// ---- liveness ------------------------------------------------------------------------------------

/// The newest of each author's blocks that anybody holds. Forgotten rows do not count any more.
std::map<Author, std::vector<Invariants::Best>> Invariants::best_of(
    const std::vector<Holder>& living) const {
  std::map<Author, std::vector<Best>> best;
  for (const Holder& holder : living) {
    if (holder.table == nullptr) continue;
    for (const Author& author : authors_) {
      if (!holder.table->steps_held(author)) continue;
      const RosterEntry* entry = entry_of(*holder.roster, author);
      if (entry != nullptr && is_forgotten(*entry, holder)) continue;
      auto& blocks = best.try_emplace(author, static_cast<std::size_t>(block_count_)).first->second;
      for (int b = 0; b < block_count_; ++b) {
        const Contribution held = holder.table->block(author, b);
        Best& known = blocks[static_cast<std::size_t>(b)];
        if (held.steps > known.steps) known = {held.steps, held.sums};
      }
    }
  }
  return best;
}

/// (4) from the blocks alone, weighted by the time each covers.
Coefficients Invariants::average_of(const std::map<Author, std::vector<Best>>& rows) const {
  Coefficients c = Coefficients::Zero(mission_.basis.modes_x, mission_.basis.modes_y);
  for (int k = 0; k < mission_.basis.mode_count(); ++k) {
    double sum_s = 0;
    std::int64_t steps = 0;
    for (const auto& [author, blocks] : rows) {
      const Best& block = blocks[static_cast<std::size_t>(k / kBlockSize)];
      sum_s += block.sums[static_cast<std::size_t>(k % kBlockSize)];
      steps += block.steps;
    }
    if (steps > 0) c.data()[k] = sum_s / (static_cast<double>(steps) * mission_.timing.dt_s);
  }
  return c;
}

void Invariants::recovered(double t_s, const std::vector<Holder>& living) {
  for (const Holder& holder : living) {
    if (holder.table != nullptr && holder.answered >= 0) continue;
    return violate(t_s, Invariant::kEverybodyIsBack, name_of(holder.self),
                   holder.table == nullptr ? "is not admitted" : "has seen no tick");
  }
  for (const Holder& holder : living) check_counted(t_s, holder, living);
  const auto best = best_of(living);
  const Coefficients c_true = average_of(best);
  compare_views(living);
  for (const Holder& holder : living) {
    if (mission_.radio_range_m <= 0) check_rows(t_s, holder, best);
    check_view(t_s, holder, best, c_true);
  }
  if (mission_.radio_range_m > 0) check_neighbours(t_s, living);
  check_quiet(t_s);
}

void Invariants::coordinated(double t_s, const Coordinator& coordinator, Instant now,
                             const std::vector<Holder>& living) {
  for (const Holder& holder : living) {
    const RosterEntry* entry = entry_of(coordinator.roster(), holder.self);
    const char* taken_for = entry == nullptr ? "nobody" : to_string(coordinator.presence(*entry, now));
    if (entry != nullptr && coordinator.presence(*entry, now) == Presence::kAlive) continue;
    violate(t_s, Invariant::kTheLivingAreKnown, "the coordinator",
            text("takes ", name_of(holder.self), " for ", taken_for));
  }
}

void Invariants::check_counted(double t_s, const Holder& holder, const std::vector<Holder>& living) {
  for (const Holder& other : living) {
    const RosterEntry* entry = entry_of(*holder.roster, other.self);
    if (entry == nullptr || !is_forgotten(*entry, holder)) continue;
    violate(t_s, Invariant::kTheLivingCount, name_of(holder.self),
            text("leaves out what ", name_of(other.self), " covers at tick ", holder.answered));
  }
}

void Invariants::compare_views(const std::vector<Holder>& living) {
  const Coefficients c_true = average_of(best_of(living));
  largest_view_error_ = 0;
  for (const Holder& holder : living) {
    if (holder.coverage == nullptr || holder.answered < 0) continue;
    const Coefficients difference = *holder.coverage - c_true;
    largest_view_error_ = std::max(
        largest_view_error_, std::sqrt((weights_.array() * difference.array().square()).sum()));
  }
}

void Invariants::check_view(double t_s, const Holder& holder,
                            const std::map<Author, std::vector<Best>>& best,
                            const Coefficients& c_true) {
  double stale_s = 0, covered_s = 0;
  for (const auto& [author, blocks] : best) {
    covered_s += static_cast<double>(blocks.front().steps) * mission_.timing.dt_s;
    const RosterEntry* entry = entry_of(*holder.roster, author);
    if (mission_.radio_range_m > 0) {
      const std::int64_t lacks = blocks.front().steps - steps_of(*holder.table, author);
      stale_s += static_cast<double>(std::max<std::int64_t>(lacks, 0)) * mission_.timing.dt_s;
      continue;
    }
    if (entry == nullptr || entry->active_until >= 0) continue;
    // Two periods until a digest complains, two ticks on the way.
    const Tick period = holder.table->announced_period(author);
    stale_s += static_cast<double>(2 * period + 2) * mission_.timing.dt_s;
  }
  // Of what it holds now: an agent whose ticks do not come computes no c_k.
  Coefficients c = Coefficients::Zero(mission_.basis.modes_x, mission_.basis.modes_y);
  holder.table->average(c);
  const double error = (c - c_true).cwiseAbs().maxCoeff();
  if (covered_s <= stale_s || error <= 2 * stale_s / (covered_s - stale_s)) return;
  violate(t_s, Invariant::kViewsAgree, name_of(holder.self),
          text("|c - c_true| = ", error, " > ", 2 * stale_s / (covered_s - stale_s), " with ", stale_s,
               " s of ", covered_s, " s unknown"));
}

void Invariants::check_rows(double t_s, const Holder& holder,
                            const std::map<Author, std::vector<Best>>& best) {
  for (const auto& [author, blocks] : best) {
    const auto newest = std::min_element(blocks.begin(), blocks.end(), [](const Best& a, const Best& b) {
                          return a.steps < b.steps;
                        })->steps;
    const RosterEntry* entry = entry_of(*holder.roster, author);
    // Whoever a coordinator admitted that died before it told anybody else is nobody to the team.
    if (entry == nullptr) continue;
    const bool speaks = entry->active_until < 0;
    const Tick period = holder.table->announced_period(author);
    const std::int64_t tolerated = speaks ? 2 * period + 2 : 0;
    const std::int64_t held = steps_of(*holder.table, author);
    if ((held > 0 || newest == 0) && held + tolerated >= newest) continue;
    violate(t_s, Invariant::kEverybodyLearnsEveryRow, name_of(holder.self),
            text("holds ", held, " of ", newest, " steps of ", name_of(author),
                 speaks ? ", a member" : ", who has left"));
  }
}

/// What an agent held is known to others after a round of digests for each hop between them.
void Invariants::check_neighbours(double t_s, const std::vector<Holder>& living) {
  Memory& present = memories_.emplace_back(Memory{t_s, {}});
  for (const Holder& holder : living) {
    for (const Author& author : authors_) present.held[holder.self][author] = steps_of(*holder.table, author);
  }
  for (int hops = 1; hops < static_cast<int>(living.size()); ++hops) {
    const double takes_s = hops * kRounds * kDigests_s;
    const auto past = std::find_if(memories_.rbegin(), memories_.rend(), [&](const Memory& memory) {
      return memory.t_s <= t_s - takes_s;
    });
    if (past == memories_.rend()) return;
    for (const Holder& holder : living) {
      for (const Author& other : within(hops, holder.self, t_s - past->t_s, t_s, living)) {
        check_learned(t_s, holder, other, past->held[other], hops);
      }
    }
  }
}

/// Whom `self` has heard for so long without a break, through at most so many others less one.
std::set<Author> Invariants::within(int hops, const Author& self, double heard_for_s, double t_s,
                                    const std::vector<Holder>& living) const {
  const auto hears = [&](const Author& a, const Author& b) {
    const auto apart = last_apart_t_s_.find(std::minmax(a.agent, b.agent));
    return apart == last_apart_t_s_.end() || t_s - apart->second > heard_for_s;
  };
  std::set<Author> reached{self};
  for (int hop = 0; hop < hops; ++hop) {
    const std::set<Author> inner = reached;
    for (const Holder& holder : living) {
      const auto heard = [&](const Author& one) { return hears(one, holder.self); };
      if (std::any_of(inner.begin(), inner.end(), heard)) reached.insert(holder.self);
    }
  }
  return reached;
}

void Invariants::check_learned(double t_s, const Holder& holder, const Author& other,
                               const std::map<Author, std::int64_t>& held_then, int hops) {
  for (const auto& [author, then] : held_then) {
    const RosterEntry* entry = entry_of(*holder.roster, author);
    if (entry == nullptr || author == holder.self) continue;
    // Nobody repeats what an author that speaks will soon say itself: a slack for each on the way.
    const Tick period = holder.table->announced_period(author);
    const std::int64_t tolerated = entry->active_until < 0 ? hops * (2 * period + 2) : 0;
    const std::int64_t held = steps_of(*holder.table, author);
    if (held + tolerated >= then) continue;
    violate(t_s, Invariant::kEverybodyLearnsEveryRow, name_of(holder.self),
            text("holds ", held, " steps of ", name_of(author), ", of whom ", name_of(other), ", ", hops,
                 " hops away, has long held ", then));
  }
}

void Invariants::check_quiet(double t_s) {
  if (recovered_ && relayed_ > 0 && mission_.radio_range_m <= 0) {
    violate(t_s, Invariant::kRelaysStop, "the team", text(relayed_, " blocks relayed"));
  }
  recovered_ = true;
  relayed_ = 0;
}

void Invariants::ended(double t_s, const std::string& still_running, const std::string& failure,
                       const RunFacts& facts, Tick excused) {
  if (!still_running.empty()) {
    violate(t_s, Invariant::kEverybodyEnds, still_running, text("at tick ", last_tick_));
  }
  if (!failure.empty()) violate(t_s, Invariant::kMissionDoesNotFail, "the coordinator", failure);
  if (last_tick_ < mission_.timing.tick_count) {
    violate(t_s, Invariant::kLastTickReached, "the world",
            text("tick ", last_tick_, " of ", mission_.timing.tick_count));
  }
  if (facts.ticks + excused < mission_.timing.tick_count) {
    violate(t_s, Invariant::kRecordIsWhole, "the logger",
            text(facts.ticks, " of ", mission_.timing.tick_count, " ticks, and only ", excused,
                 " may be missing"));
  }
  const double goal = mission_.goal_ergodic_metric;
  if (goal > 0 && !(facts.ergodic_metric_last <= goal)) {
    violate(t_s, Invariant::kGoalReached, "the team",
            text("phi^2 = ", facts.ergodic_metric_last, " > ", goal));
  }
}

}  // namespace ergocast::lab
