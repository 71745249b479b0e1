// SPDX-License-Identifier: BSD-3-Clause
// Prints what docs/reference/make cannot read from .proto and .lcm files: the rules that the
// program applies to each field of a scenario, and the checks, receivers and signatures of each
// message. Also prints the messages of plan/plan.proto.
//
// Each line is a fact; its parts are separated by tabs.
//   rule      MESSAGE.FIELD  LIMITS  DEFAULT  "required" or nothing
//   message   CHANNEL  TYPE  "signed" or nothing  receivers on swarm, world and command bus
//   fields    TYPE  the limits of each field, in the order of its .lcm file
//   plan      a line of plan/plan.proto
#include <algorithm>
#include <array>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/channels.h"
#include "lcmtypes/fields.h"
#include "lcmtypes/wire.h"
#include "plan/mission_fields.h"
#include "scenario/parse/fields.h"
#include "scenario/scenario.pb.h"
#include "team/subscriptions.h"
#include "text/shortest.h"

namespace ergocast {
namespace {

constexpr const char* kRoleNames[kRoleCount] = {"agents", "coordinator",    "world",    "drivers",
                                                "logger", "`ergocast run`", "displays", "page"};

void print(const std::vector<std::string>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) std::cout << (i > 0 ? "\t" : "") << parts[i];
  std::cout << '\n';
}

// ---- Scenario ----

std::string limits_of(const Range& range) {
  return range.coordinate ? "at most " + shortest(range.high) + " from 0" : range.text();
}

void print_rules() {
  const auto* file = proto::Scenario::descriptor()->file();
  for (int i = 0; i < file->message_type_count(); ++i) {
    for (int j = 0; j < file->message_type(i)->field_count(); ++j) {
      const auto& field = *file->message_type(i)->field(j);
      const FieldRule* rule = rule_of(field);
      if (rule == nullptr) continue;
      print({"rule", file->message_type(i)->name() + '.' + field.name(), limits_of(rule->range),
             rule->absence == Absence::kDefaulted ? shortest(rule->default_value) : "",
             rule->absence == Absence::kRefused ? "required" : ""});
    }
  }
}

// ---- Messages ----

/// Visits the fields of a message as Writer and Reader do, and notes what a receiver accepts.
class Describer {
 public:
  std::vector<std::string> limits;
  bool is_signed = false;

  void number(const auto&) { add(""); }
  void each_number(const auto&) { add(""); }
  void count(const auto&) { add("0 to 2⁴⁸"); }
  void counts(const auto&) { add("each 0 to 2⁴⁸"); }
  void capped_count(const auto&) { add("0 to 2⁴⁸"); }
  void count_or_none(const auto&) { add("−1 to 2⁴⁸"); }
  void finite(double) { add("finite"); }
  void quantity(double) { add("finite, at least 0"); }
  void within(std::int32_t, std::int32_t least, std::int32_t most) { add(least, most); }
  void small(std::int32_t, std::int32_t most) { add(0, most); }
  void vector(const auto&) { add("finite"); }
  void flag(bool) { add(""); }
  template <class Enum>
  void enumerator(Enum, Enum last) {
    add(0, static_cast<std::int32_t>(last));
  }
  void bytes(const Signature&) { add(""), is_signed = true; }
  void bytes(const std::vector<std::byte>&) { add(""); }
  void text(const std::string&, int limit) {
    add("at most " + std::to_string(limit) + " bytes, no control characters");
  }
  void sums(const auto&, std::size_t) { add("at most elapsed_s in size"); }
  void averages(const auto&, double, std::int32_t, std::size_t) { add(""); }
  void room_for_tag() { add(""); }
  void holds(bool) {}

  /// One element shows the fields of all.
  template <class Element>
  void length(std::vector<Element>& elements, int limit) {
    add(0, limit);
    elements.resize(1);
  }
  template <class Element, std::size_t kLimit>
  std::span<Element> length(std::array<Element, kLimit>& elements, std::int32_t) {
    add(0, static_cast<std::int32_t>(kLimit));
    return std::span(elements).first(1);
  }

