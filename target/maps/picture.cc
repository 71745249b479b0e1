// SPDX-License-Identifier: BSD-3-Clause
// Chooses the reader by the first bytes of the file.
#include "target/maps/picture.h"

#include <array>
#include <utility>

#include "target/maps/map_text.h"
#include "target/maps/png_reader.h"
#include "text/input_file.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWriteAgain = "write it again, with map_saver or as grey PGM or PNG";

class PngPicture : public Picture {
 public:
  explicit PngPicture(const fs::path& file) : file_(file), png_(file) {}

  std::optional<MapProblem> open() {
    if (auto problem = png_.open()) return problem;
    if (png_.interlaced())
      return MapProblem{file_.string() + " has interlaced rows", "save it without interlacing"};
    if (auto problem = check_dimensions(file_, png_.columns(), png_.rows())) return problem;
    columns_ = static_cast<int>(png_.columns());
    rows_ = static_cast<int>(png_.rows());
    has_alpha_ = png_.has_alpha();
    return png_.begin(PngReader::As::kWithAlpha);
  }

  std::optional<MapProblem> next_row(std::span<Pixel> pixels) override {
    if (auto problem = png_.next()) return problem;
    const std::size_t channels = png_.channels(), colours = channels - 1;
    const double most = png_.wide() ? 65535 : 255;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      double sum = 0;
      for (std::size_t colour = 0; colour < colours; ++colour)
        sum += png_.sample(i * channels + colour);
      pixels[i].shade = sum / (static_cast<double>(colours) * most);
      pixels[i].opacity = png_.sample(i * channels + colours) / most;
    }
    return {};
  }

 private:
  fs::path file_;
  PngReader png_;
};

class PgmPicture : public Picture {
 public:
  explicit PgmPicture(const fs::path& file) : file_(file), in_(file) {}

  std::optional<MapProblem> open() {
    bytes_ = in_.rdbuf();
    if (bytes_ == nullptr)
      return MapProblem{file_.string() + " is gone, though it was there", "copy it there again"};
    bytes_->sbumpc();
    binary_ = bytes_->sbumpc() == '5';
    std::array<long long, 3> header{};
    for (long long& field : header) {
      const auto number = next_number();
      if (!number) return MapProblem{here() + "its header has no whole number here", kWriteAgain};
      field = *number;
    }
    if (auto problem = check_dimensions(file_, header[0], header[1])) return problem;
    if (header[2] < 1 || header[2] > 65535)
      return MapProblem{here() + "its greatest grey value is " + std::to_string(header[2]) +
                            ", and PGM has 1 to 65535",
                        kWriteAgain};
    columns_ = static_cast<int>(header[0]);
    rows_ = static_cast<int>(header[1]);
    most_ = header[2];
    if (binary_) bytes_->sbumpc();  // one space, then the pixels
    return {};
  }

  std::optional<MapProblem> next_row(std::span<Pixel> pixels) override {
    for (Pixel& pixel : pixels) {
      const auto value = binary_ ? next_sample() : next_number();
      if (!value) return no_pixel();
      if (*value > most_)
        return MapProblem{here() + "pixel " + std::to_string(*value) +
                              " is above the greatest grey value of the header, " +
                              std::to_string(most_),
                          kWriteAgain};
      pixel = {static_cast<double>(*value) / static_cast<double>(most_), 1};
    }
    if (++read_ < rows_) return {};
    if (skip_space() == kEnd) return {};
    return MapProblem{file_.string() + " goes on after its last pixel",
                      "correct the width and height in its header, or write one map in a file"};
  }

 private:
  static constexpr int kEnd = InputFile::traits_type::eof();

  std::string here() const {
    return file_.string() + ", " +
           (binary_ ? "row " + std::to_string(read_ + 1) : "line " + std::to_string(line_)) + ": ";
  }

  MapProblem no_pixel() {
    if (skip_space() == kEnd)
      return {file_.string() + " ends in row " + std::to_string(read_ + 1) + " of " +
                  std::to_string(rows_),
              "copy or write it again: it is cut short"};
    return {here() + "a pixel is no whole number", kWriteAgain};
  }

  /// The next byte that is neither space nor in a comment; it stays.
  int skip_space() {
    int c = bytes_->sgetc();
    for (bool comment = false; c != kEnd; c = bytes_->snextc()) {
      if (c == '\n') {
        ++line_;
        comment = false;
      } else if (c == '#') {
        comment = true;
      } else if (!comment && c != ' ' && !(c >= '\t' && c <= '\r')) {
        break;
      }
    }
    return c;
  }

  /// A number of at most nine digits in text.
  std::optional<long long> next_number() {
    constexpr int kMostDigits = 9;
    long long number = 0;
    int digits = 0, c = skip_space();
    for (; c >= '0' && c <= '9' && digits < kMostDigits; c = bytes_->snextc(), ++digits)
      number = 10 * number + (c - '0');
    const bool ends = c == kEnd || c == ' ' || (c >= '\t' && c <= '\r') || c == '#';
    return digits > 0 && ends ? std::optional(number) : std::nullopt;
  }

  std::optional<long long> next_sample() {
    const int high = most_ > 255 ? bytes_->sbumpc() : 0, low = bytes_->sbumpc();
    if (high == kEnd || low == kEnd) return std::nullopt;
    return 256LL * high + low;
  }

  fs::path file_;
  InputFile in_;
  std::streambuf* bytes_ = nullptr;
  bool binary_ = false;
  long long most_ = 0;
  int read_ = 0;
  long long line_ = 1;
};

template <class Kind>
OpenedPicture opened(const fs::path& file) {
  auto picture = std::make_unique<Kind>(file);
  if (auto problem = picture->open()) return failure(*problem);
  return picture;
}

}  // namespace

OpenedPicture open_picture(const fs::path& file) {
  if (auto problem = why_unreadable(file)) return failure(*problem);
  const auto begin = [&] {
    InputFile in(file);
    std::array<char, 3> bytes{};
    in.read(bytes.data(), bytes.size());
    return std::string(bytes.data(), static_cast<std::size_t>(in.gcount()));
  }();
  if (begin.starts_with("\x89PN")) return opened<PngPicture>(file);
  const bool is_pgm = begin.starts_with("P2") || begin.starts_with("P5");
  const char after = begin.size() == 3 ? begin[2] : '\0';
  if (is_pgm && (after == ' ' || after == '#' || (after >= '\t' && after <= '\r')))
    return opened<PgmPicture>(file);
  return failure(MapProblem{file.string() + " is neither PGM (P2 or P5) nor PNG",
                            "save the picture as one of them, and name it in the map's image:"});
}

}  // namespace ergocast
