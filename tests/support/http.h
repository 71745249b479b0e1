// SPDX-License-Identifier: BSD-3-Clause
// HTTP as bytes: a test also sends what no browser would.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ergocast::test {

struct HttpAnswer {
  int status = 0;  ///< 0: no answer
  std::string head, body;

  bool contains(const std::string& part) const { return head.find(part) != head.npos; }
};

/// One connection.
class HttpConnection {
 public:
  explicit HttpConnection(int port, const std::string& address = "127.0.0.1");
  ~HttpConnection();
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  bool open() const { return socket_ >= 0; }
  void send(const std::string& bytes);
  /// Reads until `enough` holds for all that came, or the other side closes.
  const std::string& read_until(const std::function<bool(const std::string&)>& enough);

 private:
  int socket_;
  std::string received_;
};

/// Sends "METHOD TARGET HTTP/1.1" with these header lines and reads the whole answer.
HttpAnswer http(int port, const std::string& method, const std::string& target,
                const std::vector<std::string>& headers, const std::string& body = "",
                const std::string& address = "127.0.0.1");

/// GET as a browser on this host sends it.
HttpAnswer get(int port, const std::string& target, std::vector<std::string> more = {});

}  // namespace ergocast::test
