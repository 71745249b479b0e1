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
  if (!read) {
    ERGOCAST_REQUIRE(!read.error().empty());
    return;
  }
  const MissionKey& key = *read;
  const std::string text = key_text(key, key.signing.has_value());
  folder.write("key", text);
  const auto again = read_key_file(file);
  ERGOCAST_REQUIRE(again.has_value());
  ERGOCAST_REQUIRE(key_text(*again, key.signing.has_value()) == text);
}

}  // namespace ergocast::fuzz
