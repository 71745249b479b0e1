// SPDX-License-Identifier: BSD-3-Clause
// What other programs are shown of a running team: Foxglove and TAK.
//
// A page with control, and that of `ergocast run`, have a process of their own, which also serves
// these programs. Its parent opens the addresses first, so that a person reads what is wrong, and
// so that they outlive that process.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/foxglove/foxglove_output.h"
#include "cli/tak/cot_output.h"
#include "cli/team/team_display.h"
#include "cli/watch/page_process.h"
#include "core/base/ids.h"
#include "core/base/result.h"

namespace ergocast::cli {

struct DisplayOptions {
  CotOptions cot;           ///< its origin is also Foxglove's
  int foxglove_port = 0;    ///< 0: Foxglove is not served
  int foxglove_socket = 0;  ///< that was inherited; 0: none
};

/// --foxglove, --cot and --origin.
void add_display_options(CLI::App& app, DisplayOptions& options);
/// What is wrong with them, and with the page's options beside them.
std::optional<std::string> why_refused(const DisplayOptions& options, const PageOptions& page);

/// Both lists, one after the other.
std::vector<std::string> together(std::vector<std::string> one, std::vector<std::string> other);

class LiveDisplays {
 public:
  /// Opens the addresses, or those that this process has inherited. If that fails, prints why and
  /// returns the exit code.
  /// @param run_dir  of the team; empty: not known here
  static Result<std::unique_ptr<LiveDisplays>, int> open(const DisplayOptions& options,
                                                         const PageOptions& page,
                                                         std::filesystem::path run_dir);

  /// With it the page's process opens the same.
  PageProcess::Displays handed() const;
  /// The address that a person gives Foxglove; empty: it is not served.
  std::string foxglove_url() const;

  // ---- in the process that shows the team ----

  /// @param note  gets a sentence when a client is too slow
  void begin(std::function<void(const std::string&)> note);
  std::vector<TeamDisplay*> displays();
  /// Call it at least ten times a second.
  void serve(Instant now);
  /// A name for each client.
  std::vector<std::string> clients() const;
  /// What was lost on the way to TAK, for people; empty: nothing.
  std::string losses() const { return cot_ ? cot_->losses() : ""; }

 private:
  LiveDisplays(const DisplayOptions& options, std::filesystem::path run_dir)
      : options_(options), run_dir_(std::move(run_dir)), origin_(options.cot.origin) {}
  std::optional<int> open_cot();
  std::optional<int> open_foxglove(PageOptions page);

  DisplayOptions options_;
  std::filesystem::path run_dir_;
  std::optional<GeoPlace> origin_;
  std::optional<CotOutput> cot_;
  std::shared_ptr<PageSocket> socket_;  // null: Foxglove is not served
  std::unique_ptr<FoxgloveOutput> foxglove_;
};

}  // namespace ergocast::cli
