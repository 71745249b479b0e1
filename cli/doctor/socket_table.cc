// SPDX-License-Identifier: BSD-3-Clause
// Splits each line of the table at blanks and skips lines that are not well formed.
#include "cli/doctor/socket_table.h"

#include <iterator>
#include <sstream>
#include <string>

#include "text/read_number.h"

namespace ergocast::doctor {

std::vector<UdpSocket> parse_socket_table(std::string_view table) {
  constexpr std::size_t kLocal = 1, kInode = 9, kColumns = 13;
  std::vector<UdpSocket> sockets;
  std::istringstream lines{std::string(table)};
  std::string line;
  std::getline(lines, line);  // the headings
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    const std::vector<std::string> words(std::istream_iterator<std::string>(fields), {});
    if (words.size() < kColumns) continue;
    const std::string_view local = words[kLocal];
    const std::size_t colon = local.rfind(':');
    if (colon == local.npos) continue;
    const auto port = read_number<std::uint16_t>(local.substr(colon + 1), 16);
    const auto inode = read_number<unsigned long>(words[kInode]);
    if (port && inode) sockets.push_back({*port, *inode});
  }
  return sockets;
}

}  // namespace ergocast::doctor
