// SPDX-License-Identifier: BSD-3-Clause
// Builds a drawing element by element. All input is made safe here: text is escaped, and a
// coordinate that is not finite is not written.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

namespace ergocast {

/// A rectangle of the drawing, in pixels, y downwards.
struct Area {
  double left = 0, top = 0, width = 0, height = 0;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

/// `value` with one decimal in SVG's format; 0 if it is not finite.
std::string pixels(double value);

/// Attributes are not escaped: they come from this program, never from a user.
class Svg {
 public:
  /// @param name  unique among the drawings of one page: the ids inside begin with it
  Svg(double width, double height, std::string name, std::string_view description);

  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view attributes);
  void rect(const Area& box, std::string_view attributes);
  void circle(const Eigen::Vector2d& center, double radius, std::string_view attributes);
  void path(std::string_view data, std::string_view attributes);
  /// `at` is on the base line of the text.
  void text(const Eigen::Vector2d& at, std::string_view attributes, std::string_view content);
  /// A picture stretched over `box`; `smooth` blends its cells into each other.
  void image(const Area& box, std::string_view data_uri, bool smooth);

  /// All that follows until end_clip() is cut off at the edge of `box`.
  void begin_clip(const Area& box);
  void end_clip();

  /// The finished document.
  std::string str() const;

 private:
  std::string name_, body_;
  double width_, height_;
  int clips_ = 0;
};

}  // namespace ergocast
