// SPDX-License-Identifier: BSD-3-Clause
// Combines the sections from summary, record and figures; a missing value leaves no empty line.
#include "report/page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "report/html.h"
#include "report/markup.h"
#include "report/page_style.h"

namespace ergocast {
namespace {

using Json = nlohmann::ordered_json;

// --- the values of the summary ---

/// A value as text for people; nothing if the key is missing, null, or a list.
std::optional<std::string> said(const Json& object, const char* key) {
  if (!object.is_object() || !object.contains(key)) return {};
  const Json& value = object[key];
  if (value.is_string()) return escape(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number()) return readable(value.get<double>());
  return {};
}

Json part(const Json& object, const char* key) {
  return object.is_object() && object.contains(key) ? object[key] : Json();
}

// --- the parts of the page ---

std::string result_line(const Json& summary) {
  std::string word = "No result", css_class = "unknown";
  std::string text = said(summary, "reason").value_or("");
  const std::string result = said(summary, "result").value_or("");
  if (result == "done") word = "Done", css_class = "done";
  if (result == "stopped") word = "Stopped", css_class = "stopped";
  if (result == "failed") word = "Failed", css_class = "failed";
  if (text.empty() && result == "done") text = "The mission came to its last tick.";
  if (summary.is_null()) {
    text =
        "There is no summary.json: the run has not ended yet or was killed. What was recorded "
        "up to then is shown.";
  }
  return "<p class=\"result " + css_class + "\"><b>" + word + ".</b> " + text + "</p>\n";
}

std::string ticks_text(const RunData& run, const Mission& mission) {
  Tick ticks = 0;
  for (const auto& [agent, track] : run.tracks) ticks = std::max(ticks, track.back().tick + 1);
  const std::string text = readable(static_cast<double>(ticks));
  const Tick planned = mission.timing.tick_count;
  return ticks == planned ? text : text + " of " + readable(static_cast<double>(planned));
}

std::optional<std::string> slope_text(const RunData& run) {
  const std::optional<PowerLaw> law = fit_last_decade(run);
  if (!law) return {};
  return "t<sup>" + readable(std::round(law->slope * 100) / 100) + "</sup>";
}

std::string cards(const RunData& run, const Mission& mission, const Json& summary) {
  Facts facts("cards");
  facts.add("φ², first → last", run.metrics.empty()
                                    ? "–"
                                    : readable(run.metrics.front().ergodic_metric) + " → " +
                                          readable(run.metrics.back().ergodic_metric));
  facts.add("φ² falls like", slope_text(run));
  facts.add("ticks", ticks_text(run, mission));
  facts.add("mission time", duration(run.end_s()));
  if (const Json wall = part(summary, "wall_time_s"); wall.is_number()) {
    facts.add("wall time", duration(wall.get<double>()));
  }
  facts.add("ticks per second", said(summary, "ticks_per_s"));
  return facts.html();
}

std::string mode_text(const Json& summary) {
  std::string mode = said(summary, "mode").value_or("");
  if (mode == "lockstep") return "lockstep: every tick waits for every agent";
  if (mode == "realtime") {
    return "real time × " + said(summary, "realtime_factor").value_or("1");
  }
  if (mode == "simulate") return "simulated in one process, without a network";
  return mode;
}

std::string point_text(const Eigen::Vector2d& x_m) {
  const auto tenth = [](double value) { return readable(std::round(value * 10) / 10); };
  return '(' + tenth(x_m.x()) + ", " + tenth(x_m.y()) + ')';
}

double path_length_m(const Track& track) {
  double length_m = 0;
  for (std::size_t i = 1; i < track.size(); ++i) {
    length_m += (track[i].x_m - track[i - 1].x_m).norm();
  }
  return length_m;
}

std::string motion_table(const RunData& run) {
  std::vector<Column> columns{{"agent", true},     {"start [m]", false},  {"end [m]", false},
                              {"distance", false}, {"mean speed", false}, {"ticks", false}};
  for (const auto& [agent, track] : run.tracks) {
    const double length_m = path_length_m(track), time_s = track.back().t_s - track.front().t_s;
    const std::string dot =
        "<span class=\"dot\" style=\"background:" + agent_color(agent) + "\"></span>";
    const std::vector<std::string> cells{dot + std::to_string(agent),
                                         point_text(track.front().x_m),
                                         point_text(track.back().x_m),
                                         with_unit(length_m, "m"),
                                         time_s > 0 ? with_unit(length_m / time_s, "m/s") : "–",
                                         readable(static_cast<double>(track.size()))};
    for (std::size_t i = 0; i < cells.size(); ++i) columns[i].cells.push_back(cells[i]);
  }
  return table(std::move(columns), run.tracks.size());
}

std::string life_text(const Json& agent) {
  const std::string from = said(agent, "active_from").value_or("?");
  const auto until = said(agent, "active_until");
  return until ? "from " + from + " until " + *until : from == "0" ? "all" : "from " + from;
}

std::string messages_table(const Json& agents) {
  struct Key {
    const char* key;
    const char* title;
    bool text;
  };
  static constexpr Key kKeys[] = {{"host", "host", true},
                                  {"incarnation", "incarnation", true},
                                  {"messages_sent", "messages sent", false},
                                  {"messages_received", "received", false},
                                  {"contributions_received", "contributions", false},
                                  {"contributions_lost", "lost", false},
                                  {"missed_ticks", "missed ticks", false},
                                  {"max_staleness_s", "oldest news [s]", false},
                                  {"kernel_drops", "kernel drops", false},
                                  {"ergodic_metric", "own φ²", false}};
  std::vector<Column> columns{{"agent", true}, {"member in ticks", true}};
  for (const Key& key : kKeys) columns.push_back({key.title, key.text});
  for (const Json& agent : agents) {
    columns[0].cells.push_back(said(agent, "id"));
    columns[1].cells.push_back(life_text(agent));
    for (std::size_t i = 0; i < std::size(kKeys); ++i) {
      columns[i + 2].cells.push_back(said(agent, kKeys[i].key));
    }
  }
  return table(std::move(columns), agents.size());
}

std::string refusals_text(const Json& refused) {
  std::string list;
  if (!refused.is_object()) return list;
  for (const auto& [reason, count] : refused.items()) {
    if (!count.is_number() || count.get<double>() == 0) continue;
    list += (list.empty() ? "" : ", ") + readable(count.get<double>()) + " for " + escape(reason);
  }
  return list.empty() ? "none" : list;
}

std::string team_facts(const Json& summary) {
  const Json messages = part(summary, "messages");
  Facts facts("facts");
  facts.add("messages sent", said(messages, "sent"));
  facts.add("messages received", said(messages, "received"));
  facts.add("contributions lost", said(messages, "lost"));
  facts.add("dropped by the kernel", said(messages, "kernel_drops"));
  if (messages.is_object()) facts.add("refused", refusals_text(part(messages, "refused")));
  facts.add("restarts", said(summary, "restarts"));
  facts.add("missed deadlines", said(summary, "missed_deadlines"));
  facts.add("skipped ticks", said(summary, "skipped_ticks"));
  const Json limit = part(summary, "speed_limit");
  if (limit.is_object())
    facts.add("commands cut to the speed limit", said(limit, "clamped_commands"));
  facts.add("ticks missing in the record", said(summary, "gaps"));
  return facts.html();
}

std::string agents_section(const RunData& run, const Json& summary) {
  std::string html = "<section><h2>Agents</h2>\n" + motion_table(run);
  if (run.empty()) html += "<p>No position was recorded.</p>\n";
  const Json agents = part(summary, "agents");
  if (agents.is_array() && !agents.empty()) {
    html += "<h2>Messages of each agent</h2>\n" + messages_table(agents);
  }
  if (!summary.is_null()) html += "<h2>The team</h2>\n" + team_facts(summary);
  return html + "</section>\n";
}

std::string law_text(const ControlLaw& law) {
  const bool relative = law.regularization == Regularization::kRelative;
  std::string text = "u<sub>max</sub> = " + readable(law.u_max_mps) + " m/s";
  text += ", ε = " + readable(law.epsilon) + (relative ? " × the residual gradient’s RMS" : "");
  text += ", σ = " + readable(law.noise_intensity);
  if (law.perturbation == Perturbation::kAdaptive) text += " to " + readable(law.noise_ceiling);
  text += " m/√s";
  text += ", k = " + readable(law.contraction_gain_per_s) + " /s";
  if (law.contraction_gain_per_s == 0) return text;
  return text + " towards " + point_text(law.contraction_center_m.head<2>()) + " m";
}

std::string weights_text(const Basis& basis) {
  const bool squared = basis.sobolev_form == SobolevForm::kSquaredNorm;
  return std::string("λ<sub>k</sub> = (1 + |k|") + (squared ? "²" : "") + ")<sup>−" +
         readable(basis.sobolev_exponent) + "</sup>, |k|² = m² + n²";
}

std::string conventions_section(const Mission& mission) {
  const Basis& basis = mission.basis;
  const std::string sum = "φ² = Σ λ<sub>k</sub> (c<sub>k</sub> − μ<sub>k</sub>)²";
  Facts facts("facts");
  facts.add("metric", basis.normalized ? sum + " / h<sub>k</sub>²" : sum);
  facts.add("weights", weights_text(basis));
  facts.add("basis",
            "f<sub>mn</sub> = cos(mπx/L<sub>x</sub>) cos(nπy/L<sub>y</sub>) from the "
            "domain’s lower left corner, m = 0 … " +
                std::to_string(basis.modes_x - 1) + ", n = 0 … " +
                std::to_string(basis.modes_y - 1));
  facts.add("h<sub>k</sub>", basis.normalized
                                 ? "√(Π L<sub>i</sub> · (½)<sup>[k<sub>i</sub> &gt; 0]</sup>)"
                                 : "not used: f is not normalised");
  facts.add("control", law_text(mission.law));
  if (mission.speed_limit_mps > 0) {
    facts.add("speed limit",
              readable(mission.speed_limit_mps) + " m/s; faster commands are cut to it");
  }
  facts.add("time step", readable(mission.timing.dt_s) +
                             " s; a recorded row is the position at its tick, and the command "
                             "computed there");
  facts.add("maps",
            "Σ c<sub>k</sub> f<sub>k</sub> with f of unit norm, in multiples of the "
            "uniform density");
  return "<section><h2>Conventions</h2>\n<p>A φ² can be compared with another only if the "
         "weights, the modes and h<sub>k</sub> are the same.</p>\n" +
         facts.html() + "</section>\n";
}

std::string identity_section(const Json& summary) {
  Facts facts("facts");
  facts.add("version", said(summary, "version"));
  facts.add("build", said(summary, "build"));
  facts.add("processor has FMA", said(summary, "cpu_fma"));
  const auto mode = said(summary, "mode");
  std::string commands;
  if (!mode || *mode != "realtime") {
    commands += "# simulate it again and compare every position\nergocast verify .\n";
  }
  commands +=
      "# the same mission as a new run\n"
      "ergocast simulate scenario.textproto --out ../again\n"
      "# make this page again\nergocast report .\n";
  if (mode && *mode != "simulate") {
    commands +=
        "# send its messages again, as for lcm-spy, on a port of their own\n"
        "lcm-logplayer --lcm-url=\"udpm://239.255.76.67:7777?ttl=0\" -s 0.1 events-000.lcm\n";
  }
  return "<section><h2>How to reproduce</h2>\n<p>In the run’s directory:</p>\n<pre>" + commands +
         "</pre>\n" + facts.html() + "</section>\n";
}

}  // namespace

std::string figures_section(const std::vector<Figure>& figures) {
  std::string html = "<section class=\"figures\">\n";
  for (const Figure& figure : figures) {
    html += std::string("<figure") + (figure.wide ? " class=\"wide\"" : "") + "><h2>" +
            escape(figure.title) + "</h2>\n<div class=\"scroll\">" + figure.svg +
            "</div><figcaption>" + escape(figure.caption) + "</figcaption></figure>\n";
  }
  return html + "</section>\n";
}

std::string framed_page(const std::string& title, const std::string& kind,
                        const std::string& header, const std::string& content) {
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n";
  html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n";
  html += element("title", escape(title) + " – Ergocast") + element("style", kPageStyle);
  html += "</head><body><main>\n<header><p>" + escape(kind) + "</p>\n" +
          element("h1", escape(title)) + header + "</header>\n";
  return html + content + "</main></body></html>\n";
}

std::string report_page(const RunData& run, const Mission& mission, const Json& summary,
                        const std::vector<Figure>& figures) {
  Facts origin("facts");
  origin.add("agents", std::to_string(std::max(run.tracks.size(), mission.starts_m.size())));
  origin.add("mode", mode_text(summary));
  origin.add("seed", std::to_string(mission.seed));
  origin.add("started", said(summary, "started"));
  origin.add("run", said(summary, "run_id"));
  origin.add("scenario hash", said(summary, "scenario_hash"));

  const std::string content = cards(run, mission, summary) + origin.html() +
                              figures_section(figures) + agents_section(run, summary) +
                              conventions_section(mission) + identity_section(summary);
  return framed_page(mission.name.empty() ? "unnamed mission" : mission.name, "Ergocast run",
                     result_line(summary), content);
}

}  // namespace ergocast
