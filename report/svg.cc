// SPDX-License-Identifier: BSD-3-Clause
// Appends each element as text, with coordinates of one decimal that are cut where they are far
// outside.
#include "report/svg.h"

#include <algorithm>
#include <cmath>

#include "report/markup.h"

namespace ergocast {
namespace {

/// For a file opened alone; a page may set other colours for a dark screen.
constexpr const char* kStyle = R"(
text{font:12px system-ui,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif;fill:#333}
.tick{font-size:11px;fill:#555}.head{font-size:13px;font-weight:600}.note{font-size:11px;fill:#666}
.middle{text-anchor:middle}.end{text-anchor:end}
.paper{fill:#fff}.frame{fill:none;stroke:#555}.mark{stroke:#555}.grid{stroke:#e3e5e8}.fine{stroke:#f1f2f4}
.curve{fill:none;stroke-linejoin:round;stroke-linecap:round}
.main{stroke:#0072b2;stroke-width:1.8}.fit{stroke:#d55e00;stroke-width:2;stroke-dasharray:7 4}
.team{stroke:#222;stroke-width:2}.limit{stroke:#333;stroke-dasharray:5 4}.band{fill:#8a94a3;fill-opacity:.18}
.halo{paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round}
.onmap{font-size:11px;font-weight:600;fill:#222}
)";

std::string attribute(std::string_view name, double value) {
  return ' ' + std::string(name) + "=\"" + pixels(value) + '"';
}

std::string box_attributes(const Area& box) {
  return attribute("x", box.left) + attribute("y", box.top) + attribute("width", box.width) +
         attribute("height", box.height);
}

std::string spaced(std::string_view attributes) { return ' ' + std::string(attributes); }

}  // namespace

std::string pixels(double value) {
  constexpr double kFarOutside = 1e5;
  return std::isfinite(value) ? fixed(std::clamp(value, -kFarOutside, kFarOutside), 1) : "0";
}

Svg::Svg(double width, double height, std::string name, std::string_view description)
    : name_(std::move(name)),
      body_("<title>" + escape(description) + "</title>\n<style>" + kStyle + "</style>\n"),
      width_(width),
      height_(height) {
  rect({0, 0, width, height}, "class=\"paper\"");
}

void Svg::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
               std::string_view attributes) {
  body_ += "<line" + attribute("x1", from.x()) + attribute("y1", from.y()) +
           attribute("x2", to.x()) + attribute("y2", to.y()) + spaced(attributes) + "/>\n";
}

void Svg::rect(const Area& box, std::string_view attributes) {
  body_ += "<rect" + box_attributes(box) + spaced(attributes) + "/>\n";
}

void Svg::circle(const Eigen::Vector2d& center, double radius, std::string_view attributes) {
  body_ += "<circle" + attribute("cx", center.x()) + attribute("cy", center.y()) +
           attribute("r", radius) + spaced(attributes) + "/>\n";
}

void Svg::path(std::string_view data, std::string_view attributes) {
  if (data.empty()) return;
  body_ += "<path d=\"" + std::string(data) + '"' + spaced(attributes) + "/>\n";
}

void Svg::text(const Eigen::Vector2d& at, std::string_view attributes, std::string_view content) {
  body_ += "<text" + attribute("x", at.x()) + attribute("y", at.y()) + spaced(attributes) + '>' +
           escape(content) + "</text>\n";
}

void Svg::image(const Area& box, std::string_view data_uri, bool smooth) {
  body_ += "<image" + box_attributes(box) + " preserveAspectRatio=\"none\"" +
           (smooth ? "" : " style=\"image-rendering:pixelated\"") + " href=\"" +
           std::string(data_uri) + "\"/>\n";
}

void Svg::begin_clip(const Area& box) {
  const std::string id = name_ + "-clip" + std::to_string(clips_++);
  body_ += "<clipPath id=\"" + id + "\"><rect" + box_attributes(box) + "/></clipPath>\n";
  body_ += "<g clip-path=\"url(#" + id + ")\">\n";
}

void Svg::end_clip() { body_ += "</g>\n"; }

std::string Svg::str() const {
  const std::string width = pixels(width_), height = pixels(height_);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"" + width +
         "\" height=\"" + height + "\" viewBox=\"0 0 " + width + ' ' + height + "\">\n" + body_ +
         "</svg>\n";
}

}  // namespace ergocast
