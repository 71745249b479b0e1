// A CSV file of `ergocast simulate --seeds … --out FILE`: one row a seed.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ergocast::studies {

/// Numbers by column, in the order of the file. Throws std::runtime_error, which names the file, if
/// it cannot be read, has no rows, or one of them failed.
using Table = std::map<std::string, std::vector<double>>;
Table read_table(const std::filesystem::path& file);

}  // namespace ergocast::studies
