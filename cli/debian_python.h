// SPDX-License-Identifier: BSD-3-Clause
// The Python that commands start.
#pragma once

namespace ergocast::cli {

/// Debian's, for which python3-ergocast is built.
inline constexpr const char* kPython = "/usr/bin/python3";

}  // namespace ergocast::cli
