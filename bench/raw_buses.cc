#include "bench/raw_buses.h"

#include <poll.h>

#include <cstring>
#include <lcm/lcm-cpp.hpp>

#include "core/require.h"

namespace ergocast::bench {

struct RawBuses::Line {
  Bus bus;
  lcm::LCM* lcm;
  const Handler* handler;
  void on_datagram(const lcm::ReceiveBuffer* buffer, const std::string&) {
    Stamp stamp;
    std::memcpy(&stamp, buffer->data, sizeof stamp);
    (*handler)(bus, stamp);
  }
};

RawBuses::RawBuses(const LcmUrl& url, const std::vector<std::pair<Bus, std::string>>& listening,
                   Handler handler)
    : handler_(std::move(handler)) {
  for (int bus = 0; bus < kBusCount; ++bus) {
    buses_.push_back(std::make_unique<lcm::LCM>(url.of(static_cast<Bus>(bus))));
    ERGOCAST_REQUIRE(buses_.back()->good());
  }
  for (const auto& [bus, channels] : listening) {
    lcm::LCM* lcm = buses_[static_cast<std::size_t>(bus)].get();
    lines_.push_back(std::make_unique<Line>(Line{bus, lcm, &handler_}));
    lcm->subscribe(channels, &Line::on_datagram, lines_.back().get())->setQueueCapacity(0);
  }
}

RawBuses::~RawBuses() = default;

void RawBuses::publish(Bus bus, const std::string& channel, const Stamp& stamp,
                       std::size_t bytes) {
  std::byte datagram[2048] = {};
  ERGOCAST_REQUIRE(bytes >= sizeof stamp && bytes <= sizeof datagram);
  std::memcpy(datagram, &stamp, sizeof stamp);
  buses_[static_cast<std::size_t>(bus)]->publish(channel, datagram, static_cast<unsigned>(bytes));
}

bool RawBuses::wait(int timeout_ms) {
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

}  // namespace ergocast::bench
