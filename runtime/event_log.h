// Messages as they came, in LCM's log format: lcm-logplayer replays them, lcm-logplayer-gui shows them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lcm {
class LogFile;
}

namespace ergocast {

/// events-000.lcm, events-001.lcm, … in one folder, from the first number that is not taken: the
/// log that a killed process left may end amid a message.
class EventLog {
 public:
  /// A segment that has grown to this is closed and the next begun.
  static constexpr std::int64_t kSegmentBytes = 64 << 20;

  explicit EventLog(std::filesystem::path folder, std::int64_t segment_bytes = kSegmentBytes);
  ~EventLog();

  void write(std::string_view channel, std::span<const std::byte> bytes);

  /// Hands everything to the operating system. The first write error since the start, if any.
  std::optional<std::string> flush();

  /// Removes the segments that this log has begun.
  void discard();

 private:
  std::filesystem::path segment_file(int segment) const;
  void open_next();
  void fail();

  std::filesystem::path folder_, file_;
  std::int64_t segment_bytes_, written_ = 0;
  int first_segment_ = 0, segment_ = 0;
  std::unique_ptr<lcm::LogFile> log_;
  std::optional<std::string> error_;
};

}  // namespace ergocast
