// SPDX-License-Identifier: BSD-3-Clause
// A large map is read and transformed in much less memory than its size.
#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>

#include "target/maps/map_file.h"
#include "target/raster_integral.h"
#include "tests/support/grey_png.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

/// A line of /proc/self/status such as VmHWM, the most memory so far, in MiB.
double memory_mib(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0;
    if (word == key + ":" && status >> kib) return kib / 1024;
  }
  return 0;
}

TEST(MapMemory, IsThatOfRowsAndNotOfTheMap) {
  constexpr int kSide = 4096;
  const test::TempFolder folder;
  const auto file = folder.path() / "map_memory.png";
  test::write_png(file, kSide, kSide, {.bits = 16},
                  [](int column, int row, int) { return (column ^ row) & 1023; });
  // Resets the peak.
  if (!(std::ofstream("/proc/self/clear_refs") << 5 << std::flush)) GTEST_SKIP() << "no clear_refs";
  const double before = memory_mib("VmRSS");

  const Eigen::Vector2d size_m(100, 100);
  OpenedMap opened = open_map(file);
  MapFile& map = **opened;
  RasterIntegral integral({{{0, 0}, size_m}, kSide, kSide}, size_m, {.modes_x = 16, .modes_y = 16},
                          free_area(size_m, {}));
  std::vector<double> row(kSide);
  for (int i = 0; i < kSide; ++i) {
    ASSERT_FALSE(map.next_row(row));
    integral.add_row(kSide - 1 - i, row);
  }
  EXPECT_NEAR(integral.shares().values(0, 0), 1, 1e-12);
  // As numbers the map has 128 MiB, as pixels 32; a row of numbers and the cosines have 0.6.
  EXPECT_LT(memory_mib("VmHWM") - before, 8);
}

/// Adds a compressed text of `bytes` equal letters to a picture, before its pixels.
void add_text(const std::filesystem::path& file, std::size_t bytes, int times) {
  const auto word = [](std::uint64_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift);
    return text;
  };
  const std::string letters(bytes, 'a');
  std::string packed(compressBound(bytes), '\0');
  uLongf size = packed.size();
  ASSERT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                     reinterpret_cast<const Bytef*>(letters.data()), bytes),
            Z_OK);
  const std::string chunk = std::string("zTXtkey\0\0", 9) + packed.substr(0, size);
  const std::string whole =
      word(chunk.size() - 4) + chunk +
      word(crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size())));
  std::ifstream in(file, std::ios::binary);
  std::string picture(std::istreambuf_iterator<char>(in), {});
  constexpr std::size_t kAfterHeader = 33;
  for (int i = 0; i < times; ++i) picture.insert(kAfterHeader, whole);
  std::ofstream(file, std::ios::binary) << picture;
}

TEST(MapMemory, IsNotThatOfTextsInAPicture) {
  const test::TempFolder folder;
  const auto file = folder.path() / "texts.png";
  test::write_png(file, 4, 4, {}, [](int, int, int) { return 1; });
  add_text(file, 7'000'000, 16);
  if (!(std::ofstream("/proc/self/clear_refs") << 5 << std::flush)) GTEST_SKIP() << "no clear_refs";
  const double before = memory_mib("VmRSS");
  OpenedMap opened = open_map(file);
  MapFile& map = **opened;
  std::vector<double> row(4);
  for (int i = 0; i < 4; ++i) ASSERT_FALSE(map.next_row(row));
  EXPECT_LT(memory_mib("VmHWM") - before, 8);
}

}  // namespace
}  // namespace ergocast
