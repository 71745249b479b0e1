// SPDX-License-Identifier: BSD-3-Clause
// Opens the files of a new segment exclusively, and counts segments by their file names.
#include "logger/run_record.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <utility>

namespace ergocast {
namespace {

namespace fs = std::filesystem;

std::string error_at(const fs::path& file, int error) {
  return file.string() + ": " + (error != 0 ? std::strerror(error) : "cannot be written");
}

}  // namespace

fs::path segment_file(const fs::path& folder, const std::string& table, int segment) {
  if (segment == 0) return folder / table;
  char number[16];
  std::snprintf(number, sizeof number, "-%03d", segment);
  const fs::path name(table);
  return folder / (name.stem().string() + number + name.extension().string());
}

int segment_count(const fs::path& folder) {
  const auto bytes = [&folder](const char* table, int segment) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(segment_file(folder, table, segment), error);
    return error ? std::optional<std::uintmax_t>() : size;
  };
  // A process killed while it began a segment left at most one empty table; that segment is used
  // again.
  const auto exists = [&bytes](int segment) {
    const auto rows = bytes(kTrajectoryFile, segment), values = bytes(kMetricsFile, segment);
    return (rows && values) || rows.value_or(0) + values.value_or(0) > 0;
  };
  int count = 0;
  while (exists(count)) ++count;
  return count;
}

RunRecord::RunRecord(fs::path folder, int segment)
    : folder_(std::move(folder)), segment_(segment) {}

RunRecord::Created RunRecord::create(const fs::path& folder) {
  return begin(
      folder, 0,
      "there is already a record; continue it with --resume, or choose another folder with --out");
}

RunRecord::Created RunRecord::go_on(const fs::path& folder) {
  return begin(folder, segment_count(folder), "");
}

RunRecord::Created RunRecord::begin(const fs::path& folder, int segment, const char* if_taken) {
  auto record = std::unique_ptr<RunRecord>(new RunRecord(folder, segment));
  for (auto [stream, file] : {std::pair{&record->trajectory_, record->trajectory_file()},
                              std::pair{&record->metrics_, record->metrics_file()}}) {
    std::error_code error;
    const bool taken = fs::file_size(file, error) > 0 && !error;
    if (taken) return failure(file.string() + ": " + if_taken);
    stream->open(file);
    if (!*stream) return failure(error_at(file, stream->error()));
  }
  return record;
}

fs::path RunRecord::trajectory_file() const {
  return segment_file(folder_, kTrajectoryFile, segment_);
}

fs::path RunRecord::metrics_file() const { return segment_file(folder_, kMetricsFile, segment_); }

std::optional<std::string> RunRecord::flush() {
  for (auto [stream, file] :
       {std::pair{&trajectory_, trajectory_file()}, {&metrics_, metrics_file()}}) {
    stream->clear();
    if (!stream->flush()) return error_at(file, stream->error());
  }
  return std::nullopt;
}

void RunRecord::discard() {
  std::error_code ignored;
  fs::remove(trajectory_file(), ignored);
  fs::remove(metrics_file(), ignored);
}

std::optional<std::string> write_file(const fs::path& file, std::string_view text) {
  fs::path temporary = file;
  temporary += ".tmp";
  errno = 0;
  std::ofstream out(temporary, std::ios::binary);
  out << text << std::flush;
  std::error_code error;
  if (!out) {
    const std::string problem = error_at(file, errno);
    fs::remove(temporary, error);
    return problem;
  }
  out.close();
  fs::rename(temporary, file, error);
  if (!error) return std::nullopt;
  const std::string problem = file.string() + ": " + error.message();
  fs::remove(temporary, error);
  return problem;
}

}  // namespace ergocast
