// SPDX-License-Identifier: BSD-3-Clause
// A mission key's file: refused in a sentence, or a key that reads back from its own text.
#include "runtime/process/key_file.h"

#include <sys/stat.h>

#include "tests/fuzz/files.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(key_file) {
  static const Folder folder;
  const std::filesystem::path file = folder.path() / "key";
  folder.write("key", text_of(input));
  chmod(file.c_str(), 0600);
  const auto read = read_key_file(file);
  if (const auto* problem = std::get_if<std::string>(&read)) {
    ERGOCAST_REQUIRE(!problem->empty());
    return;
  }
  const MissionKey& key = std::get<MissionKey>(read);
  const std::string text = key_text(key, key.signing.has_value());
  folder.write("key", text);
  const auto again = read_key_file(file);
  ERGOCAST_REQUIRE(std::holds_alternative<MissionKey>(again));
  ERGOCAST_REQUIRE(key_text(std::get<MissionKey>(again), key.signing.has_value()) == text);
}

}  // namespace ergocast::fuzz
