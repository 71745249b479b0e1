// SPDX-License-Identifier: BSD-3-Clause
// The small languages inside SVG's attributes: lists of numbers, path data and transforms.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ergocast {

using DrawnRing = std::vector<Eigen::Vector2d>;

/// What is wrong with an attribute, and what to do.
struct SvgSyntaxError : std::runtime_error {
  SvgSyntaxError(const std::string& what, std::string remedy_text)
      : std::runtime_error(what), remedy(std::move(remedy_text)) {}
  std::string remedy;
};

/// Reads an attribute from left to right; blanks and commas separate.
class SvgReader {
 public:
  explicit SvgReader(std::string_view text) : rest_(text) {}

  bool at_end();
  /// The next letter if there is one before the next number.
  std::optional<char> letter();
  /// The letters up to the next other character: a function's name.
  std::string_view word();
  /// @throws SvgSyntaxError if the next character is another one
  void expect(char character);
  bool number_follows();
  /// @throws SvgSyntaxError if no finite number follows
  double number();
  /// A digit 0 or 1, which the next number may follow at once.
  /// @throws SvgSyntaxError
  void flag();
  Eigen::Vector2d point();
  std::string_view rest() const { return rest_; }

 private:
  void skip_separators();
  std::string_view rest_;
};

/// Numbers up to the end.
/// @throws SvgSyntaxError
std::vector<double> svg_numbers(std::string_view text);

/// A length in pixels, which are units of the viewBox. Nothing if it is in percent.
/// @throws SvgSyntaxError
std::optional<double> svg_length(std::string_view text);

struct SvgPath {
  std::vector<DrawnRing> rings;  ///< the subpaths, each closed as filling closes it
  bool curved = false;           ///< whether a part is a curve, of which only the ends are corners
};

/// A path's `d`.
/// @throws SvgSyntaxError
SvgPath svg_path(std::string_view d);

/// matrix, translate, scale, rotate, skewX and skewY, applied as written.
/// @throws SvgSyntaxError
Eigen::Affine2d svg_transform(std::string_view text);

}  // namespace ergocast
