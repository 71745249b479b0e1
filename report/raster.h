// SPDX-License-Identifier: BSD-3-Clause
// Draws fields of numbers as small pictures: colour scales and a PNG in a data URI.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>

namespace ergocast {

struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// Colours for 0 (first) to 1 (last). Each scale becomes steadily lighter or darker, so that it is
/// also readable in grey and with any colour vision.
using ColorScale = std::array<Rgb, 256>;
const ColorScale& viridis();  ///< dark violet to yellow
const ColorScale& pencil();   ///< white to a middle grey, behind coloured lines

/// One value a cell: row i along x, column j along y, both upwards from the domain's origin.
using Field = Eigen::MatrixXd;

/// "data:image/png;base64,…" of `field`, drawn with y upwards; 0 is the first colour, 1 the last.
/// Values outside are clamped, and NaN counts as 0.
std::string png_data_uri(const Field& field, const ColorScale& colors);

}  // namespace ergocast
