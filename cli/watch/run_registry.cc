// SPDX-License-Identifier: BSD-3-Clause
// Works with one descriptor of the folder, whose owner and mode were checked. So no other user can
// replace the folder meanwhile. A file gets its name when it is complete and locked.
#include "cli/watch/run_registry.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <utility>

#include "plan/mission_limits.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSuffix = ".json";
/// Paths are at most 4 KiB.
/// Limit (Commands): length of the entry of a live run [bytes]. Beyond it: the run is not shown.
constexpr std::size_t kMostEntryBytes = std::size_t{1} << 15;
/// Limit (Commands): live runs of a user that a command reads. Beyond it: others are not shown.
constexpr std::size_t kMostEntries = 1000;

/// A file descriptor that is closed in the destructor.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

/// Whether no other user can read the folder or write there.
bool is_ours_alone(const struct stat& folder) {
  return S_ISDIR(folder.st_mode) && folder.st_uid == geteuid() && (folder.st_mode & 077) == 0;
}

/// A descriptor of the registry; −1 if it does not exist; an error if it is not this user's alone.
Result<int> open_registry(const fs::path& folder) {
  const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (fd < 0 && errno == ENOENT) return -1;
  struct stat status {};
  if (fd >= 0 && fstat(fd, &status) == 0 && is_ours_alone(status)) return fd;
  const bool is_folder = fd >= 0;
  const std::string why =
      is_folder ? "other users own it, read it or write to it" : "is no folder that can be read";
  if (is_folder) close(fd);
  return failure(folder.string() + ": " + why +
                 "; remove it, and it is made anew with the right owner");
}

std::string name_of(RunId run) { return to_hex(run) + kSuffix; }

bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::string contents_of(int file) {
  std::string text(kMostEntryBytes + 1, '\0');
  const ssize_t size = pread(file, text.data(), text.size(), 0);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  return text;
}

/// The value of a key as text; nullopt if it is missing or no text.
std::optional<std::string> text_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_string()) return std::nullopt;
  return found->get<std::string>();
}

/// The names in the folder that may be entries; a leading point marks one that is being written.
std::vector<std::string> names_in(int folder) {
  std::vector<std::string> names;
  DIR* stream = fdopendir(dup(folder));
  if (stream == nullptr) return names;
  while (const dirent* entry = readdir(stream)) {
    if (entry->d_name[0] != '.' && names.size() < kMostEntries) names.emplace_back(entry->d_name);
  }
  closedir(stream);
  std::sort(names.begin(), names.end());
  return names;
}

