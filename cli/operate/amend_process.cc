// SPDX-License-Identifier: BSD-3-Clause
// Hands drawing and key as files in memory, and reads what the process prints from another one.
#include "cli/operate/amend_process.h"

#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <span>
#include <sstream>
#include <utility>

#include "runtime/process/key_file.h"

namespace ergocast::cli {
namespace {

using State = OrderReport::State;

/// The most that is read of the output.
constexpr std::size_t kMostOutput = 2000;
/// The drawing is the first descriptor that the process gets.
constexpr const char* kDrawingName = "/proc/self/fd/3";

Result<SealedFile> sealed(const std::string& name, const std::string& text) {
  return SealedFile::make(name, std::as_bytes(std::span(text)));
}

/// "12:3: " at the beginning.
void drop_place(std::string& line) {
  for (int i = 0; i < 2; ++i) {
    const auto digits = line.find_first_not_of("0123456789");
    if (digits == 0 || digits == line.npos || line[digits] != ':') break;
    line.erase(0, digits + 1);
  }
  line.erase(0, line.find_first_not_of(' '));
}

}  // namespace

std::string amend_answer(std::string printed, const std::string& file_name) {
  std::istringstream lines(printed);
  std::string answer;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("warning: ")) continue;
    if (line.starts_with(file_name + ':')) {
      line.erase(0, file_name.size() + 1);
      drop_place(line);
    }
    // The last line of an order that is obeyed says all that the earlier ones have said.
    if (line.starts_with("amendment ")) answer.clear();
    answer += (answer.empty() ? "" : "; ") + line;
  }
  return answer;
}

AmendProcess::AmendProcess(const BusOptions& team, const DrawnTarget& target, const std::string& by)
    : checked_("the target is checked") {
  start(team, target.text(), {"--target", kDrawingName, "--by=" + by});
}

AmendProcess::AmendProcess(const BusOptions& team, const DrawnZone& zone, const std::string& by)
    : checked_("the zone is checked") {
  start(team, zone.text(), {"--zone", kDrawingName, "--for", zone.duration(), "--by=" + by});
}

void AmendProcess::start(const BusOptions& team, const std::string& text,
                         std::vector<std::string> what) {
  problem_ = "the system cannot create a process: order it again";
  auto drawing = sealed("drawn", text);
  const int output = memfd_create("amend-output", MFD_CLOEXEC);
  if (output >= 0) output_.emplace(output);
  if (!drawing || !output_) return;
  drawing_ = *std::move(drawing);
  Child::Program program;
  program.signal_if_orphaned = SIGKILL;
  program.hand(drawing_->descriptor());  // as kDrawingName
  program.command = {std::filesystem::read_symlink("/proc/self/exe").string(),
                     "amend",
                     "--lcm-url",
                     team.url.base(),
                     "--run-id",
                     to_hex(team.run)};
  std::ranges::move(what, std::back_inserter(program.command));
  if (const MissionKey* key = team.authenticator.key()) {
    auto kept = sealed("amend-key", key_text(*key, true));
    if (!kept) return;
    key_ = *std::move(kept);
    program.command.insert(program.command.end(), {"--key-file", program.hand(key_->descriptor())});
  }
  program.log = program.hand(output_->fd());
  if (auto started = Child::start(program)) child_ = *started;
  running_ = child_.has_value();
}

AmendProcess::~AmendProcess() {
  if (!child_) return;
  child_->send(SIGKILL);
  while (child_->running()) poll(nullptr, 0, 1);
}

void AmendProcess::send(const MonitoredRun&, Instant, Outbox&) {
  running_ = child_ && child_->running();
}

std::string AmendProcess::printed() const {
  std::string text(kMostOutput, '\0');
  const ssize_t count = pread(output_->fd(), text.data(), text.size(), 0);
  text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return text;
}

OrderReport AmendProcess::report(const MonitoredRun&, Instant) const {
  if (!child_) return {State::kFailed, problem_};
  const std::string answer = amend_answer(printed(), kDrawingName);
  if (running_)
    return answer.starts_with("amendment ") ? OrderReport{State::kAnswered, answer}
                                            : OrderReport{State::kSent, checked_};
  if (child_->exit_code() == 0) return {State::kDone, answer};
  return {State::kFailed, answer.empty() ? "ergocast amend " + child_->fate() : answer};
}

}  // namespace ergocast::cli
