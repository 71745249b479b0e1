// SPDX-License-Identifier: BSD-3-Clause
// Walks from header to header of LCM's log format, whose numbers are big-endian.
#include "runtime/event_reader.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace ergocast {
namespace {

/// Sync word, number, time, length of the channel and of the bytes.
constexpr std::size_t kHeaderBytes = 28;
constexpr std::uint64_t kSync = 0xEDA1DA01;
constexpr std::uint64_t kLongestChannel = 63;
constexpr std::uint64_t kMostBytes = 1 << 16;  // of a datagram

std::uint64_t big_endian(const char* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

/// By number: events-1000.lcm follows events-999.lcm.
std::vector<std::filesystem::path> segments_in(const std::filesystem::path& folder) {
  std::vector<std::pair<std::size_t, std::filesystem::path>> segments;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool ours = name.starts_with("events-") && name.ends_with(".lcm");
    if (ours && entry.is_regular_file(error)) segments.emplace_back(name.size(), entry.path());
  }
  std::sort(segments.begin(), segments.end());
  std::vector<std::filesystem::path> files;
  for (auto& [length, file] : segments) files.push_back(std::move(file));
  return files;
}

void read_segment(const std::filesystem::path& file, const auto& wanted, const auto& visit) {
  std::ifstream in(file, std::ios::binary);
  std::string channel;
  std::vector<char> bytes;
  for (char header[kHeaderBytes]; in.read(header, kHeaderBytes);) {
    const std::uint64_t channel_size = big_endian(header + 20, 4),
                        size = big_endian(header + 24, 4);
    if (big_endian(header, 4) != kSync || channel_size > kLongestChannel || size > kMostBytes)
      return;
    const auto time_us = static_cast<std::int64_t>(big_endian(header + 12, 8));
    channel.resize(channel_size);
    if (!in.read(channel.data(), static_cast<std::streamsize>(channel_size))) return;
    if (!wanted(std::string_view(channel), time_us)) {
      in.ignore(static_cast<std::streamsize>(size));
      continue;
    }
    bytes.resize(size);
    if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) return;
    visit(EventView{time_us, channel, std::as_bytes(std::span(bytes))});
  }
}

}  // namespace

void read_events(const std::filesystem::path& folder,
                 const std::function<bool(std::string_view channel, std::int64_t time_us)>& wanted,
                 const std::function<void(const EventView&)>& visit) {
  for (const auto& file : segments_in(folder)) read_segment(file, wanted, visit);
}

}  // namespace ergocast
