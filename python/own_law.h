// SPDX-License-Identifier: BSD-3-Clause
// A law that a person has written in Python: ergocast.Law.
//
// One object computes the velocities of all agents of a tick, in one call. The first agent that
// asks at a tick has it called; the others read their rows. So all agents have to know the places
// of all others: studies::why_not_in_python().
#pragma once

#include <pybind11/pybind11.h>

#include "core/law/law.h"

namespace ergocast::python {

/// Makes laws that ask `law`, an ergocast.Law, its class or FILE.py:CLASS; make_law() if it is
/// None. ergocast.LawError if it is none of these, or if not all agents of the mission know all
/// places. After an error of the law its mission has ended. To be destroyed with the GIL.
LawMaker laws_of(const pybind11::object& law, const Mission& mission);

}  // namespace ergocast::python
