// SPDX-License-Identifier: BSD-3-Clause
// Tables of modes in files: each is named by its hash.
//
// A process does not see changes of a file that it has loaded. A file that is sealed against
// changes is mapped, so that processes share one copy in memory. Any other file is copied first,
// then checked.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "modes/table.h"

namespace ergocast {

/// "modes-<16 hex digits>.bin"
std::string table_file_name(std::uint64_t hash);

/// The table in `file`, checked; or a sentence that names the file and the problem.
Result<ModesTable> load_table(const std::filesystem::path& file);

/// Writes the table into `folder`, unless it is there. The file appears completely or not at all.
/// @return  why it could not
std::optional<std::string> save_table(const FreeModes& table, const std::filesystem::path& folder);

}  // namespace ergocast
