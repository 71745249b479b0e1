#include "runtime/event_log.h"

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <lcm/lcm-cpp.hpp>

namespace ergocast {
namespace {

/// What LCM writes around a message: its number, time and lengths.
constexpr std::int64_t kEventHeaderBytes = 28;

std::int64_t wall_clock_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

EventLog::EventLog(std::filesystem::path folder, std::int64_t segment_bytes)
    : folder_(std::move(folder)), segment_bytes_(segment_bytes) {
  std::error_code ignored;
  while (std::filesystem::exists(segment_file(first_segment_), ignored)) ++first_segment_;
  segment_ = first_segment_;
  open_next();
}

EventLog::~EventLog() = default;

void EventLog::fail() {
  if (!error_) error_ = file_.string() + ": " + std::strerror(errno);
}

std::filesystem::path EventLog::segment_file(int segment) const {
  char name[32];
  std::snprintf(name, sizeof name, "events-%03d.lcm", segment);
  return folder_ / name;
}

void EventLog::open_next() {
  flush();
  file_ = segment_file(segment_++);
  log_ = std::make_unique<lcm::LogFile>(file_.string(), "w");
  if (!log_->good()) fail();
  written_ = 0;
}

void EventLog::write(std::string_view channel, std::span<const std::byte> bytes) {
  if (error_) return;
  if (written_ >= segment_bytes_) open_next();
  lcm::LogEvent event{};
  event.timestamp = wall_clock_us();
  event.channel = channel;
  event.datalen = static_cast<std::int32_t>(bytes.size());
  // LCM only reads it; its type is not const because the same struct serves for reading a log.
  event.data = const_cast<std::byte*>(bytes.data());
  if (!log_->good() || log_->writeEvent(&event) != 0) fail();
  written_ += kEventHeaderBytes + static_cast<std::int64_t>(channel.size() + bytes.size());
}

std::optional<std::string> EventLog::flush() {
  if (log_ && log_->good() && std::fflush(log_->getFilePtr()) != 0) fail();
  return error_;
}

void EventLog::discard() {
  std::error_code ignored;
  for (int segment = first_segment_; segment < segment_; ++segment) {
    std::filesystem::remove(segment_file(segment), ignored);
  }
}

}  // namespace ergocast
