// SPDX-License-Identifier: BSD-3-Clause
// Tests each invariant and goal of the laboratory with a bug that breaks it: the real program
// simulates the same seeds with the bug (bugs.h) and without.
#include "lab/invariants.h"

#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "tests/checks_can_fail/words.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

using lab::Invariant;

struct Plant {
  Invariant broken;
  const char* bug;            ///< "": only the one in the options
  std::string faults = "";    ///< a fault file's lines
  std::string scenario = "";  ///< lines added to faulty_team's
  std::string prints = "";    ///< selects one of several reports under that name
  const char* pace = "--realtime";
};

// Runs to the mission's end, so that effects of few blocks appear, too.
const char* const kLateBlocks =
    "loss = 0.5\nreordering = 0.5\nreordering_max_s = 3\nswarm_bus_only = 1\nlasting_share = 1";
const char* const kDeadAgents = "agent_crashes_per_s = 0.1\ndowntime_max_s = 20";
const char* const kPauses = "pauses_per_s = 0.3\npause_max_s = 5";
const char* const kTargets = "targets_per_s = 0.3";
const char* const kManyTargets = "targets_per_s = 1";
const char* const kTargetsAndPauses = "targets_per_s = 0.3\npauses_per_s = 0.3\npause_max_s = 5";
const char* const kEnds = "ends_per_s = 0.3";
const char* const kManyEnds = "ends_per_s = 1";
const char* const kZones = "zones_per_s = 0.3";
const char* const kLaws = "laws_per_s = 0.3";
const char* const kUndoneTargets = "targets_per_s = 0.3\ncancels_per_s = 1";
const char* const kUndoneEnds = "ends_per_s = 0.3\ncancels_per_s = 1";
const char* const kUndoneLaws = "laws_per_s = 0.5\ncancels_per_s = 0.5";
const char* const kUndoneZones = "zones_per_s = 0.5\ncancels_per_s = 1";
const char* const kEarlyZones = "zones_per_s = 0.15\nlasting_share = 0.2";
const char* const kZonesAndRecalls = "zones_per_s = 0.05\nrecalls_per_s = 0.3";
const char* const kRecalls = "recalls_per_s = 0.3";
const char* const kDepartures = "recalls_per_s = 0.3\ndeparture_share = 1";
const char* const kByRowsAlone = "agents { dead_reckoning: false }";
const char* const kTenAgents =
    "agents { starts { x_m: 30 y_m: 30 } starts { x_m: 70 y_m: 65 } starts { x_m: 50 y_m: 45 } "
    "starts { x_m: 25 y_m: 60 } starts { x_m: 75 y_m: 30 } starts { x_m: 50 y_m: 90 } }";
const char* const kHalfLife = "law { memory_half_life_s: 3 }";
const char* const kHalfLifeByRowsAlone =
    "law { memory_half_life_s: 3 }\nagents { dead_reckoning: false }";

const char* const kCrowd =
    "separation { distance_m: 20 }\nworld { speed_limit_mps: 20 }\ngoal_ergodic_metric: 1";
/// Bodies at their speed limit, so that no spare distance hides missing knowledge.
const char* const kFastCrowd =
    "separation { distance_m: 20 }\nworld { speed_limit_mps: 10 }\ngoal_ergodic_metric: 1";
const char* const kCrowdInACorner =
    "separation { distance_m: 20 }\nworld { speed_limit_mps: 20 }\ngoal_ergodic_metric: 1\n"
    "target { gaussians { mean_x_m: 0 mean_y_m: 0 sigma_m: 3 weight: 20 } }";
const char* const kUnguardedCrowd =
    "separation { distance_m: 12 guard: false }\nworld { speed_limit_mps: 10 }\n"
    "goal_ergodic_metric: 1\ntime { command_hold_s: 0.3 }\n"
    "target { gaussians { mean_x_m: 0 mean_y_m: 0 sigma_m: 3 weight: 20 } }";
