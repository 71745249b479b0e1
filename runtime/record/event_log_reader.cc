// SPDX-License-Identifier: BSD-3-Clause
// Checks the first word and the lengths of each event before it reads the event.
#include "runtime/record/event_log_reader.h"

#include <array>
#include <map>
#include <span>
#include <utility>

#include "lcmtypes/message_authenticator.h"
#include "runtime/bus/lcm_datagram.h"
#include "runtime/record/event_log.h"

namespace ergocast {
namespace {

template <class Number>
Number big_endian(std::span<const std::byte> bytes) {
  std::uint64_t number = 0;
  for (const std::byte byte : bytes.first(sizeof(Number))) {
    number = number << 8 | std::to_integer<std::uint64_t>(byte);
  }
  return static_cast<Number>(number);
}

bool compressed(const std::filesystem::path& file) { return file.extension() == ".zst"; }

}  // namespace

Result<EventLogReader> EventLogReader::open(const std::filesystem::path& folder) {
  std::map<int, std::filesystem::path> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const auto number = segment_number(entry.path().filename().string());
    if (!number) continue;
    const auto [at, is_new] = found.emplace(*number, entry.path());
    if (!is_new && !compressed(entry.path())) at->second = entry.path();  // both are there
  }
  if (error) return failure(folder.string() + ": " + error.message() + "; name a run directory");
  if (found.empty()) {
    return failure(
        folder.string() +
        ": has no event log (events-000.lcm …); `ergocast run` writes one, and `ergocast "
        "simulate --event-log`");
  }
  std::vector<std::filesystem::path> segments;
  int expected = found.begin()->first;
  for (auto& [number, path] : found) {
    if (number != expected++) {
      return failure(path.string() +
                     ": the segment before it is missing; copy it back, or move the " +
                     "segments on one side of the gap away");
    }
    segments.push_back(std::move(path));
  }
  return EventLogReader(std::move(segments));
}

bool EventLogReader::open_next() {
  if (next_segment_ == segments_.size()) return false;
  const auto& path = segments_[next_segment_++];
  auto opened = SegmentFile::open(path);
  if (!opened) {
    problem_ = opened.error().sentence(path);
    return false;
  }
  file_.emplace(*std::move(opened));
  return true;
}

std::string EventLogReader::place() const {
  return segments_[next_segment_ == 0 ? 0 : next_segment_ - 1].string() + ", byte " +
         std::to_string(begin_);
}

/// Goes to the next segment, unless compressed bytes are damaged.
const LoggedEvent* EventLogReader::end_segment() {
  if (file_->damaged()) return refuse("damaged");
  file_.reset();
  return next();
}

const LoggedEvent* EventLogReader::refuse(const std::string& what) {
  const std::filesystem::path& segment = segments_[next_segment_ - 1];
  const std::string bytes = std::to_string(begin_);
  std::string remedy = "`truncate -s " + bytes + "` on a copy";
  if (compressed(segment)) {
    remedy = "`zstd -dc " + segment.filename().string() + " | head -c " + bytes + " > " +
             segment.stem().string() + '`';
  }
  problem_ = place() + ": " + what + "; everything before it is sound: " + remedy + " keeps it";
  return nullptr;
}

const LoggedEvent* EventLogReader::next() {
  if (problem_ || (!file_ && !open_next())) return nullptr;
  std::array<std::byte, kEventHeaderBytes> header{};
  begin_ = file_->position();
  if (!file_->read(header.data(), header.size())) return end_segment();
  const std::span<const std::byte> bytes(header);
  if (big_endian<std::uint32_t>(bytes) != kEventSync) return refuse("no event of LCM's log format");
  event_.time_us = big_endian<std::int64_t>(bytes.subspan(12));
  const auto name = big_endian<std::uint32_t>(bytes.subspan(20));
  const auto size = big_endian<std::uint32_t>(bytes.subspan(24));
  if (name >= kMaxChannelBytes || size > kMaxDatagramBytes) {
    return refuse("an event longer than any message of Ergocast");
  }
  event_.channel.resize(name);
  event_.bytes.resize(size);
  if (file_->read(event_.channel.data(), name) && file_->read(event_.bytes.data(), size))
    return &event_;
  return end_segment();
}

}  // namespace ergocast
