// SPDX-License-Identifier: BSD-3-Clause
// Orders by UDP to a mock vehicle, which answers each with its state as JSON.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/process/support/waiting.h"

namespace ergocast::test {

class OrderSocket {
 public:
  /// @param prefix  begins each order
  explicit OrderSocket(int port, std::string prefix = "")
      : socket_(::socket(AF_INET, SOCK_DGRAM, 0)), prefix_(std::move(prefix)) {
    const sockaddr_in to{
        AF_INET, htons(static_cast<in_port_t>(port)), {htonl(INADDR_LOOPBACK)}, {}};
    connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  OrderSocket(const OrderSocket&) = delete;
  OrderSocket& operator=(const OrderSocket&) = delete;
  ~OrderSocket() { close(socket_); }

  /// The vehicle's state after the order. An order or an answer may be lost, or late.
  nlohmann::json orders(const std::string& order) const {
    const std::string text = prefix_ + order + " #" + std::to_string(++orders_);
    nlohmann::json state;
    EXPECT_TRUE(eventually([&] {
      send(socket_, text.data(), text.size(), 0);
      for (pollfd ready{socket_, POLLIN, 0}; poll(&ready, 1, 2000) > 0;) {
        std::array<char, 4096> in;
        const auto size = recv(socket_, in.data(), in.size(), 0);
        if (size <= 0) return false;  // the mock does not listen yet
        state = nlohmann::json::parse(in.data(), in.data() + size);
        if (state["order"] == text) return true;
      }
      return false;
    })) << order;
    return state;
  }
  nlohmann::json state() const { return orders("state"); }
  bool sees(const std::function<bool(const nlohmann::json&)>& condition) const {
    return eventually([&] { return condition(state()); });
  }

 private:
  int socket_;
  std::string prefix_;
  mutable int orders_ = 0;
};

}  // namespace ergocast::test
