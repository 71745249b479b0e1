// SPDX-License-Identifier: BSD-3-Clause
// A page in a process of its own. If the page has control, this process gives the orders.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "cli/operate/control.h"
#include "cli/watch/page_process.h"
#include "cli/watch/progress.h"
#include "core/base/ids.h"
#include "core/base/result.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {

class ControlledPage {
 public:
  /// Starts the page's process. The page shows `team`, and with control gives orders to it.
  /// An error if the page's address or LCM cannot be used.
  /// @param displays  what the page's process also serves
  /// @param display  gets the lines about the page and about control; it outlives the page
  static Result<std::unique_ptr<ControlledPage>> start(const BusOptions& team,
                                                       const std::filesystem::path& run_dir,
                                                       const PageOptions& page, bool with_control,
                                                       PageProcess::Displays displays,
                                                       ProgressDisplay& display);

  PageProcess& page() { return *page_; }
  /// Null: the page only shows.
  Control* control() { return control_.get(); }
  /// Call at least ten times a second.
  void attend(Instant now);
  /// The mission is over: no order has an effect from now on.
  void end_control(Instant now) {
    if (control_) control_->end(now);
  }

 private:
  std::unique_ptr<Control> control_;
  std::unique_ptr<PageProcess> page_;
};

}  // namespace ergocast::cli
