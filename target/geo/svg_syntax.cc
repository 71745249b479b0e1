// SPDX-License-Identifier: BSD-3-Clause
// One pass over the characters of each attribute.
#include "target/geo/svg_syntax.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/portable_math.h"

namespace ergocast {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_separator(char c) {
  return c == ' ' || c == ',' || c == '\t' || c == '\n' || c == '\r' || c == '\f';
}

[[noreturn]] void fail(const std::string& what, std::string remedy) {
  throw SvgSyntaxError(what, std::move(remedy));
}

}  // namespace

// ---- numbers ----

void SvgReader::skip_separators() {
  while (!rest_.empty() && is_separator(rest_.front())) rest_.remove_prefix(1);
}

bool SvgReader::at_end() {
  skip_separators();
  return rest_.empty();
}

std::optional<char> SvgReader::letter() {
  if (at_end() || !is_letter(rest_.front())) return std::nullopt;
  const char found = rest_.front();
  rest_.remove_prefix(1);
  return found;
}

std::string_view SvgReader::word() {
  skip_separators();
  std::size_t length = 0;
  while (length < rest_.size() && is_letter(rest_[length])) ++length;
  const std::string_view found = rest_.substr(0, length);
  rest_.remove_prefix(length);
  return found;
}

void SvgReader::expect(char character) {
  if (at_end() || rest_.front() != character)
    fail(std::string("lacks a '") + character + "'", "save the drawing anew");
  rest_.remove_prefix(1);
}

bool SvgReader::number_follows() {
  return !at_end() && !is_letter(rest_.front()) && rest_.front() != ')';
}

double SvgReader::number() {
  skip_separators();
  std::string_view digits = rest_;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || !std::isfinite(value))
    fail("has no finite number at \"" + std::string(rest_.substr(0, 20)) + '"',
         "write numbers in units of the viewBox, without a unit's name");
  rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
  return value;
}

void SvgReader::flag() {
  if (at_end() || (rest_.front() != '0' && rest_.front() != '1'))
    fail("has an arc whose flags are not 0 or 1", "save the drawing anew as plain SVG");
  rest_.remove_prefix(1);
}

Eigen::Vector2d SvgReader::point() {
  const double x = number();
  return {x, number()};
}

std::vector<double> svg_numbers(std::string_view text) {
  SvgReader reader(text);
  std::vector<double> numbers;
  while (!reader.at_end()) numbers.push_back(reader.number());
  return numbers;
}

std::optional<double> svg_length(std::string_view text) {
  SvgReader reader(text);
  const double value = reader.number();
  const std::string_view unit = reader.rest();
  constexpr double kInch = 96;
  for (const auto& [name, pixels] :
       {std::pair("", 1.0), std::pair("px", 1.0), std::pair("in", kInch),
        std::pair("cm", kInch / 2.54), std::pair("mm", kInch / 25.4), std::pair("pt", kInch / 72),
        std::pair("pc", kInch / 6)})
    if (unit == name) return value * pixels;
  if (unit == "%") return std::nullopt;
  fail("is in " + std::string(unit.substr(0, 20)) + ", which is not read",
       "write it without a unit, or in mm, cm, in, pt or px");
}

// ---- paths ----

namespace {

/// Follows the pen of a path.
class Pen {
 public:
  explicit Pen(std::string_view d) : reader_(d) {}

  SvgPath path() {
    while (!reader_.at_end()) {
      const auto command = reader_.letter();
      if (!command)
        fail("has a number where a command is due", "save the drawing anew as plain SVG");
      if (rings_.empty() && *command != 'M' && *command != 'm')
        fail("does not begin with M", "save the drawing anew as plain SVG");
      obey(*command);
    }
    return {std::move(rings_), curved_};
  }

