// SPDX-License-Identifier: BSD-3-Clause
// Keeps the socket, the pipe and the command, and starts the process with them as often as needed.
#include "cli/watch/page_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spdlog/logger.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iterator>
#include <sstream>
#include <utility>

#include "runtime/bus/clock.h"
#include "runtime/process/logging.h"
#include "text/printable.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// How long the process may take to exit by itself.
constexpr auto kEndOfPage = 2s;
constexpr auto kBeginOfPage = 30s;
/// Further ends of the process are not reported.
constexpr int kMostEndsToReport = 5;

}  // namespace

Result<std::unique_ptr<PageProcess>> PageProcess::start(const Setup& setup,
                                                        ProgressDisplay& display) {
  auto opened = PageSocket::open(setup.page);
  if (!opened) return failure(opened.error());
  std::unique_ptr<PageProcess> page(new PageProcess(setup, *std::move(opened), display));
  page->launch(now());
  return page;
}

PageProcess::PageProcess(const Setup& setup, PageSocket socket, ProgressDisplay& display)
    : socket_(std::move(socket)),
      control_token_(setup.control_token),
      display_(display),
      listens_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      key_(setup.key),
      certificate_(setup.certificate),
      tls_key_(setup.tls_key),
      foxglove_(setup.displays.foxglove) {
  if (!setup.run_dir.empty()) log_ = open_log_file(setup.run_dir / "log/run.log", "run");
  int ends[2] = {-1, -1};
  if (listens_.fd() >= 0 && pipe2(ends, O_CLOEXEC) == 0) {
    until_.emplace(ends[0]);
    running_.emplace(ends[1]);
    program_.descriptors = {socket_.fd(), until_->fd(), listens_.fd()};
  }
  if (setup.control != nullptr) {
    program_.descriptors.push_back(setup.control->fd());
    program_.environment.push_back(std::string(kControlToken) + '=' + control_token_);
  }
  auto& command = program_.command;
  command = {setup.program.string(), "run-page", "--lcm-url",
             setup.url.base(),       "--run-id", to_hex(setup.run)};
  if (!setup.run_dir.empty()) command.push_back(setup.run_dir.string());
  const auto hand = [this, &command](const char* option, const std::optional<SealedFile>& file) {
    if (file) command.insert(command.end(), {option, program_.hand(file->descriptor())});
  };
  hand("--key-file", key_);
  hand("--tls-cert", certificate_);
  hand("--tls-key", tls_key_);
  hand_displays(setup.displays);
  if (!setup.page.listen.empty()) {
    command.insert(command.end(), {"--listen", setup.page.listen});
  }
  if (!socket_.token().empty()) {
    program_.environment.push_back(std::string(kPageToken) + '=' + socket_.token());
  }
  program_.log = setup.run_dir.empty() ? "/dev/null" : setup.run_dir / "log/page.log";
  program_.signal_if_orphaned = SIGKILL;
}

void PageProcess::hand_displays(const Displays& displays) {
  auto& command = program_.command;
  command.insert(command.end(), displays.arguments.begin(), displays.arguments.end());
  auto& environment = program_.environment;
  environment.insert(environment.end(), displays.environment.begin(), displays.environment.end());
  if (!foxglove_) return;
  program_.descriptors.push_back(foxglove_->fd());
  const auto number = kPageSocket - 1 + std::ssize(program_.descriptors);
  command.insert(command.end(), {"--foxglove-socket", std::to_string(number)});
}

std::string PageProcess::url() const {
  return socket_.url() + (control_token_.empty() ? "" : "#control=" + control_token_);
}

PageProcess::~PageProcess() {
  if (!child_) return;
  child_->send(SIGTERM);
  for (const Instant until = now() + kEndOfPage; child_->running();) {
    if (now() > until) child_->send(SIGKILL);
    poll(nullptr, 0, 10);
  }
}

void PageProcess::launch(Instant now) {
  auto started = Child::start(program_);
  if (started) {
    child_ = *started;
  } else {
    restart_at_ = now + restart_delay(ends_++);
  }
}

void PageProcess::wait_until_it_listens(int stop_fd) {
  pollfd events[] = {{listens_.fd(), POLLIN, 0}, {stop_fd, POLLIN, 0}};
  for (const Instant until = now() + kBeginOfPage; child_ && child_->running() && now() < until;) {
    if (poll(events, std::size(events), 50) > 0) return;
  }
}

void PageProcess::attend(Instant now) {
  if (child_ && !child_->running()) {
    if (ends_ < kMostEndsToReport) {
      display_.print("page (process " + std::to_string(child_->pid()) + ") " + child_->fate() +
                     ", and is started again; the mission does not need it (log/page.log)");
    }
    child_.reset();
    restart_at_ = now + restart_delay(ends_++);
  }
  if (!child_ && now >= restart_at_) launch(now);
}

void PageProcess::print(const std::string& line) {
  std::istringstream parts(line);
  for (std::string part; log_ && std::getline(parts, part);) log_->info("{}", printable(part));
}

}  // namespace ergocast::cli
