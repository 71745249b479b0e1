// SPDX-License-Identifier: BSD-3-Clause
// Refuses pictures that are not plain grey.
#include "target/maps/png_map.h"

#include "target/maps/png_reader.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

class PngMap : public MapFile {
 public:
  explicit PngMap(const fs::path& file) : file_(file), png_(file) {}

  std::optional<MapProblem> open() {
    if (auto problem = png_.open()) return problem;
    if (auto problem = check_kind()) return problem;
    if (auto problem = check_dimensions(file_, png_.columns(), png_.rows())) return problem;
    columns_ = static_cast<int>(png_.columns());
    rows_ = static_cast<int>(png_.rows());
    return png_.begin(PngReader::As::kStored);
  }

  std::optional<MapProblem> next_row(std::span<double> values) override {
    if (auto problem = png_.next()) return problem;
    const bool masked = png_.channels() == 2;
    const double opaque = png_.wide() ? 65535 : 255;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = png_.sample(i * png_.channels());
      if (masked) values[i] = values[i] * png_.sample(i * 2 + 1) / opaque;
    }
    return {};
  }

 private:
  std::optional<MapProblem> check_kind() const {
    const int color = png_.color_type(), bits = png_.bit_depth();
    std::string what;
    if (color == PNG_COLOR_TYPE_PALETTE) {
      what = " has a palette of colours";
    } else if ((color & PNG_COLOR_MASK_COLOR) != 0) {
      what = " has colours";
    } else if (bits < 8) {
      what = " has " + std::to_string(bits) + " bits a pixel";
    } else if (png_.interlaced()) {
      what = " is interlaced";
    } else {
      return {};
    }
    return MapProblem{file_.string() + what,
                      "save it in grey of 8 or 16 bits, not interlaced, with or without alpha"};
  }

  fs::path file_;
  PngReader png_;
};

}  // namespace

OpenedMap open_png_map(const fs::path& file) {
  auto map = std::make_unique<PngMap>(file);
  if (auto problem = map->open()) return failure(*problem);
  return map;
}

}  // namespace ergocast