 private:
  void obey(char command) {
    const bool relative = command >= 'a';
    const auto from = [&] { return relative ? at_ : Eigen::Vector2d(0, 0); };
    const auto curve = [&](int handles) {
      do {
        for (int i = 0; i < handles; ++i) reader_.point();
        line_to(from() + reader_.point());
      } while (reader_.number_follows());
      curved_ = true;
    };
    switch (relative ? static_cast<char>(command - 'a' + 'A') : command) {
      case 'M':
        begin(from() + reader_.point());
        while (reader_.number_follows()) line_to(from() + reader_.point());
        return;
      case 'L':
        do line_to(from() + reader_.point());
        while (reader_.number_follows());
        return;
      case 'H':
        do line_to({from().x() + reader_.number(), at_.y()});
        while (reader_.number_follows());
        return;
      case 'V':
        do line_to({at_.x(), from().y() + reader_.number()});
        while (reader_.number_follows());
        return;
      case 'C':
        return curve(2);
      case 'S':
      case 'Q':
        return curve(1);
      case 'T':
        return curve(0);
      case 'A':
        do arc(from());
        while (reader_.number_follows());
        return;
      case 'Z':
        at_ = begin_;
        closed_ = true;
        return;
      default:
        fail(std::string("has the unknown command ") + command,
             "save the drawing anew as plain SVG");
    }
  }

  void arc(const Eigen::Vector2d& from) {
    reader_.point();   // radii
    reader_.number();  // turn
    reader_.flag();
    reader_.flag();
    line_to(from + reader_.point());
    curved_ = true;
  }

  void begin(const Eigen::Vector2d& place) {
    rings_.emplace_back().push_back(place);
    at_ = begin_ = place;
    closed_ = false;
  }

  /// After Z a line begins a new subpath where the old one began.
  void line_to(const Eigen::Vector2d& place) {
    if (closed_) begin(begin_);
    rings_.back().push_back(place);
    at_ = place;
  }

  SvgReader reader_;
  std::vector<DrawnRing> rings_;
  Eigen::Vector2d at_{0, 0}, begin_{0, 0};
  bool closed_ = false, curved_ = false;
};

}  // namespace

SvgPath svg_path(std::string_view d) { return Pen(d).path(); }

// ---- transforms ----

namespace {

Eigen::Affine2d affine(double a, double b, double c, double d, double e, double f) {
  Eigen::Affine2d result;
  result.matrix() << a, c, e, b, d, f, 0, 0, 1;
  return result;
}

Eigen::Affine2d turned(double angle_deg) {
  const double angle = angle_deg * std::numbers::pi / 180;
  return affine(portable::cos(angle), portable::sin(angle), -portable::sin(angle),
                portable::cos(angle), 0, 0);
}

double tangent(double degrees) {
  const portable::SinCos at = portable::sin_cos(degrees * std::numbers::pi / 180);
  return at.sin / at.cos;
}

Eigen::Affine2d step_of(std::string_view name, const std::vector<double>& v) {
  const std::size_t n = v.size();
  if (name == "matrix" && n == 6) return affine(v[0], v[1], v[2], v[3], v[4], v[5]);
  if (name == "translate" && (n == 1 || n == 2)) return affine(1, 0, 0, 1, v[0], n == 2 ? v[1] : 0);
  if (name == "scale" && (n == 1 || n == 2)) return affine(v[0], 0, 0, n == 2 ? v[1] : v[0], 0, 0);
  if (name == "rotate" && n == 1) return turned(v[0]);
  if (name == "rotate" && n == 3)
    return affine(1, 0, 0, 1, v[1], v[2]) * turned(v[0]) * affine(1, 0, 0, 1, -v[1], -v[2]);
  if (name == "skewX" && n == 1) return affine(1, 0, tangent(v[0]), 1, 0, 0);
  if (name == "skewY" && n == 1) return affine(1, tangent(v[0]), 0, 1, 0, 0);
  fail("has a transform that SVG does not know: " + std::string(name), "save the drawing anew");
}

}  // namespace

Eigen::Affine2d svg_transform(std::string_view text) {
  SvgReader reader(text);
  Eigen::Affine2d all = Eigen::Affine2d::Identity();
  while (!reader.at_end()) {
    const std::string_view name = reader.word();
    reader.expect('(');
    std::vector<double> values;
    while (reader.number_follows()) values.push_back(reader.number());
    reader.expect(')');
    all = all * step_of(name, values);
  }
  return all;
}

}  // namespace ergocast
