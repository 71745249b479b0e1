// SPDX-License-Identifier: BSD-3-Clause
// Checks whether a file named by a person can be read to its end.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace ergocast {

/// Why not, without the name: a pipe, a device or a socket would block the program or never end. A
/// missing file is no problem here: opening it reports the error.
std::optional<std::string> why_not_regular(const std::filesystem::path& file);

}  // namespace ergocast
