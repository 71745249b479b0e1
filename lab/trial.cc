#include "lab/trial.h"

#include <algorithm>
#include <cmath>

#include "core/noise.h"
#include "lab/clock.h"
#include "lab/dice.h"
#include "lcmtypes/codec.h"

namespace ergocast::lab {
namespace {

/// More events than this in a virtual second are a storm of messages.
constexpr std::int64_t kMostMessagesPer_s = 100000;
/// How often the team's views are compared after healing.
constexpr auto kCheckPeriod = std::chrono::seconds(1);
/// After the last tick: how long the slowest process may take to end.
constexpr double kFarewell_s = 10;
/// A stream of dice beside lab/faults.cc's.
constexpr std::uint32_t kClocks = 16;

double in_seconds(Instant at) { return std::chrono::duration<double>(at.time_since_epoch()).count(); }

/// The mission of a trial, decoded once; a plan with other bytes is another mission.
PlanDecoder decoder_of(const Mission& mission, const TrialOptions& options) {
  return [mission, &options](std::span<const std::byte> plan) {
    return std::ranges::equal(plan, options.plan) ? std::optional(mission) : options.decode_plan(plan);
  };
}

Mission mission_of(const TrialOptions& options, std::uint64_t seed) {
  Mission mission = options.decode_plan(options.plan).value();
  mission.seed = seed;
  return mission;
}

class Trial {
 public:
  Trial(const TrialOptions& options, std::uint64_t seed, std::ostream& trajectory,
        std::ostream& metrics);
  TrialResult run();

 private:
  struct Process {
    SkewedClock clock;
    Instant wakeup{};
    Instant restart = Instant::max();  // when it is started again, while it is down
    std::uint32_t life = 0;
    bool up = false, heard = false;
  };
  struct Ending {
    Instant at;
    Incident incident;
  };
  struct Recovery {
    Instant since;
    std::vector<std::pair<Author, std::int64_t>> lacks;
  };

  Seat coordinator_seat() const { return agents_count_; }
  Seat world_seat() const { return agents_count_ + 1; }
  Seat recorder_seat() const { return agents_count_ + 2; }
  Process& at(Seat seat) { return processes_[static_cast<std::size_t>(seat)]; }
  Agent& agent(Seat seat) { return *agents_[static_cast<std::size_t>(seat)]; }
  template <class F>
  auto with(Seat seat, F f);
  std::string name_of(Seat seat) const;
  Incarnation incarnation_of(Seat seat) const;

  void set_clocks();
  void start(Seat seat);
  Instant next_time();
  void pass_to(Instant now);
  double progress_s() const;

  // The driver of the faults.
  void begin_incidents();
  void end_incidents();
  void begin(const Incident& incident);
  void cut(const Incident& incident, bool join);
  bool may_crash(Seat seat);
  bool crash(Seat seat, double lasts_s);
  void restart_due();
  void heal();
  bool anybody_else_knows_the_mission(Seat seat);

  void deliver_due();
  void hear(Seat seat, const Delivery& delivery);
  void advance_due();
  void advance(Seat seat);
  void publish(Seat seat);
  void after_agent(Seat seat);
  void look_for_recovery(Seat seat);

  Holder holder_of(Seat seat);
  std::vector<Holder> living();
  void note_answer(Seat seat, const Message& message, const Holder& holder);
  void supervise_coordinator();
  std::string still_running();
  bool timed_out() const;
  bool failed() const;
  bool mission_over() const;
  bool everybody_finished();
  void check_recovered();
  TrialResult result();

  const TrialOptions& options_;
  std::uint64_t seed_;
  Mission mission_;
  PlanDecoder decode_plan_;
  RunId run_;
  int agents_count_, seats_;
  Network network_;
  Invariants invariants_;
  Seats hears_bus_[kBusCount];

  std::vector<Process> processes_;
  std::vector<std::unique_ptr<Agent>> agents_;
  std::unique_ptr<Coordinator> coordinator_;
  std::unique_ptr<World> world_;
  Recorder recorder_;

