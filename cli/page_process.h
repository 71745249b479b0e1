// SPDX-License-Identifier: BSD-3-Clause
// The page of `ergocast run --watch`: a process of its own, whose end costs the mission nothing.
//
// The socket is bound here, before the mission starts, and outlives the process that serves it. So
// the address and the token stay, and browsers that connect meanwhile wait for the next process.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "cli/page_socket.h"
#include "cli/progress.h"
#include "core/ids.h"
#include "runtime/child.h"
#include "runtime/lcm_url.h"

namespace spdlog {
class logger;
}

namespace ergocast::cli {

/// What the process inherits, besides its options (cli/run_page.cc): descriptors, and a variable of
/// its environment, which only this user can read.
inline constexpr int kPageSocket = 3;
inline constexpr int kPageUntil = 4;  ///< a pipe that ends when the mission has ended
inline constexpr const char* kPageToken = "ERGOCAST_PAGE_TOKEN";

class PageProcess {
 public:
  struct Setup {
    std::filesystem::path program;  ///< `ergocast`
    std::filesystem::path run_dir;
    LcmUrl url;
    RunId run = 0;
    std::filesystem::path key_file;  ///< empty: no key
    PageOptions page;
  };

  /// An error tells why the page's address cannot be used.
  static std::variant<std::unique_ptr<PageProcess>, std::string> start(const Setup& setup,
                                                                       ProgressDisplay& display);
  PageProcess(const PageProcess&) = delete;
  PageProcess& operator=(const PageProcess&) = delete;
  /// Ends the process.
  ~PageProcess();

  std::string url() const { return socket_.url(); }
  /// Starts the process again if it has ended; to be called all the time.
  void attend(Instant now);
  /// A line for the page's log, which goes to log/run.log.
  void print(const std::string& line);
  /// The record is complete: from now on the page shows it.
  void finish() { running_.reset(); }

 private:
  PageProcess(const Setup& setup, PageSocket socket, ProgressDisplay& display);
  void launch(Instant now);

  PageSocket socket_;
  ProgressDisplay& display_;
  std::shared_ptr<spdlog::logger> log_;  // null: it cannot be written
  std::optional<Socket> until_;          // the process's end of the pipe
  std::optional<Socket> running_;        // ours, as long as the mission runs
  Child::Program program_;
  std::optional<Child> child_;
  int ends_ = 0;
  Instant restart_at_{};
};

}  // namespace ergocast::cli
