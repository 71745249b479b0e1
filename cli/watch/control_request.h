// SPDX-License-Identifier: BSD-3-Clause
// A request of an operator from a page with control (`ergocast run --watch --control` or `ergocast
// watch --control`).
//
// A browser sends a request as JSON. The page's process checks its form, and passes it on to the
// process that started it. That process checks it again and decides (cli/operate/control_desk.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "cli/watch/drawn_target.h"
#include "cli/watch/drawn_zone.h"
#include "core/base/ids.h"

namespace ergocast::cli {

enum class ControlAct {
  kTake,     ///< takes control, also from another operator
  kRelease,  ///< gives control back
  kHere,     ///< keeps control: the browser is still there
  kPause,
  kResume,
  kStop,     ///< in order
  kStopNow,  ///< at once
  kHome,     ///< one agent goes home
  kOut,      ///< one agent leaves the mission
  kTarget,   ///< the team covers a drawn target
  kZone,     ///< the team leaves a drawn zone
  kReopen,   ///< a zone is cancelled: it ends
};
/// "take", "release", "here", "pause", "resume", "stop", "stop-now", "home", "out", "target",
/// "zone" or "reopen".
const char* to_string(ControlAct act);

struct ControlRequest {
  /// Limit (Page): length of a request of an operator [bytes]. Beyond it: it is refused with 400.
  static constexpr std::size_t kLongest = 4096;
  /// Limit (Page): length of an operator's name [bytes]. Beyond it: the request counts
  /// without a name.
  static constexpr std::size_t kLongestName = 48;

  std::uint32_t operator_id = 0;  ///< random, one for each page that was opened; not secret
  /// The operator chooses it. Empty if it does not fit into a line of the log: a bad name stops no
  /// request.
  std::string name;
  std::int64_t number = 0;  ///< greater than in all earlier requests of this operator
  Tick tick = 0;            ///< the newest that the page has shown
  ControlAct act = ControlAct::kHere;
  AgentId agent = kUnassigned;          ///< for kHome and kOut only
  std::optional<DrawnTarget> target{};  ///< for kTarget only
  std::optional<DrawnZone> zone{};      ///< for kZone only
  std::int32_t amendment = -1;          ///< for kReopen only: that of the zone
  /// For kTarget and kZone: the first number under which this page has sent an earlier state of the
  /// drawing without an answer; 0: none. At most one of them becomes an order.
  std::int64_t instead_of = 0;

  /// Nothing if a field is unknown, missing, of a wrong type or out of range.
  static std::optional<ControlRequest> parse(std::string_view text);
};

}  // namespace ergocast::cli
