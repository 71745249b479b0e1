// SPDX-License-Identifier: BSD-3-Clause
// The commands of `ergocast`. Each declares its own options in its file, and stores its action when
// the command line selects it.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace ergocast::cli {

/// Runs the command that the command line selects; returns the program's exit code.
using Action = std::function<int()>;

/// `run`: runs a mission as processes over LCM on this host.
void add_run(CLI::App& app, Action& action);
/// `simulate`: runs a mission in this process, in virtual time.
void add_simulate(CLI::App& app, Action& action);
/// `study`: simulates each combination of scenario, variation and seed once.
void add_study(CLI::App& app, Action& action);
/// `bench`: compares laws of papers and of other people on nine targets.
void add_bench(CLI::App& app, Action& action);
/// `new`: writes a scenario for robots in a map.
void add_new(CLI::App& app, Action& action);
/// `check`: reports every problem of a scenario.
void add_check(CLI::App& app, Action& action);
/// `report`: makes the report of a run directory, again if it exists.
void add_report(CLI::App& app, Action& action);
/// `verify`: simulates a recorded run again and compares every file of the record.
void add_verify(CLI::App& app, Action& action);
/// `keygen`: makes a mission key.
void add_keygen(CLI::App& app, Action& action);
/// `deploy`: writes the files that start a mission on several hosts.
void add_deploy(CLI::App& app, Action& action);
/// `list`: names the live runs of this user on this host.
void add_list(CLI::App& app, Action& action);
/// `status`: shows the state of a running team, from any host on its buses.
void add_status(CLI::App& app, Action& action);
/// `watch`: shows a record, or a running team, in a browser.
void add_watch(CLI::App& app, Action& action);
/// `run-page`: serves a page for `run --watch` or `watch --control`, which start it.
void add_run_page(CLI::App& app, Action& action);
/// `export`: writes a record in the formats of other tools.
void add_export(CLI::App& app, Action& action);
/// `replay`: sends a recorded run again, for displays.
void add_replay(CLI::App& app, Action& action);
/// `pause` and `resume`: stop the vehicles of a mission for a while, and continue.
void add_pause(CLI::App& app, Action& action);
/// `amend`: gives a running team a new target.
void add_amend(CLI::App& app, Action& action);
/// `recall`: sends agents home, or out of the mission.
void add_recall(CLI::App& app, Action& action);
/// `stop`: ends a mission that another command started, in order or at once.
void add_stop(CLI::App& app, Action& action);
/// `spy`: opens LCM's viewer on one bus of a mission.
void add_spy(CLI::App& app, Action& action);
/// `doctor`: finds what prevents communication between hosts, and the commands that repair it.
void add_doctor(CLI::App& app, Action& action);

}  // namespace ergocast::cli
