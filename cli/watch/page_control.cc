// SPDX-License-Identifier: BSD-3-Clause
// Adds an event to each browser's stream when the state of control has changed.
#include "cli/watch/page_control.h"

namespace ergocast::cli {

void PageControl::listen() {
  while (auto state = link_.receive()) {
    if (*state == state_) continue;
    state_ = std::move(*state);
    ++changes_;
  }
}

PageServer::Content PageControl::joined(PageServer::Content content) {
  content.control_token = token_;
  content.control = [this](const std::string& request) { return link_.send(request); };
  content.events = [this, make = std::move(content.events)] {
    return [this, base = make(), seen = std::uint64_t{0}]() mutable -> std::optional<std::string> {
      auto text = base();
      if (!text || seen == changes_) return text;
      seen = changes_;
      return *text + "event: control\ndata: " + state_ + "\n\n";
    };
  };
  return content;
}

}  // namespace ergocast::cli
