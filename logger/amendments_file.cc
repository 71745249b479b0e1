// SPDX-License-Identifier: BSD-3-Clause
// Writes one amendment a line, and checks each one that is read.
#include "logger/amendments_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "logger/json_file.h"
#include "logger/run_record.h"
#include "plan/mission_limits.h"

namespace ergocast {
namespace {

using Json = nlohmann::ordered_json;

/// Limit (Record): length of `amendments.json` [bytes]: some thousand targets of 256 numbers.
/// Beyond it: `verify`, `report` and other commands refuse the record.
constexpr std::size_t kMostAmendmentBytes = std::size_t{64} << 20;
/// Limit (Record): values in `amendments.json`. Beyond it: `verify`, `report` and other commands
/// refuse the record.
constexpr std::size_t kMostAmendmentValues = 2'500'000;

Json without_numbers(const ReceivedAmendment& one, double dt_s) {
  const Amendment& amendment = one.amendment;
  Json json = {{"number", amendment.number},
               {"kind", to_string(amendment.kind)},
               {"from_tick", amendment.from},
               {"t_s", static_cast<double>(amendment.from) * dt_s}};
  if (amendment.kind == AmendmentKind::kEnd) {
    json["tick_count"] = amendment.hash;
  } else if (amendment.kind == AmendmentKind::kReopen) {
    json["zone"] = amendment.hash;
  } else if (amendment.kind >= AmendmentKind::kTarget) {
    json["hash"] = to_hex(amendment.hash);
  }
  if (one.zone) {
    json["closed_tick"] = one.zone->closed;
    json["until_tick"] = one.zone->until;
    if (one.zone->cancelled >= 0) json["cancelled_tick"] = one.zone->cancelled;
  }
  if (one.note) {
    json["x_m"] = one.note->x_m.x();
    json["y_m"] = one.note->x_m.y();
    if (one.note->is_sighting()) {
      json["sigma_m"] = one.note->sigma_m;
      json["share"] = one.note->share;
    }
  }
  if (!amendment.by.empty()) json["by"] = amendment.by;
  if (one.is_void) json["void"] = true;
  return json;
}

/// Corners, and in a box the heights.
void write_place(const Zone& zone, Json& json) {
  json["corners_m"] = Json::array();
  for (const Eigen::Vector2d& corner_m : zone.corners_m)
    json["corners_m"].push_back({corner_m.x(), corner_m.y()});
  if (zone.high_m > zone.low_m) json["heights_m"] = {zone.low_m, zone.high_m};
}

/// The numbers of each kind.
Json law_json(const LawChange& change) {
  Json list = Json::array();
  for (const LawNumbers& numbers : change.kinds)
    list.push_back({{"u_max_mps", numbers.u_max_mps},
                    {"noise_intensity", numbers.noise_intensity},
                    {"noise_ceiling", numbers.noise_ceiling}});
  return list;
}

Json list_of(const Coefficients& numbers) {
  return std::vector<double>(numbers.begin(), numbers.end());
}

// ---- reading ----

/// No mission has so many ticks.
constexpr Tick kMostTicks = Tick{1} << 53;

/// The value of a key; null if there is none.
const Json& value_in(const Json& object, const char* key) {
  static const Json null;
  const auto found = object.find(key);
  return found == object.end() ? null : *found;
}

std::optional<std::int64_t> count_in(const Json& object, const char* key, std::int64_t most) {
  const Json& value = value_in(object, key);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > static_cast<std::uint64_t>(most))
    return std::nullopt;
  return value.get<std::int64_t>();
}

std::optional<AmendmentKind> kind_in(const Json& object) {
  constexpr std::array kKinds{AmendmentKind::kPause,  AmendmentKind::kResume,
                              AmendmentKind::kTarget, AmendmentKind::kEnd,
                              AmendmentKind::kZone,   AmendmentKind::kLaw,
                              AmendmentKind::kReopen, AmendmentKind::kDismiss};
  const Json& name = value_in(object, "kind");
  const auto found =
      std::ranges::find_if(kKinds, [&](AmendmentKind kind) { return name == to_string(kind); });
  return found == kKinds.end() ? std::nullopt : std::optional(*found);
}

/// A number that to_hex() wrote.
std::optional<std::uint64_t> hash_in(const Json& object) {
  const Json& hash = value_in(object, "hash");
  if (!hash.is_string()) return std::nullopt;
  const auto& text = hash.get_ref<const std::string&>();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? std::optional(number) : std::nullopt;
}

/// The numbers of a list; nothing if it is none, or has other values.
std::optional<Coefficients> numbers_in(const Json& list) {
  if (!list.is_array()) return std::nullopt;
  Coefficients numbers(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].is_number()) return std::nullopt;
    numbers[static_cast<Eigen::Index>(i)] = list[i].get<double>();
  }
  return numbers;
}

