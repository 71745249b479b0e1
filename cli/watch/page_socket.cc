// SPDX-License-Identifier: BSD-3-Clause
// Binds to the first address to which the system resolves a text.
#include "cli/watch/page_socket.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <utility>

#include "runtime/process/program_options.h"

namespace ergocast::cli {
namespace {

constexpr int kWaiting = 1024;  // connections that the kernel holds for the server

std::string address_in(const PageOptions& options) {
  return options.listen.empty() ? "127.0.0.1" : options.listen;
}

/// A listening socket, or the error as errno.
Result<Socket, int> listening(const std::string& address, int port) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  wanted.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  if (getaddrinfo(address.c_str(), std::to_string(port).c_str(), &wanted, &found) != 0) {
    return failure(EADDRNOTAVAIL);
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, &freeaddrinfo);
  Socket socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK);
  const int yes = 1;  // but not SO_REUSEPORT: two servers must not share a port
  if (socket.fd() < 0 || setsockopt(socket.fd(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0 ||
      bind(socket.fd(), found->ai_addr, found->ai_addrlen) != 0 ||
      listen(socket.fd(), kWaiting) != 0) {
    return failure(errno);
  }
  return socket;
}

int port_of(int fd) {
  sockaddr_storage address{};
  socklen_t length = sizeof address;
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length);
  // Both address families store the port at the same place.
  return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

/// "[::1]" of "[::1]:80", "a.b" of "a.b:80".
std::string name_in(const std::string& host) {
  const auto bracket = host.find(']');
  return host.substr(0, host.find(':', bracket == host.npos ? 0 : bracket));
}

/// Whether the text is an address. DNS rebinding needs a name, so an address in a Host header is
/// safe.
bool is_address(const std::string& name) {
  unsigned char bytes[16];
  if (name.starts_with('[') && name.ends_with(']')) {
    return inet_pton(AF_INET6, name.substr(1, name.size() - 2).c_str(), bytes) == 1;
  }
  return inet_pton(AF_INET, name.c_str(), bytes) == 1;
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != std::ssize(bytes)) {
    throw std::runtime_error("the system gives no random numbers");
  }
  std::string text;
  for (const unsigned char byte : bytes) {
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  }
  return text;
}

bool same_secret(const std::string& a, const std::string& b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return difference == 0;
}

PageSocket::PageSocket(Socket socket, const PageOptions& options, std::string token)
    : socket_(std::move(socket)),
      address_(address_in(options)),
      token_(std::move(token)),
      port_(port_of(socket_.fd())),
      tls_(options.tls) {}

Result<PageSocket> PageSocket::open(const PageOptions& options) {
  const std::string address = address_in(options);
  auto opened = listening(address, options.port > 0 ? options.port : kUsualPort);
  if (options.port == 0 && !opened) opened = listening(address, 0);
  if (opened) {
    return PageSocket(*std::move(opened), options, options.listen.empty() ? "" : random_token());
  }
  if (options.port > 0 && opened.error() != EADDRNOTAVAIL) {
    return failure("port " + std::to_string(options.port) + " of " + address +
                   " is not free; choose another with " + options.port_option);
  }
  return failure("cannot listen on " + address + ": is it an address of this host?");
}

Result<PageSocket> PageSocket::inherited(int fd, const PageOptions& options, std::string token) {
  int listens = 0;
  socklen_t length = sizeof listens;
  const bool there = getsockopt(fd, SOL_SOCKET, SO_ACCEPTCONN, &listens, &length) == 0;
  if (!there || listens == 0) return failure("no page's socket was handed over");
  if (!options.listen.empty() && token.empty()) {
    return failure("no page's token was handed over");
  }
  return PageSocket(Socket(fd), options, std::move(token));
}

std::string PageSocket::url() const {
  const bool anywhere = address_ == "0.0.0.0" || address_ == "::";
  std::string host = anywhere ? host_name() : address_;
  if (host.find(':') != host.npos) host = '[' + host + ']';
  const std::string base = origin(host + ':' + std::to_string(port_)) + '/';
  return token_.empty() ? base : base + "?token=" + token_;
}

std::string PageSocket::origin(const std::string& host) const {
  return (encrypted() ? "https://" : "http://") + host;
}

std::unique_ptr<ByteStream> PageSocket::stream(Socket accepted) const {
  return encrypted() ? tls_->open(std::move(accepted)) : plain_stream(std::move(accepted));
}

bool PageSocket::is_called(const std::string& host) const {
  const std::string name = name_in(host), port = host.substr(name.size());
  const int usual = encrypted() ? 443 : 80;
  if (port != ':' + std::to_string(port_) && !(port.empty() && port_ == usual)) return false;
  if (token_.empty()) return name == "127.0.0.1" || name == "localhost";
  return name == "localhost" || name == address_ || name == host_name() || is_address(name);
}

}  // namespace ergocast::cli
