// SPDX-License-Identifier: BSD-3-Clause
// What a density makes of the modes of a plane.
#pragma once

#include "core/basis/basis.h"

namespace ergocast {

struct PlaneIntegrals {
  PlaneCoefficients values;  ///< ∫ f_mn times the density
  double error_bound = 0;    ///< how far any entry may be off
};

}  // namespace ergocast
