// SPDX-License-Identifier: BSD-3-Clause
// Mission keys as files that only their owner may read.
//
//   ergocast key 1
//   shared <64 hex digits>
//   coordinator <64 hex digits>
//   signing <128 hex digits>      only in the coordinator's file
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "lcmtypes/message_authenticator.h"

namespace ergocast {

/// A new key, of the operating system's random bits; it can sign.
MissionKey make_mission_key();

/// The text of a key file, without the signing key if `for_coordinator` is false.
std::string key_text(const MissionKey& key, bool for_coordinator);

/// The key in `file`, or one sentence with the error and its remedy. Files that other users may
/// read or write, and files of other users, are refused. A file in $CREDENTIALS_DIRECTORY, where
/// systemd puts the credentials of a service, may be readable by its group.
Result<MissionKey> read_key_file(const std::filesystem::path& file);

/// All bytes of another file with a secret, under the same conditions. A longer file is refused.
/// @param remedy  for a file that cannot be opened, such as "; name another"
Result<std::string> read_private_file(const std::filesystem::path& file, std::size_t most_bytes,
                                      const std::string& remedy = "");

/// Writes a file that only its owner may read; never replaces one. An error names the remedy.
std::optional<std::string> write_key_file(const std::filesystem::path& file,
                                          const std::string& text);

}  // namespace ergocast
