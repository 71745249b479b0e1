// SPDX-License-Identifier: BSD-3-Clause
// A blocking socket with a long patience, and answers cut at their first empty line.
#include "tests/support/http.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>

namespace ergocast::test {

HttpConnection::HttpConnection(int port, const std::string& address)
    : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, address.c_str(), &to.sin_addr);
  const timeval patience{300, 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) return;
  close(socket_);
  socket_ = -1;
}

HttpConnection::~HttpConnection() {
  if (open()) close(socket_);
}

void HttpConnection::send(const std::string& bytes) {
  for (std::size_t sent = 0; open() && sent < bytes.size();) {
    const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return;
    sent += static_cast<std::size_t>(count);
  }
}

const std::string& HttpConnection::read_until(
    const std::function<bool(const std::string&)>& enough) {
  char buffer[65536];
  while (open() && !enough(received_)) {
    const ssize_t count = recv(socket_, buffer, sizeof buffer, 0);
    if (count <= 0) break;
    received_.append(buffer, static_cast<std::size_t>(count));
  }
  return received_;
}

namespace {

/// Whether `text` has all of an answer with a Content-Length.
bool whole(const std::string& text) {
  const auto head = text.find("\r\n\r\n");
  const auto at = text.find("Content-Length:");
  if (head == text.npos || at == text.npos || at > head) return false;
  return text.size() >= head + 4 + std::strtoul(text.c_str() + at + 15, nullptr, 10);
}

}  // namespace

HttpAnswer http(int port, const std::string& method, const std::string& target,
                const std::vector<std::string>& headers, const std::string& body,
                const std::string& address) {
  HttpConnection connection(port, address);
  std::string request = method + ' ' + target + " HTTP/1.1\r\nConnection: close\r\n";
  for (const std::string& header : headers) request += header + "\r\n";
  if (!body.empty()) request += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  connection.send(request + "\r\n" + body);
  const std::string& text = connection.read_until(whole);
  const auto head = text.find("\r\n\r\n");
  if (head == text.npos || !text.starts_with("HTTP/1.1 ")) return {};
  return {std::atoi(text.c_str() + 9), text.substr(0, head), text.substr(head + 4)};
}

HttpAnswer get(int port, const std::string& target, std::vector<std::string> more) {
  more.push_back("Host: 127.0.0.1:" + std::to_string(port));
  return http(port, "GET", target, more);
}

}  // namespace ergocast::test