/// Reads one file of the registry into `found`.
void look_at(int folder, const std::string& name, const std::string& path, LiveRuns& found) {
  const Descriptor file(
      openat(folder, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (file.get() < 0 && errno == ENOENT) return;  // its run has just ended
  struct stat status {};
  const bool sound = file.get() >= 0 && fstat(file.get(), &status) == 0 &&
                     S_ISREG(status.st_mode) && status.st_uid == geteuid();
  const auto foreign = [&](const std::string& why) {
    found.warnings.push_back(path + ": " + why + "; no run is taken from it (remove it)");
  };
  if (!sound) return foreign("is no file of this user");
  const auto read = live_run_from(contents_of(file.get()));
  if (!read) return foreign(read.error());
  const LiveRun& run = *read;
  if (name != name_of(run.run)) return foreign("is not named after its run, " + to_hex(run.run));
  if (flock(file.get(), LOCK_SH | LOCK_NB) != 0) {
    found.runs.push_back(run);
    return;
  }
  // A run that ends normally removes its name before it releases the lock.
  if (fstat(file.get(), &status) != 0 || status.st_nlink == 0) return;
  unlinkat(folder, name.c_str(), 0);
  if (run.preparing) return;  // it had started nothing
  found.warnings.push_back("run " + to_hex(run.run) + " of " + run.scenario + ", " +
                           run.run_dir.string() +
                           ": its `ergocast run` was killed; its entry is removed");
}

}  // namespace

std::string to_json_text(const LiveRun& run) {
  Json json = {{"version", run.version},
               {"run_id", to_hex(run.run)},
               {"scenario", run.scenario},
               {"started", run.started}};
  if (run.preparing) {
    json["preparing"] = true;
  } else {
    json["lcm_url"] = run.url.base();
    json["run_dir"] = run.run_dir.string();
  }
  if (!run.key_file.empty()) json["key_file"] = run.key_file.string();
  json["pid"] = run.pid;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

Result<LiveRun> live_run_from(std::string_view text) {
  if (text.size() > kMostEntryBytes) return failure("is larger than an entry can be");
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return failure("is no entry of a run");
  LiveRun run;
  const auto preparing = json.find("preparing");
  if (preparing != json.end()) {
    if (!preparing->is_boolean()) return failure("preparing is neither true nor false");
    run.preparing = preparing->get<bool>();
  }
  std::vector<const char*> keys{"version", "run_id", "scenario", "started"};
  if (!run.preparing) keys.insert(keys.end(), {"lcm_url", "run_dir"});
  std::map<std::string, std::string> texts;
  for (const char* key : keys) {
    const auto value = text_in(json, key);
    if (!value)
      return failure(std::string("is no entry of a run: ") + key + " is missing or no text");
    texts[key] = *value;
  }
  run.run = std::strtoull(texts["run_id"].c_str(), nullptr, 16);
  if (run.run == 0 || to_hex(run.run) != texts["run_id"])
    return failure("run_id is no number of a run");
  if (!is_name(texts["scenario"])) return failure("scenario is no name");
  run.scenario = texts["scenario"];
  run.version = texts["version"];
  run.started = texts["started"];
  run.key_file = text_in(json, "key_file").value_or("");
  if (!run.key_file.empty() && !run.key_file.is_absolute())
    return failure("key_file is no absolute path");
  const auto pid = json.find("pid");
  run.pid = pid == json.end() || !pid->is_number_integer() ? 0 : pid->get<int>();
  if (run.pid <= 0) return failure("pid is missing or no number of a process");
  if (run.preparing) return run;
  auto url = LcmUrl::parse(texts["lcm_url"]);
  if (!url) return failure("lcm_url: " + url.error());
  run.url = *url;
  run.run_dir = texts["run_dir"];
  if (!run.run_dir.is_absolute()) return failure("run_dir is no absolute path");
  return run;
}

fs::path run_registry() {
  const char* named = std::getenv("XDG_RUNTIME_DIR");
  struct stat status {};
  if (named != nullptr && fs::path(named).is_absolute() && stat(named, &status) == 0 &&
      is_ours_alone(status)) {
    return fs::path(named) / "ergocast";
  }
  return "/tmp/ergocast-" + std::to_string(geteuid());
}

Result<Socket> open_run_registry(bool make) {
  const fs::path registry = run_registry();
  if (make && mkdir(registry.c_str(), 0700) != 0 && errno != EEXIST)
    return failure(registry.string() + ": " + std::strerror(errno));
  const auto opened = open_registry(registry);
  if (!opened) return failure(opened.error());
  return Socket(*opened);
}

Result<std::unique_ptr<RunEntry>> RunEntry::write(const LiveRun& run) {
  const fs::path registry = run_registry();
  const auto failed = [&registry] {
    return failure(registry.string() + ": " + std::strerror(errno));
  };
  if (mkdir(registry.c_str(), 0700) != 0 && errno != EEXIST) return failed();
  const auto opened = open_registry(registry);
  if (!opened) return failure(opened.error());
  Descriptor folder(*opened);
  const std::string name = name_of(run.run), unfinished = '.' + name;
  Descriptor file(openat(folder.get(), unfinished.c_str(),
                         O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (file.get() < 0) return failed();
  if (flock(file.get(), LOCK_EX | LOCK_NB) != 0 || !write_all(file.get(), to_json_text(run)) ||
      renameat(folder.get(), unfinished.c_str(), folder.get(), name.c_str()) != 0) {
    const auto problem = failed();
    unlinkat(folder.get(), unfinished.c_str(), 0);
    return problem;
  }
  return std::unique_ptr<RunEntry>(new RunEntry(folder.release(), file.release(), name));
}

RunEntry::RunEntry(int folder, int file, std::string name)
    : folder_(folder), file_(file), name_(std::move(name)) {}

RunEntry::~RunEntry() {
  unlinkat(folder_, name_.c_str(), 0);
  close(file_);
  close(folder_);
}

LiveRuns live_runs() {
  LiveRuns found;
  const fs::path registry = run_registry();
  const auto opened = open_registry(registry);
  if (!opened) {
    found.warnings.push_back(opened.error());
    return found;
  }
  const Descriptor folder(*opened);
  if (folder.get() < 0) return found;
  for (const std::string& name : names_in(folder.get())) {
    look_at(folder.get(), name, (registry / name).string(), found);
  }
  std::sort(found.runs.begin(), found.runs.end(), [](const LiveRun& a, const LiveRun& b) {
    return std::tie(a.started, a.run) < std::tie(b.started, b.run);
  });
  return found;
}

}  // namespace ergocast::cli
