// SPDX-License-Identifier: BSD-3-Clause
// Serves a page to browsers. It answers GET, and such a request has no other effect. A page with
// control also answers POST to /control.
//
// Protection against other pages in the same browser: a foreign Host header is refused (DNS
// rebinding). Requests of other origins are refused, and no answer allows another origin to read
// it. Other hosts need a token, which becomes a cookie that no script reads and no other site
// sends. A POST needs the page's own origin and the control token in a header, which no foreign
// page can set. cli/watch/connections.h protects against clients that are too slow or send too
// much.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/watch/connections.h"
#include "cli/watch/control_request.h"
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
    /// Takes a request of an operator (cli/watch/control_request.h); false if it cannot be passed
    /// on now. Null: the page only shows.
    std::function<bool(const ControlRequest&, const std::string& text)> control = {};
    std::string control_token = {};
  };

  /// @param socket  accepts the connections
  static std::unique_ptr<PageServer> make(PageSocket socket, Content content);
  virtual ~PageServer() = default;

  /// Same as in Connections.
  virtual int fd() const = 0;
  virtual void serve(Instant now) = 0;
  /// A name for each browser that follows the team now.
  virtual std::vector<std::string> clients() const = 0;
};

}  // namespace ergocast::cli
