// SPDX-License-Identifier: BSD-3-Clause
// A file of faults: one `name = value` in each line; '#' begins a comment.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "lab/faults.h"

namespace ergocast::cli {

/// The faults in a file, or all its problems, "file: field: what is wrong (remedy)".
Result<lab::Faults, std::vector<std::string>> read_faults(const std::filesystem::path& file);

}  // namespace ergocast::cli
