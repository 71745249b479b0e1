// SPDX-License-Identifier: BSD-3-Clause
// Writes the picture of a team as JSON, with null for unknown values.
#include <nlohmann/json.hpp>

#include "cli/team/overload.h"
#include "cli/team/team_text.h"

namespace ergocast {
namespace {

template <class T>
nlohmann::ordered_json or_null(bool known, const T& value) {
  return known ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// The law that holds: its numbers for each kind of agents.
nlohmann::ordered_json law_json(const TeamPicture& at) {
  if (!at.law) return nullptr;
  nlohmann::ordered_json json = {{"amendment", at.law->number}, {"from_tick", at.law->from}};
  for (const LawNumbers& numbers : at.law->kinds)
    json["kinds"].push_back({{"u_max_mps", numbers.u_max_mps},
                             {"noise_intensity", numbers.noise_intensity},
                             {"noise_ceiling", numbers.noise_ceiling}});
  return json;
}

/// How many objects are hidden, and the finds; null without objects.
nlohmann::ordered_json objects_json(const TeamPicture& at) {
  if (at.objects == 0) return nullptr;
  auto finds = nlohmann::ordered_json::array();
  for (const Find& find : at.finds)
    finds.push_back({{"object", find.object},
                     {"agent", find.agent},
                     {"tick", find.tick},
                     {"t_s", find.t_s},
                     {"x_m", find.x_m.x()},
                     {"y_m", find.x_m.y()}});
  return {{"count", at.objects}, {"found", at.finds.size()}, {"finds", std::move(finds)}};
}

nlohmann::ordered_json contacts_json(const TeamPicture& at) {
  auto contacts = nlohmann::ordered_json::array();
  for (const Contact& contact : at.contacts)
    contacts.push_back({{"x_m", contact.x_m.x()},
                        {"y_m", contact.x_m.y()},
                        {"probability", contact.probability},
                        {"reports", contact.reports},
                        {"t_s", contact.t_s},
                        {"confirmed", contact.confirmed}});
  return contacts;
}

nlohmann::ordered_json json_of(const AgentRow& row) {
  nlohmann::ordered_json json = {{"id", row.author.agent},
                                 {"incarnation", to_hex(row.author.incarnation)},
                                 {"state", to_string(row.condition)},
                                 {"silent_s", row.silent_s},
                                 {"restarts", row.restarts}};
  if (!row.kind.empty()) json["kind"] = row.kind;
  json["position_m"] = or_null(!row.position_m.empty(), row.position_m);
  json["velocity_mps"] = or_null(!row.velocity_mps.empty(), row.velocity_mps);
  json["moves"] = or_null(row.moves.has_value(), row.moves.value_or(false));
  if (row.charge_ppm != kNoCharge) {
    json["charge"] = share_of(row.charge_ppm);
    json["charges"] = row.charges;
  }
  if (!row.status) return json;
  const AgentStatus& status = *row.status;
  json["host"] = status.host;
  json["phase"] = to_string(status.phase);
  json["tick"] = row.tick;
  json["waiting_for"] = or_null(status.waiting_for != kUnassigned, name_of(status.waiting_for));
  json["ergodic_metric"] = or_null(status.answered_tick >= 0, status.ergodic_metric);
  json["max_staleness_s"] = status.max_staleness_s;
  json["loop_lag_s"] = status.loop_lag_s;
  json["blocked_s"] = row.blocked_s;
  json["blocked_by"] = or_null(status.blocked_by != kUnassigned, status.blocked_by);
  json["messages_sent"] = status.messages_sent;
  json["contributions_received"] = status.contributions_received;
  json["contributions_lost"] = status.contributions_lost;
  json["kernel_drops"] = status.kernel_drops;
  for (std::size_t i = 0; i < status.refused.size(); ++i) {
    json["refused"][to_string(static_cast<Refusal>(i))] = status.refused[i];
  }
  json["babbler"] = or_null(status.rate_offender != kUnassigned, status.rate_offender);
  return json;
}

}  // namespace

std::string team_json(const TeamPicture& at) {
  const auto warning = overload_warning(at.missed_deadlines, at.tick, at.agents_expected);
  nlohmann::ordered_json json = {
      {"run_id", to_hex(at.run)},
      {"replay", at.replay},
      {"authenticated", at.authenticated},
      {"scenario", or_null(!at.scenario.empty(), at.scenario)},
      {"state", at.state ? nlohmann::ordered_json(to_string(*at.state)) : nlohmann::ordered_json()},
      {"reason", at.reason},
      {"trouble", at.trouble},
      {"paused", at.paused},
      {"tick", at.counted},
      {"tick_count", or_null(at.tick_count > 0, at.tick_count)},
      {"t_s", or_null(at.dt_s > 0, static_cast<double>(at.counted) * at.dt_s)},
      {"world_tick", at.tick},
      {"ergodic_metric", or_null(at.ergodic_metric.has_value(), at.ergodic_metric.value_or(0))},
      {"free_domain", at.free_domain},
      {"detection_probability",
       or_null(at.detection_probability.has_value(), at.detection_probability.value_or(0))},
      {"agents_alive", at.agents_alive},
      {"agents_expected", at.agents_expected},
      {"missed_deadlines", at.missed_deadlines},
      {"late_share", late_share(at.missed_deadlines, at.tick, at.agents_expected)},
      {"warning", or_null(warning.has_value(), warning.value_or(""))},
      {"skipped_ticks", at.skipped_ticks},
      {"clamped_commands", at.clamped_commands},
      {"forgotten", at.forgotten}};
  json["objects"] = objects_json(at);
  if (at.wrong_confirmations) {
    json["wrong_confirmations"] = *at.wrong_confirmations;
    json["contacts"] = contacts_json(at);
    json["more_contacts"] = at.more_contacts;
  }
  json["holds"] = nlohmann::ordered_json::array();
  for (const Hold& hold : at.holds)
    json["holds"].push_back({hold.from, or_null(!hold.open(), hold.until)});
  json["target"] = nullptr;
  if (at.target)
    json["target"] = {{"amendment", at.target->number}, {"from_tick", at.target->from}};
  json["end"] = nullptr;
  if (at.end) json["end"] = {{"amendment", at.end->number}, {"from_tick", at.end->from}};
  json["zones"] = nlohmann::ordered_json::array();
  for (const Zone& zone : at.zones)
    json["zones"].push_back({{"amendment", zone.number},
                             {"closed_tick", zone.closed},
                             {"from_tick", zone.from},
                             {"until_tick", zone.end()}});
  json["law"] = law_json(at);
  json["other_versions"] = nlohmann::ordered_json::object();
  for (const auto& [host, version] : at.other_versions) json["other_versions"][host] = version;
  json["clients"] = at.clients;
  json["agents"] = nlohmann::ordered_json::array();
  for (const AgentRow& row : at.agents) json["agents"].push_back(json_of(row));
  for (const ProcessRow& row : at.processes) {
    json["processes"][row.name] = {{"state", row.trouble  ? "silent"
                                             : !row.heard ? "not heard"
                                             : at.over    ? "ended"
                                                          : "alive"},
                                   {"silent_s", row.silent_s},
                                   {"incarnation", or_null(row.heard, to_hex(row.incarnation))},
                                   {"host", or_null(!row.host.empty(), row.host)},
                                   {"tick", or_null(row.heard, row.tick)}};
  }
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace ergocast
