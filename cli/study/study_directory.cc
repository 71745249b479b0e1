// SPDX-License-Identifier: BSD-3-Clause
// Locks the folder, refuses the folder of another study, reads the finished rows, and appends new
// ones.
#include "cli/study/study_directory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "logger/run_record.h"
#include "plan/mission_limits.h"
#include "text/input_file.h"
#include "text/json_bounds.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kIdentityFile = "study.json";
constexpr const char* kTableFile = "study.csv";

/// Limit (Studies): length of `study.csv` [bytes]. Beyond it: `study` refuses the folder.
constexpr std::size_t kMostTableBytes = std::size_t{1} << 30;  // a row has some 400
/// Limit (Studies): length of `study.json` [bytes]. Beyond it: `study` refuses the folder.
constexpr std::size_t kMostIdentityBytes = std::size_t{64} << 20;
/// Limit (Studies): values in `study.json`. Beyond it: `study` refuses the folder.
constexpr std::size_t kMostIdentityValues = 4'000'000;

std::string problem_with(const fs::path& path, const std::string& problem) {
  return "--out " + path.string() + ": " + problem;
}

Json to_json(const StudyShard& shard) {
  return {{"index", shard.index},           {"of", shard.of},
          {"first_seed", shard.first_seed}, {"last_seed", shard.last_seed},
          {"command", shard.command},       {"missions", shard.missions}};
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
  Json json = {{"version", identity.version}};
  if (identity.shard) json["shard"] = to_json(*identity.shard);
  if (!identity.settings.empty()) json["set"] = identity.settings;
  json["fields"] = identity.study.fields;
  json["points"] = points;
  return json;
}

/// Throws Json::exception if a key is missing or its value is of another type.
StudyShard shard_from(const Json& json) {
  StudyShard shard;
  shard.index = json.at("index").get<std::uint64_t>();
  shard.of = json.at("of").get<std::uint64_t>();
  shard.first_seed = json.at("first_seed").get<std::uint64_t>();
  shard.last_seed = json.at("last_seed").get<std::uint64_t>();
  shard.command = json.at("command").get<std::string>();
  shard.missions = json.at("missions").get<std::vector<std::string>>();
  return shard;
}

/// Throws like shard_from().
StudyIdentity identity_from(const Json& json) {
  StudyIdentity identity;
  identity.version = json.at("version").get<std::string>();
  identity.study.fields = json.at("fields").get<std::vector<std::string>>();
  if (json.contains("set")) identity.settings = json["set"].get<std::vector<std::string>>();
  for (const Json& point : json.at("points")) {
    identity.study.points.push_back({point.at("scenario").get<std::string>(),
                                     point.at("values").get<std::vector<std::string>>(),
                                     point.at("agents").get<int>(),
                                     point.at("duration_s").get<double>()});
    identity.plan_hashes.push_back(point.at("plan_hash").get<std::string>());
  }
  if (json.contains("shard")) identity.shard = shard_from(json["shard"]);
  return identity;
}

bool is_sound(const StudyShard& shard, std::size_t points) {
  return shard.index >= 1 && shard.index <= shard.of && shard.of <= kMostStudyRuns &&
         shard.last_seed >= shard.first_seed &&
         shard.last_seed - shard.first_seed < kMostStudyRuns / points &&
         shard.missions.size() == points;
}

bool is_sound(const StudyIdentity& identity) {
  const studies::Study& study = identity.study;
  const auto sound = [&study](const studies::StudyPoint& point) {
    return point.values.size() == study.fields.size() && point.agents >= 1 &&
           point.agents <= kMaxAgents && point.duration_s >= 0;
  };
  return !study.points.empty() && study.points.size() <= kMostStudyRuns &&
         std::all_of(study.points.begin(), study.points.end(), sound) &&
         (!identity.shard || is_sound(*identity.shard, study.points.size()));
}

std::string name_of(const std::optional<StudyShard>& shard) {
  return shard ? shard->name() : "no shard";
}