/// Each knows only its own position, and its beacons may be lost.
#define HEARSAY(lease)                                          \
  "separation { distance_m: 6 lease_s: " lease                  \
  " }\nworld { speed_limit_mps: 10 }\ngoal_ergodic_metric: 1\n" \
  "time { command_hold_s: 0 }\n"                                \
  "target { gaussians { mean_x_m: 50 mean_y_m: 50 sigma_m: 3 weight: 20 } }"
const char* const kHearsayCrowd = HEARSAY("6");
const char* const kBriefLease = HEARSAY("0.5");
#undef HEARSAY
const char* const kLateBeacons =
    "delay_mean_s = 0.6\ndelay_max_s = 1.5\nswarm_bus_only = 1\nlasting_share = 1";
const char* const kSilentLinks =
    "clogging = 0.002\nclog_max_s = 60\nswarm_bus_only = 1\nlasting_share = 1";
const char* const kCrowdWithInertia =
    "separation { distance_m: 20 }\nworld { speed_limit_mps: 20 }\ngoal_ergodic_metric: 1\n"
    "vehicle { kind: ACCELERATION max_acceleration_mps2: 10 }";
const char* const kCrowdOfUnicycles =
    "separation { distance_m: 20 }\nworld { speed_limit_mps: 20 }\ngoal_ergodic_metric: 1\n"
    "vehicle { kind: UNICYCLE max_turn_radps: 1 }";
const char* const kCrowdWithWings =
    "separation { distance_m: 15 }\nworld { speed_limit_mps: 20 }\ngoal_ergodic_metric: 1\n"
    "vehicle { kind: FIXED_WING max_turn_radps: 1.5 min_speed_mps: 5 }\n"
    "target { gaussians { mean_x_m: 50 mean_y_m: 50 sigma_m: 3 weight: 20 } }";
/// A solid block between the two Gaussians, in a place that many agents want.
#define WALLED                                                                                  \
  "goal_ergodic_metric: 1\ntarget { gaussians { mean_x_m: 50 mean_y_m: 47 sigma_m: 10 weight: " \
  "5 } }\n"                                                                                     \
  "world { speed_limit_mps: 20 walls { vertices { x_m: 42 y_m: 40 } vertices { x_m: 58 y_m: "   \
  "40 } vertices { x_m: 58 y_m: 55 } vertices { x_m: 42 y_m: 55 } } wall_clearance_m: 2 }"
const char* const kWalled = WALLED;
const char* const kWalledCrowd = WALLED "\nseparation { distance_m: 10 }";
const char* const kWalledWithInertia =
    WALLED "\nvehicle { kind: ACCELERATION max_acceleration_mps2: 10 }";
const char* const kWalledWithWings =
    WALLED "\nvehicle { kind: FIXED_WING max_turn_radps: 1.5 min_speed_mps: 5 }";
#undef WALLED

const char* const kUnsureCrowd =
    "separation { distance_m: 20 position_error_m: 1 }\nworld { speed_limit_mps: 20 }\n"
    "goal_ergodic_metric: 1";

/// Every kind of vehicle, each with its own speed.
const char* const kMixedCrowd =
    "separation { distance_m: 12 }\nworld { speed_limit_mps: 20 }\ngoal_ergodic_metric: 1\n"
    "agents { kind { name: \"a\" count: 1 vehicle { kind: FIXED_WING max_turn_radps: 1 "
    "min_speed_mps: 5 } } "
    "kind { name: \"b\" count: 1 vehicle { kind: ACCELERATION max_acceleration_mps2: 8 } } "
    "kind { name: \"c\" count: 1 vehicle { kind: UNICYCLE max_turn_radps: 1 } speed_limit_mps: 12 "
    "} "
    "kind { name: \"d\" count: 1 } }\n"
    "target { gaussians { mean_x_m: 50 mean_y_m: 50 sigma_m: 3 weight: 20 } }";

