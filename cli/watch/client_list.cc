// SPDX-License-Identifier: BSD-3-Clause
// Writes a new file for each change, locked before it gets its name, so that a reader finds whole
// files only.
#include "cli/watch/client_list.h"

#include <dirent.h>
#include <fcntl.h>
#include <spdlog/logger.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/watch/run_registry.h"
#include "runtime/process/logging.h"
#include "text/printable.h"

namespace ergocast::cli {
namespace {

/// Such a name is none of an entry of a run.
constexpr std::string_view kPrefix = ".clients-";
constexpr std::string_view kUnfinished = ".unfinished-clients-";
constexpr std::size_t kMostBytes = std::size_t{32} << 10;
constexpr std::size_t kLongestName = 200;
constexpr std::size_t kMostFiles = 100;
/// Lines of the log in a second: a client that connects again and again must not fill the disk.
constexpr int kMostNotes = 4;

std::string file_of(RunId run) { return std::string(kPrefix) + to_hex(run) + '-'; }

/// The names of this run's files.
std::vector<std::string> files_in(int folder, RunId run) {
  std::vector<std::string> names;
  DIR* stream = fdopendir(dup(folder));
  if (stream == nullptr) return names;
  rewinddir(stream);
  while (const dirent* entry = readdir(stream))
    if (std::string_view(entry->d_name).starts_with(file_of(run)) && names.size() < kMostFiles)
      names.emplace_back(entry->d_name);
  closedir(stream);
  return names;
}

void add_names(const std::string& text, std::vector<std::string>& names) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_array()) return;
  for (std::size_t i = 0; i < std::min(json.size(), kMostNamedClients); ++i)
    if (json[i].is_string()) names.push_back(printable(json[i].get<std::string>()));
}

void add_file(int folder, const std::string& name, std::vector<std::string>& names) {
  const Socket file(openat(folder, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (file.fd() < 0 || fstat(file.fd(), &status) != 0 || !S_ISREG(status.st_mode) ||
      status.st_uid != geteuid())
    return;
  if (flock(file.fd(), LOCK_SH | LOCK_NB) == 0) {
    // Either its process has ended, or it has just replaced the file.
    if (fstat(file.fd(), &status) == 0 && status.st_nlink > 0) unlinkat(folder, name.c_str(), 0);
    return;
  }
  std::string text(kMostBytes, '\0');
  const ssize_t size = pread(file.fd(), text.data(), text.size(), 0);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  add_names(text, names);
}

std::string text_of(const std::vector<std::string>& names) {
  auto list = nlohmann::json::array();
  for (std::size_t i = 0; i < std::min(names.size(), kMostNamedClients); ++i)
    list.push_back(names[i].substr(0, kLongestName));
  return list.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

}  // namespace

ClientFile::~ClientFile() {
  if (folder_ && !name_.empty()) unlinkat(folder_->fd(), name_.c_str(), 0);
}

void ClientFile::write(RunId run, const std::vector<std::string>& names) {
  if (!folder_) {
    auto opened = open_run_registry(true);
    if (!opened) return;
    folder_ = *std::move(opened);
  }
  const std::string end = to_hex(run) + '-' + std::to_string(getpid());
  const std::string name = std::string(kPrefix) + end, unfinished = std::string(kUnfinished) + end;
  unlinkat(folder_->fd(), unfinished.c_str(), 0);
  Socket file(openat(folder_->fd(), unfinished.c_str(),
                     O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  const std::string text = text_of(names);
  const auto size = static_cast<ssize_t>(text.size());
  if (file.fd() < 0) return;
  if (flock(file.fd(), LOCK_EX | LOCK_NB) != 0 ||
      ::write(file.fd(), text.data(), text.size()) != size ||
      renameat(folder_->fd(), unfinished.c_str(), folder_->fd(), name.c_str()) != 0) {
    unlinkat(folder_->fd(), unfinished.c_str(), 0);
    return;
  }
  name_ = name;
  file_ = std::move(file);
}

std::vector<std::string> named_clients(RunId run) {
  std::vector<std::string> names;
  const auto folder = open_run_registry(false);
  if (!folder || folder->fd() < 0) return names;
  for (const std::string& name : files_in(folder->fd(), run)) add_file(folder->fd(), name, names);
  std::ranges::sort(names);
  return names;
}

ClientList::ClientList(const std::filesystem::path& log, const std::string& process_name, Note note)
    : note_(std::move(note)) {
  if (!log.empty()) log_ = open_log_file(log, process_name);
}

void ClientList::update(RunId run, std::vector<std::string> names, Instant now) {
  if (now - second_ >= std::chrono::seconds(1)) {
    second_ = now;
    notes_ = 0;
  }
  std::ranges::sort(names);
  if (run == 0 || (run == run_ && names == names_)) return;
  for (const std::string& name : names)
    if (!std::ranges::binary_search(names_, name)) note(name + " is connected");
  for (const std::string& name : names_)
    if (!std::ranges::binary_search(names, name)) note(name + " has left");
  run_ = run;
  names_ = std::move(names);
  file_.write(run, names_);
}

void ClientList::note(const std::string& sentence) {
  if (notes_++ >= kMostNotes) return;
  if (log_) log_->info("{}", printable(sentence));
  if (note_) note_(sentence);
}

}  // namespace ergocast::cli
