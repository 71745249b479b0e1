// SPDX-License-Identifier: BSD-3-Clause
// Simplifies by Douglas and Peucker's rule, keeps the extremes of each pixel column, and writes
// short path data.
#include "report/polyline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "report/svg.h"

namespace ergocast {
namespace {

double squared_distance(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                        const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0;
  return (point - from - share * along).squaredNorm();
}

std::pair<std::size_t, double> farthest(const Polyline& points, std::size_t first,
                                        std::size_t last) {
  std::size_t index = first;
  double distance2 = 0;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double here = squared_distance(points[i], points[first], points[last]);
    if (here > distance2) std::tie(index, distance2) = std::pair(i, here);
  }
  return {index, distance2};
}

/// ".5" and "-.5" for 0.5 and −0.5.
std::string short_tenths(long tenths) {
  std::string text = pixels(static_cast<double>(tenths) / 10);
  const std::size_t zero = text.find("0.");
  if (zero == 0 || (zero == 1 && text[0] == '-')) text.erase(zero, 1);
  return text;
}

long to_tenths(double value) { return std::lround(std::clamp(value, -1e5, 1e5) * 10); }

}  // namespace

Polyline simplify(const Polyline& points, double tolerance) {
  if (points.size() < 3) return points;
  std::vector<bool> keep(points.size(), false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> stretches{{0, points.size() - 1}};
  while (!stretches.empty()) {
    const auto [first, last] = stretches.back();
    stretches.pop_back();
    const auto [index, distance2] = farthest(points, first, last);
    if (distance2 <= tolerance * tolerance) continue;
    keep[index] = true;
    stretches.push_back({first, index});
    stretches.push_back({index, last});
  }
  Polyline kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (keep[i]) kept.push_back(points[i]);
  }
  return kept;
}

Polyline thin_columns(const Polyline& points) {
  Polyline thin;
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    const double column = std::floor(points[begin].x());
    while (end < points.size() && std::floor(points[end].x()) == column) ++end;
    const auto first = points.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto [low, high] =
        std::minmax_element(first, points.begin() + static_cast<std::ptrdiff_t>(end),
                            [](const auto& a, const auto& b) { return a.y() < b.y(); });
    std::array<std::size_t, 4> picked{begin, static_cast<std::size_t>(low - points.begin()),
                                      static_cast<std::size_t>(high - points.begin()), end - 1};
    std::sort(picked.begin(), picked.end());
    const auto unique_end = std::unique(picked.begin(), picked.end());
    for (auto i = picked.begin(); i != unique_end; ++i) thin.push_back(points[*i]);
  }
  return thin;
}

std::string path_data(const Polyline& points) {
  if (points.empty()) return "";
  long x = to_tenths(points[0].x()), y = to_tenths(points[0].y());
  std::string data = 'M' + short_tenths(x) + ' ' + short_tenths(y) + 'l';
  const std::size_t start = data.size();
  // Differences between rounded positions, so that rounding errors do not add up along the path.
  for (const Eigen::Vector2d& point : points) {
    const long dx = to_tenths(point.x()) - x, dy = to_tenths(point.y()) - y;
    if (dx == 0 && dy == 0) continue;
    if (dx >= 0 && data.size() > start) data += ' ';
    data += short_tenths(dx);
    if (dy >= 0) data += ' ';
    data += short_tenths(dy);
    x += dx;
    y += dy;
  }
  if (data.size() == start) data += "0 0";
  return data;
}

}  // namespace ergocast