const char* const kTwoKinds =
    "agents { kind { name: \"a\" count: 2 footprint_sigma_m: 20 quality: 0.5 } "
    "kind { name: \"b\" count: 2 footprint_sigma_m: 5 } }";

/// Two of them; the last 20 s of the mission are a reserve.
const char* const kStations =
    "agents { kind { name: \"a\" count: 2 station { x_m: 8 y_m: 50 } reserve_s: 20 } "
    "kind { name: \"b\" count: 2 } }";

const char* const kDrifting =
    "world { objects { count: 5 motion { speed_mps: 5 } } }\nsensor { radius_m: 20 }";
const char* const kObjects = "world { objects { count: 5 } }\nsensor { radius_m: 20 }";

const char* const kSearch = "law { kind: SEARCH }\nsensor { radius_m: 5 }";
const char* const kEndsWhenFound =
    "world { objects { count: 5 end_when_found: 3 } }\nsensor { radius_m: 8 }";

/// They last for 20 s.
const char* const kBatteries =
    "agents { kind { name: \"a\" count: 2 station { x_m: 8 y_m: 50 } battery { capacity_wh: 1 "
    "power_w: 180 charge_w: 900 reserve: 0 } } kind { name: \"b\" count: 2 } }";

const char* const kBatteriesByRowsAlone =
    "agents { dead_reckoning: false kind { name: \"a\" count: 2 station { x_m: 8 y_m: 50 } battery "
    "{ capacity_wh: 1 power_w: 180 charge_w: 900 reserve: 0 } } kind { name: \"b\" count: 2 } }";

const char* const kShortRests =
    "agents { kind { name: \"a\" count: 2 station { x_m: 8 y_m: 50 } reserve_s: 1 } "
    "kind { name: \"b\" count: 2 } }";

const char* const kStationsForAll =
    "agents { kind { name: \"a\" count: 4 station { x_m: 8 y_m: 50 } reserve_s: 1 } }";
const char* const kLongRests =
    "agents { kind { name: \"a\" count: 4 station { x_m: 8 y_m: 50 } reserve_s: 20 } }";