/// The target of an entry that has its numbers.
Result<TargetChange> target_in(const Json& entry, const Amendment& amendment,
                               const Mission& mission) {
  static const Json kNone = Json::array();
  auto target = numbers_in(value_in(entry, "target"));
  auto cosine =
      numbers_in(entry.contains("cosine_target") ? value_in(entry, "cosine_target") : kNone);
  if (!target || !cosine || !is_target(*target, *cosine, mission))
    return failure("its target is none of the mission of " + std::string(kPlanFile));
  TargetChange change{amendment.number, amendment.from, *std::move(target), *std::move(cosine)};
  if (target_hash(change) != amendment.hash) return failure("its target has another hash");
  return change;
}

bool read_point(const Json& pair, double& one, double& other) {
  if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number())
    return false;
  one = pair[0].get<double>();
  other = pair[1].get<double>();
  return true;
}

/// The zone of an entry that has its corners.
Result<Zone> zone_in(const Json& entry, const Amendment& amendment, const Mission& mission) {
  const auto closed = count_in(entry, "closed_tick", kMostTicks);
  const auto until = count_in(entry, "until_tick", kMostTicks);
  const Json& corners = value_in(entry, "corners_m");
  const auto bad = [] {
    return failure("its zone is none of the mission of " + std::string(kPlanFile));
  };
  if (!closed || !until || !corners.is_array()) return bad();
  Zone zone{amendment.number, *closed, amendment.from, *until, Ring(corners.size())};
  if (entry.contains("cancelled_tick")) {
    const auto cancelled = count_in(entry, "cancelled_tick", kMostTicks);
    if (!cancelled) return bad();
    zone.cancelled = *cancelled;
  }
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (!read_point(corners[i], zone.corners_m[i].x(), zone.corners_m[i].y())) return bad();
  if (entry.contains("heights_m") &&
      !read_point(value_in(entry, "heights_m"), zone.low_m, zone.high_m))
    return bad();
  if (!is_zone(zone, mission.domain)) return bad();
  if (zone_hash(zone) != amendment.hash) return failure("its zone has another hash");
  return zone;
}

/// The law of an entry that has its numbers.
Result<LawChange> law_in(const Json& entry, const Amendment& amendment, const Mission& mission) {
  const Json& list = value_in(entry, "law");
  const auto bad = [] {
    return failure("its law is none of the mission of " + std::string(kPlanFile));
  };
  if (!list.is_array()) return bad();
  LawChange change{amendment.number, amendment.from, std::vector<LawNumbers>(list.size())};
  for (std::size_t i = 0; i < list.size(); ++i) {
    LawNumbers& numbers = change.kinds[i];
    for (const auto& [key, number] : {std::pair("u_max_mps", &numbers.u_max_mps),
                                      std::pair("noise_intensity", &numbers.noise_intensity),
                                      std::pair("noise_ceiling", &numbers.noise_ceiling)}) {
      const Json& value = value_in(list[i], key);
      if (!value.is_number()) return bad();
      *number = value.get<double>();
    }
  }
  if (!is_law(change, mission)) return bad();
  if (law_hash(change) != amendment.hash) return failure("its law has another hash");
  return change;
}

/// The sighting or dismissal of an entry that has its place.
Result<SearchNote> note_in(const Json& entry, const Amendment& amendment, const Mission& mission) {
  SearchNote note{amendment.number, amendment.from};
  const auto bad = [] {
    return failure("its place is none of the mission of " + std::string(kPlanFile));
  };
  for (const auto& [key, number] :
       {std::pair("x_m", &note.x_m.x()), std::pair("y_m", &note.x_m.y()),
        std::pair("sigma_m", &note.sigma_m), std::pair("share", &note.share)}) {
    const Json& value = value_in(entry, key);
    if (!value.is_number() && !value.is_null()) return bad();
    if (value.is_number()) *number = value.get<double>();
  }
  const bool is_sighting = amendment.kind == AmendmentKind::kTarget;
  if (note.is_sighting() != is_sighting || !is_search_note(note, mission)) return bad();
  if (!is_sighting && search_note_hash(note) != amendment.hash)
    return failure("its place has another hash");
  return note;
}

