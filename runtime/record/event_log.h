// SPDX-License-Identifier: BSD-3-Clause
// Received messages in LCM's log format: lcm-logplayer replays them, lcm-logplayer-gui shows them.
#pragma once

#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/record/segment_compressor.h"

namespace ergocast {

/// An event of LCM's log format begins with this word. Its number and time stamp [µs] follow in 64
/// bits, then the lengths of channel and message in 32; all big-endian.
inline constexpr std::uint32_t kEventSync = 0xEDA1DA01;
inline constexpr std::size_t kEventHeaderBytes = 28;

/// Limit (Record): length of the event log, unless `--event-log-limit` sets it [MiB]. Beyond it:
/// the oldest segment is removed and counted.
inline constexpr std::int64_t kEventLogMib = 4096;

/// Limit (Record): length of a segment of the event log [bytes]. Beyond it: the next segment
/// begins.
inline constexpr std::int64_t kEventSegmentBytes = 64 << 20;

struct EventLogLimits {
  std::int64_t segment_bytes =
      kEventSegmentBytes;  ///< at this size a segment ends and the next begins
  std::int64_t total_bytes = kEventLogMib << 20;  ///< of all segments; the oldest are removed first
  bool compressed = false;  ///< finished segments become events-….lcm.zst, also older ones
};

/// Writes events-000.lcm, events-001.lcm, … in one folder, after the highest existing number. It
/// never continues a file, because the log of a killed process may end within a message.
class EventLog {
 public:
  explicit EventLog(std::filesystem::path folder, EventLogLimits limits = {});
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;
  /// Compresses the finished segments that are not compressed yet, if the limits ask for it.
  ~EventLog();

  /// Appends a message, at the wall clock's time; discards it while the log cannot be written.
  void write(std::string_view channel, std::span<const std::byte> bytes);
  /// Appends a message at the caller's time [µs since 1970].
  void write(std::string_view channel, std::span<const std::byte> bytes, std::int64_t time_us);

  /// Passes all data to the operating system. Returns the write error since the last call, if any.
  /// The segment then ends with its last whole event, and the next call begins a new segment.
  std::optional<std::string> flush();

  /// Segments removed because of the limit.
  int removed() const { return removed_; }

  /// Removes the segments that this log has begun.
  void discard();

 private:
  std::filesystem::path segment_file(int segment) const;
  void open_next();
  void make_room();
  void fail();

  std::filesystem::path folder_, file_;
  EventLogLimits limits_;
  std::int64_t written_ = 0;       // bytes of the current segment
  std::deque<std::int64_t> ends_;  // of its last events
  int first_segment_ = 0, segment_ = 0, removed_ = 0;
  std::int64_t number_ = 0;  // of the next event of the segment
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> log_{nullptr, &std::fclose};
  std::optional<SegmentCompressor> compressor_;  // if segments are to be compressed
  std::optional<std::string> error_;
  bool error_reported_ = false;  // the caller has received the error
};

/// The number of a segment's file, or nothing for other names.
std::optional<int> segment_number(std::string_view file);

}  // namespace ergocast
