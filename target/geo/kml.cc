// SPDX-License-Identifier: BSD-3-Clause
// Walks the elements of a parsed file, and collects those that are not known.
#include "target/geo/kml.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <utility>

#include "target/geo/xml_places.h"
#include "text/read_number.h"

namespace ergocast {
namespace {

/// Limit (Files of a scenario): levels of nested tags in a KML file. Beyond it: the scenario is
/// refused.
constexpr int kDeepestKml = 32;
constexpr std::string_view kKmlBlanks = " \t\r\n";
const std::string kDelete = "delete it there, or draw it as a polygon";

using Names = std::set<std::string_view>;
const Names kKmlContainers = {"Document", "Folder", "Placemark", "MultiGeometry"};
/// They change how polygons look, and no place.
const Names kUnplaced = {"name",           "visibility",
                         "open",           "author",
                         "link",           "address",
                         "phoneNumber",    "Snippet",
                         "description",    "LookAt",
                         "Camera",         "TimeStamp",
                         "TimeSpan",       "styleUrl",
                         "Style",          "StyleMap",
                         "CascadingStyle", "Region",
                         "Metadata",       "ExtendedData",
                         "Schema",         "extrude",
                         "tessellate",     "altitudeMode",
                         "drawOrder",      "balloonVisibility",
                         "AddressDetails", "snippet"};

struct BadKml {
  PolygonFileProblem problem;
};

/// Without the prefix of a namespace.
std::string_view kml_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  return name.substr(name.find(':') == name.npos ? 0 : name.find(':') + 1);
}

class KmlWalk {
 public:
  explicit KmlWalk(std::string_view text) : places_(text) {}

  std::vector<GeoPolygon> polygons(const pugi::xml_document& document) {
    const pugi::xml_node root = document.document_element();
    if (kml_name(root) != "kml") fail(root, "is no KML", "name a file that a program saved as KML");
    container(root, 0);
    if (!problems_.empty()) throw BadKml{problems_.all()};
    if (polygons_.empty()) fail(root, "has no polygon", "draw one, or name another file");
    return std::move(polygons_);
  }

 private:
  [[noreturn]] void fail(const pugi::xml_node& node, std::string what, std::string remedy) const {
    throw BadKml{{places_.of(node), std::move(what), std::move(remedy)}};
  }

  void container(const pugi::xml_node& node, int depth) {
    if (depth > kDeepestKml) fail(node, "is in more than 32 others", "take it out of its folders");
    const auto seen = [&] { return polygons_.size() + failures_; };
    const std::size_t before = seen();
    for (const pugi::xml_node& child : node.children()) {
      if (problems_.full()) return;
      if (child.type() != pugi::node_element || kUnplaced.contains(kml_name(child))) continue;
      try {
        part(child, depth);
      } catch (const BadKml& refused) {
        problems_.add(refused.problem);
        ++failures_;
      }
    }
    const bool has_place = kml_name(node) == "Placemark" || kml_name(node) == "MultiGeometry";
    if (has_place && seen() == before) fail(node, "has no polygon", kDelete);
  }

  void part(const pugi::xml_node& node, int depth) {
    if (kKmlContainers.contains(kml_name(node))) return container(node, depth + 1);
    if (kml_name(node) == "Polygon") return polygon(node);
    fail(node, "is no polygon", kDelete);
  }

