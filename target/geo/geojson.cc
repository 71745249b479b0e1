// SPDX-License-Identifier: BSD-3-Clause
// Walks the members of a parsed file with their names; a problem ends that of its feature or
// polygon.
#include "target/geo/geojson.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "text/json_bounds.h"
#include "text/shortest.h"

namespace ergocast {
namespace {

using Json = nlohmann::json;

/// A position has three values: a list of two numbers. Files of 16 MiB as programs write them have
/// fewer.
/// Limit (Files of a scenario): values in a GeoJSON file. Beyond it: the scenario is refused.
constexpr std::size_t kMostValues = 4'000'000;
constexpr const char* kSimplify = "simplify it: ogr2ogr -simplify 0.0001 out.geojson in.geojson";

struct Refused {
  PolygonFileProblem problem;
};

[[noreturn]] void fail(const std::string& member, std::string what, std::string remedy) {
  throw Refused{{member, std::move(what), std::move(remedy)}};
}

std::string indexed(const std::string& member, std::size_t index) {
  return member + "[" + std::to_string(index) + "]";
}
std::string below(const std::string& member, const char* name) {
  return member.empty() ? name : member + "." + name;
}

class Walk {
 public:
  std::vector<GeoPolygon> polygons;
  PolygonFileProblems problems;

  void file(const Json& root) {
    if (root.is_object() && root.contains("crs")) reference_system(root["crs"]);
    if (type_of(root) == "FeatureCollection") {
      const std::string top;
      const Json& features = list(root, "features", top);
      for (std::size_t i = 0; i < features.size() && !problems.full(); ++i)
        apart([&] { object(features[i], indexed("features", i)); });
    } else {
      object(root, "");
    }
    const bool none =
        std::ranges::all_of(polygons, [](const auto& one) { return one.rings.empty(); });
    if (none && problems.empty()) fail("", "has no polygon", "draw one, or name another file");
  }

 private:
  template <class Read>
  void apart(Read read) {
    try {
      read();
    } catch (Refused& refused) {
      problems.add(std::move(refused.problem));
    }
  }

  static std::string type_of(const Json& json) {
    const bool has_type = json.is_object() && json.contains("type") && json["type"].is_string();
    return has_type ? json["type"].get<std::string>() : "";
  }

  /// RFC 7946 knows WGS 84 alone; older files may name others.
  static void reference_system(const Json& crs) {
    if (crs.is_null()) return;
    const Json name =
        crs.is_object() ? crs.value(Json::json_pointer("/properties/name"), Json()) : Json();
    const std::string text = name.is_string() ? name.get<std::string>() : "";
    if (text.find("CRS84") != text.npos || text.find("4326") != text.npos) return;
    fail("crs", "is another reference system than WGS 84",
         "convert it: ogr2ogr -t_srs EPSG:4326 out.geojson in.geojson");
  }

  static const Json& list(const Json& object, const char* name, const std::string& member) {
    const auto at = object.find(name);
    if (at == object.end() || !at->is_array()) {
      fail(member, std::string("has no list \"") + name + '"', "write GeoJSON as RFC 7946 has it");
    }
    return *at;
  }

  /// A Feature or a geometry.
  void object(const Json& json, const std::string& member) {
    if (type_of(json) != "Feature") return geometry(json, member);
    const auto at = json.find("geometry");
    if (at != json.end() && at->is_null()) {  // a feature without a place (RFC 7946, 3.2)
      polygons.push_back({member, {}});
      return;
    }
    geometry(at == json.end() ? Json() : *at, below(member, "geometry"));
  }

  void geometry(const Json& json, const std::string& member) {
    const std::string type = type_of(json);
    if (type == "Polygon") {
      polygon(list(json, "coordinates", member), member, below(member, "coordinates"));
    } else if (type == "MultiPolygon") {
      const Json& parts = list(json, "coordinates", member);
      if (parts.empty()) polygons.push_back({member, {}});
      const std::string name = below(member, "coordinates");
      for (std::size_t i = 0; i < parts.size(); ++i)
        apart([&] { polygon(parts[i], indexed(name, i), indexed(name, i)); });
    } else {
      fail(member,
           type.empty() ? "is no GeoJSON object with a type"
                        : "has the type " + type + ", which is no polygon",
           "keep features of the types Polygon and MultiPolygon");
    }
  }