/// Takes in the content of an entry, if it is there.
std::optional<std::string> read_content(const Json& entry, const Mission& mission,
                                        ReceivedAmendment& one) {
  if (one.amendment.kind == AmendmentKind::kZone && entry.contains("corners_m")) {
    auto zone = zone_in(entry, one.amendment, mission);
    if (!zone) return zone.error();
    one.zone = *std::move(zone);
  }
  if (one.amendment.kind == AmendmentKind::kLaw && entry.contains("law")) {
    auto law = law_in(entry, one.amendment, mission);
    if (!law) return law.error();
    one.law = *std::move(law);
  }
  const bool has_place =
      one.amendment.kind == AmendmentKind::kTarget || one.amendment.kind == AmendmentKind::kDismiss;
  if (has_place && entry.contains("x_m")) {
    const auto note = note_in(entry, one.amendment, mission);
    if (!note) return note.error();
    one.note = *note;
  }
  if (one.amendment.kind == AmendmentKind::kTarget && entry.contains("target")) {
    auto target = target_in(entry, one.amendment, mission);
    if (!target) return target.error();
    one.target = *std::move(target);
  }
  return std::nullopt;
}

Result<ReceivedAmendment> amendment_in(const Json& entry, const Mission& mission) {
  const std::string none = "is not an amendment";
  if (!entry.is_object()) return failure(none);
  const auto number = count_in(entry, "number", kMaxAmendments - 1);
  const auto from = count_in(entry, "from_tick", kMostTicks);
  const auto kind = kind_in(entry);
  if (!number || !from || !kind) return failure(none);
  ReceivedAmendment one{{static_cast<std::int32_t>(*number), *kind, *from, 0}};
  one.is_void = value_in(entry, "void") == true;
  if (entry.contains("by")) {
    const Json& by = value_in(entry, "by");
    if (!by.is_string() || !is_operator_name(by.get_ref<const std::string&>()))
      return failure("its operator has no possible name");
    one.amendment.by = by.get<std::string>();
  }
  if (*kind == AmendmentKind::kEnd) {
    const auto tick_count = count_in(entry, "tick_count", kMostTicks);
    if (!tick_count || !is_tick_count(*tick_count, mission.timing))
      return failure("its end is none of the mission of " + std::string(kPlanFile));
    one.amendment.hash = static_cast<std::uint64_t>(*tick_count);
    return one;
  }
  if (*kind == AmendmentKind::kReopen) {
    const auto zone = count_in(entry, "zone", *number - 1);
    if (!zone) return failure("the zone that it cancels has no possible number");
    one.amendment.hash = static_cast<std::uint64_t>(*zone);
    return one;
  }
  if (*kind < AmendmentKind::kTarget) return one;
  const auto hash = hash_in(entry);
  if (!hash) return failure("its " + std::string(to_string(*kind)) + " has no hash");
  one.amendment.hash = *hash;
  if (const auto problem = read_content(entry, mission, one)) return failure(*problem);
  return one;
}

/// Reads a list of holds_json(); nothing if its content is impossible.
std::optional<std::vector<Hold>> holds_in(const Json& list) {
  std::vector<Hold> holds;
  if (!list.is_array()) return std::nullopt;
  for (const Json& pair : list) {
    if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number_integer()) return std::nullopt;
    if (!pair[1].is_null() && !pair[1].is_number_integer()) return std::nullopt;
    holds.push_back({pair[0].get<Tick>(), pair[1].is_null() ? -1 : pair[1].get<Tick>()});
  }
  return are_holds(holds) ? std::optional(std::move(holds)) : std::nullopt;
}

