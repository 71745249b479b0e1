// SPDX-License-Identifier: BSD-3-Clause
// Locks the folder, refuses the folder of another study, reads the finished rows, and appends new
// ones.
#include "cli/study_directory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

#include "logger/run_record.h"
#include "text/regular_file.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kIdentityFile = "study.json";
constexpr const char* kTableFile = "study.csv";

std::string content_of(const fs::path& file) {
  if (why_not_regular(file)) return "";
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string said(const fs::path& path, const std::string& problem) {
  return "--out " + path.string() + ": " + problem;
}

Json to_json(const StudyIdentity& identity) {
  Json points = Json::array();
  for (std::size_t i = 0; i < identity.study.points.size(); ++i) {
    const studies::StudyPoint& point = identity.study.points[i];
    points.push_back({{"scenario", point.scenario},
                      {"values", point.values},
                      {"agents", point.agents},
                      {"duration_s", point.duration_s},
                      {"plan_hash", identity.plan_hashes[i]}});
  }
  return {{"version", identity.version},
          {"set", identity.settings},
          {"fields", identity.study.fields},
          {"points", points}};
}

/// Why the study `ours` cannot continue in the folder of `theirs`.
std::string difference(const Json& ours, const Json& theirs) {
  const std::string fresh = "; give a new folder";
  for (const char* key : {"version", "set", "fields", "points"}) {
    if (!theirs.is_object() || !theirs.contains(key)) return "its study.json is damaged" + fresh;
  }
  if (ours["version"] != theirs["version"]) {
    return "its study was begun by ergocast " + theirs["version"].dump() + fresh;
  }
  if (ours["set"] != theirs["set"]) return "its study sets " + theirs["set"].dump() + fresh;
  if (ours["fields"] != theirs["fields"]) {
    return "its study varies " + theirs["fields"].dump() + fresh;
  }
  if (ours["points"].size() != theirs["points"].size()) {
    return "its study has " + std::to_string(theirs["points"].size()) + " points, this one " +
           std::to_string(ours["points"].size()) + fresh;
  }
  for (std::size_t i = 0; i < ours["points"].size(); ++i) {
    if (ours["points"][i] == theirs["points"][i]) continue;
    return "its study differs at point " + std::to_string(i + 1) + ", " +
           theirs["points"][i].dump() + fresh;
  }
  return "";
}

/// Why this study cannot use the folder; nothing if it can.
std::optional<std::string> objection(const fs::path& folder, const Json& identity) {
  std::error_code error;
  const fs::path file = folder / kIdentityFile;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    return said(folder, "is a file; give a folder");
  }
  if (!fs::exists(file, error)) {
    const bool taken = fs::exists(folder, error) && !fs::is_empty(folder, error);
    if (taken)
      return said(folder, "is not empty and no study; give a new folder, or empty this one");
    return std::nullopt;
  }
  const Json theirs = Json::parse(content_of(file), nullptr, false);
  const std::string why = difference(identity, theirs);
  if (why.empty()) return std::nullopt;
  return said(folder, why);
}

bool before(const studies::StudyRow& a, const studies::StudyRow& b) {
  return std::pair(a.point, a.figures.seed) < std::pair(b.point, b.figures.seed);
}

}  // namespace

std::variant<std::unique_ptr<StudyDirectory>, std::string> StudyDirectory::open(
    const fs::path& folder, const StudyIdentity& identity) {
  const Json json = to_json(identity);
  if (auto problem = objection(folder, json)) return *problem;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return said(folder, error.message() + "; give another folder");
  if (!fs::exists(folder / kIdentityFile)) {
    if (auto problem = write_file(folder / kIdentityFile, json.dump(2) + '\n')) return *problem;
  }
  const int lock = ::open((folder / kIdentityFile).c_str(), O_RDONLY | O_CLOEXEC);
  if (lock < 0 || flock(lock, LOCK_EX | LOCK_NB) != 0) {
    if (lock >= 0) close(lock);
    return said(folder, "another ergocast study is at work there; wait for it");
  }
  std::unique_ptr<StudyDirectory> directory(new StudyDirectory(folder, identity, lock));
  if (auto problem = directory->read_rows()) return *problem;
  return directory;
}

StudyDirectory::StudyDirectory(fs::path folder, const StudyIdentity& identity, int lock)
    : folder_(std::move(folder)), table_(identity.study), lock_(lock) {}

StudyDirectory::~StudyDirectory() {
  if (file_ >= 0) close(file_);
  close(lock_);
}

std::optional<std::string> StudyDirectory::read_rows() {
  const fs::path path = folder_ / kTableFile;
  std::string text = content_of(path);
  text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
  if (text.empty()) text = table_.header() + '\n';
  std::string_view rest = text;
  for (std::int64_t number = 1; !rest.empty(); ++number) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(line.size() + 1);
    const auto row = number == 1 ? std::nullopt : table_.parse(line);
    if (row) rows_.push_back(*row);
    if (row || (number == 1 && line == table_.header())) continue;
    return path.string() + ':' + std::to_string(number) +
           ": is no row of this study; remove the line";
  }
  if (auto problem = write_file(path, text)) return problem;
  file_ = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0) return path.string() + ": " + std::strerror(errno);
  return std::nullopt;
}

std::vector<std::pair<std::size_t, std::uint64_t>> StudyDirectory::done() const {
  std::vector<std::pair<std::size_t, std::uint64_t>> runs;
  for (const studies::StudyRow& row : rows_) runs.emplace_back(row.point, row.figures.seed);
  std::sort(runs.begin(), runs.end());
  return runs;
}

std::optional<std::string> StudyDirectory::add(const studies::StudyRow& row) {
  const off_t end = lseek(file_, 0, SEEK_END);
  const std::string line = table_.line(row) + '\n';
  errno = 0;
  if (write(file_, line.data(), line.size()) == static_cast<ssize_t>(line.size())) {
    rows_.push_back(row);
    return std::nullopt;
  }
  std::string problem = (folder_ / kTableFile).string() + ": " +
                        (errno == 0 ? "the disk is full" : std::strerror(errno));
  if (ftruncate(file_, end) != 0) problem += ", and its last line is torn";
  return problem;
}

std::optional<std::string> StudyDirectory::sort() {
  std::sort(rows_.begin(), rows_.end(), before);
  std::string text = table_.header() + '\n';
  for (const studies::StudyRow& row : rows_) text += table_.line(row) + '\n';
  return write_file(folder_ / kTableFile, text);
}

}  // namespace ergocast::cli
