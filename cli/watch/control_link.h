// SPDX-License-Identifier: BSD-3-Clause
// The connection between the process that gives orders and the process that serves its page. It is
// a pair of sockets without a name, so no other process can connect.
//
// Each text is one packet, so a killed process cannot leave half of a text.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "runtime/bus/socket.h"

namespace ergocast::cli {

/// The beginning of the state of control that the page gets last: the mission is over.
inline constexpr const char* kControlOver = R"({"over":true)";

class ControlLink {
 public:
  /// The longest text.
  static constexpr std::size_t kLongest = 32 << 10;

  /// Both ends; nothing if the system has no descriptors for them.
  static std::optional<std::pair<ControlLink, ControlLink>> pair();
  /// An end that this process has inherited; nothing if `fd` is no such end.
  static std::optional<ControlLink> inherited(int fd);

  int fd() const { return end_.fd(); }
  /// False if the other end does not read, or the text is too long. Does not wait.
  bool send(const std::string& text) const;
  /// The next text, if there is one. Does not wait.
  std::optional<std::string> receive() const;

 private:
  explicit ControlLink(Socket end) : end_(std::move(end)) {}

  Socket end_;
};

}  // namespace ergocast::cli
