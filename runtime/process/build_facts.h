// SPDX-License-Identifier: BSD-3-Clause
// Version, commit, compiler and processor of this program, and what the processor here can do.
#pragma once

#include <string>

namespace ergocast {

/// The text of --version. Its first line begins with "ergocast" and the version, and names LCM and
/// the compiler. Two lines may follow: the commit, if the program was built from a known one, and
/// the features of the processor that the build needs, may use, and finds here.
std::string facts_text();

/// Whether this processor has fused multiply-add, which changes the results of glibc's sin and cos.
bool processor_has_fma();

}  // namespace ergocast
