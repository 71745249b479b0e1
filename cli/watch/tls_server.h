// SPDX-License-Identifier: BSD-3-Clause
// TLS for a page, with a certificate and a key that the user names.
//
// Only TLS 1.2 and 1.3, and only ciphers that protect a recorded connection if the key becomes
// known later. A client cannot renegotiate, nor resume a session, so the server keeps nothing of a
// connection that has ended.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "cli/watch/byte_stream.h"
#include "core/base/result.h"
#include "runtime/bus/socket.h"

namespace ergocast::cli {

/// Files in PEM format.
struct TlsFiles {
  std::filesystem::path certificate;  ///< the server's, then those that lead to its root
  std::filesystem::path key;
};

class TlsServer {
 public:
  /// Reads both files. An error names the file and the remedy: one cannot be read, is not in PEM
  /// format, is of a sort that OpenSSL does not accept, or the key is of another certificate or
  /// open to other users.
  static Result<std::shared_ptr<const TlsServer>> read(const TlsFiles& files);
  virtual ~TlsServer() = default;

  /// Why browsers would refuse the certificate at that time: not valid yet, or no longer.
  virtual std::optional<std::string> why_not_valid(
      std::chrono::system_clock::time_point at) const = 0;
  /// The stream of a new connection, which begins with a handshake.
  /// @param socket  non-blocking
  virtual std::unique_ptr<ByteStream> open(Socket socket) const = 0;
  /// The texts of the files.
  virtual const std::string& certificate() const = 0;
  virtual const std::string& key() const = 0;
};

}  // namespace ergocast::cli
