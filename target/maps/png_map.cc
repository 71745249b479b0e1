// SPDX-License-Identifier: BSD-3-Clause
// Reads one row after the other with libpng, and refuses pictures that are not plain grey.
#include "target/maps/png_map.h"

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <utility>
#include <vector>

#include "text/input_file.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

/// libpng reports errors by longjmp, which runs no destructors: the functions that call setjmp hold
/// only numbers and pointers.
class PngMap : public MapFile {
 public:
  explicit PngMap(const fs::path& file)
      : file_(file),
        stream_(opened(file)),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &on_error, &on_warning)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {}
  ~PngMap() override { png_destroy_read_struct(&png_, &info_, nullptr); }

  std::optional<MapProblem> open() {
    if (stream_ == nullptr || info_ == nullptr) {
      return MapProblem{file_.string() + " cannot be opened any more", "try again"};
    }
    if (!has_signature()) {
      return MapProblem{file_.string() + " is not a PNG",
                        "write it as one, or give it the ending that fits: .png, .csv or .asc"};
    }
    if (!read_header()) return damaged();
    if (auto problem = check_kind()) return problem;
    const auto columns = png_get_image_width(png_, info_), rows = png_get_image_height(png_, info_);
    if (auto problem = check_dimensions(file_, columns, rows)) return problem;
    columns_ = static_cast<int>(columns);
    rows_ = static_cast<int>(rows);
    if (!begin_rows()) return damaged();
    wide_ = png_get_bit_depth(png_, info_) == 16;
    masked_ = png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY_ALPHA;
    line_.resize(png_get_rowbytes(png_, info_));
    return {};
  }

  std::optional<MapProblem> next_row(std::span<double> values) override {
    const bool last = ++read_ == rows_;
    if (!read_line(last)) return damaged();
    const std::size_t samples = masked_ ? 2 : 1;
    const double opaque = wide_ ? 65535 : 255;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = sample(i * samples);
      if (masked_) values[i] = values[i] * sample(i * samples + 1) / opaque;
    }
    return {};
  }

 private:
  static void on_error(png_structp png, png_const_charp message) {
    auto* self = static_cast<PngMap*>(png_get_error_ptr(png));
    std::snprintf(self->error_, sizeof self->error_, "%s", message);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}
  static StdioFile opened(const fs::path& file) {
    auto opened = open_input(file);
    if (opened) return *std::move(opened);
    return {nullptr, &std::fclose};
  }

  bool has_signature() {
    png_byte bytes[8];
    const bool read = std::fread(bytes, 1, sizeof bytes, stream_.get()) == sizeof bytes;
    return read && png_sig_cmp(bytes, 0, sizeof bytes) == 0;
  }

  // libpng reports errors by a jump. NOLINTBEGIN(cert-err52-cpp)
  bool read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_init_io(png_, stream_.get());
    // Texts and profiles are skipped: each may unpack to megabytes, and we need none. All chunks
    // but those that the pixels need are meant.
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_sig_bytes(png_, 8);
    png_read_info(png_, info_);
    return true;
  }

  bool begin_rows() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    // A transparent grey value becomes an ordinary alpha channel.
    png_set_tRNS_to_alpha(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  bool read_line(bool last) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_row(png_, line_.data(), nullptr);
    if (last) png_read_end(png_, nullptr);
    return true;
  }
  // NOLINTEND(cert-err52-cpp)

  MapProblem damaged() const {
    return {file_.string() + " is damaged or cut short: " + error_, "write it again"};
  }

  std::optional<MapProblem> check_kind() const {
    const int color = png_get_color_type(png_, info_), bits = png_get_bit_depth(png_, info_);
    std::string what;
    if (color == PNG_COLOR_TYPE_PALETTE) {
      what = " has a palette of colours";
    } else if ((color & PNG_COLOR_MASK_COLOR) != 0) {
      what = " has colours";
    } else if (bits < 8) {
      what = " has " + std::to_string(bits) + " bits a pixel";
    } else if (png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE) {
      what = " is interlaced";
    } else {
      return {};
    }
    return MapProblem{file_.string() + what,
                      "save it in grey of 8 or 16 bits, not interlaced, with or without alpha"};
  }

  /// PNG stores the high byte first.
  double sample(std::size_t i) const {
    return wide_ ? 256.0 * line_[2 * i] + line_[2 * i + 1] : line_[i];
  }

  fs::path file_;
  StdioFile stream_;
  png_structp png_;
  png_infop info_;
  std::vector<png_byte> line_;
  bool wide_ = false, masked_ = false;
  int read_ = 0;
  char error_[128] = "";
};

}  // namespace

OpenedMap open_png_map(const fs::path& file) {
  auto map = std::make_unique<PngMap>(file);
  if (auto problem = map->open()) return failure(*problem);
  return map;
}

}  // namespace ergocast
