// SPDX-License-Identifier: BSD-3-Clause
// The child answers with one byte for each cell, or with a letter and a message.
#include "target/geo/svg_painter.h"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "target/geo/bounded_child.h"
#include "target/geo/svg_hairs.h"
#include "target/geo/svg_luminance.h"
#include "target/maps/symbol.h"

namespace ergocast {
namespace {

/// The functions with the names and types of rsvg.h and cairo.h.
struct RsvgLibrary {
  struct Error {
    unsigned domain;
    int code;
    char* message;
  };
  struct Box {
    double x, y, width, height;
  };
  /// Places in a picture are (xx x + xy y + x0, yx x + yy y + y0).
  struct Matrix {
    double xx, yx, xy, yy, x0, y0;
  };
  void* (*rsvg_handle_new_from_data)(const unsigned char* data, std::size_t length, Error** error);
  void (*rsvg_handle_set_dpi)(void* handle, double dpi);
  int (*rsvg_handle_render_document)(void* handle, void* cairo, const Box* viewport, Error** error);
  void* (*cairo_image_surface_create)(int format, int width, int height);
  void* (*cairo_create)(void* surface);
  void (*cairo_transform)(void* cairo, const Matrix* matrix);
  int (*cairo_status)(void* cairo);
  void (*cairo_destroy)(void* cairo);
  void (*cairo_surface_destroy)(void* surface);
  void (*cairo_surface_flush)(void* surface);
  unsigned char* (*cairo_image_surface_get_data)(void* surface);
  int (*cairo_image_surface_get_stride)(void* surface);

  bool load() {
    void* const handle = dlopen("librsvg-2.so.2", RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) return false;
    const auto find = [&](auto& function, const char* name) {
      return find_symbol(handle, name, function);
    };
    return find(rsvg_handle_new_from_data, "rsvg_handle_new_from_data") &&
           find(rsvg_handle_set_dpi, "rsvg_handle_set_dpi") &&
           find(cairo_transform, "cairo_transform") && find(cairo_destroy, "cairo_destroy") &&
           find(cairo_surface_destroy, "cairo_surface_destroy") &&
           find(rsvg_handle_render_document, "rsvg_handle_render_document") &&
           find(cairo_image_surface_create, "cairo_image_surface_create") &&
           find(cairo_create, "cairo_create") && find(cairo_status, "cairo_status") &&
           find(cairo_surface_flush, "cairo_surface_flush") &&
           find(cairo_image_surface_get_data, "cairo_image_surface_get_data") &&
           find(cairo_image_surface_get_stride, "cairo_image_surface_get_stride");
  }
};

/// The first byte of the child's answer.
enum class Outcome : char { kNoLibrary, kError, kPainted };

struct Paint {
  const std::string& svg;
  int columns, rows;     // cells, which are pixels
  double width, height;  // of the page, in pixels
  bool solid_white;
};

/// @param pixel  opacity, red, green, blue, from the highest byte; the others times opacity
bool is_solid(std::uint32_t pixel, bool solid_white) {
  const std::uint32_t opacity = pixel >> 24;
  if (opacity == 0 || pixel == 0xffffffff) return solid_white && opacity > 0;
  const auto part = [&](unsigned shift) {
    return (pixel >> shift & 255) / static_cast<double>(opacity);
  };
  return solid_white || luminance(part(16), part(8), part(0)) < kSolidLuminance;
}

/// How dark a pixel is: kSolidDarkness, or of one that hides the page, how far it is from white to
/// solid.
std::uint8_t darkness(std::uint32_t pixel, bool solid_white) {
  if (is_solid(pixel, solid_white)) return kSolidDarkness;
  if (pixel >> 24 != 255) return 0;
  const auto part = [&](unsigned shift) { return (pixel >> shift & 255) / 255.0; };
  const double off_white = 1 - luminance(part(16), part(8), part(0));
  return static_cast<std::uint8_t>(kMostFaint * std::min(1.0, off_white / (1 - kSolidLuminance)));
}

std::string answer(Outcome outcome, const std::string& rest) {
  return static_cast<char>(outcome) + rest;
}

/// Paints a drawing as it is written, and with rows and columns exchanged: what is thinner than a
/// fifteenth of a pixel can fall between the samples along one of the two.
class Painter {
 public:
  explicit Painter(const Paint& paint)
      : paint_(paint), cells_(static_cast<std::size_t>(paint.columns * paint.rows), '\0') {}

