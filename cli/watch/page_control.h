// SPDX-License-Identifier: BSD-3-Clause
// The page's side of control. It passes operators' requests to the process that decides, and the
// state of control to the browsers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "cli/watch/control_link.h"
#include "cli/watch/page_server.h"
#include "core/base/ids.h"

namespace ergocast::cli {

class PageControl {
 public:
  /// Limit (Page): requests of all browsers that a page passes on in a second, other than to stop
  /// at once. Beyond it: the answer is 503.
  static constexpr int kMostInASecond = 40;

  /// @param token  each request must have it
  PageControl(ControlLink link, std::string token)
      : link_(std::move(link)), token_(std::move(token)) {}

  /// Adds control to the content: requests are passed on, and each browser's events contain the
  /// state. Valid as long as this object.
  PageServer::Content joined(PageServer::Content content);
  /// Receives the newest state; call it often.
  void listen(Instant now);

 private:
  ControlLink link_;
  std::string token_, state_;
  std::uint64_t changes_ = 0;
  Instant heard_{};     // when the last state came
  bool silent_ = true;  // none has come for some seconds
  bool over_ = false;   // the mission is over
  Instant second_{};
  int passed_on_ = 0;  // since then
};

}  // namespace ergocast::cli