const Plant kPlants[] = {
    {Invariant::kPositionsInTheDomain, "the edges push outwards"},
    {Invariant::kInputsBounded, "the input is not cut"},
    {Invariant::kInputsBounded, "agents keep to the plan's law", kLaws},
    {Invariant::kInputsBounded, "a law holds a tick late", kLaws, "", "", "--lockstep"},
    {Invariant::kInputsBounded, "agents keep to a law that is undone", kUndoneLaws},
    {Invariant::kInputsBounded, "all kinds have the law of the last", kLaws, kTwoKinds},
    {Invariant::kDistanceKept, "bodies are no bodies", "", kCrowd},
    {Invariant::kDistanceKept, "only two bodies count", "", kCrowd},
    {Invariant::kDistanceKept, "a body takes the whole gap", "", kCrowd},
    {Invariant::kDistanceKept, "old places count as new", "", kCrowd},
    {Invariant::kDistanceKept, "places count as half as old", "", kFastCrowd},
    {Invariant::kDistanceKept, "a body without messages does not exist", "", kCrowd},
    {Invariant::kDistanceKept, "edges count afterwards", "", kCrowdInACorner},
    {Invariant::kDistanceKept, "no command is held", "loss = 0.3", kUnguardedCrowd},
    {Invariant::kDistanceKept, "places of beacons are always new", kLateBeacons, kHearsayCrowd},
    {Invariant::kDistanceKept, "a beacon's age counts from its arrival", kLateBeacons,
     kHearsayCrowd},
    {Invariant::kDistanceKept, "nobody keeps to the lease", kSilentLinks, kBriefLease},
    {Invariant::kDistanceKept, "a body needs no way to brake", "", kCrowdWithInertia},
    {Invariant::kDistanceKept, "a body looks everywhere at once", "", kCrowdOfUnicycles},
    {Invariant::kDistanceKept, "a body takes the whole gap", "", kCrowdOfUnicycles},
    {Invariant::kDistanceKept, "a body takes the whole gap", "", kCrowdWithWings},
    {Invariant::kDistanceKept, "a loiter circle is a point", "", kCrowdWithWings},
    {Invariant::kDistanceKept, "a body needs no way to brake", "", kCrowdWithWings},
    {Invariant::kDistanceKept, "nobody knows of position errors", "", kUnsureCrowd},
    {Invariant::kDistanceKept, "a body takes the whole gap", "", kMixedCrowd},
    {Invariant::kDistanceKept, "a neighbour needs no way to brake", "", kMixedCrowd},
    {Invariant::kDistanceKept, "a neighbour's loiter circle is a point", "", kMixedCrowd},
    {Invariant::kDistanceKept, "a neighbour is taken for another vehicle", "", kMixedCrowd},
    {Invariant::kDetectionsInReach, "sensors detect from everywhere", "", kObjects},
    {Invariant::kDetectionsInReach, "sensors detect objects where they were", "", kDrifting},
    {Invariant::kLooksAreTrue, "a tile is added to the one before", "", kSearch},
    {Invariant::kLooksAreTrue, "an old tile replaces a newer one", kLateBlocks, kSearch},
    {Invariant::kLooksAreTrue, "a relayed row is the relayer's", "", kSearch, "", "--lockstep"},
    {Invariant::kLooksAreTrue, "agents forget nothing by a note", kTargets, kSearch, "",
     "--lockstep"},
    {Invariant::kFindsAreRecorded, "a find is recorded a tick late", "", kObjects, "",
     "--lockstep"},
    {Invariant::kFindsAreRecorded, "no find is recorded", "", kObjects, "", "--lockstep"},
    {Invariant::kEndsOnceFound, "finds end nothing", "", kEndsWhenFound, "names no end at tick",
     "--lockstep"},
    {Invariant::kEndsOnceFound, "the first find ends the mission", "", kEndsWhenFound,
     "names an end, and ", "--lockstep"},
    {Invariant::kWallsKept, "walls are air", "", kWalledCrowd},
    {Invariant::kWallsKept, "walls keep half of their clearance", "", kWalledCrowd},
    {Invariant::kWallsKept, "held commands know no walls", "loss = 0.3", kWalled},
    {Invariant::kWallsKept, "nobody brakes before walls", "", kWalledWithInertia},
    {Invariant::kWallsKept, "a loiter circle may reach into walls", "", kWalledWithWings},
    {Invariant::kZonesNotEntered, "no filter knows zones", kZones, kTenAgents, "", "--lockstep"},
    {Invariant::kZonesNotEntered, "no filter knows zones", kZones, kTenAgents},
    {Invariant::kZonesNotEntered, "a zone closes only at its tick", kZones, kTenAgents, "",
     "--lockstep"},
    {Invariant::kZonesNotEntered, "a zone ends early", kZones, kTenAgents, "", "--lockstep"},
    {Invariant::kZonesNotEntered, "a cancelled zone ends at once", kUndoneZones, kTenAgents},
    {Invariant::kZonesLeft, "nobody is led out of a zone", kZones, kTenAgents},
    {Invariant::kHomeInTime, "an agent goes home late", "", kStations, "", "--lockstep"},
    {Invariant::kEmptyOnlyAtHome, "the way home needs no charge", "", kBatteries, "", "--lockstep"},
    {Invariant::kChargesAreTrue, "batteries are charged anywhere", "", kBatteries, "",
     "--lockstep"},
    {Invariant::kNothingCountsWhilePaused, "charging agents add samples", "", kBatteries},
    {Invariant::kNothingCountsWhilePaused, "charging agents add samples", "", kBatteries, "",
     "--lockstep"},
    {Invariant::kForecastOfWhatIsKnown, "charging agents are foreseen", "", kBatteries},
    {Invariant::kForecastOfWhatIsKnown, "charging agents are foreseen", "", kBatteriesByRowsAlone,
     "", "--lockstep"},
    {Invariant::kHomeInTime, "an agent goes home late", kEarlyZones, kShortRests, "", "--lockstep"},
    {Invariant::kHomeInTime, "agents go home by the plan's end", kManyEnds, kStationsForAll, "",
     "--lockstep"},
    {Invariant::kForecastOfWhatIsKnown, "agents go by the plan's end", kEnds, kStations, "",
     "--lockstep"},
    {Invariant::kNothingCountsWhilePaused, "the way home is not asked for", kManyEnds, kLongRests},
    {Invariant::kRecalledComeHome, "a recalled agent stays where it is", kRecalls, "", "",
     "--lockstep"},
    {Invariant::kRecalledComeHome, "a recalled agent stays where it is", kZonesAndRecalls, "", "",
     "--lockstep"},
    {Invariant::kForecastOfWhatIsKnown, "agents go by an end that is undone", kUndoneEnds,
     kStations, "", "--lockstep"},
    {Invariant::kForecastOfWhatIsKnown, "the resting are foreseen", "", kStations},
    {Invariant::kForecastOfWhatIsKnown, "the recalled are foreseen", kRecalls},
    {Invariant::kSumsBounded, "a sum runs away"},
    {Invariant::kSumsBounded, "a half-life passes unnoticed", "", kHalfLife, "remembers"},
    {Invariant::kSumsBounded, "a half-life passes a tick early", "", kHalfLife, "remembers"},
    {Invariant::kSumsBounded, "time is not halved with its sums", "", kHalfLife},
    {Invariant::kAverageOfWhatIsHeld, "a receiver halves nothing", "", kHalfLife},
    {Invariant::kForecastOfWhatIsKnown, "a forecast halves nothing", "", kHalfLife},
    {Invariant::kForecastOfWhatIsKnown, "a forecast halves nothing", "", kHalfLifeByRowsAlone},
    {Invariant::kForecastOfWhatIsKnown, "former targets are not halved", kTargets, kHalfLife},
    {Invariant::kForecastOfWhatIsKnown, "former targets are not halved", kManyTargets,
     kHalfLifeByRowsAlone},
    {Invariant::kRelaysAnswerDigests, "an agent repeats unasked"},
    {Invariant::kDigestsSayWhatIsHeld, "a digest exaggerates"},
    {Invariant::kWholeMessagesAccepted, "whole messages are refused"},
    {Invariant::kDamagedMessagesRefused, "damage passes", "corruption = 0.01"},
    {Invariant::kHeldNeverShrinks, "a backup is put back"},
    {Invariant::kNoStepCountsTwice, "a sample counts twice"},
    {Invariant::kNothingCountsWhilePaused, "a sample counts while all stand", kPauses},
    {Invariant::kNothingCountsWhilePaused, "one agent ignores pauses", kPauses},
    {Invariant::kNothingCountsWhilePaused, "recalls are ignored", kRecalls, "", "", "--lockstep"},
    {Invariant::kWhatIsNotPausedCounts, "one agent goes on later", kPauses},
    {Invariant::kNobodyMovesWhilePaused, "an agent creeps on", kPauses, "", ": agent "},
    {Invariant::kNobodyMovesWhilePaused, "the world creeps on", kPauses, "", ": vehicle ",
     "--lockstep"},
    {Invariant::kNobodyMovesAfterTheEnd, "an agent drives on after the end", "", "", ": agent "},
    {Invariant::kNobodyMovesAfterTheEnd, "vehicles go home after the end", "", "", ": vehicle "},
    {Invariant::kAverageOfWhatIsHeld, "the average is off"},
    {Invariant::kSamplesAreTrue, "one agent keeps to the plan's target", kTargets},
    {Invariant::kSamplesAreTrue, "a target that is undone before its tick holds", kUndoneTargets},
    {Invariant::kSamplesAreTrue, "a target counts twice", kTargets},
    {Invariant::kSamplesAreTrue, "a target holds a tick late", kTargets, "", "", "--lockstep"},
    {Invariant::kSamplesAreTrue, "a pause does not delay a target", kTargetsAndPauses},
    {Invariant::kForecastOfWhatIsKnown, "teammates go on with the former target", kTargets},
    {Invariant::kForecastOfWhatIsKnown, "teammates go on with the former target", kTargets,
     kByRowsAlone},
    {Invariant::kHonestMessagesAccepted, "a shifted block is refused", "targets_per_s = 1"},
    {Invariant::kForecastOfWhatIsKnown, "a late block becomes the one before", kLateBlocks,
     kByRowsAlone},
    {Invariant::kForecastOfWhatIsKnown, "a relayed block becomes the one before", kLateBlocks,
     kByRowsAlone},
    {Invariant::kForecastOfWhatIsKnown, "the dead are foreseen for ever", kDeadAgents},
    {Invariant::kForecastOfWhatIsKnown, "the dead are foreseen for ever", kDeadAgents,
     kByRowsAlone},
    {Invariant::kForecastOfWhatIsKnown, "an agent foresees itself"},
    {Invariant::kForecastOfWhatIsKnown, "an agent foresees itself", "", kByRowsAlone},
    {Invariant::kForecastOfWhatIsKnown, "a block's age counts from its arrival", kLateBlocks},
    {Invariant::kForecastOfWhatIsKnown, "a block's age counts from its arrival", kLateBlocks,
     kByRowsAlone},
    {Invariant::kAverageOfWhatIsHeld, "a quality does not count", "", kTwoKinds},
    {Invariant::kForecastOfWhatIsKnown, "a footprint is not foreseen", "", kTwoKinds},
    {Invariant::kZerothIsOne, "a receiver rounds"},
    {Invariant::kHonestMessagesAccepted, "an honest block is refused"},
    {Invariant::kNoEarlyEnd, "an agent gives up"},
    {Invariant::kClosedNumbersStayEmpty, "a closed number is given away", kDepartures},
    {Invariant::kNoWakeupInThePast, "an agent never sleeps"},
    {Invariant::kHeardLoggerIsKept, "the world ignores the logger"},
    {Invariant::kEverybodyIsBack, "a newcomer is mute", "", "agents { quorum: 3 }"},
    {Invariant::kLiveAgentsAreKnown, "the coordinator ignores an agent"},
    {Invariant::kLiveAgentsCount, "the coordinator ignores an agent", "",
     "agents { forget_silent_after_s: 1 }"},
    {Invariant::kEverybodyLearnsEveryRow, "one agent's rows are dropped", "", "", ", a member"},
    {Invariant::kEverybodyLearnsEveryRow, "one agent's rows are dropped", "",
     "world { radio_range_m: 200 }", "hops away, has long held"},
    {Invariant::kViewsAgree, "a receiver mixes up modes", "", "law { anticipation: 0 }"},
    {Invariant::kRelaysStop, "an agent repeats what all have"},
    {Invariant::kEverybodyEnds, "the world hangs"},
    {Invariant::kMissionDoesNotFail, "the coordinator panics"},
    {Invariant::kLastTickReached, "the coordinator ends too early"},
    {Invariant::kLastTickReached, "the end does not move", kPauses},
    {Invariant::kRecordIsWhole, "the world keeps a tick to itself"},
    {Invariant::kGoalReached, "", "", "goal_ergodic_metric: 1e-9"},
};

