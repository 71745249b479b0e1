// SPDX-License-Identifier: BSD-3-Clause
// Reads one row after the other, so that a large picture needs the memory of one row.
#include "target/maps/png_reader.h"

#include <csetjmp>
#include <cstdio>
#include <utility>

namespace ergocast {
namespace {

StdioFile opened(const std::filesystem::path& file) {
  auto opened = open_input(file);
  if (opened) return *std::move(opened);
  return {nullptr, &std::fclose};
}

}  // namespace

PngReader::PngReader(const std::filesystem::path& file)
    : file_(file),
      stream_(opened(file)),
      png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &on_error, &on_warning)),
      info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {}

PngReader::~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

std::optional<MapProblem> PngReader::open() {
  if (stream_ == nullptr || info_ == nullptr) {
    return MapProblem{file_.string() + " cannot be opened any more", "try again"};
  }
  if (!has_signature()) {
    return MapProblem{file_.string() + " is not a PNG",
                      "write it as one, or give it the ending that fits: .png, .csv or .asc"};
  }
  if (!read_header()) return damaged();
  return {};
}

bool PngReader::has_alpha() const {
  return (color_type() & PNG_COLOR_MASK_ALPHA) != 0 ||
         png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
}

std::optional<MapProblem> PngReader::begin(As as) {
  if (!begin_rows(as)) return damaged();
  wide_ = bit_depth() == 16;
  channels_ = png_get_channels(png_, info_);
  line_.resize(png_get_rowbytes(png_, info_));
  return {};
}

std::optional<MapProblem> PngReader::next() {
  const bool last = ++read_ == rows();
  if (!read_line(last)) return damaged();
  return {};
}

void PngReader::on_error(png_structp png, png_const_charp message) {
  auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
  std::snprintf(self->error_, sizeof self->error_, "%s", message);
  png_longjmp(png, 1);
}

bool PngReader::has_signature() {
  png_byte bytes[8];
  const bool read = std::fread(bytes, 1, sizeof bytes, stream_.get()) == sizeof bytes;
  return read && png_sig_cmp(bytes, 0, sizeof bytes) == 0;
}

// libpng reports errors by a jump. NOLINTBEGIN(cert-err52-cpp)
bool PngReader::read_header() {
  if (setjmp(png_jmpbuf(png_)) != 0) return false;
  png_init_io(png_, stream_.get());
  // Texts and profiles are skipped: each may unpack to megabytes, and we need none. All chunks
  // but those that the pixels need are meant.
  png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_set_sig_bytes(png_, 8);
  png_read_info(png_, info_);
  return true;
}

bool PngReader::begin_rows(As as) {
  if (setjmp(png_jmpbuf(png_)) != 0) return false;
  if (as == As::kStored) {
    png_set_tRNS_to_alpha(png_);
  } else {
    png_set_expand(png_);
    if (!has_alpha()) png_set_add_alpha(png_, 0xffff, PNG_FILLER_AFTER);
  }
  png_read_update_info(png_, info_);
  return true;
}

bool PngReader::read_line(bool last) {
  if (setjmp(png_jmpbuf(png_)) != 0) return false;
  png_read_row(png_, line_.data(), nullptr);
  if (last) png_read_end(png_, nullptr);
  return true;
}
// NOLINTEND(cert-err52-cpp)

MapProblem PngReader::damaged() const {
  return {file_.string() + " is damaged or cut short: " + error_, "write it again"};
}

}  // namespace ergocast
