// SPDX-License-Identifier: BSD-3-Clause
// The page's side of control: passes requests of operators on, and the state of control to the
// browsers. It decides nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "cli/watch/control_link.h"
#include "cli/watch/page_server.h"

namespace ergocast::cli {

class PageControl {
 public:
  /// @param token  that a request must have
  PageControl(ControlLink link, std::string token)
      : link_(std::move(link)), token_(std::move(token)) {}

  /// The content with control: requests are answered, and each browser's events have the state.
  /// Valid as long as this object.
  PageServer::Content joined(PageServer::Content content);
  /// Takes the newest state in; call it often.
  void listen();

 private:
  ControlLink link_;
  std::string token_, state_;
  std::uint64_t changes_ = 0;
};

}  // namespace ergocast::cli
