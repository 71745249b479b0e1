// SPDX-License-Identifier: BSD-3-Clause
// What the laboratory does to a mission, and the schedule of it that a seed draws.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"

namespace ergocast::lab {

/// Probabilities are per message and link (one transmitter, one receiver, one bus) unless stated
/// otherwise. Times are virtual. By default nothing goes wrong.
struct Faults {
  double loss = 0;              ///< never arrives
  double duplication = 0;       ///< arrives twice
  double corruption = 0;        ///< arrives with bytes changed, cut off or added
  double delay_mean_s = 0;      ///< every message: exponential; the order on a link is kept
  double delay_max_s = 0;       ///< cut off there
  double reordering = 0;        ///< held back alone, so that later messages overtake it
  double reordering_max_s = 0;  ///< for up to so long, uniform
  double clogging = 0;          ///< its whole link is held back; then all messages arrive at once
  double clog_max_s = 0;        ///< for up to so long, uniform
  double replay = 0;            ///< recorded by an attacker and sent once more
  double replay_max_s = 0;      ///< up to so much later, uniform
  double partitions_per_s =
      0;  ///< the processes fall into two parts that receive nothing from each other
  double partition_max_s = 0;      ///< for up to so long, uniform
  double one_way_share = 0;        ///< share of partitions in which only one part receives nothing
  double agent_crashes_per_s = 0;  ///< of the whole team
  double coordinator_crashes_per_s = 0;
  double world_crashes_per_s = 0;
  double pauses_per_s = 0;        ///< an operator pauses the mission, …
  double pause_max_s = 0;         ///< … and resumes it after up to so long, uniform
  double targets_per_s = 0;       ///< an operator gives the team another target
  double ends_per_s = 0;          ///< an operator gives the mission another end
  double recalls_per_s = 0;       ///< an operator sends an agent home, …
  double departure_share = 0;     ///< … or, with this share of recalls, out of the mission
  double zones_per_s = 0;         ///< an operator sends the team out of a zone
  double laws_per_s = 0;          ///< an operator changes speed and noise of the law
  double cancels_per_s = 0;       ///< an operator undoes a target, an end, a law or a zone
  double downtime_max_s = 0;      ///< until a crashed process is started again, uniform
  double clock_rate_error = 0;    ///< a process's clock runs at a rate of 1 ± so much, uniform
  double clock_offset_max_s = 0;  ///< and started up to so long before, uniform
  double swarm_bus_only = 0;      ///< above 0: a vehicle and its agent share a wire, not a radio
  double sites = 0;               ///< above 1: so many networks, joined by relays; see site_of()
  double link_delay_s = 0;        ///< a message from one site to another: late by this, …
  double link_jitter_s = 0;       ///< … ± up to so much, uniform, so that it may overtake, …
  double link_loss = 0;           ///< … or lost for all processes of the other site
  double site_cut_s = 0;          ///< one site, but not site 0, is cut off for so long, …
  double site_cut_at_s = 0;       ///< … from this time on
  /// The share of the mission's time after which all is healed. 1: nothing is healed, and no
  /// process has to recover.
  double lasting_share = 0.6;
};

/// At least 1.
int site_count(const Faults& faults);
/// Agents fill sites in the order of their numbers. All other processes are at site 0.
int site_of(int node, int agents, int sites);
/// Whether messages between sites are late or lost.
bool has_bad_links(const Faults& faults);

/// Whether no fault affects the world, the logger, or messages between them.
bool spares_the_record(const Faults& faults);

/// Whether nothing goes wrong, and the operator sends no agent out of the mission.
bool only_wishes(const Faults& faults);

/// Whether faults of messages alone may keep an answer away for as long as `patience_s`.
bool hinders(const Faults& faults, double patience_s);

/// One member of Faults, by the name that people write.
struct FaultField {
  const char* name;
  double Faults::*value;
  double most;  ///< the least is 0
};
std::span<const FaultField> fault_fields();

/// "Swarm testing": the seed determines which kinds of fault are on, each with probability 1/2, and
/// how strong they are. All at once would hide what happens with only one.
Faults drawn(std::uint64_t seed);

/// A fault that happens at a given moment, independently of messages.
struct FaultEvent {
  enum class Kind {
    kSplit,
    kOneWayCut,
    kAgentCrash,
    kCoordinatorCrash,
    kWorldCrash,
    kPause,
    kRecall,
    kDeparture,
    kTarget,
    kEnd,
    kZone,
    kLaw,
    kCancel,
    kSiteCut
  };
  Kind kind;
  double at_s;  ///< after the start of the mission
  double lasts_s;
  std::uint64_t who;  ///< splits and cuts: bit i: node i is in the first part; crash or recall:
                      ///< which agent; target, end, zone, law or
                      ///< what is undone: which one; cut site: which
};

/// The events of `horizon_s` seconds, by time.
std::vector<FaultEvent> fault_events(const Faults& faults, std::uint64_t seed, int agents,
                                     double horizon_s);

}  // namespace ergocast::lab
