#include "runtime/socket_table.h"

#include <charconv>
#include <iterator>
#include <sstream>
#include <string>

namespace ergocast {
namespace {

/// The whole of `text`, in the range of `number`.
template <class Number>
bool read(std::string_view text, Number& number, int base = 10) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

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
    std::uint16_t port = 0;
    UdpSocket socket;
    if (read(local.substr(colon + 1), port, 16) && read(words[kInode], socket.inode)) {
      socket.port = port;
      sockets.push_back(socket);
    }
  }
  return sockets;
}

}  // namespace ergocast