class InvariantsCanFail : public OwnHost {
 protected:
  /// The exit code of two seeds of the faulty team without faults, except for those of the plant.
  int run_plant(const Plant& plant, const char* bug) {
    std::string text = text_of(scenario_file("faulty_team"));
    for (std::istringstream lines(plant.scenario); lines;) {
      std::string line;
      std::getline(lines, line);
      put_over(line, text);
    }
    const auto scenario = folder_ / "faulty_team.textproto", faults = folder_ / "faults.ini";
    std::ofstream(scenario) << text;
    std::ofstream(faults) << plant.faults << '\n';
    setenv("ERGOCAST_BUG", bug, 1);
    const int code = run("ergocast-with-bugs", {"simulate", scenario, plant.pace, "--seeds", "1:2",
                                                "--jobs", "1", "--faults", faults});
    unsetenv("ERGOCAST_BUG");
    return code;
  }
  /// The first output: violations, or that there were none.
  std::string printed() const { return output().substr(0, 1000); }

 private:
  /// "agents { quorum: 3 }" goes into the block, if there is one; "name: value" takes its place.
  static void put_over(const std::string& line, std::string& text) {
    const auto brace = line.find('{'), colon = line.find(':');
    if (colon == line.npos) return;
    if (brace < colon) {
      const std::string block = line.substr(0, brace + 1);
      const auto at = text.find("\n" + block);
      if (at == text.npos) {
        text += line + '\n';
        return;
      }
      text.insert(at + 1 + block.size(), line.substr(brace + 1, line.rfind('}') - brace - 1));
    } else {
      const auto at = text.find("\n" + line.substr(0, colon + 1));
      if (at != text.npos) text.erase(at + 1, text.find('\n', at + 1) - at);
      text += line + '\n';
    }
  }
};

