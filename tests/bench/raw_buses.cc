// SPDX-License-Identifier: BSD-3-Clause
// Implements the same three buses twice, over liblcm and over UDP system calls.
#include "tests/bench/raw_buses.h"

#include <poll.h>

#include <array>
#include <cstring>
#include <lcm/lcm-cpp.hpp>

#include "cli/doctor/group_listener.h"
#include "core/base/require.h"

namespace ergocast::bench {
namespace {

constexpr std::size_t kMostBytes = 2048;

class LcmBuses final : public RawBuses {
 public:
  LcmBuses(const LcmUrl& url, const std::vector<Bus>& listening, Handler handler)
      : handler_(std::move(handler)) {
    for (int bus = 0; bus < kBusCount; ++bus) {
      buses_.push_back(std::make_unique<lcm::LCM>(url.of(static_cast<Bus>(bus))));
      ERGOCAST_REQUIRE(buses_.back()->good());
    }
    for (const Bus bus : listening) {
      lcm::LCM* lcm = buses_[static_cast<std::size_t>(bus)].get();
      lines_.push_back(std::make_unique<Line>(Line{bus, lcm, &handler_}));
      lcm->subscribe(".*", &Line::on_datagram, lines_.back().get())->setQueueCapacity(0);
    }
  }

  void publish(Bus bus, const std::string& channel, const Stamp& stamp,
               std::size_t bytes) override {
    std::byte datagram[kMostBytes] = {};
    ERGOCAST_REQUIRE(bytes >= sizeof stamp && bytes <= sizeof datagram);
    std::memcpy(datagram, &stamp, sizeof stamp);
    buses_[static_cast<std::size_t>(bus)]->publish(channel, datagram, static_cast<unsigned>(bytes));
  }

  bool wait(int timeout_ms) override {
    std::vector<pollfd> ready;
    for (const auto& line : lines_) ready.push_back({line->lcm->getFileno(), POLLIN, 0});
    if (poll(ready.data(), ready.size(), timeout_ms) <= 0) return false;
    for (std::size_t i = 0; i < ready.size(); ++i) {
      if ((ready[i].revents & POLLIN) == 0) continue;
      while (lines_[i]->lcm->handleTimeout(0) > 0) {
      }
    }
    return true;
  }

 private:
  struct Line {
    Bus bus;
    lcm::LCM* lcm;
    const Handler* handler;
    void on_datagram(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
      if (channel == "LCM_SELF_TEST") return;  // every liblcm sends it when it starts
      Stamp stamp;
      std::memcpy(&stamp, buffer->data, sizeof stamp);
      (*handler)(bus, stamp);
    }
  };
  Handler handler_;
  std::vector<std::unique_ptr<lcm::LCM>> buses_;
  std::vector<std::unique_ptr<Line>> lines_;  // the buses we listen to
};

class UdpBuses final : public RawBuses {
 public:
  UdpBuses(const LcmUrl& url, const std::vector<Bus>& listening, Handler handler)
      : handler_(std::move(handler)), mouth_(AF_INET, SOCK_DGRAM), listening_(listening) {
    for (int bus = 0; bus < kBusCount; ++bus)
      to_.push_back(address_of(url.group, url.base_port + bus));
    for (const Bus bus : listening) {
      std::string error;
      ears_.push_back(
          doctor::group_listener(url.group, url.base_port + static_cast<int>(bus), error));
      ERGOCAST_REQUIRE(error.empty());
      ready_.push_back({ears_.back().fd(), POLLIN, 0});
    }
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      parts_[i] = {space_[i].data(), space_[i].size()};
      headers_[i] = {};
      headers_[i].msg_hdr.msg_iov = &parts_[i];
      headers_[i].msg_hdr.msg_iovlen = 1;
    }
  }

  void publish(Bus bus, const std::string& channel, const Stamp& stamp,
               std::size_t bytes) override {
    constexpr std::size_t kLcmHeaderBytes = 8;
    std::byte datagram[kMostBytes] = {};
    const std::size_t size = kLcmHeaderBytes + channel.size() + 1 + bytes;
    ERGOCAST_REQUIRE(bytes >= sizeof stamp && size <= sizeof datagram);
    std::memcpy(datagram, &stamp, sizeof stamp);
    const sockaddr_in& to = to_[static_cast<std::size_t>(bus)];
    sendto(mouth_.fd(), datagram, size, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

  bool wait(int timeout_ms) override {
    if (poll(ready_.data(), ready_.size(), timeout_ms) <= 0) return false;
    for (std::size_t i = 0; i < ready_.size(); ++i) {
      if ((ready_[i].revents & POLLIN) != 0) handle_all(i);
    }
    return true;
  }

 private:
  static constexpr std::size_t kAtOnce = 16;

  void handle_all(std::size_t ear) {
    int count = 0;
    do {
      count = recvmmsg(ready_[ear].fd, headers_.data(), kAtOnce, MSG_DONTWAIT, nullptr);
      for (int i = 0; i < count; ++i) {
        Stamp stamp;
        std::memcpy(&stamp, space_[static_cast<std::size_t>(i)].data(), sizeof stamp);
        handler_(listening_[ear], stamp);
      }
    } while (count == static_cast<int>(kAtOnce));
  }

  Handler handler_;
  Socket mouth_;
  std::vector<Bus> listening_;
  std::vector<Socket> ears_;
  std::vector<sockaddr_in> to_;
  std::vector<pollfd> ready_;
  std::array<std::array<std::byte, kMostBytes>, kAtOnce> space_;
  std::array<iovec, kAtOnce> parts_;
  std::array<mmsghdr, kAtOnce> headers_;
};

}  // namespace

std::unique_ptr<RawBuses> RawBuses::open(Carrier carrier, const LcmUrl& url,
                                         const std::vector<Bus>& listening, Handler handler) {
  if (carrier == Carrier::kLcm)
    return std::make_unique<LcmBuses>(url, listening, std::move(handler));
  return std::make_unique<UdpBuses>(url, listening, std::move(handler));
}

}  // namespace ergocast::bench
