// SPDX-License-Identifier: BSD-3-Clause
// Reads what EventLog has written, without liblcm.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

namespace ergocast {

struct EventView {
  std::int64_t time_us = 0;  ///< wall time of the logger
  std::string_view channel;
  std::span<const std::byte> bytes;  ///< valid during the call
};

/// Visits the events of events-000.lcm, events-001.lcm … in the folder, in their order. The bytes
/// of channels that `wanted` turns down are not read. A segment ends at its first damaged or
/// incomplete event.
void read_events(const std::filesystem::path& folder,
                 const std::function<bool(std::string_view channel, std::int64_t time_us)>& wanted,
                 const std::function<void(const EventView&)>& visit);

}  // namespace ergocast
