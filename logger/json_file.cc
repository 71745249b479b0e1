// SPDX-License-Identifier: BSD-3-Clause
// Bounds the memory that the values take, before it parses them.
#include "logger/json_file.h"

#include "text/input_file.h"
#include "text/json_bounds.h"

namespace ergocast {

Result<nlohmann::ordered_json> read_json(const std::filesystem::path& file,
                                         const JsonLimits& limits) {
  using Json = nlohmann::ordered_json;
  const auto read = read_whole(file, limits.bytes);
  if (!read) {
    if (read.error().kind == FileProblem::Kind::kMissing) return Json(nullptr);
    return failure(read.error().sentence(file));
  }
  try {
    return parse_bounded<Json>(*read, limits.values);
  } catch (const JsonTooLarge& problem) {
    return failure(file.string() + ": " + problem.what() + "; remove it");
  } catch (const Json::exception& error) {
    return failure(file.string() + ": is not JSON: " + error.what() + ": " + kCopyAgainOrRemove);
  }
}

}  // namespace ergocast
