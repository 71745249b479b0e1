// SPDX-License-Identifier: BSD-3-Clause
// The page of `ergocast run --watch`, or of `ergocast watch --control`, in a separate process. If
// it ends, the mission continues.
//
// The socket is bound here, before the mission starts, and outlives the process that serves it. So
// a restarted process has the same address and token, and waiting browsers connect to it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/watch/control_link.h"
#include "cli/watch/page_socket.h"
#include "cli/watch/progress.h"
#include "core/base/ids.h"
#include "core/base/result.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/process/child.h"
#include "runtime/process/sealed_file.h"

namespace spdlog {
class logger;
}

namespace ergocast::cli {

/// The process inherits these descriptors, its options (cli/operate/run_page.cc), and environment
/// variables that only this user can read.
inline constexpr int kPageSocket = 3;
inline constexpr int kPageUntil = 4;    ///< a pipe that ends when the mission has ended
inline constexpr int kPageListens = 5;  ///< an eventfd that it writes to when it receives messages
inline constexpr int kPageControl = 6;  ///< of a page with control: its end of the ControlLink
inline constexpr const char* kPageToken = "ERGOCAST_PAGE_TOKEN";
inline constexpr const char* kControlToken = "ERGOCAST_CONTROL_TOKEN";

class PageProcess {
 public:
  /// What else the process serves: cli/operate/live_displays.h.
  struct Displays {
    std::vector<std::string> arguments = {}, environment = {};
    std::shared_ptr<const PageSocket> foxglove = {};  ///< null: Foxglove is not served
  };
  struct Setup {
    std::filesystem::path program;  ///< `ergocast`
    std::filesystem::path run_dir;  ///< empty: there is none on this host
    LcmUrl url;
    RunId run = 0;
    std::optional<SealedFile> key;  ///< checks messages and cannot sign; nothing: no key
    PageOptions page;
    std::optional<SealedFile> certificate, tls_key;  ///< of page.tls, if there is one
    const ControlLink* control = nullptr;            ///< the page's end; null: the page only shows
    std::string control_token = {};
    Displays displays = {};
  };

  /// Returns an error if the page's address cannot be used.
  static Result<std::unique_ptr<PageProcess>> start(const Setup& setup, ProgressDisplay& display);
  PageProcess(const PageProcess&) = delete;
  PageProcess& operator=(const PageProcess&) = delete;
  /// Ends the process.
  ~PageProcess();

  /// The address that a person opens. What follows # never leaves the browser.
  std::string url() const;
  /// Waits until the process receives messages or has ended, or until `stop_fd` is readable. A page
  /// that misses the first places cannot compute what the team has found. The mission does not wait
  /// longer than 30 s.
  void wait_until_it_listens(int stop_fd);
  /// Starts the process again if it has ended; call it often.
  void attend(Instant now);
  /// Writes a line to the page's log, log/run.log.
  void print(const std::string& line);
  /// Call when the record is complete: from now on the page shows it, and has no control.
  void finish() {
    running_.reset();
    control_token_.clear();
  }

 private:
  PageProcess(const Setup& setup, PageSocket socket, ProgressDisplay& display);
  void hand_displays(const Displays& displays);
  void launch(Instant now);

  PageSocket socket_;
  std::string control_token_;
  ProgressDisplay& display_;
  std::shared_ptr<spdlog::logger> log_;  // null: it cannot be opened
  std::optional<Socket> until_;          // the process's end of the pipe
  std::optional<Socket> running_;        // ours, as long as the mission runs
  Socket listens_;
  std::optional<SealedFile> key_, certificate_, tls_key_;  // each new process inherits them
  std::shared_ptr<const PageSocket> foxglove_;             // as this
  Child::Program program_;
  std::optional<Child> child_;
  int ends_ = 0;
  Instant restart_at_{};
};

}  // namespace ergocast::cli
