// SPDX-License-Identifier: BSD-3-Clause
// Starts a new segment at a size limit, removes the oldest beyond the total, and cuts an incomplete
// event off.
#include "runtime/record/event_log.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>
#include <string_view>

#include "text/read_number.h"

namespace ergocast {
namespace {

/// Our segments have lower numbers; a foreign file with a higher number leaves enough of them free.
constexpr int kFirstForeignNumber = 1'000'000'000;
/// More bytes than the C library buffers before it writes.
constexpr std::int64_t kUnwrittenBytes = 1 << 17;
/// The bytes to compress for each byte written, and for each flush(). So a finished segment is
/// compressed while half of the next one is written.
constexpr std::int64_t kCompressedPerByte = 2, kCompressedPerFlush = 1 << 20;
constexpr std::string_view kCompressed = ".zst";

std::int64_t wall_clock_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

/// Writes numbers big-endian, one after the other.
class HeaderBytes {
 public:
  template <class Number>
  void add(Number number) {
    for (int shift = 8 * static_cast<int>(sizeof number) - 8; shift >= 0; shift -= 8) {
      bytes_[size_++] = static_cast<std::byte>(static_cast<std::uint64_t>(number) >> shift);
    }
  }
  std::span<const std::byte> bytes() const { return std::span(bytes_).first(size_); }

 private:
  std::array<std::byte, kEventHeaderBytes> bytes_{};
  std::size_t size_ = 0;
};

bool put(std::FILE* file, std::span<const std::byte> bytes) {
  return std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
}

/// Sizes of the segments in a folder, by number; compressed ones are segments, too.
std::map<int, std::int64_t> segments_in(const std::filesystem::path& folder) {
  std::map<int, std::int64_t> segments;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::optional<int> number = segment_number(entry.path().filename().string());
    if (!number) continue;
    const auto bytes = entry.file_size(error);
    segments[*number] += error ? 0 : static_cast<std::int64_t>(bytes);
  }
  return segments;
}

bool remove_segment(const std::filesystem::path& file) {
  std::error_code error;
  const bool whole = std::filesystem::remove(file, error);
  return std::filesystem::remove(file.string() + std::string(kCompressed), error) || whole;
}

}  // namespace

std::optional<int> segment_number(std::string_view file) {
  constexpr std::string_view kBefore = "events-", kAfter = ".lcm";
  if (file.ends_with(kCompressed)) file.remove_suffix(kCompressed.size());
  if (!file.starts_with(kBefore) || !file.ends_with(kAfter)) return std::nullopt;
  file.remove_prefix(kBefore.size());
  file.remove_suffix(kAfter.size());
  const auto number = read_number<int>(file);
  return number >= 0 && number < kFirstForeignNumber ? number : std::nullopt;
}

EventLog::EventLog(std::filesystem::path folder, EventLogLimits limits)
    : folder_(std::move(folder)), limits_(limits) {
  const auto there = segments_in(folder_);
  if (limits_.compressed) {
    compressor_.emplace();
    for (const auto& [number, bytes] : there) compressor_->add(segment_file(number));
  }
  if (!there.empty()) first_segment_ = there.rbegin()->first + 1;
  std::error_code ignored;
  while (std::filesystem::exists(segment_file(first_segment_), ignored)) ++first_segment_;
  segment_ = first_segment_;
  open_next();
}

EventLog::~EventLog() {
  while (compressor_ && !compressor_->idle()) compressor_->work(kCompressedPerFlush);
}

void EventLog::fail() {
  if (error_) return;
  error_ = file_.string() + ": " + std::strerror(errno);
  log_.reset();
  // Removes an incomplete event.
  std::error_code ignored;
  const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(file_, ignored));
  while (!ends_.empty() && ends_.back() > bytes) ends_.pop_back();
  if (!ends_.empty()) {
    std::filesystem::resize_file(file_, static_cast<std::uintmax_t>(ends_.back()), ignored);
  } else if (std::filesystem::remove(file_, ignored)) {
    --segment_;
  }
}

std::filesystem::path EventLog::segment_file(int segment) const {
  char name[32];
  std::snprintf(name, sizeof name, "events-%03d.lcm", segment);
  return folder_ / name;
}

void EventLog::open_next() {
  error_.reset();
  log_.reset();
  make_room();
  written_ = 0;
  ends_.clear();
  file_ = segment_file(segment_++);
  number_ = 0;
  log_.reset(std::fopen(file_.c_str(), "wb"));
  if (!log_) fail();
}

/// Removes old segments until a new one has room.
void EventLog::make_room() {
  auto there = segments_in(folder_);
  std::int64_t total = 0;
  for (const auto& [number, bytes] : there) total += bytes;
  while (!there.empty() && total + limits_.segment_bytes > limits_.total_bytes) {
    if (!remove_segment(segment_file(there.begin()->first))) return;
    total -= there.begin()->second;
    there.erase(there.begin());
    ++removed_;
  }
}

void EventLog::write(std::string_view channel, std::span<const std::byte> bytes) {
  write(channel, bytes, wall_clock_us());
}

void EventLog::write(std::string_view channel, std::span<const std::byte> bytes,
                     std::int64_t time_us) {
  if (error_) return;
  if (written_ >= limits_.segment_bytes) {
    if (std::fflush(log_.get()) != 0) return fail();
    log_.reset();
    if (compressor_) compressor_->add(file_);
    open_next();
    if (error_) return;
  }
  HeaderBytes header;
  header.add(kEventSync);
  header.add(number_++);
  header.add(time_us);
  header.add(static_cast<std::uint32_t>(channel.size()));
  header.add(static_cast<std::uint32_t>(bytes.size()));
  const auto name = std::as_bytes(std::span(channel));
  if (!put(log_.get(), header.bytes()) || !put(log_.get(), name) || !put(log_.get(), bytes)) {
    return fail();
  }
  const auto size = static_cast<std::int64_t>(kEventHeaderBytes + channel.size() + bytes.size());
  written_ += size;
  if (compressor_) compressor_->work(kCompressedPerByte * size);
  ends_.push_back(written_);
  while (ends_.front() < written_ - kUnwrittenBytes) ends_.pop_front();
}

std::optional<std::string> EventLog::flush() {
  if (error_ && error_reported_) open_next();
  if (compressor_) compressor_->work(kCompressedPerFlush);
  if (!error_ && std::fflush(log_.get()) != 0) fail();
  error_reported_ = error_.has_value();
  return error_;
}

void EventLog::discard() {
  compressor_.reset();
  for (int segment = first_segment_; segment < segment_; ++segment) {
    remove_segment(segment_file(segment));
  }
}

}  // namespace ergocast
