// SPDX-License-Identifier: BSD-3-Clause
// Serves a page to browsers. It answers GET only, and nothing that it gets has any other effect.
//
// Against other pages in the same browser: a Host header that is not ours is refused (DNS
// rebinding), so are requests that other origins make; no answer allows another origin to read it.
// Beyond this host a token is needed, which becomes a cookie that no script reads and no other site
// sends. Against clients that send or take nothing, or too much: cli/connections.h.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "cli/connections.h"
#include "cli/page_socket.h"
#include "core/ids.h"

namespace ergocast::cli {

class PageServer {
 public:
  struct Content {
    std::function<Connections::Text()> page;
    std::string policy;  ///< the header Content-Security-Policy
    /// JSON of the record; null as long as there is none.
    std::function<Connections::Text()> record;
    /// One for each browser; none: there are no events.
    std::function<Connections::Stream()> events;
  };

  /// @param socket  whose connections it takes
  static std::unique_ptr<PageServer> make(PageSocket socket, Content content);
  virtual ~PageServer() = default;

  /// Those of Connections.
  virtual int fd() const = 0;
  virtual void serve(Instant now) = 0;
};

}  // namespace ergocast::cli
