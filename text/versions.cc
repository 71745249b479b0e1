// SPDX-License-Identifier: BSD-3-Clause
// Reads a version as numbers between points, and never fails on received text.
#include "text/versions.h"

#include <algorithm>
#include <charconv>

namespace ergocast {
namespace {

/// The number at the head of `rest`, which loses it and the point behind it.
int next_number(std::string_view& rest) {
  const std::string_view part = rest.substr(0, rest.find('.'));
  rest.remove_prefix(std::min(rest.size(), part.size() + 1));
  int number = 0;
  const auto read = std::from_chars(part.data(), part.data() + part.size(), number);
  return read.ec == std::errc() ? number : 0;
}

}  // namespace

bool is_older_version(std::string_view version, std::string_view other) {
  while (!version.empty() || !other.empty()) {
    const int ours = next_number(version), theirs = next_number(other);
    if (ours != theirs) return ours < theirs;
  }
  return false;
}

std::string update_of_hosts(const std::string& host, const std::string& version,
                            const std::string& other_host, const std::string& other_version) {
  return is_older_version(version, other_version) ? "update " + host + " to " + other_version
                                                  : "update " + other_host + " to " + version;
}

}  // namespace ergocast
