// SPDX-License-Identifier: BSD-3-Clause
// Whether a file that a person names can be read to its end.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace ergocast {

/// Why not, without the name: a pipe, a device or a socket would hold the program up, or never end.
/// A file that does not exist is no such problem: opening it says so.
std::optional<std::string> why_not_regular(const std::filesystem::path& file);

}  // namespace ergocast
