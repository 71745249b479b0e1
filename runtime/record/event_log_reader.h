// SPDX-License-Identifier: BSD-3-Clause
// Reads the event log of a run directory, segment by segment.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "runtime/record/segment_file.h"

namespace ergocast {

/// A logged message. The bytes may be anything.
struct LoggedEvent {
  std::int64_t time_us = 0;
  std::string channel;
  std::vector<std::byte> bytes;
};

class EventLogReader {
 public:
  /// Finds the segments, also compressed ones. An error if there is none, or if one is missing in
  /// between.
  static Result<EventLogReader> open(const std::filesystem::path& folder);

  /// The next event, valid until the next call; null at the end and after a problem. An incomplete
  /// event at a segment's end comes from a killed logger and is left out.
  const LoggedEvent* next();

  /// The problem that ended the reading early: file, byte and remedy.
  const std::optional<std::string>& problem() const { return problem_; }
  /// "FILE, byte N": where the last event begins.
  std::string place() const;

 private:
  explicit EventLogReader(std::vector<std::filesystem::path> segments)
      : segments_(std::move(segments)) {}
  bool open_next();
  const LoggedEvent* end_segment();
  const LoggedEvent* refuse(const std::string& what);

  std::vector<std::filesystem::path> segments_;
  std::size_t next_segment_ = 0;
  std::optional<SegmentFile> file_;
  std::uint64_t begin_ = 0;
  LoggedEvent event_;
  std::optional<std::string> problem_;
};

}  // namespace ergocast
