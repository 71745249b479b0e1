// SPDX-License-Identifier: BSD-3-Clause
// Asks the file system for the type of the file without opening it.
#include "text/regular_file.h"

namespace ergocast {

namespace fs = std::filesystem;

std::optional<std::string> why_not_regular(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status) || fs::is_regular_file(status)) return std::nullopt;
  if (fs::is_directory(status)) return "is a folder, not a file";
  return "is not a regular file: pipes, devices and sockets are not read";
}

}  // namespace ergocast