  void polygon(const Json& rings, const std::string& member, const std::string& coordinates) {
    if (!rings.is_array()) {
      fail(coordinates, "is no list of rings", "write the outline, then the holes");
    }
    GeoPolygon& polygon = polygons.emplace_back();
    polygon.member = member;
    for (std::size_t i = 0; i < rings.size(); ++i)
      apart([&] { polygon.rings.push_back(ring(rings[i], indexed(coordinates, i))); });
  }

  static std::vector<GeoPlace> ring(const Json& positions, const std::string& member) {
    constexpr std::size_t kFewest = 4;
    if (!positions.is_array() || positions.size() < kFewest) {
      fail(member, "has fewer than four positions",
           "a ring has three or more, and its first again");
    }
    std::vector<GeoPlace> ring;
    for (std::size_t i = 0; i < positions.size(); ++i)
      ring.push_back(place_of(positions[i], indexed(member, i)));
    const GeoPlace &first = ring.front(), &last = ring.back();
    if (first.latitude_deg != last.latitude_deg || first.longitude_deg != last.longitude_deg) {
      fail(member, "is not closed", "repeat its first position as the last");
    }
    ring.pop_back();
    const auto same = [](const GeoPlace& a, const GeoPlace& b) {
      return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg;
    };
    ring.erase(std::unique(ring.begin(), ring.end(), same), ring.end());
    while (ring.size() > 1 && same(ring.front(), ring.back())) ring.pop_back();
    return ring;
  }

  static GeoPlace place_of(const Json& position, const std::string& member) {
    const bool is_position = position.is_array() && position.size() >= 2 &&
                             position[0].is_number() && position[1].is_number();
    if (!is_position) fail(member, "is no position", "write [longitude, latitude]");
    const GeoPlace place{position[1].get<double>(), position[0].get<double>()};
    const auto check = [&](const char* name, double value, double limit) {
      if (value >= -limit && value <= limit) return;
      fail(member,
           std::string(name) + " " + shortest(value) + " is outside " + shortest(-limit) + " to " +
               shortest(limit),
           "write [longitude, latitude] in degrees of WGS 84, in this order");
    };
    check("longitude", place.longitude_deg, 180);
    check("latitude", place.latitude_deg, 90);
    return place;
  }
};

}  // namespace

namespace {

/// "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error …"
PolygonFileProblem no_json(std::string_view error) {
  constexpr std::string_view kAt = "parse error at ";
  if (const std::size_t at = error.find(kAt); at != error.npos)
    error.remove_prefix(at + kAt.size());
  const std::size_t colon = error.starts_with("line ") ? error.find(": ") : error.npos;
  const std::string place(colon == error.npos ? "" : error.substr(0, colon));
  const std::string_view what = colon == error.npos ? error : error.substr(colon + 2);
  const bool comma =
      what.find("unexpected ']'") != what.npos || what.find("unexpected '}'") != what.npos;
  const bool curly = what.find('\xe2') != what.npos;
  return {place, "is no JSON: " + std::string(what),
          comma   ? "remove the comma before it"
          : curly ? "write straight quotes"
                  : "repair it there"};
}

}  // namespace

Result<std::vector<GeoPolygon>, PolygonFileProblem> parse_geojson(std::string_view text) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return failure(
        PolygonFileProblem{"", "is in UTF-16, and GeoJSON is UTF-8",
                           "convert it: iconv -f UTF-16 -t UTF-8 in.geojson > out.geojson"});
  if (text.starts_with('<'))
    return failure(PolygonFileProblem{"", "is XML such as KML, no GeoJSON",
                                      "name KML as such: a file that ends in .kml"});
  try {
    Walk walk;
    walk.file(parse_bounded<Json>(text, kMostValues));
    if (!walk.problems.empty()) return failure(walk.problems.all());
    return std::move(walk.polygons);
  } catch (const JsonTooLarge& problem) {
    return failure(PolygonFileProblem{"", problem.what(), kSimplify});
  } catch (const Refused& refused) {
    return failure(refused.problem);
  } catch (const Json::exception& error) {
    return failure(no_json(error.what()));
  }
}

Result<std::vector<GeoPolygon>, PolygonFileProblem> read_geojson(
    const std::filesystem::path& file) {
  return text_of_polygon_file(file, ".geojson", kSimplify).and_then(parse_geojson);
}

}  // namespace ergocast