/// The reason why this study cannot use the folder; nullopt if it can.
std::optional<std::string> objection(const fs::path& folder, const StudyIdentity& ours) {
  std::error_code error;
  const fs::path file = folder / kIdentityFile;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    return problem_with(folder, "is a file; give a folder");
  }
  if (!fs::exists(file, error)) {
    const bool taken = fs::exists(folder, error) && !fs::is_empty(folder, error);
    if (taken)
      return problem_with(folder,
                          "is not empty and no study; give a new folder, or empty this one");
    return std::nullopt;
  }
  const auto theirs = read_identity(folder);
  std::string why = theirs ? difference(ours, *theirs) : theirs.error();
  if (why.empty() && name_of(ours.shard) != name_of(theirs->shard)) {
    why = "its study is " + name_of(theirs->shard) + ", this one " + name_of(ours.shard);
  }
  if (why.empty()) return std::nullopt;
  return problem_with(folder, why + "; give a new folder");
}

bool before(const studies::StudyRow& a, const studies::StudyRow& b) {
  return std::pair(a.point, a.figures.seed) < std::pair(b.point, b.figures.seed);
}

}  // namespace

std::string StudyShard::name() const {
  return "shard " + std::to_string(index) + '/' + std::to_string(of) + " of seeds " +
         std::to_string(first_seed) + ':' + std::to_string(last_seed);
}

std::string difference(const StudyIdentity& our_identity, const StudyIdentity& their_identity) {
  const Json ours = to_json(our_identity), theirs = to_json(their_identity);
  if (ours["version"] != theirs["version"]) {
    return "its study was begun by ergocast " + theirs["version"].dump();
  }
  if (our_identity.settings != their_identity.settings) {
    return "its study sets " + Json(their_identity.settings).dump();
  }
  if (ours["fields"] != theirs["fields"]) return "its study varies " + theirs["fields"].dump();
  if (ours["points"].size() != theirs["points"].size()) {
    return "its study has " + std::to_string(theirs["points"].size()) + " points, this one " +
           std::to_string(ours["points"].size());
  }
  for (std::size_t i = 0; i < ours["points"].size(); ++i) {
    if (ours["points"][i] == theirs["points"][i]) continue;
    return "its study differs at point " + std::to_string(i + 1) + ", " +
           theirs["points"][i].dump();
  }
  return "";
}

Result<StudyIdentity> read_identity(const fs::path& folder) {
  const fs::path file = folder / kIdentityFile;
  std::error_code error;
  if (!fs::exists(file, error)) return failure("is no study: there is no study.json");
  const auto read = read_whole(file, kMostIdentityBytes);
  if (!read) return failure("its study.json " + read.error().what);
  try {
    const Json json = parse_bounded<Json>(*read, kMostIdentityValues);
    StudyIdentity identity = identity_from(json);
    if (is_sound(identity)) return identity;
  } catch (const JsonTooLarge& problem) {
    return failure(std::string("its study.json ") + problem.what());
  } catch (const Json::exception&) {  // a key is missing, or its value is of another type
  }
  return failure("its study.json is damaged");
}

Result<std::unique_ptr<StudyDirectory>> StudyDirectory::open(const fs::path& folder,
                                                             const StudyIdentity& identity) {
  if (auto problem = objection(folder, identity)) return failure(*problem);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return failure(problem_with(folder, error.message() + "; give another folder"));
  if (!fs::exists(folder / kIdentityFile)) {
    if (auto problem = write_file(folder / kIdentityFile, to_json(identity).dump(2) + '\n'))
      return failure(*problem);
  }
  const int lock = ::open((folder / kIdentityFile).c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (lock < 0 || flock(lock, LOCK_EX | LOCK_NB) != 0) {
    if (lock >= 0) close(lock);
    return failure(problem_with(folder, "another ergocast study is at work there; wait for it"));
  }
  std::unique_ptr<StudyDirectory> directory(new StudyDirectory(folder, identity, lock));
  if (auto problem = directory->read_rows()) return failure(*problem);
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
  auto read = read_whole(path, kMostTableBytes);
  // A file that cannot be read is not overwritten.
  if (!read && read.error().kind != FileProblem::Kind::kMissing) return read.error().sentence(path);
  std::string text = std::move(read).value_or("");
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
  if (auto failure = write_file(path, text)) return failure;
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
  if (ftruncate(file_, end) != 0) problem += ", and its last line is incomplete";
  return problem;
}

std::optional<std::string> StudyDirectory::sort() {
  std::sort(rows_.begin(), rows_.end(), before);
  std::string text = table_.header() + '\n';
  for (const studies::StudyRow& row : rows_) text += table_.line(row) + '\n';
  return write_file(folder_ / kTableFile, text);
}

}  // namespace ergocast::cli
