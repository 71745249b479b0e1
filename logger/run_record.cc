#include "logger/run_record.h"

#include <cerrno>
#include <cstring>

namespace ergocast {
namespace {

/// A stream that failed earlier does not remember why; whether the disk is full can still be seen.
std::string error_at(const std::filesystem::path& file) {
  if (errno != 0) return file.string() + ": " + std::strerror(errno);
  std::error_code error;
  const auto space = std::filesystem::space(file.parent_path(), error);
  const bool full = !error && space.available < 65536;
  return file.string() + (full ? ": the disk is full" : ": cannot be written");
}

}  // namespace

RunRecord::RunRecord(std::filesystem::path folder) : folder_(std::move(folder)) {}

std::variant<std::unique_ptr<RunRecord>, std::string> RunRecord::create(
    const std::filesystem::path& folder) {
  auto record = std::unique_ptr<RunRecord>(new RunRecord(folder));
  for (auto [stream, name] : {std::pair{&record->trajectory_, kTrajectoryFile},
                              std::pair{&record->metrics_, kMetricsFile}}) {
    const std::filesystem::path file = folder / name;
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) {
      return file.string() + ": there is already a record; choose another folder with --out";
    }
    errno = 0;
    stream->open(file, std::ios::binary);
    if (!*stream) return error_at(file);
  }
  return record;
}

std::optional<std::string> RunRecord::flush() {
  errno = 0;
  if (!trajectory_.flush()) return error_at(folder_ / kTrajectoryFile);
  if (!metrics_.flush()) return error_at(folder_ / kMetricsFile);
  return std::nullopt;
}

std::optional<std::string> write_file(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::path temporary = file;
  temporary += ".tmp";
  errno = 0;
  std::ofstream out(temporary, std::ios::binary);
  out << text << std::flush;
  std::error_code error;
  if (!out) {
    const std::string problem = error_at(file);
    std::filesystem::remove(temporary, error);
    return problem;
  }
  out.close();
  std::filesystem::rename(temporary, file, error);
  if (!error) return std::nullopt;
  const std::string problem = file.string() + ": " + error.message();
  std::filesystem::remove(temporary, error);
  return problem;
}

}  // namespace ergocast