  Instant now_{};
  std::vector<Incident> incidents_;
  std::size_t next_incident_ = 0;
  std::vector<Ending> endings_;
  double planned_s_, faulty_s_;  // virtual time of the mission, and of its faults
  std::optional<Instant> healed_, failed_since_;
  bool end_said_ = false;  // by a coordinator
  Instant next_check_ = Instant::max(), deadline_ = Instant::max();

  Outbox outbox_;
  std::vector<std::byte> bytes_, damaged_;
  std::vector<Tick> answered_;  // by agent
  std::vector<std::optional<Recovery>> recoveries_;
  double recovery_sum_s_ = 0;
  TrialFigures figures_;
};

Trial::Trial(const TrialOptions& options, std::uint64_t seed, std::ostream& trajectory,
             std::ostream& metrics)
    : options_(options),
      seed_(seed),
      mission_(mission_of(options, seed)),
      decode_plan_(decoder_of(mission_, options)),
      run_(random_words(seed, Purpose::kIncarnation, ~0U, 0).first | 1),
      agents_count_(static_cast<int>(mission_.starts_m.size())),
      seats_(agents_count_ + 3),
      network_(seed, options.faults, seats_),
      invariants_(mission_),
      processes_(static_cast<std::size_t>(seats_)),
      agents_(static_cast<std::size_t>(agents_count_)),
      recorder_(run_, 1, decode_plan_, trajectory, metrics),
      planned_s_(static_cast<double>(mission_.timing.tick_count) * mission_.timing.dt_s /
                 mission_.timing.realtime_factor),
      answered_(static_cast<std::size_t>(agents_count_), -1),
      recoveries_(static_cast<std::size_t>(agents_count_)) {
  figures_.seed = seed;
  faulty_s_ = options.faults.lasting_share * planned_s_;
  incidents_ = incidents(options.faults, seed, agents_count_, faulty_s_);
  for (const Seat seat : {world_seat(), recorder_seat()}) {
    hears_bus_[static_cast<std::size_t>(Bus::kCommand)].set(static_cast<std::size_t>(seat));
  }
  for (const Bus bus : {Bus::kSwarm, Bus::kWorld}) {
    for (Seat seat = 0; seat < seats_; ++seat) {
      if (seat != world_seat()) hears_bus_[static_cast<std::size_t>(bus)].set(static_cast<std::size_t>(seat));
    }
  }
  set_clocks();
  for (Seat seat = 0; seat < seats_; ++seat) start(seat);
}

template <class F>
auto Trial::with(Seat seat, F f) {
  if (seat < agents_count_) return f(agent(seat));
  if (seat == coordinator_seat()) return f(*coordinator_);
  if (seat == world_seat()) return f(*world_);
  return f(recorder_);
}

std::string Trial::name_of(Seat seat) const {
  if (seat < agents_count_) return "agent " + std::to_string(seat);
  return seat == coordinator_seat() ? "the coordinator" : seat == world_seat() ? "the world" : "the logger";
}

Incarnation Trial::incarnation_of(Seat seat) const {
  const std::uint32_t life = processes_[static_cast<std::size_t>(seat)].life;
  return random_words(seed_, Purpose::kIncarnation, static_cast<std::uint32_t>(seat), life).first | 1;
}

void Trial::set_clocks() {
  const Faults& faults = options_.faults;
  if (faults.clock_rate_error <= 0 && faults.clock_offset_max_s <= 0) return;
  Dice dice(seed_, kClocks);
  for (Process& process : processes_) {
    const double rate = 1 + faults.clock_rate_error * (2 * dice.uniform() - 1);
    process.clock = SkewedClock(rate, seconds(faults.clock_offset_max_s * dice.uniform()));
    ++figures_.skewed_clocks;
  }
}

void Trial::start(Seat seat) {
  Process& process = at(seat);
  const Incarnation incarnation = incarnation_of(seat);
  if (seat < agents_count_) {
    agents_[static_cast<std::size_t>(seat)] = std::make_unique<Agent>(
        AgentIdentity{run_, seat, incarnation, "laboratory", options_.version}, decode_plan_);
    answered_[static_cast<std::size_t>(seat)] = -1;
    invariants_.born({seat, incarnation});
  } else if (seat == coordinator_seat()) {
    const bool first = process.life == 0;
    coordinator_ = std::make_unique<Coordinator>(
        run_, incarnation, decode_plan_, first ? options_.plan : std::vector<std::byte>(),
        first ? Takeover::kNever : Takeover::kMust);
  } else if (seat == world_seat()) {
    world_ = std::make_unique<World>(run_, incarnation, decode_plan_);
  }
  process.up = true;
  process.restart = Instant::max();
  process.wakeup = now_;
  ++process.life;
}

// ---- time ----------------------------------------------------------------------------------------

/// What the schedule of the faults goes by. A lockstep mission flies in no time where nobody is
/// late, so there it is mission time; but a mission that stands still is to be healed as well.
double Trial::progress_s() const {
  const double virtual_s = in_seconds(now_);
  if (mission_.timing.pace == Pace::kRealtime) return virtual_s;
  return std::max(virtual_s,
                  static_cast<double>(invariants_.last_tick()) * mission_.timing.dt_s /
                      mission_.timing.realtime_factor);
}

Instant Trial::next_time() {
  Instant next = std::min(network_.next(), next_check_);
  for (const Process& process : processes_) {
    next = std::min(next, process.up ? process.wakeup : process.restart);
  }
  for (const Ending& ending : endings_) next = std::min(next, ending.at);
  if (healed_) return std::min(next, deadline_);
  if (next_incident_ < incidents_.size()) {
    next = std::min(next, Instant(seconds(incidents_[next_incident_].at_s)));
  }
  return std::min(next, Instant(seconds(faulty_s_)));
}

TrialResult Trial::run() {
  while (!everybody_finished() && !invariants_.violation()) {
    now_ = std::max(now_, next_time());
    if (now_ >= deadline_) break;
    if (static_cast<double>(figures_.messages) > kMostMessagesPer_s * (progress_s() + 1)) break;
    if (!healed_) {
      end_incidents();
      begin_incidents();
      if (progress_s() >= faulty_s_) heal();
    }
    restart_due();
    deliver_due();
    advance_due();
    supervise_coordinator();
    if (failed() && !failed_since_) failed_since_ = now_;
    check_recovered();
  }
  return result();
}

// ---- faults --------------------------------------------------------------------------------------

void Trial::begin_incidents() {
  const double progress = progress_s();
  while (next_incident_ < incidents_.size() && incidents_[next_incident_].at_s <= progress + 1e-9) {
    begin(incidents_[next_incident_++]);
  }
}

void Trial::begin(const Incident& incident) {
  using enum Incident::Kind;
  switch (incident.kind) {
    case kSplit:
    case kOneWayCut:
      ++(incident.kind == kSplit ? figures_.splits : figures_.one_way_cuts);
      cut(incident, false);
      endings_.push_back({now_ + seconds(incident.lasts_s), incident});
      return;
    case kAgentCrash:
      figures_.agent_crashes += crash(static_cast<Seat>(incident.who), incident.lasts_s);
      return;
    case kCoordinatorCrash:
      figures_.coordinator_crashes += crash(coordinator_seat(), incident.lasts_s);
      return;
    case kWorldCrash: figures_.world_crashes += crash(world_seat(), incident.lasts_s); return;
  }
}

void Trial::cut(const Incident& incident, bool join) {
  const auto first = [&](Seat seat) { return (incident.who >> (seat % 64) & 1) != 0; };
  for (Seat from = 0; from < seats_; ++from) {
    for (Seat to = 0; to < seats_; ++to) {
      const bool deaf = incident.kind == Incident::Kind::kSplit ? first(from) != first(to)
                                                                : first(from) && !first(to);
      if (!deaf) continue;
      join ? network_.join(from, to) : network_.cut(from, to);
    }
  }
}

void Trial::end_incidents() {
  std::erase_if(endings_, [this](const Ending& ending) {
    if (ending.at > now_) return false;
    cut(ending.incident, true);
    return true;
  });
}

bool Trial::anybody_else_knows_the_mission(Seat but) {
  for (Seat seat = 0; seat < agents_count_; ++seat) {
    if (seat != but && at(seat).up && agent(seat).follower().mission()) return true;
  }
  return false;
}

/// What nobody remembers, nobody can bring back: a vehicle's position is known to the world and,
/// by its last commands, to its agent; the mission to the coordinator and the agents that follow it.
/// So these are not taken down together.
bool Trial::may_crash(Seat seat) {
  if (!at(seat).up || at(seat).life >= kMaxIncarnationsPerAgent - 2) return false;
  if (mission_over()) return false;
  const bool world_knows = at(world_seat()).up && world_->begun_at();
  if (seat < agents_count_) {
    const bool coordinator_knows = at(coordinator_seat()).up && coordinator_->mission() != nullptr;
    if (!coordinator_knows && !anybody_else_knows_the_mission(seat)) return false;
    return world_knows || invariants_.last_tick() < 0;
  }
  if (seat == coordinator_seat()) return anybody_else_knows_the_mission(kMaxSeats);
  return world_knows && std::none_of(answered_.begin(), answered_.end(),
                                     [](Tick tick) { return tick < 0; });
}

bool Trial::crash(Seat seat, double lasts_s) {
  if (!may_crash(seat)) return false;
  at(seat).up = false;
  at(seat).restart = now_ + seconds(lasts_s);
  if (seat < agents_count_) {
    answered_[static_cast<std::size_t>(seat)] = -1;
    recoveries_[static_cast<std::size_t>(seat)].reset();
  }
  return true;
}

void Trial::restart_due() {
  for (Seat seat = 0; seat < seats_; ++seat) {
    if (at(seat).up || at(seat).restart > now_) continue;
    start(seat);
    if (seat >= agents_count_) continue;
    Recovery recovery{now_, {}};
    const auto team = living();
    for (const Author& author : invariants_.authors()) {
      if (author.agent != seat) continue;
      std::int64_t most = 0;
      for (const Holder& holder : team) {
        if (holder.table != nullptr) most = std::max(most, holder.table->steps_held(author).value_or(0));
      }
      if (most > 0) recovery.lacks.emplace_back(author, most);
    }
    recoveries_[static_cast<std::size_t>(seat)] = std::move(recovery);
  }
}

void Trial::heal() {
  healed_ = now_;
  endings_.clear();
  network_.heal(now_);
  for (Process& process : processes_) {
    if (!process.up) process.restart = now_;
  }
  const double bound_s = recovery_bound_s(mission_, options_.faults);
  next_check_ = now_ + seconds(bound_s);
  deadline_ = next_check_ +
              seconds((planned_s_ + kFarewell_s) / (1 - options_.faults.clock_rate_error));
}

// ---- messages ------------------------------------------------------------------------------------

void Trial::deliver_due() {
  while (network_.next() <= now_) {
    const Delivery delivery = network_.pop();
    for (Seat seat = 0; seat < seats_; ++seat) {
      if (delivery.to.test(static_cast<std::size_t>(seat)) && at(seat).up) hear(seat, delivery);
    }
  }
}

void Trial::hear(Seat seat, const Delivery& delivery) {
  Process& process = at(seat);
  const Instant local = process.clock.local(now_);
  const Message& message = *delivery.message;
  process.heard = true;
  if (seat >= agents_count_) {
    if (seat == coordinator_seat()) return coordinator_->receive(message, local);
    return seat == world_seat() ? world_->receive(message, local) : recorder_.receive(message, local);
  }
  if (const auto* digest = std::get_if<Digest>(&message)) invariants_.heard(agent(seat).author(), *digest);
  agent(seat).receive(message, local, delivery.transmitter);
}

void Trial::advance_due() {
  for (Seat seat = 0; seat < seats_; ++seat) {
    if (at(seat).up && (at(seat).heard || at(seat).wakeup <= now_)) advance(seat);
  }
}

void Trial::advance(Seat seat) {
  Process& process = at(seat);
  const Instant local = process.clock.local(now_);
  process.heard = false;
  with(seat, [&](auto& core) { core.advance(local, outbox_); });
  publish(seat);
  const Instant next = with(seat, [](auto& core) { return core.finished() ? Instant::max() : core.next_wakeup(); });
  invariants_.wakeup(in_seconds(now_), name_of(seat), next <= local);
  process.wakeup = process.clock.when(next);
  if (seat < agents_count_) after_agent(seat);
}

void Trial::publish(Seat seat) {
  const bool is_agent = seat < agents_count_;
  const Holder speaker = is_agent ? holder_of(seat) : Holder();
  for (const Outgoing& outgoing : outbox_) {
    const double t_s = in_seconds(now_);
    invariants_.sent(t_s, outgoing, speaker.table != nullptr ? &speaker : nullptr);
    if (is_agent) note_answer(seat, outgoing.message, speaker);
    encode(outgoing.message, bytes_);
    auto decoded = decode(bytes_, run_);
    invariants_.decoded(t_s, decoded, false);
    if (std::holds_alternative<Refusal>(decoded)) continue;
    ++figures_.messages;
    if (const auto* part = std::get_if<MissionPart>(&outgoing.message)) {
      end_said_ |= part->state == MissionState::kEnded || part->state == MissionState::kFailed;
    }
    figures_.digests += std::holds_alternative<Digest>(outgoing.message);
    figures_.contributions += std::holds_alternative<Contribution>(outgoing.message);
    figures_.relayed += outgoing.relayer != kUnassigned;
    const AgentId sender = header_of(outgoing.message).sender;
    const int corrupted = network_.send(
        now_, seat, hears_bus_[static_cast<std::size_t>(outgoing.bus)], outgoing.bus,
        outgoing.relayer != kUnassigned ? outgoing.relayer : sender,
        std::make_shared<const Message>(std::get<Message>(std::move(decoded))));
    for (int i = 0; i < corrupted; ++i) {
      damaged_ = bytes_;
      damage(damaged_, seed_, static_cast<std::uint64_t>(network_.counted().corrupted - i));
      invariants_.decoded(t_s, decode(damaged_, run_), true);
    }
  }
  outbox_.clear();
}

void Trial::after_agent(Seat seat) {
  const double t_s = in_seconds(now_);
  Agent& one = agent(seat);
  invariants_.refused(t_s, one.author(), one.refused());
  look_for_recovery(seat);
  if (one.finished()) invariants_.finished(t_s, one.author(), one.reason(), mission_over());
}

/// Once for each tick that an agent answers.
void Trial::note_answer(Seat seat, const Message& message, const Holder& holder) {
  const auto* command = std::get_if<Command>(&message);
  Tick& answered = answered_[static_cast<std::size_t>(seat)];
  if (command == nullptr || command->header.tick <= answered) return;
  answered = command->header.tick;
  ++figures_.agent_steps;
  invariants_.answered(in_seconds(now_), holder);
}

void Trial::look_for_recovery(Seat seat) {
  auto& recovery = recoveries_[static_cast<std::size_t>(seat)];
  const CoverageTable* table = agent(seat).coverage();
  if (!recovery || table == nullptr) return;
  std::erase_if(recovery->lacks, [&](const auto& lack) {
    return table->steps_held(lack.first).value_or(0) >= lack.second;
  });
  if (!recovery->lacks.empty()) return;
  const double took_s = in_seconds(now_) - in_seconds(recovery->since);
  recovery_sum_s_ += took_s;
  figures_.recovery_max_s = std::max(figures_.recovery_max_s, took_s);
  ++figures_.recoveries;
  recovery.reset();
}

// ---- verdict -------------------------------------------------------------------------------------

Holder Trial::holder_of(Seat seat) {
  const Agent& one = agent(seat);
  return {one.author(), one.coverage(), &one.team_coverage(), &one.follower().roster(), one.tick()};
}

std::vector<Holder> Trial::living() {
  std::vector<Holder> living;
  for (Seat seat = 0; seat < agents_count_; ++seat) {
    if (at(seat).up) living.push_back(holder_of(seat));
  }
  return living;
}

bool Trial::mission_over() const {
  return end_said_ || invariants_.last_tick() >= mission_.timing.tick_count;
}

bool Trial::everybody_finished() {
  for (Seat seat = 0; seat < seats_; ++seat) {
    if (!at(seat).up || !with(seat, [](auto& core) { return core.finished(); })) return false;
  }
  return true;
}

/// Like an init system: who could take nothing over starts anew.
void Trial::supervise_coordinator() {
  if (!at(coordinator_seat()).up || !coordinator_->finished() || mission_over()) return;
  if (!healed_ && coordinator_->mission() == nullptr) {
    ++figures_.coordinator_crashes;
    at(coordinator_seat()).up = false;
    at(coordinator_seat()).restart = now_;
    return;
  }
  invariants_.finished(in_seconds(now_), {kCoordinator, 0}, coordinator_->reason(), false);
}

void Trial::check_recovered() {
  if (now_ < next_check_) return;
  next_check_ = now_ + kCheckPeriod;
  if (mission_over() || options_.faults.lasting_share >= 1) return;
  invariants_.recovered(in_seconds(now_), living());
}

std::string Trial::still_running() {
  std::string names;
  for (Seat seat = 0; seat < seats_; ++seat) {
    if (with(seat, [](auto& core) { return core.finished(); })) continue;
    names += (names.empty() ? "" : ", ") + name_of(seat);
  }
  return names;
}

/// Whether a lockstep mission was given up because of what we did to it.
bool Trial::timed_out() const {
  const auto patience = seconds(mission_.timing.lockstep_timeout_s + kFarewell_s);
  return failed_since_ && mission_.timing.pace == Pace::kLockstep &&
         (!healed_ || *failed_since_ < *healed_ + patience);
}

/// A coordinator that came back when all was over has no mission that could fail.
bool Trial::failed() const {
  return coordinator_->state() == MissionState::kFailed && coordinator_->mission() != nullptr;
}

TrialResult Trial::result() {
  TrialResult result;
  result.timed_out = timed_out();
  const double t_s = in_seconds(now_);
  if (!result.timed_out && !invariants_.violation()) {
    const bool healed = options_.faults.lasting_share < 1;
    healed ? invariants_.recovered(t_s, living()) : invariants_.compare_views(living());
    invariants_.ended(t_s, still_running(), failed() ? coordinator_->reason() : "", recorder_.facts());
  }
  result.violation = invariants_.violation();
  figures_.virtual_s = t_s;
  figures_.ergodic_metric = recorder_.facts().ergodic_metric_last;
  figures_.view_error = invariants_.largest_view_error();
  figures_.faults = network_.counted();
  if (figures_.recoveries > 0) {
    figures_.recovery_mean_s = recovery_sum_s_ / static_cast<double>(figures_.recoveries);
  }
  result.figures = figures_;
  return result;
}

}  // namespace

TrialResult fly_trial(const TrialOptions& options, std::uint64_t seed, std::ostream& trajectory,
                      std::ostream& metrics) {
  return Trial(options, seed, trajectory, metrics).run();
}

}  // namespace ergocast::lab
