// SPDX-License-Identifier: BSD-3-Clause
// Writes an event with pugixml, which escapes the text of scenarios and other hosts.
#include "cli/tak/cot_event.h"

#include <cstdio>
#include <pugixml.hpp>
#include <sstream>

#include "text/printable.h"

namespace ergocast::cli {
namespace {

constexpr const char* kUnknown = "9999999.0";

std::string decimals(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// About a centimetre.
std::string degrees(double value_deg) { return decimals(value_deg, 7); }

/// "2026-01-31T12:00:00.250Z"
std::string time_text(WallTime time) {
  using namespace std::chrono;
  const auto day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(floor<milliseconds>(time - day));
  char text[64];
  std::snprintf(
      text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02d.%03dZ", static_cast<int>(date.year()),
      static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
      static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
      static_cast<int>(clock.seconds().count()), static_cast<int>(clock.subseconds().count()));
  return text;
}

void add(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name) = printable(value).c_str();
}

void add_child(pugi::xml_node node, const char* child, const char* name, const std::string& value) {
  add(node.append_child(child), name, value);
}

/// Clients close an outline whose last corner is its first one.
void add_outline(pugi::xml_node detail, const CotEvent& event) {
  constexpr int kOpaque = 0xffffff, kQuarter = 0x40000000;
  const auto link = [&](const GeoPlace& corner) {
    add_child(detail, "link", "point",
              degrees(corner.latitude_deg) + ',' + degrees(corner.longitude_deg));
  };
  for (const GeoPlace& corner : event.outline) link(corner);
  link(event.outline.front());
  add_child(detail, "strokeColor", "value", std::to_string(event.argb));
  add_child(detail, "strokeWeight", "value", "3.0");
  add_child(detail, "fillColor", "value", std::to_string((event.argb & kOpaque) | kQuarter));
  add_child(detail, "labels_on", "value", "true");
}

void add_point_colour(pugi::xml_node detail, const CotEvent& event) {
  const std::string argb = std::to_string(event.argb);
  add_child(detail, "color", "argb", argb);
  add_child(detail, "usericon", "iconsetpath", "COT_MAPPING_SPOTMAP/" + event.type + '/' + argb);
}

void add_detail(pugi::xml_node detail, const CotEvent& event) {
  add_child(detail, "contact", "callsign", event.callsign);
  if (event.track) {
    const pugi::xml_node track = detail.append_child("track");
    add(track, "course", decimals(event.track->course_deg, 1));
    add(track, "speed", decimals(event.track->speed_mps, 2));
  }
  if (!event.outline.empty()) {
    add_outline(detail, event);
  } else if (event.argb != 0) {
    add_point_colour(detail, event);
  }
  detail.append_child("remarks").text() = printable(event.remarks).c_str();
}

}  // namespace

std::string cot_xml(const CotEvent& event, WallTime time) {
  pugi::xml_document document;
  pugi::xml_node node = document.append_child("event");
  add(node, "version", "2.0");
  add(node, "uid", event.uid);
  add(node, "type", event.type);
  add(node, "how", event.how);
  add(node, "time", time_text(time));
  add(node, "start", time_text(time));
  add(node, "stale", time_text(time + event.lasts));
  pugi::xml_node point = node.append_child("point");
  add(point, "lat", degrees(event.place.latitude_deg));
  add(point, "lon", degrees(event.place.longitude_deg));
  for (const char* unknown : {"hae", "ce", "le"}) add(point, unknown, kUnknown);
  add_detail(node.append_child("detail"), event);
  std::ostringstream text;
  document.save(text, "", pugi::format_raw, pugi::encoding_utf8);
  return text.str();
}

}  // namespace ergocast::cli
