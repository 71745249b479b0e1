// SPDX-License-Identifier: BSD-3-Clause
// Writes addresses without the system's functions, so that participants can name them.
#include "relay/address.h"

#include <algorithm>
#include <cstdio>

namespace ergocast::relay {
namespace {

constexpr std::array<std::uint8_t, 12> kIpv4{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

}  // namespace

std::string to_text(const Address& address) {
  std::array<char, 64> text{};
  const auto& ip = address.ip;
  if (std::equal(kIpv4.begin(), kIpv4.end(), ip.begin())) {
    std::snprintf(text.data(), text.size(), "%d.%d.%d.%d:%d", ip[12], ip[13], ip[14], ip[15],
                  address.port);
    return text.data();
  }
  std::string groups;
  for (std::size_t i = 0; i < ip.size(); i += 2) {
    std::snprintf(text.data(), text.size(), "%s%x", i == 0 ? "" : ":", ip[i] << 8 | ip[i + 1]);
    groups += text.data();
  }
  return "[" + groups + "]:" + std::to_string(address.port);
}

}  // namespace ergocast::relay