 private:
  void add(std::string text) { limits.push_back(std::move(text)); }
  void add(std::int32_t least, std::int32_t most) {
    if (most == std::numeric_limits<std::int32_t>::max()) return add("at least 0");
    add((least < 0 ? "−" : "") + std::to_string(std::abs(least)) + " to " + std::to_string(most));
  }
};

template <class Form, class Plain>
Describer described(const std::string& type) {
  Describer describer;
  Plain plain;
  Fields<Form>::list(describer, plain);
  std::vector<std::string> parts = {"fields", type};
  parts.insert(parts.end(), describer.limits.begin(), describer.limits.end());
  print(parts);
  return describer;
}

template <class Form, class Plain>
void print_message(std::size_t index) {
  const std::string type = Fields<Form>::Generated::getTypeName();
  const bool is_signed = described<Form, Plain>(type).is_signed;
  const ChannelName& name = channel_names()[index];
  std::vector<std::string> parts = {"message",
                                    std::string(name.text) + (name.per_agent ? "<id>" : ""), type,
                                    is_signed ? "signed" : ""};
  for (std::size_t bus = 0; bus < kBusCount; ++bus) {
    std::string receivers;
    for (std::size_t role = 0; role < kRoleCount; ++role) {
      const bool receives = (kSubscriptions[role][bus] >> index & 1) != 0;
      if (!receives || role == static_cast<std::size_t>(Role::kLogger)) continue;
      // The page is one of the displays.
      const auto displays = kSubscriptions[static_cast<std::size_t>(Role::kMonitor)][bus];
      if (role == static_cast<std::size_t>(Role::kPage) && (displays >> index & 1) != 0) continue;
      receivers += (receivers.empty() ? "" : ", ") + std::string(kRoleNames[role]);
    }
    parts.push_back(receivers);
  }
  print(parts);
}

void print_messages() {
  described<Header, Header>("header_t");
  [&]<std::size_t... Index>(std::index_sequence<Index...>) {
    (print_message<std::variant_alternative_t<Index, Message>,
                   std::variant_alternative_t<Index, Message>>(Index),
     ...);
  }
  (std::make_index_sequence<kMessageTypeCount>());
  // The other forms of a contribution.
  constexpr std::size_t kIndex = type_index<Contribution>();
  print_message<Averages, Contribution>(kIndex);
  print_message<LowSums, Contribution>(kIndex);
  print_message<LowAverages, Contribution>(kIndex);
}

// ---- The plan ----

/// "sobolev_form" → "SobolevForm", and "world.walls" → "Walls".
std::string type_name(std::string_view field) {
  std::string name;
  bool begins = true;
  for (const char c : field.substr(field.rfind('.') + 1)) {
    if (c != '_') name += begins ? static_cast<char>(c - 'a' + 'A') : c;
    begins = c == '_';
  }
  return name;
}

/// Prints the fields of a part as those of a Protobuf message.
class PlanSchema : public FieldVisitor {
 public:
  static constexpr const char* kTop = "  ";

  explicit PlanSchema(std::string indent = kTop) : indent_(std::move(indent)) {}

  void line(const std::string& text) const { print({"plan", indent_ + text}); }

  void number(const Field& field, const auto& value) const {
    const double otherwise = field.when.otherwise;
    add(std::is_same_v<decltype(value), const double&> ? "double" : "int32", field,
        otherwise == 0 ? "" : "absent: " + shortest(otherwise));
  }
  void flag(const Field& field, bool) const { add("bool", field); }
  void text(const Field& field, const std::string&) const { add("string", field); }
  void choice(const Field& field, auto, Words words) const {
    line("enum " + type_name(field.name) + " {");
    int value = 0;
    for (const char* word : words)
      line("  " + std::string(word) + " = " + std::to_string(value++) + ";");
    line("}");
    add(type_name(field.name), field);
  }
  void part(const Field& field, const auto& part) const {
    message(field, part);
    add(type_name(field.name), field);
  }
  void part(const Field& field, const std::optional<VehicleLimits>&) const {
    add("Vehicle", field, "absent: the plan's; present but empty: a point");
  }
  void part(const Field& field, const std::vector<AgentKind>&) const {
    message(field, AgentKind());
    add("repeated " + type_name(field.name), field);
  }
  void places(const Field& x, const Field& z, const Eigen::Vector3d&) const {
    add("double", x);
    std::string y = x.name;
    y[y.rfind('x')] = 'y';
    add("double", {x.number + 1, y.c_str()});
    add("double", z);
  }
  void places(const Field& xy, const Field& z, const std::vector<Eigen::Vector3d>&) const {
    add("repeated double", xy, "x and y of each in turn");
    add("repeated double", z, "z of each, unless all are 0");
  }
  void derived(const Field& field, const Tick&) const { add("int64", field); }
  void derived(const Field& field, const std::uint64_t&) const { add("uint64", field); }
  void derived(const Field& field, const bool&) const { add("bool", field); }
  void derived(const Field& field, const Coefficients&) const { add("repeated double", field); }
  void derived(const Field& field, const Rings&) const { add("repeated Ring", field); }

 private:
  /// A plan itself has no blocks of agents and of the world; a kind in it has no block of a band.
  std::string name_in_plan(std::string name) const {
    if (indent_ == kTop) return name.substr(name.rfind('.') + 1);
    std::ranges::replace(name, '.', '_');
    return name;
  }
  void add(const std::string& type, const Field& field, const std::string& note = "") const {
    line(type + ' ' + name_in_plan(field.name) + " = " + std::to_string(field.number) + ';' +
         (note.empty() ? "" : "  // " + note));
  }
  void message(const Field& field, const auto& part) const {
    line("message " + type_name(field.name) + " {");
    PlanSchema inner(indent_ + "  ");
    list_fields(inner, part);
    line("}");
  }

  std::string indent_;
};

void print_plan() {
  PlanSchema plan;
  const Mission mission;
  list_fields(plan, mission);
}

}  // namespace
}  // namespace ergocast

int main() {
  ergocast::print_rules();
  ergocast::print_messages();
  ergocast::print_plan();
}
