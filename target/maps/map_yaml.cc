// SPDX-License-Identifier: BSD-3-Clause
// Reads one line after the other, and takes comments and quotes off the values.
#include "target/maps/map_yaml.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "target/maps/map_text.h"
#include "text/input_file.h"

namespace ergocast {
namespace {

constexpr double kFarthest_m = 1e7, kLargestCell_m = 1e6, kSmallestCell_m = 1e-6;

/// The text without a comment, which begins with # at the beginning or after a space.
std::string_view without_comment(std::string_view text) {
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#' && (i == 0 || text[i - 1] == ' ' || text[i - 1] == '\t')) {
      return text.substr(0, i);
    }
  }
  return text;
}

class YamlReader {
 public:
  explicit YamlReader(std::string file) : file_(std::move(file)) {}

  Result<MapYaml, MapProblem> read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    while (!text.empty() && !problem_) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      take_line(without_comment(text.substr(0, end)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (problem_) return failure(*problem_);
    MapYaml map;
    take_picture(map);
    take_place(map);
    take_thresholds(map);
    if (problem_) return failure(*problem_);
    return map;
  }

 private:
  struct Value {
    int line;
    std::string text;
  };

  /// Keeps the first problem.
  void refuse(int line, const std::string& what, std::string remedy) {
    if (problem_) return;
    const std::string where = line > 0 ? ", line " + std::to_string(line) : "";
    problem_ = MapProblem{file_ + where + ": " + what, std::move(remedy)};
  }

  void take_line(std::string_view line) {
    const std::string_view text = trimmed(line);
    if (text.empty() || text == "---" || text == "...") return;
    const std::size_t colon = text.find(':');
    const bool is_pair =
        line.front() != ' ' && line.front() != '\t' && colon != text.npos &&
        (colon + 1 == text.size() || text[colon + 1] == ' ' || text[colon + 1] == '\t');
    if (!is_pair)
      return refuse(line_, "is no line \"key: value\"",
                    "write each key with its value on one line");
    const std::string key(trimmed(text.substr(0, colon)));
    static const std::vector<std::string> kKeys = {
        "image",           "resolution",  "origin", "negate",
        "occupied_thresh", "free_thresh", "mode",   "map_type"};  // nav2 ignores the last one, too
    if (std::ranges::find(kKeys, key) == kKeys.end())
      return refuse(
          line_, quoted_word(key) + " is no key of an occupancy map",
          "keep image, resolution, origin, negate, occupied_thresh, free_thresh and mode");
    if (values_.contains(key))
      return refuse(line_, key + " is there for the second time", "keep one of its lines");
    const std::string_view value = trimmed(text.substr(colon + 1));
    if (value.empty())
      return refuse(line_, key + " has no value on its line", "write its value after the colon");
    values_[key] = {line_, std::string(value)};
  }

  /// The value of a required key; an empty one is reported.
  Value value_of(const std::string& key) {
    const auto found = values_.find(key);
    if (found != values_.end()) return found->second;
    refuse(0, "has no " + key, "add the line that map_saver writes: " + example_of(key));
    return {0, ""};
  }

  static std::string example_of(const std::string& key) {
    static const std::map<std::string, std::string> kExamples = {
        {"image", "map.pgm"}, {"resolution", "0.05"},      {"origin", "[-10.0, -10.0, 0.0]"},
        {"negate", "0"},      {"occupied_thresh", "0.65"}, {"free_thresh", "0.196"}};
    return key + ": " + kExamples.at(key);
  }

  static std::string plain(const std::string& text) {
    const bool is_quoted = text.size() >= 2 && text.front() == text.back() &&
                           (text.front() == '"' || text.front() == '\'');
    return is_quoted ? text.substr(1, text.size() - 2) : text;
  }

  double number(const std::string& key, double low, double high, const std::string& remedy) {
    const Value value = value_of(key);
    const std::optional<double> number = number_in(value.text);
    if (number && *number >= low && *number <= high) return *number;
    if (number)
      refuse(value.line, key + " " + quoted_word(value.text) + " is outside its limits", remedy);
    else
      refuse(value.line, key + " " + quoted_word(value.text) + " is no number", remedy);
    return low;
  }

  void take_picture(MapYaml& map) {
    const Value image = value_of("image");
    map.image = plain(image.text);
    if (map.image.empty())
      refuse(image.line, "image has no name", "name the picture, such as map.pgm");
    const Value negate = value_of("negate");
    map.negate = negate.text == "1" || negate.text == "true";
    if (!map.negate && negate.text != "0" && negate.text != "false")
      refuse(negate.line, "negate is " + quoted_word(negate.text) + ", neither 0 nor 1",
             "write 0 where dark is occupied, 1 where dark is free");
    const auto mode = values_.find("mode");
    if (mode == values_.end()) return;
    const std::string name = plain(mode->second.text);
    if (name == "scale")
      map.mode = OccupancyMode::kScale;
    else if (name == "raw")
      map.mode = OccupancyMode::kRaw;
    else if (name != "trinary")
      refuse(mode->second.line, "mode " + quoted_word(name) + " is unknown",
             "write trinary, scale or raw");
  }

  void take_place(MapYaml& map) {
    map.resolution_m = number("resolution", kSmallestCell_m, kLargestCell_m,
                              "write the side of a cell in metres, such as 0.05");
    const Value origin = value_of("origin");
    std::vector<double> numbers;
    std::string_view rest = origin.text;
    const bool is_list = rest.size() >= 2 && rest.starts_with('[') && rest.ends_with(']');
    rest = is_list ? rest.substr(1, rest.size() - 2) : std::string_view();
    for (bool more = is_list; more;) {
      const std::size_t comma = rest.find(',');
      const std::optional<double> one = number_in(trimmed(rest.substr(0, comma)));
      more = one && comma != rest.npos && numbers.size() < 3;
      if (one && std::abs(*one) <= kFarthest_m) numbers.push_back(*one);
      if (more)
        rest.remove_prefix(comma + 1);
      else if (!one)
        numbers.clear();
    }
    if (numbers.size() != 3)
      return refuse(origin.line,
                    "origin " + quoted_word(origin.text) + " is no list of three numbers up to 1e7",
                    "write [x, y, yaw] in metres and radians, such as [-10.0, -10.0, 0.0]");
    map.origin_m = {numbers[0], numbers[1]};
    map.yaw_rad = numbers[2];
  }

  void take_thresholds(MapYaml& map) {
    const std::string remedy = "write a number from 0 to 1";
    map.occupied_thresh = number("occupied_thresh", 0, 1, remedy);
    map.free_thresh = number("free_thresh", 0, 1, remedy);
    if (map.free_thresh <= map.occupied_thresh) return;
    refuse(value_of("free_thresh").line,
           "free_thresh " + value_of("free_thresh").text + " is above occupied_thresh " +
               value_of("occupied_thresh").text,
           "write the smaller number for free_thresh, such as 0.196 and 0.65");
  }

  std::string file_;
  int line_ = 0;
  std::map<std::string, Value> values_;
  std::optional<MapProblem> problem_;
};

}  // namespace

Result<MapYaml, MapProblem> parse_map_yaml(std::string_view text, const std::string& file) {
  return YamlReader(file).read(text);
}

Result<MapYaml, MapProblem> read_map_yaml(const std::filesystem::path& file) {
  if (auto problem = why_unreadable(file)) return failure(*problem);
  const auto text = read_whole(file, kMaxMapYamlBytes);
  if (!text)
    return failure(MapProblem{file.string() + ' ' + text.error().what, text.error().remedy});
  auto map = parse_map_yaml(*text, file.string());
  if (map) map->image = file.parent_path() / map->image;
  return map;
}

}  // namespace ergocast
