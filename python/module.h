// SPDX-License-Identifier: BSD-3-Clause
// The parts of the module ergocast._native. Each function adds its classes.
#pragma once

#include <pybind11/pybind11.h>

namespace ergocast::python {

/// Domain, Basis, Mission, ControlLaw, and functions of them: core/basis/basis.h.
void add_method(pybind11::module_& module);
/// Controller, CoverageTable, IdealTeam: core/law/control.h, core/law/coverage_table.h,
/// lab/ideal_team.h.
void add_team(pybind11::module_& module);
/// Gaussian, Region, Target: target/target.h.
void add_target(pybind11::module_& module);
/// Record, compile_mission(), simulate(): logger/run_data.h, cli/record/simulated_record.h.
void add_records(pybind11::module_& module);
/// LawInput, run_study_mission(): python/own_law.h, studies/study_run.h.
void add_own_laws(pybind11::module_& module);

}  // namespace ergocast::python
