// SPDX-License-Identifier: BSD-3-Clause
// Adds an event to each browser's stream when the state of control has changed.
#include "cli/watch/page_control.h"

#include <chrono>

namespace ergocast::cli {
namespace {

/// The other process repeats the state twice a second.
constexpr std::chrono::seconds kPatience{3};

}  // namespace

void PageControl::listen(Instant now) {
  while (auto state = link_.receive()) {
    heard_ = now;
    if (*state == state_) continue;
    state_ = std::move(*state);
    ++changes_;
  }
  if (now - second_ >= std::chrono::seconds(1)) {
    second_ = now;
    passed_on_ = 0;
  }
  over_ = over_ || state_.starts_with(kControlOver);
  const bool silent = !over_ && now - heard_ > kPatience;
  if (silent != silent_) ++changes_;
  silent_ = silent;
}

PageServer::Content PageControl::joined(PageServer::Content content) {
  content.control_token = token_;
  content.control = [this](const ControlRequest& request, const std::string& text) {
    // A browser may still hold control of a mission that has just ended.
    if (over_) return request.act == ControlAct::kHere || request.act == ControlAct::kRelease;
    const bool counts = request.act != ControlAct::kStopNow;
    if (silent_ || (counts && passed_on_ >= kMostInASecond)) return false;
    passed_on_ += counts ? 1 : 0;
    return link_.send(text);
  };
  content.events = [this, make = std::move(content.events)] {
    return [this, base = make(), seen = std::uint64_t{0}]() mutable -> std::optional<std::string> {
      auto text = base();
      if (!text || seen == changes_ || state_.empty()) return text;
      seen = changes_;
      const std::string state = silent_ ? R"({"silent":true})" : state_;
      return *text + "event: control\ndata: " + state + "\n\n";
    };
  };
  return content;
}

}  // namespace ergocast::cli
