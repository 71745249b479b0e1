// SPDX-License-Identifier: BSD-3-Clause
// Serves a page to browsers. It answers GET only, and nothing that it gets has any other effect.
//
// Against other pages in the same browser: a Host header that is not ours is refused (DNS
// rebinding), so are requests that other origins make; no answer allows another origin to read it.
// Beyond this host a token is needed, which becomes a cookie that no script reads and no other site
// sends.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace ergocast::cli {

/// Makes the calling thread one that the team's processes are always preferred to.
void lower_priority();

class PageServer {
 public:
  /// More browsers get 503.
  static constexpr int kMostStreams = 16;
  /// Taken if it is free and no other is asked for.
  static constexpr int kUsualPort = 8765;

  struct Options {
    std::string listen;  ///< an address of this host; empty: 127.0.0.1, without a token
    int port = 0;        ///< 0: kUsualPort, or any
  };

  /// The next text of an event stream, empty if there is nothing new; nothing at its end.
  using Stream = std::function<std::optional<std::string>()>;

  /// Called by several threads at once, none of which may be kept waiting for long.
  struct Content {
    std::function<std::string()> page;
    std::string policy;  ///< the header Content-Security-Policy
    /// JSON of the record; nothing as long as there is none.
    std::function<std::optional<std::string>()> record;
    /// One for each browser; none: there are no events.
    std::function<Stream()> events;
  };

  /// Begins to serve. An error tells why it cannot.
  static std::variant<std::unique_ptr<PageServer>, std::string> start(const Options& options,
                                                                      Content content);
  virtual ~PageServer() = default;

  /// What a person opens, with the token if there is one.
  virtual std::string url() const = 0;
};

}  // namespace ergocast::cli
