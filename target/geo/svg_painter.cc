// SPDX-License-Identifier: BSD-3-Clause
// The child paints into memory that it shares with its parent, and ends.
#include "target/geo/svg_painter.h"

#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <utility>

#include "target/geo/svg_luminance.h"
#include "target/maps/symbol.h"

namespace ergocast {
namespace {

constexpr int kPixelsPerCell = 2;
/// Limit (Files of a scenario): memory for painting a drawing [bytes]. Beyond it: the scenario is
/// refused.
constexpr std::size_t kMostPaintBytes = std::size_t{1} << 30;
/// Limit (Files of a scenario): processor time for painting a drawing [s]. Beyond it: the scenario
/// is refused.
constexpr unsigned kMostPaintSeconds = 120;

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

enum class Outcome : int { kNone, kNoLibrary, kError, kPainted };

/// What the child writes for its parent; the cells follow it.
struct Shared {
  Outcome outcome;
  std::array<char, 200> message;
};

struct Paint {
  const std::string& svg;
  int columns, rows;     // cells
  double width, height;  // pixels
  bool solid_white;
};

bool is_solid(const unsigned char* pixel, bool solid_white) {
  const int opacity = pixel[3];  // blue, green, red, each times opacity
  if (opacity == 0) return false;
  const double whole = opacity;
  return solid_white ||
         luminance(pixel[2] / whole, pixel[1] / whole, pixel[0] / whole) < kSolidLuminance;
}

void note(Shared& shared, Outcome outcome, const char* message = "") {
  std::snprintf(shared.message.data(), shared.message.size(), "%s", message);
  shared.outcome = outcome;
}

/// Paints a drawing as it is written, and with rows and columns exchanged: what is thinner than a
/// fifteenth of a pixel can fall between the samples along one of the two.
class Painter {
 public:
  Painter(const Paint& paint, Shared& shared, std::uint8_t* cells)
      : paint_(paint), shared_(shared), cells_(cells) {}

  void paint() {
    if (!rsvg_.load()) return note(shared_, Outcome::kNoLibrary);
    const auto* const svg = reinterpret_cast<const unsigned char*>(paint_.svg.data());
    handle_ = rsvg_.rsvg_handle_new_from_data(svg, paint_.svg.size(), &error_);
    if (handle_ != nullptr) rsvg_.rsvg_handle_set_dpi(handle_, 96);
    if (handle_ == nullptr || !paint_once(false) || !paint_once(true)) {
      return note(shared_, Outcome::kError,
                  error_ != nullptr ? error_->message : "it cannot be painted");
    }
    note(shared_, Outcome::kPainted);
  }

 private:
  bool paint_once(bool turned) {
    constexpr int kArgb32 = 0;
    constexpr RsvgLibrary::Matrix kExchange{0, 1, 1, 0, 0, 0};
    int width = paint_.columns * kPixelsPerCell, height = paint_.rows * kPixelsPerCell;
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
    if (done && pixels != nullptr) {
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          if (is_solid(pixels + stride * y + 4 * std::ptrdiff_t{x}, paint_.solid_white))
            turned ? mark(y, x) : mark(x, y);
    }
    rsvg_.cairo_destroy(cairo);
    rsvg_.cairo_surface_destroy(surface);
    return done && pixels != nullptr;
  }

  /// A pixel, from the upper left corner.
  void mark(int x, int y) {
    const std::ptrdiff_t row = paint_.rows - 1 - y / kPixelsPerCell;
    cells_[row * paint_.columns + x / kPixelsPerCell] = 1;
  }

  const Paint& paint_;
  Shared& shared_;
  std::uint8_t* cells_;
  RsvgLibrary rsvg_{};
  RsvgLibrary::Error* error_ = nullptr;
  void* handle_ = nullptr;
};

void bound(int resource, rlim_t most) {
  const rlimit limit{most, most};
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

/// Sanitizers need more memory than there is.
void bound_memory() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  std::ifstream pages("/proc/self/statm");
  std::size_t now = 0;
  pages >> now;
  bound(RLIMIT_AS, now * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + kMostPaintBytes);
#endif
}

[[noreturn]] void become_painter(const Paint& paint, Shared& shared, std::uint8_t* cells) {
  for (const int signal : {SIGABRT, SIGSEGV, SIGXCPU, SIGALRM, SIGINT, SIGTERM, SIGTRAP})
    std::signal(signal, SIG_DFL);
  std::freopen("/dev/null", "w", stdout);
  std::freopen("/dev/null", "w", stderr);
  bound(RLIMIT_CORE, 0);
  bound(RLIMIT_CPU, kMostPaintSeconds);
  alarm(10 * kMostPaintSeconds);
  bound_memory();
  Painter(paint, shared, cells).paint();
  _exit(0);
}

/// Memory that a child writes and its parent reads.
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t bytes)
      : bytes_(bytes),
        at_(mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {}
  ~SharedMemory() {
    if (at_ != MAP_FAILED) munmap(at_, bytes_);
  }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  void* at() const { return at_ == MAP_FAILED ? nullptr : at_; }

 private:
  std::size_t bytes_;
  void* at_;
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
  const double pixel = cell / kPixelsPerCell;
  const Paint paint{
      svg, count(size.x()), count(size.y()), size.x() / pixel, size.y() / pixel, solid_white};
  PaintedDrawing painted{CellGrid(paint.columns, paint.rows), cell};
  const SharedMemory memory(sizeof(Shared) + painted.solid.size());
  if (memory.at() == nullptr) return refuse("cannot be painted: no memory", "try again");
  auto& shared = *new (memory.at()) Shared{};
  auto* const cells = static_cast<std::uint8_t*>(memory.at()) + sizeof(Shared);
  const pid_t child = fork();
  if (child == 0) become_painter(paint, shared, cells);
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  switch (child < 0 ? Outcome::kNone : shared.outcome) {
    case Outcome::kNoLibrary:
      return refuse("needs librsvg, which this machine does not have", "apt install librsvg2-2");
    case Outcome::kError:
      return refuse(std::string("librsvg: ") + shared.message.data(),
                    "save the drawing anew as plain SVG");
    case Outcome::kNone:
      return refuse("cannot be painted with 1 GiB and 120 s of processor time",
                    "leave out all but the walls");
    case Outcome::kPainted:
      break;
  }
  for (std::size_t i = 0; i < painted.solid.size(); ++i) painted.solid[i] = cells[i] != 0;
  return painted;
}

}  // namespace ergocast