TEST_F(InvariantsCanFail, EachOfThem) {
  std::set<Invariant> planted;
  for (const Plant& plant : kPlants) {
    const std::string name(lab::name_of(plant.broken));
    planted.insert(plant.broken);
    if (*plant.bug != '\0') {
      EXPECT_EQ(run_plant(plant, ""), 0) << "without the bug: " << printed();
    }
    EXPECT_EQ(run_plant(plant, plant.bug), 4) << name << " holds though " << plant.bug << '\n'
                                              << printed();
    for (const char* seed : {"seed 1: ", "seed 2: "}) {
      EXPECT_TRUE(answered(seed + name + ": ")) << plant.bug << " is not seen: " << printed();
    }
    EXPECT_TRUE(answered(plant.prints)) << plant.prints << " is not reported: " << printed();
    EXPECT_TRUE(answered("again: ergocast simulate ")) << printed();
    EXPECT_TRUE(answered("--seeds 2")) << printed();
  }
  for (const auto& [invariant, name] : lab::kInvariants) {
    EXPECT_TRUE(planted.contains(invariant)) << "nothing is planted against: " << name;
  }
}

/// Plants with one report trigger one place in the code; another place with this report needs its
/// own plant.
TEST(Invariants, AreReportedAtAsManyPlacesAsThereArePlants) {
  std::string sources;
  for (const std::string& file : sources_in("lab")) {
    sources += text_of(std::filesystem::path(ERGOCAST_SOURCE_DIR) / file);
  }
  const std::regex report("violate\\(\\s*\\w+,\\s+Invariant::\\w+");
  const auto places =
      std::distance(std::sregex_iterator(sources.begin(), sources.end(), report), {});
  std::set<std::pair<Invariant, std::string>> planted;
  for (const Plant& plant : kPlants) planted.emplace(plant.broken, plant.prints);
  EXPECT_EQ(places, std::ssize(planted));
}

TEST_F(InvariantsCanFail, AMissionWhoseProcessCrashesIsOneThatFailed) {
  EXPECT_EQ(run_plant({}, "an agent crashes"), 4);
  EXPECT_TRUE(answered("seed 1: ")) << printed();
  EXPECT_TRUE(answered("SIGABRT")) << printed();
}

}  // namespace
}  // namespace ergocast::test
