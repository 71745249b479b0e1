// SPDX-License-Identifier: BSD-3-Clause
// Included before every source for arm64: without this macro, Eigen multiplies and adds with two
// roundings, as on other processors.
#pragma once

#include <arm_neon.h>
#undef __ARM_FEATURE_FMA
