// SPDX-License-Identifier: BSD-3-Clause
// Simulates a mission into a run directory: for `ergocast simulate`, and for Python.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/record/simulated_events.h"
#include "core/base/result.h"
#include "core/law/law.h"
#include "core/mission/amendments.h"
#include "logger/recorder.h"
#include "logger/run_record.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

/// The result of a simulated mission.
struct SimulatedRecord {
  nlohmann::ordered_json summary;
  bool failed = false;  ///< the mission, not its record
};

/// A law that no scenario can name.
struct OwnLaw {
  LawMaker laws = make_law;
  std::string name{};  ///< for the summary
};

/// A simulation that goes on.
struct SimulationInProgress {
  const Recorder& recorder;
  std::function<void(std::string reason)> end;  ///< ends its mission in order
};

/// Simulates the mission until it is over or the disk is full, and writes the tables and
/// summary.json.
/// @param record  empty; in a folder of prepare_run_directory()
/// @param look    called now and then; it may end the simulation
/// @param events  writes the event log, too; may be null. A team of sites has none
/// @param amendments  known from the beginning; are_amendments(). None for a team of sites
/// @param law     of a program's own; make_law() without
/// @return        the error if the record is incomplete
Result<SimulatedRecord> simulate_into(RunRecord& record, const Scenario& scenario,
                                      const std::function<void(SimulationInProgress&)>& look,
                                      SimulatedEvents* events = nullptr, Amendments amendments = {},
                                      const OwnLaw& law = {});

}  // namespace ergocast::cli
