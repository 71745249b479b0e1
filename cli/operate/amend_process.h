// SPDX-License-Identifier: BSD-3-Clause
// The order to cover a target, or to leave a zone, that was drawn on the page. `ergocast amend`
// gives it in a process of its own: to compile a target or to find the ways out of a zone may take
// seconds, and this process must not stop meanwhile.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/operate/order.h"
#include "cli/watch/drawn_target.h"
#include "cli/watch/drawn_zone.h"
#include "runtime/bus/socket.h"
#include "runtime/process/child.h"
#include "runtime/process/program_options.h"
#include "runtime/process/sealed_file.h"

namespace ergocast::cli {

class AmendProcess final : public Order {
 public:
  /// Starts the process.
  /// @param team  its run is known, and its key can sign
  /// @param by  the operator
  AmendProcess(const BusOptions& team, const DrawnTarget& target, const std::string& by);
  AmendProcess(const BusOptions& team, const DrawnZone& zone, const std::string& by);
  AmendProcess(const AmendProcess&) = delete;
  AmendProcess& operator=(const AmendProcess&) = delete;
  /// Ends the process. What it has sent may still be obeyed.
  ~AmendProcess() override;

  void send(const MonitoredRun& team, Instant now, Outbox& out) override;
  OrderReport report(const MonitoredRun& team, Instant now) const override;

 private:
  /// @param text  of the drawing, which the process gets as its first descriptor
  /// @param what  the options that name it
  void start(const BusOptions& team, const std::string& text, std::vector<std::string> what);
  std::string printed() const;

  const char* checked_;  // while nothing is known
  std::optional<SealedFile> drawing_, key_;
  std::optional<Socket> output_;  // a file in memory, which gets both of its streams
  std::optional<Child> child_;
  bool running_ = false;
  std::string problem_;  // why there is no process
};

/// What people read of the output of `ergocast amend`, on one line: the place in the file
/// `file_name`, which they have never seen, is left out.
std::string amend_answer(std::string printed, const std::string& file_name);

}  // namespace ergocast::cli
