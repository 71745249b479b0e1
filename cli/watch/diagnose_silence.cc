// SPDX-License-Identifier: BSD-3-Clause
// Checks the possible causes of silence in order, keys first, and describes the first that applies.
#include "cli/watch/diagnose_silence.h"

namespace ergocast::cli {
namespace {

/// Explains why every message was refused, if the keys are the cause.
std::string key_problem(const BusOptions& options, const RefusalCounts& refused) {
  const auto count = [&refused](Refusal kind) { return refused[static_cast<std::size_t>(kind)]; };
  const std::string url = options.url.base();
  // Some of the refused messages may come from other teams.
  if (count(Refusal::kUnkeyed) > count(Refusal::kTag)) {
    return "the team on " + url + " has no mission key: ask without --key-file";
  }
  if (count(Refusal::kTag) == 0) return "";
  return options.authenticator.keyed()
             ? "the team on " + url + " has another mission key than " + options.key_file
             : "the team on " + url + " has a mission key: give it with --key-file";
}

}  // namespace

std::string why_nobody(const BusOptions& options, const Transport& transport) {
  const std::string url = options.url.base();
  std::string text =
      "no message of " + (options.run == 0 ? "any run" : "run " + to_hex(options.run)) +
      " arrived on " + url +
      ": is the mission running, and on this URL? `ergocast list` names the runs that "
      "you started here, `ergocast doctor --lcm-url \"" +
      url + "\"` checks the network between the hosts";
  if (transport.unknown_format().count > 0) {
    text =
        transport.unknown_format().channel + " arrives on " + url + " in a format that version " +
        version() +
        " does not know: another version of Ergocast is on this URL; `ergocast doctor --peer` on "
        "both hosts names the one to update";
  }
  const std::string keys = key_problem(options, transport.refused());
  return keys.empty() ? text : keys;
}

}  // namespace ergocast::cli
