// SPDX-License-Identifier: BSD-3-Clause
// Sockets and devices that never block.
#include "bridges/mavlink/link.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <utility>

namespace ergocast::mavlink {
namespace {

using namespace std::chrono_literals;

constexpr auto kRetry = 1s;
/// A udpin link answers another address once the last one has been silent for so long.
constexpr auto kPeerSilent = 3s;
/// How many datagrams of others are skipped in one turn, so that a flood stops no setpoint.
constexpr int kMostStrangers = 64;
/// A frame is left out while more bytes wait to be sent: a setpoint that arrives late is an old
/// one. For tcp; a serial line holds what it sends in 0.1 s.
constexpr int kMostQueuedBytes = 512;
/// A connection ends if what was sent is not acknowledged for so long [ms].
constexpr unsigned kUnacknowledged_ms = 3000;

class Fd {
 public:
  explicit Fd(int fd = -1) : fd_(fd) {}
  Fd(Fd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Fd& operator=(Fd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Fd() {
    if (fd_ >= 0) close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

struct Address {
  sockaddr_storage storage{};
  socklen_t size = 0;
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  bool operator==(const Address& other) const {
    return size == other.size && std::memcmp(&storage, &other.storage, size) == 0;
  }
};

Result<Address> resolve(const std::string& host, const std::string& port, int kind) {
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_socktype = kind;
  wanted.ai_flags = host.empty() ? AI_PASSIVE : 0;
  wanted.ai_family = host.empty() ? AF_INET : AF_UNSPEC;
  const int code =
      getaddrinfo(host.empty() ? nullptr : host.c_str(), port.c_str(), &wanted, &found);
  if (code != 0) return failure(host + ":" + port + ": " + gai_strerror(code));
  Address address;
  address.size = found->ai_addrlen;
  std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
  freeaddrinfo(found);
  return address;
}

Fd new_socket(const Address& address, int kind) {
  return Fd(socket(address.storage.ss_family, kind | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

std::vector<std::byte> begin_of(const std::array<std::byte, 4096>& bytes, ssize_t size) {
  return {bytes.begin(), bytes.begin() + size};
}

class UdpLink final : public Link {
 public:
  UdpLink(Fd fd, std::optional<Address> peer) : fd_(std::move(fd)), peer_(peer), fixed_(peer) {}
  int fd() const override { return fd_.get(); }
  bool has_datagrams() const override { return true; }

  std::vector<std::byte> read(Instant now) override {
    std::array<std::byte, 4096> in;
    for (int i = 0; i < kMostStrangers; ++i) {
      Address from;
      from.size = sizeof from.storage;
      const ssize_t size = recvfrom(fd_.get(), in.data(), in.size(), 0,
                                    reinterpret_cast<sockaddr*>(&from.storage), &from.size);
      if (size < 0 && errno == ECONNREFUSED) continue;  // nobody is there yet
      if (size <= 0) return {};
      if (!fixed_ && (!peer_ || (!(*peer_ == from) && now - heard_at_ > kPeerSilent))) peer_ = from;
      if (!(*peer_ == from)) continue;
      heard_at_ = now;
      return begin_of(in, size);
    }
    return {};
  }
  void write(std::span<const std::byte> frame) override {
    if (peer_) sendto(fd_.get(), frame.data(), frame.size(), 0, peer_->get(), peer_->size);
  }

 private:
  Fd fd_;
  std::optional<Address> peer_;
  bool fixed_;
  Instant heard_at_{};
};

/// A stream that may end and be opened again.
class StreamLink : public Link {
 public:
  StreamLink(std::string name, int most_queued_bytes)
      : name_(std::move(name)), most_queued_bytes_(most_queued_bytes) {}
  int fd() const override { return fd_.get(); }
  bool has_datagrams() const override { return false; }

  std::vector<std::byte> read(Instant) override {
    std::array<std::byte, 4096> in;
    const ssize_t size = fd_.get() < 0 ? -1 : ::read(fd_.get(), in.data(), in.size());
    if (size > 0) return begin_of(in, size);
    const bool ended = size == 0 || (errno != EAGAIN && errno != EINTR);
    if (fd_.get() >= 0 && ended) fd_ = Fd();
    return {};
  }
  void write(std::span<const std::byte> frame) override {
    int queued_bytes = 0;
    if (ioctl(fd_.get(), TIOCOUTQ, &queued_bytes) == 0 && queued_bytes > most_queued_bytes_) return;
    // A frame that is cut would spoil the next one, but the reader finds the one after that.
    if (fd_.get() >= 0 && ::write(fd_.get(), frame.data(), frame.size()) < 0 && errno == EPIPE)
      fd_ = Fd();
  }
  std::string mend(Instant now) override {
    const bool up = fd_.get() >= 0;
    if (up == was_up_ && (up || now < next_try_)) return "";
    if (!up && now >= next_try_) {
      next_try_ = now + kRetry;
      fd_ = open_again();
    }
    const bool is_up = fd_.get() >= 0;
    if (is_up == std::exchange(was_up_, is_up)) return "";
    return name_ + (is_up ? " is open" : " is closed, and is opened again");
  }

 protected:
  virtual Fd open_again() = 0;

 private:
  std::string name_;
  int most_queued_bytes_;
  Fd fd_;
  bool was_up_ = false;
  Instant next_try_{};
};

class TcpLink final : public StreamLink {
 public:
  TcpLink(const std::string& name, const Address& to)
      : StreamLink(name, kMostQueuedBytes), to_(to) {}

 private:
  Fd open_again() override {
    Fd fd = new_socket(to_, SOCK_STREAM);
    const int yes = 1;
    setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    setsockopt(fd.get(), IPPROTO_TCP, TCP_USER_TIMEOUT, &kUnacknowledged_ms,
               sizeof kUnacknowledged_ms);
    const bool begun =
        fd.get() >= 0 && (connect(fd.get(), to_.get(), to_.size) == 0 || errno == EINPROGRESS);
    return begun ? std::move(fd) : Fd();
  }
  Address to_;
};

std::optional<speed_t> speed_of(int baud) {
  constexpr std::pair<int, speed_t> kSpeeds[] = {
      {9600, B9600},      {19200, B19200},     {38400, B38400},     {57600, B57600},
      {115200, B115200},  {230400, B230400},   {460800, B460800},   {500000, B500000},
      {921600, B921600},  {1000000, B1000000}, {1500000, B1500000}, {2000000, B2000000},
      {3000000, B3000000}};
  for (const auto& [number, speed] : kSpeeds) {
    if (number == baud) return speed;
  }
  return std::nullopt;
}

class SerialLink final : public StreamLink {
 public:
  SerialLink(const std::string& device, int baud, speed_t speed)
      : StreamLink(device, baud / 100), device_(device), speed_(speed) {}

 private:
  Fd open_again() override {
    Fd fd(::open(device_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    termios line{};
    if (fd.get() < 0 || tcgetattr(fd.get(), &line) != 0) return Fd();
    ioctl(fd.get(), TIOCEXCL);  // two programs on one line would take each other's bytes
    cfmakeraw(&line);
    line.c_cflag |= CLOCAL | CREAD;
    line.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS);
    cfsetispeed(&line, speed_);
    cfsetospeed(&line, speed_);
    return tcsetattr(fd.get(), TCSANOW, &line) == 0 ? std::move(fd) : Fd();
  }
  std::string device_;
  speed_t speed_;
};

Result<std::unique_ptr<Link>> udp_to(const std::string& host, const std::string& port) {
  const auto to = resolve(host, port, SOCK_DGRAM);
  if (!to) return failure(to.error());
  Fd fd = new_socket(*to, SOCK_DGRAM);
  if (fd.get() < 0) return failure("udp:" + host + ":" + port + ": " + std::strerror(errno));
  return std::make_unique<UdpLink>(std::move(fd), *to);
}

Result<std::unique_ptr<Link>> udp_at(const std::string& host, const std::string& port) {
  const auto here = resolve(host, port, SOCK_DGRAM);
  if (!here) return failure(here.error());
  Fd fd = new_socket(*here, SOCK_DGRAM);
  if (fd.get() < 0 || bind(fd.get(), here->get(), here->size) != 0)
    return failure("udpin:" + host + ":" + port + ": " + std::strerror(errno));
  return std::make_unique<UdpLink>(std::move(fd), std::nullopt);
}

}  // namespace

Result<std::unique_ptr<Link>> Link::open(std::string_view text) {
  const auto wrong = failure("'" + std::string(text) +
                             "' is no link: udp:HOST:PORT, udpin:PORT, tcp:HOST:PORT or "
                             "serial:DEVICE:BAUD");
  const auto first = text.find(':'), last = text.rfind(':');
  if (first == text.npos) return wrong;
  const std::string kind(text.substr(0, first)), number(text.substr(last + 1));
  const std::string middle(first == last ? "" : text.substr(first + 1, last - first - 1));
  int value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size() || value <= 0) return wrong;
  if (kind == "serial") {
    const auto speed = speed_of(value);
    if (middle.empty()) return wrong;
    if (!speed) return failure("serial: " + number + " is no usual rate, such as 57600 or 921600");
    return std::make_unique<SerialLink>(middle, value, *speed);
  }
  if (value > 65535) return wrong;
  if (kind == "udpin") return udp_at(middle, number);
  if (middle.empty()) return wrong;
  if (kind == "udp") return udp_to(middle, number);
  if (kind != "tcp") return wrong;
  const auto to = resolve(middle, number, SOCK_STREAM);
  if (!to) return failure(to.error());
  return std::make_unique<TcpLink>(std::string(text), *to);
}

}  // namespace ergocast::mavlink
