// SPDX-License-Identifier: BSD-3-Clause
// Serves a page to browsers. It answers only GET, and a request has no other effect.
//
// Protection against other pages in the same browser: a foreign Host header is refused (DNS
// rebinding). Requests of other origins are refused, and no answer allows another origin to read
// it. Other hosts need a token, which becomes a cookie that no script reads and no other site
// sends. cli/watch/connections.h protects against clients that are too slow or send too much.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "cli/watch/connections.h"
#include "cli/watch/page_socket.h"
#include "core/base/ids.h"

namespace ergocast::cli {

class PageServer {
 public:
  struct Content {
    std::function<Connections::Text()> page;
    std::string policy;  ///< the header Content-Security-Policy
    /// JSON of the record; null while there is none.
    std::function<Connections::Text()> record;
    /// Makes the event stream of one browser; null: there are no events.
    std::function<Connections::Stream()> events;
  };

  /// @param socket  accepts the connections
  static std::unique_ptr<PageServer> make(PageSocket socket, Content content);
  virtual ~PageServer() = default;

  /// Same as in Connections.
  virtual int fd() const = 0;
  virtual void serve(Instant now) = 0;
};

}  // namespace ergocast::cli