/// Whether numbers ascend, and of those that are not void also the ticks of targets.
bool follow(const std::vector<ReceivedAmendment>& all) {
  if (!std::ranges::is_sorted(all, {}, [](const auto& one) { return one.amendment.number; }))
    return false;
  std::int32_t number = -1;
  Tick target_from = -1, law_from = -1;
  for (const ReceivedAmendment& one : all) {
    if (one.is_void) continue;
    const Amendment& amendment = one.amendment;
    if (amendment.number == std::exchange(number, amendment.number)) return false;
    if (amendment.kind == AmendmentKind::kTarget &&
        amendment.from < std::exchange(target_from, amendment.from))
      return false;
    if (amendment.kind == AmendmentKind::kLaw &&
        amendment.from < std::exchange(law_from, amendment.from))
      return false;
  }
  return true;
}

Result<ReceivedAmendments> all_in(const Json& content, const Mission& mission) {
  if (!content.is_object()) return failure("is not an object");
  const Json& entries = value_in(content, "amendments");
  auto holds = holds_in(value_in(content, "holds"));
  if (!holds || !entries.is_array()) return failure("has no list of amendments, or no holds");
  std::vector<ReceivedAmendment> all;
  for (const Json& entry : entries) {
    auto one = amendment_in(entry, mission);
    if (!one) return failure("entry " + std::to_string(all.size()) + ": " + one.error());
    all.push_back(*std::move(one));
  }
  if (!follow(all)) return failure("its amendments are not in their order");
  return ReceivedAmendments(std::move(all), *std::move(holds));
}

}  // namespace

Json holds_json(std::span<const Hold> holds) {
  Json list = Json::array();
  for (const Hold& hold : holds)
    list.push_back({hold.from, hold.open() ? Json(nullptr) : Json(hold.until)});
  return list;
}

Json amendments_json(const ReceivedAmendments& heard, double dt_s) {
  Json list = Json::array();
  for (const ReceivedAmendment& one : heard.all()) list.push_back(without_numbers(one, dt_s));
  return list;
}

std::string amendments_text(const ReceivedAmendments& heard, double dt_s) {
  std::string text = "{\"holds\": " + holds_json(heard.holds()).dump() + ",\n\"amendments\": [";
  const char* separator = "\n";
  for (const ReceivedAmendment& one : heard.all()) {
    Json json = without_numbers(one, dt_s);
    if (one.target) {
      json["target"] = list_of(one.target->target);
      if (one.target->cosine.size() > 0) json["cosine_target"] = list_of(one.target->cosine);
    }
    if (one.zone) write_place(*one.zone, json);
    if (one.law) json["law"] = law_json(*one.law);
    text += std::exchange(separator, ",\n") + json.dump();
  }
  return text + "]}\n";
}

Result<ReceivedAmendments> recorded_amendments(const std::filesystem::path& run_dir,
                                               const Json& summary, const Mission& mission) {
  const auto file = run_dir / kAmendmentsFile;
  const auto content = read_json(file, {kMostAmendmentBytes, kMostAmendmentValues});
  if (!content) return failure(content.error());
  if (content->is_null()) {
    auto holds = summary.is_object() ? holds_in(value_in(summary, "holds")) : std::nullopt;
    ReceivedAmendments heard;
    if (holds) heard.note(only_pauses(*std::move(holds)));
    return heard;
  }
  auto heard = all_in(*content, mission);
  if (!heard) return failure(file.string() + ": " + heard.error() + ": " + kCopyAgainOrRemove);
  return heard;
}

std::optional<std::string> missing_target(const std::filesystem::path& run_dir, const Json& summary,
                                          const ReceivedAmendments& heard) {
  if (const ReceivedAmendment* const unknown = heard.unknown_content())
    return "its logger did not receive the " + std::string(to_string(unknown->amendment.kind)) +
           " of amendment " + std::to_string(unknown->amendment.number);
  const Json listed = summary.is_object() ? value_in(summary, "amendments") : Json();
  const bool names_targets = listed.is_array() && std::ranges::any_of(listed, [](const Json& one) {
                               return one.is_object() && kind_in(one) >= AmendmentKind::kTarget;
                             });
  std::error_code ignored;
  if (!names_targets || std::filesystem::exists(run_dir / kAmendmentsFile, ignored))
    return std::nullopt;
  return std::string(kAmendmentsFile) +
         " is missing, which has the targets, zones, laws and contacts that its summary names; "
         "copy it from "
         "where the run was recorded";
}

}  // namespace ergocast