  void polygon(const pugi::xml_node& node) {
    GeoPolygon& polygon = polygons_.emplace_back();
    polygon.member = places_.of(node);
    std::vector<std::vector<GeoPlace>> outlines;
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() != pugi::node_element || kUnplaced.contains(kml_name(child))) continue;
      const bool outer = kml_name(child) == "outerBoundaryIs";
      if (!outer && kml_name(child) != "innerBoundaryIs")
        fail(child, "is no part of a polygon", "write outerBoundaryIs and innerBoundaryIs");
      boundary(child, outer ? outlines : polygon.rings);
    }
    if (outlines.size() != 1) fail(node, "has not one outline", "write one outerBoundaryIs");
    polygon.rings.insert(polygon.rings.begin(), std::move(outlines.front()));
  }

  void boundary(const pugi::xml_node& node, std::vector<std::vector<GeoPlace>>& rings) const {
    const std::size_t before = rings.size();
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() != pugi::node_element) continue;
      if (kml_name(child) != "LinearRing") fail(child, "is no ring", "write LinearRing");
      std::optional<std::vector<GeoPlace>> places;
      for (const pugi::xml_node& part : child.children()) {
        if (part.type() != pugi::node_element || kUnplaced.contains(kml_name(part))) continue;
        if (kml_name(part) != "coordinates" || places)
          fail(part, "is no part of a ring", "write one list of coordinates");
        places = ring(part);
      }
      if (!places) fail(child, "has no coordinates", "write them, or delete it");
      rings.push_back(*std::move(places));
    }
    if (rings.size() == before) fail(node, "has no LinearRing", "write one, or delete it");
  }

  /// Programs close rings, or leave that to the reader.
  std::vector<GeoPlace> ring(const pugi::xml_node& node) const {
    std::string text;  // comments may stand between its parts
    for (const pugi::xml_node& part : node.children())
      if (part.type() == pugi::node_pcdata || part.type() == pugi::node_cdata) text += part.value();
    std::string_view rest = text;
    std::vector<GeoPlace> ring;
    const auto same = [](const GeoPlace& a, const GeoPlace& b) {
      return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg;
    };
    for (;;) {
      rest.remove_prefix(std::min(rest.size(), rest.find_first_not_of(kKmlBlanks)));
      if (rest.empty()) break;
      const std::string_view tuple = rest.substr(0, rest.find_first_of(kKmlBlanks));
      rest.remove_prefix(tuple.size());
      const GeoPlace place = place_of(node, tuple);
      if (ring.empty() || !same(ring.back(), place)) ring.push_back(place);
    }
    while (ring.size() > 1 && same(ring.front(), ring.back())) ring.pop_back();
    if (ring.size() < 3) fail(node, "has fewer than three places", "draw more, or delete it");
    return ring;
  }

  GeoPlace place_of(const pugi::xml_node& node, std::string_view tuple) const {
    std::vector<double> values;
    for (std::string_view rest = tuple;;) {
      const std::size_t comma = rest.find(',');
      const auto value = read_number<double>(rest.substr(0, comma));
      if (!value || !std::isfinite(*value)) break;
      values.push_back(*value);
      if (comma == rest.npos) {
        if (values.size() == 2 || values.size() == 3) return checked(node, tuple, values);
        break;
      }
      rest.remove_prefix(comma + 1);
    }
    fail(node, "has no place at \"" + std::string(tuple.substr(0, 40)) + '"',
         "write longitude,latitude,height with points, and blanks between places");
  }

  GeoPlace checked(const pugi::xml_node& node, std::string_view tuple,
                   const std::vector<double>& values) const {
    if (std::abs(values[0]) > 180 || std::abs(values[1]) > 90)
      fail(node, "is nowhere on the earth at \"" + std::string(tuple.substr(0, 40)) + '"',
           "write longitude before latitude, in degrees");
    return {values[1], values[0]};
  }

  const XmlPlaces places_;
  std::vector<GeoPolygon> polygons_;
  PolygonFileProblems problems_;
  std::size_t failures_ = 0;
};

}  // namespace

Result<std::vector<GeoPolygon>, PolygonFileProblem> parse_kml(std::string_view text) {
  if (text.starts_with("PK"))
    return failure(PolygonFileProblem{"", "is a KMZ archive", "unpack it: unzip in.kmz doc.kml"});
  pugi::xml_document document;
  const auto parsed = document.load_buffer(text.data(), text.size());
  if (!parsed)
    return failure(PolygonFileProblem{line_of(text, static_cast<std::size_t>(parsed.offset)),
                                      std::string("is no XML: ") + parsed.description(),
                                      "save it anew as KML"});
  try {
    return KmlWalk(text).polygons(document);
  } catch (const BadKml& refused) {
    return failure(refused.problem);
  }
}

Result<std::vector<GeoPolygon>, PolygonFileProblem> read_kml(const std::filesystem::path& file) {
  return text_of_polygon_file(file, ".kml", "simplify it: ogr2ogr -simplify 0.0001 out.kml in.kml")
      .and_then(parse_kml);
}

}  // namespace ergocast
