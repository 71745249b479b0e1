// SPDX-License-Identifier: BSD-3-Clause
// ergocast-driver-mavlink: one vehicle with a PX4 or ArduPilot autopilot.
#include <ergocast/team/subscriptions.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <string>
#include <utility>

#include "bridges/mavlink/buses.h"
#include "bridges/mavlink/driver.h"
#include "bridges/mavlink/frame_reader.h"
#include "bridges/mavlink/frame_writer.h"
#include "bridges/mavlink/link.h"
#include "bridges/mavlink/options.h"

namespace ergocast::mavlink {
namespace {

enum ExitCode { kDone = 0, kUnavailable = 3, kFailed = 4 };

/// In one turn, so that a flood does not keep setpoints from being sent.
constexpr int kMostReads = 256;

Instant now() {
  return Instant(std::chrono::duration_cast<Instant::duration>(
      std::chrono::steady_clock::now().time_since_epoch()));
}

std::optional<std::uint64_t> signing_time_now() {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  return signing_time(time.tv_sec, time.tv_nsec);
}

/// A line of the log. Characters that could control a terminal are shown as dots. It is left out
/// while the log takes no more, because setpoints must not wait for a reader.
void say(AgentId id, const char* level, std::string text) {
  static int left_out = 0;
  pollfd log{STDERR_FILENO, POLLOUT, 0};
  if (poll(&log, 1, 0) <= 0 || (log.revents & POLLOUT) == 0) return ++left_out, void();
  if (const int lines = std::exchange(left_out, 0); lines > 0)
    text += " (" + std::to_string(lines) + " lines before this one could not be written)";
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' ' || c == 127; }, '.');
  char time[32];
  const std::time_t seconds = std::time(nullptr);
  std::tm parts{};
  std::strftime(time, sizeof time, "%Y-%m-%dT%H:%M:%S", localtime_r(&seconds, &parts));
  std::fprintf(stderr, "%s %s driver-%d: %s\n", time, level, id, text.c_str());
}

Incarnation random_identity() {
  Incarnation bits = 0;
  while ((bits & 0xFFFFFFFF) == 0) {
    if (getrandom(&bits, sizeof bits, 0) != static_cast<ssize_t>(sizeof bits)) bits = 0;
  }
  return bits;
}

int signals_to_wait_for() {
  std::signal(SIGPIPE, SIG_IGN);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaddset(&set, SIGHUP);  // nohup ignores it
  sigprocmask(SIG_BLOCK, &set, nullptr);
  return signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
}

class Process {
 public:
  Process(const Options& options, Buses buses, std::unique_ptr<Link> link, std::uint64_t time)
      : options_(options),
        buses_(std::move(buses)),
        link_(std::move(link)),
        driver_(options.run, random_identity(), options.id, options.vehicle),
        reader_(options.signing_key, time),
        writer_(options.signing_key, time),
        signals_(signals_to_wait_for()) {}
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() { close(signals_); }

  int run() {
    say(options_.id, "info", "waits for a mission and for the autopilot at " + options_.link);
    for (act(); !driver_.finished(); act()) {
      wait();
      buses_.read(driver_.run(), [this](const Message& message, Bus bus, AgentId transmitter) {
        driver_.receive(message, bus, transmitter, now());
      });
      read_link();
    }
    say(options_.id, driver_.failed() ? "error" : "info",
        "finished at tick " + std::to_string(driver_.tick()) + ": " + driver_.reason() + "; " +
            std::to_string(driver_.missed_deadlines()) + " commands too late");
    return driver_.failed() ? kFailed : kDone;
  }

 private:
  void act() {
    if (const std::string change = link_->mend(now()); !change.empty())
      say(options_.id, "info", change);
    out_.clear();
    packets_.clear();
    driver_.advance(now(), out_, packets_);
    buses_.send(out_);
    if (const auto time = signing_time_now()) writer_.note_time(*time);
    for (const Packet& packet : packets_) link_->write(writer_.frame_of(packet, driver_.source()));
    for (const Note& note : driver_.take_notes())
      say(options_.id, note.warning ? "warning" : "info", note.text);
  }

  void wait() {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(driver_.next_wakeup() - now());
    std::vector<pollfd> all{{signals_, POLLIN, 0}, {link_->fd(), POLLIN, 0}};
    for (const int fd : buses_.fds()) all.push_back({fd, POLLIN, 0});
    poll(all.data(), all.size(), static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 1000)));
    signalfd_siginfo signal;
    if (::read(signals_, &signal, sizeof signal) > 0) driver_.stop("a signal stopped the driver");
  }

  void read_link() {
    for (int i = 0; i < kMostReads; ++i) {
      const auto bytes = link_->read(now());
      if (bytes.empty()) break;
      if (link_->has_datagrams()) reader_.begin_anew();
      received_.clear();
      reader_.read(bytes, received_);
      for (const Received& one : received_) driver_.receive(one, now());
    }
    const FrameReader::Counts& counts = reader_.counts();
    const std::int64_t refused = counts.unsigned_ + counts.wrong_key + counts.repeated;
    if (refused > 0 && !std::exchange(told_of_signatures_, true))
      say(options_.id, "warning", "messages without a valid and new signature are refused");
  }

  const Options& options_;
  Buses buses_;
  std::unique_ptr<Link> link_;
  Driver driver_;
  FrameReader reader_;
  FrameWriter writer_;
  int signals_;
  bool told_of_signatures_ = false;
  Outbox out_;
  std::vector<Packet> packets_;
  std::vector<Received> received_;
};

int run(const Options& options) {
  const auto failed = [&](const std::string& problem) {
    say(options.id, "error", problem);
    return kUnavailable;
  };
  const auto time = signing_time_now();
  if (options.signing_key && !time)
    return failed("the clock of this machine is before 2015, so messages cannot be signed: set it");
  auto buses = Buses::open(options.url, subscriptions_of(Driver::kRole), options.authenticator);
  if (!buses) return failed(buses.error());
  auto link = Link::open(options.link);
  if (!link) return failed(link.error());
  return Process(options, *std::move(buses), *std::move(link), time.value_or(0)).run();
}

}  // namespace
}  // namespace ergocast::mavlink

int main(int argc, char** argv) {
  ergocast::mavlink::Options options;
  const int code = ergocast::mavlink::read_command_line(argc, argv, options);
  return code >= 0 ? code : ergocast::mavlink::run(options);
}
