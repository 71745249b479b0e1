// SPDX-License-Identifier: BSD-3-Clause
// Certificates and clients for tests of a page over TLS.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/http.h"

namespace ergocast::test {

/// A certificate that signs itself, NAME.pem, and its key, NAME.key, which only this user may read.
/// @param valid_s  from when to when, in seconds after now
std::pair<std::filesystem::path, std::filesystem::path> make_certificate(
    const std::filesystem::path& folder, const std::string& name,
    std::pair<long, long> valid_s = {-3600, 3600});

/// A client that trusts every certificate.
class HttpsConnection {
 public:
  /// @param most  the highest version of TLS that it offers, such as 0x0302 for 1.1; 0: all
  explicit HttpsConnection(int port, const std::string& address = "127.0.0.1", int most = 0);
  ~HttpsConnection();
  HttpsConnection(const HttpsConnection&) = delete;
  HttpsConnection& operator=(const HttpsConnection&) = delete;

  /// Whether the handshake has succeeded.
  bool open() const;
  void send(const std::string& bytes);
  /// Reads until `enough` holds for all that came, or the other side ends.
  const std::string& read_until(const std::function<bool(const std::string&)>& enough);
  /// Whether the other side has said that it has sent all, rather than just closed.
  bool ended_in_order() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// As http() in tests/support/http.h.
HttpAnswer https(int port, const std::string& method, const std::string& target,
                 const std::vector<std::string>& headers, const std::string& address = "127.0.0.1");

}  // namespace ergocast::test