  std::string paint() {
    if (!rsvg_.load()) return answer(Outcome::kNoLibrary, "");
    const auto* const svg = reinterpret_cast<const unsigned char*>(paint_.svg.data());
    handle_ = rsvg_.rsvg_handle_new_from_data(svg, paint_.svg.size(), &error_);
    if (handle_ != nullptr) rsvg_.rsvg_handle_set_dpi(handle_, 96);
    if (handle_ == nullptr || !paint_once(false) || !paint_once(true))
      return answer(Outcome::kError, error_ != nullptr ? error_->message : "it cannot be painted");
    return answer(Outcome::kPainted, cells_);
  }

 private:
  bool paint_once(bool turned) {
    constexpr int kArgb32 = 0;
    constexpr RsvgLibrary::Matrix kExchange{0, 1, 1, 0, 0, 0};
    int width = paint_.columns, height = paint_.rows;
    if (turned) std::swap(width, height);
    void* const surface = rsvg_.cairo_image_surface_create(kArgb32, width, height);
    void* const cairo = rsvg_.cairo_create(surface);
    if (turned) rsvg_.cairo_transform(cairo, &kExchange);
    const RsvgLibrary::Box page{0, 0, paint_.width, paint_.height};
    const bool done = rsvg_.rsvg_handle_render_document(handle_, cairo, &page, &error_) != 0 &&
                      rsvg_.cairo_status(cairo) == 0;
    rsvg_.cairo_surface_flush(surface);
    const unsigned char* const pixels = rsvg_.cairo_image_surface_get_data(surface);
    const std::ptrdiff_t stride = rsvg_.cairo_image_surface_get_stride(surface);
    std::vector<std::uint32_t> row(static_cast<std::size_t>(width));
    for (int y = 0; done && pixels != nullptr && y < height; ++y) {
      std::memcpy(row.data(), pixels + stride * y, 4 * row.size());
      for (int x = 0; x < width; ++x) {
        const std::uint8_t dark = darkness(row[static_cast<std::size_t>(x)], paint_.solid_white);
        turned ? mark(y, x, dark) : mark(x, y, dark);
      }
    }
    rsvg_.cairo_destroy(cairo);
    rsvg_.cairo_surface_destroy(surface);
    return done && pixels != nullptr;
  }

  /// A pixel, from the upper left corner.
  void mark(int x, int y, std::uint8_t dark) {
    const auto row = static_cast<std::size_t>(paint_.rows - 1 - y);
    char& cell =
        cells_[row * static_cast<std::size_t>(paint_.columns) + static_cast<std::size_t>(x)];
    cell = static_cast<char>(std::max(dark, static_cast<std::uint8_t>(cell)));
  }

  const Paint& paint_;
  std::string cells_;
  RsvgLibrary rsvg_{};
  RsvgLibrary::Error* error_ = nullptr;
  void* handle_ = nullptr;
};

tl::unexpected<PolygonFileProblem> refuse(std::string what, std::string remedy) {
  return failure(PolygonFileProblem{"", std::move(what), std::move(remedy)});
}

}  // namespace

Result<PaintedDrawing, PolygonFileProblem> paint_svg(const std::string& svg,
                                                     const Eigen::Vector2d& size,
                                                     bool solid_white) {
  const double cell = size.maxCoeff() / kPaintedCells;
  const auto count = [&](double length) {
    return std::clamp(static_cast<int>(std::ceil(length / cell - 1e-6)), 1, kPaintedCells);
  };
  const Paint paint{svg,        count(size.x()), count(size.y()), size.x() / cell, size.y() / cell,
                    solid_white};
  PaintedDrawing painted{CellGrid(paint.columns, paint.rows), cell};
  const auto told = in_bounded_child(std::size_t{1} << 23, [&] { return Painter(paint).paint(); });
  const bool is_whole = told && !told->empty() && told->find("NoMemory") == told->npos &&
                        (static_cast<Outcome>(told->front()) != Outcome::kPainted ||
                         told->size() == 1 + painted.solid.size());
  if (!is_whole)
    return refuse("librsvg cannot paint it within 20 s of processor time and 768 MiB",
                  "delete or hide all but the walls: in Inkscape, by layers");
  const std::string rest = told->substr(1);
  switch (static_cast<Outcome>(told->front())) {
    case Outcome::kNoLibrary:
      return refuse("needs librsvg, which this machine does not have", "apt install librsvg2-2");
    case Outcome::kError:
      return refuse("librsvg: " + rest.substr(0, 200), "save the drawing anew as plain SVG");
    case Outcome::kPainted:
      break;
  }
  CellGrid& cells = painted.solid;
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = static_cast<std::uint8_t>(rest[i]);
  painted.hair = first_hair(cells);
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = cells[i] == kSolidDarkness ? 1 : 0;
  return painted;
}

}  // namespace ergocast
