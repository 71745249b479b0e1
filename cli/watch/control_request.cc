// SPDX-License-Identifier: BSD-3-Clause
// Reads a request field by field. A text with anything unexpected is no request.
#include "cli/watch/control_request.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/mission/amendments.h"
#include "core/mission/kinds.h"
#include "text/printable.h"

namespace ergocast::cli {
namespace {

using nlohmann::json;

constexpr const char* kNames[] = {"take",     "release", "here", "pause",  "resume", "stop",
                                  "stop-now", "home",    "out",  "target", "zone",   "reopen"};

std::optional<std::int64_t> whole_number(const json& object, const char* key, std::int64_t least,
                                         std::int64_t most) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_integer()) return std::nullopt;
  if (found->is_number_unsigned() &&
      found->get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()})
    return std::nullopt;
  const auto value = found->get<std::int64_t>();
  if (value < least || value > most) return std::nullopt;
  return value;
}

std::optional<std::string> word(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) return std::nullopt;
  return found->get<std::string>();
}

/// Whether a text has characters that nobody sees, or that turn its direction.
bool hides(const std::string& text) {
  constexpr std::array kMarks = {"\u200b", "\u200c", "\u200d", "\u200e", "\u200f", "\u2028",
                                 "\u2029", "\u202a", "\u202b", "\u202c", "\u202d", "\u202e",
                                 "\u2060", "\u2066", "\u2067", "\u2068", "\u2069", "\ufeff"};
  return std::ranges::any_of(kMarks,
                             [&](const char* mark) { return text.find(mark) != text.npos; });
}

/// Whether a name fits into a line of the log.
bool is_name(const std::string& text) {
  return text.size() <= ControlRequest::kLongestName && printable(text) == text &&
         text.find_first_of("\n\t") == text.npos && !hides(text);
}

}  // namespace

const char* to_string(ControlAct act) { return kNames[static_cast<int>(act)]; }

std::optional<ControlRequest> ControlRequest::parse(std::string_view text) {
  if (text.size() > kLongest) return std::nullopt;
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return std::nullopt;
  const auto id = whole_number(object, "operator", 1, std::numeric_limits<std::uint32_t>::max());
  const auto number = whole_number(object, "number", 1, std::int64_t{1} << 53);
  const auto tick = whole_number(object, "tick", 0, std::int64_t{1} << 53);
  const auto name = word(object, "name"), act = word(object, "act");
  if (!id || !number || !tick || !name || !act) return std::nullopt;
  const auto known = std::find(std::begin(kNames), std::end(kNames), *act);
  if (known == std::end(kNames)) return std::nullopt;
  ControlRequest request{.operator_id = static_cast<std::uint32_t>(*id),
                         .name = is_name(*name) ? *name : "",
                         .number = *number,
                         .tick = *tick,
                         .act = static_cast<ControlAct>(std::distance(std::begin(kNames), known))};
  const bool names_agent = request.act == ControlAct::kHome || request.act == ControlAct::kOut;
  const auto agent = whole_number(object, "agent", 0, kMaxAgents - 1);
  if (names_agent != object.contains("agent") || (names_agent && !agent)) return std::nullopt;
  const bool has_target = request.act == ControlAct::kTarget;
  if (has_target != object.contains("target")) return std::nullopt;
  if (has_target) request.target = DrawnTarget::parse(object["target"]);
  if (has_target != request.target.has_value()) return std::nullopt;
  const bool has_zone = request.act == ControlAct::kZone;
  if (has_zone != object.contains("zone")) return std::nullopt;
  if (has_zone) request.zone = DrawnZone::parse(object["zone"]);
  if (has_zone != request.zone.has_value()) return std::nullopt;
  const bool cancels = request.act == ControlAct::kReopen;
  const auto amendment = whole_number(object, "amendment", 0, kMaxAmendments - 1);
  if (cancels != amendment.has_value()) return std::nullopt;
  const bool replaces = (has_target || has_zone) && object.contains("instead_of");
  const auto instead_of = whole_number(object, "instead_of", 1, *number - 1);
  if (replaces && !instead_of) return std::nullopt;
  const std::size_t of_the_act = names_agent || has_target || has_zone || cancels ? 1 : 0;
  if (object.size() != 5 + of_the_act + (replaces ? 1 : 0)) return std::nullopt;
  if (agent) request.agent = static_cast<AgentId>(*agent);
  if (amendment) request.amendment = static_cast<std::int32_t>(*amendment);
  request.instead_of = instead_of.value_or(0);
  return request;
}

}  // namespace ergocast::cli
