// SPDX-License-Identifier: BSD-3-Clause
// The content of maps is read exactly, and a file that cannot be a map is refused with a remedy.
#include "target/maps/map_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "target/maps/csv_map.h"
#include "tests/support/grey_png.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;
namespace fs = std::filesystem;
using Rows = std::vector<std::vector<double>>;

class Maps : public ::testing::Test {
 protected:
  fs::path written(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// All rows, or the problem that ended the reading.
  Result<Rows, MapProblem> read(const fs::path& file) {
    OpenedMap opened = open_map(file);
    if (!opened) return failure(opened.error());
    MapFile& map = **opened;
    extent_ = map.extent();
    Rows rows;
    for (int i = 0; i < map.rows(); ++i) {
      std::vector<double> row(static_cast<std::size_t>(map.columns()));
      if (const auto problem = map.next_row(row)) return failure(*problem);
      rows.push_back(row);
    }
    return rows;
  }
  Rows rows_of(const fs::path& file) {
    const auto result = read(file);
    if (result) return *result;
    ADD_FAILURE() << result.error().what;
    return {};
  }
  /// The problem of `file`; empty if there is none.
  std::string problem_of(const fs::path& file) {
    const auto result = read(file);
    if (result) return "";
    const MapProblem& problem = result.error();
    EXPECT_FALSE(problem.remedy.empty());
    EXPECT_TRUE(problem.what.starts_with(file.string())) << problem.what;
    return problem.what.substr(file.string().size()) + " (" + problem.remedy + ")";
  }
  void expect_said(const fs::path& file, const std::string& part) {
    const std::string printed = problem_of(file);
    EXPECT_NE(printed.find(part), std::string::npos) << "no \"" << part << "\" in: " << printed;
  }

  const TempFolder own_;
  const fs::path& folder_ = own_.path();
  std::optional<Rectangle> extent_;
};

int count_up(int column, int row, int) { return 10 * row + column; }

// ---- PNG ----

TEST_F(Maps, PngOfEightBitsHoldsItsNumbersFromTheTop) {
  write_png(folder_ / "a.png", 3, 2, {}, count_up);
  EXPECT_EQ(rows_of(folder_ / "a.png"), (Rows{{0, 1, 2}, {10, 11, 12}}));
  EXPECT_FALSE(extent_);
}

TEST_F(Maps, PngOfSixteenBitsKeepsAllOfThem) {
  const auto wide = [](int column, int row, int) { return 1 + 257 * column + 30000 * row; };
  write_png(folder_ / "a.PNG", 3, 2, {.bits = 16}, wide);
  EXPECT_EQ(rows_of(folder_ / "a.PNG"), (Rows{{1, 258, 515}, {30001, 30258, 30515}}));
}

TEST_F(Maps, PngsAlphaMasks) {
  for (const int bits : {8, 16}) {
    const int opaque = (1 << bits) - 1;
    const auto masked = [&](int column, int row, int channel) {
      if (channel == 0) return 100 + column + row;
      return column == 0 ? 0 : column == 1 ? opaque : opaque / 5;
    };
    write_png(folder_ / "a.png", 3, 2, {.bits = bits, .color = PNG_COLOR_TYPE_GRAY_ALPHA}, masked);
    EXPECT_EQ(rows_of(folder_ / "a.png"), (Rows{{0, 101, 102 / 5.0}, {0, 102, 103 / 5.0}})) << bits;
  }
}

TEST_F(Maps, PngOfAnotherKindIsRefused) {
  const fs::path file = folder_ / "a.png";
  write_png(file, 4, 4, {.color = PNG_COLOR_TYPE_RGB}, count_up);
  expect_said(file, " has colours (save it in grey of 8 or 16 bits");
  write_png(file, 4, 4, {.color = PNG_COLOR_TYPE_RGB_ALPHA}, count_up);
  expect_said(file, " has colours");
  write_png(file, 4, 4, {.color = PNG_COLOR_TYPE_PALETTE}, [](int, int, int) { return 1; });
  expect_said(file, " has a palette of colours");
  write_png(file, 4, 4, {.bits = 1}, count_up);
  expect_said(file, " has 1 bits a pixel");
  write_png(file, 4, 4, {.interlace = PNG_INTERLACE_ADAM7}, count_up);
  expect_said(file, " is interlaced");
}

TEST_F(Maps, PngThatIsTooLargeIsRefusedByItsHeader) {
  write_png(folder_ / "wide.png", 100000, 1, {}, count_up);
  expect_said(
      folder_ / "wide.png",
      " has 100000 columns and 1 rows; the limits are 1 and 8192 (scale it to at most 8192");
  write_png(folder_ / "high.png", 1, 8193, {}, count_up);
  expect_said(folder_ / "high.png", " has 1 columns and 8193 rows");
  write_png(folder_ / "largest.png", 8192, 1, {}, count_up);
  EXPECT_EQ(problem_of(folder_ / "largest.png"), "");
}

TEST_F(Maps, PngCutShortOrChangedAnywhereIsRefused) {
  write_png(folder_ / "whole.png", 20, 20, {}, count_up);
  std::ifstream stream(folder_ / "whole.png", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  ASSERT_EQ(problem_of(folder_ / "whole.png"), "");
  for (std::size_t length = 8; length < bytes.size() - 12; ++length) {  // the last chunk is empty
    expect_said(written("cut.png", bytes.substr(0, length)), " is damaged or cut short: ");
  }
  for (std::size_t at = 8; at < bytes.size() - 12; ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    EXPECT_NE(problem_of(written("changed.png", changed)), "") << at;
  }
  expect_said(written("not.png", "P5 3 2 255 abcdef"), " is not a PNG");
  expect_said(written("short.png", "abc"), " is not a PNG");
}

// ---- CSV ----

TEST_F(Maps, CsvIsReadLineByLine) {
  EXPECT_EQ(rows_of(written("a.csv", "0,1.5,+2e3\n 3 ,\t4,5\r\n")),
            (Rows{{0, 1.5, 2000}, {3, 4, 5}}));
  EXPECT_EQ(rows_of(written("a.csv", "1,2\n\n3,4")), (Rows{{1, 2}, {3, 4}}));
  EXPECT_EQ(rows_of(written("a.csv", "1,,3\n,5,\n")), (Rows{{1, 0, 3}, {0, 5, 0}}));
  EXPECT_EQ(rows_of(written("a.csv", "7")), (Rows{{7}}));
}

TEST_F(Maps, CsvThatIsNoneIsRefusedWithItsLine) {
  expect_said(written("a.csv", "1,2\n\n3,4,5\n"), ", line 3 has 3 numbers, the first one has 2");
  expect_said(written("a.csv", "1,2\n3\n"), ", line 2 has 1 numbers");
  expect_said(written("a.csv", "1,2\n3,-4\n"), ", line 2: -4 is negative");
  expect_said(written("a.csv", "1,nan\n"), ", line 1: nan is not a finite number");
  expect_said(written("a.csv", "inf\n"), ", line 1: inf is not a finite number");
  expect_said(written("a.csv", "1,2e30\n"), ", line 1: 2e30 is above the limit 1e30");
  expect_said(written("a.csv", "1,1e999\n"), ", line 1: 1e999 is not a number");
  expect_said(written("a.csv", "x,y\n1,2\n"), ", line 1: x is not a number (write numbers only");
  expect_said(written("a.csv", "1;2\n"), ", line 1: semicolons separate the numbers");
  expect_said(written("a.csv", ""), " is empty");
  expect_said(written("a.csv", "\n \n"), " has 0 columns and 0 rows");
  expect_said(written("a.csv", std::string(99999, ',')), " has 100000 columns and 1 rows");
  expect_said(written("a.csv", std::string(2 << 20, '1')), ", line 1 is longer than the limit");
}

TEST_F(Maps, CsvOfAGridReadsBackFromTheNorth) {
  Eigen::MatrixXd grid(2, 3);
  grid << 1, 2, 3, 4, 5, 6.25;
  EXPECT_EQ(csv_text(grid), "3,6.25\n2,5\n1,4\n");
}

// ---- ESRI ASCII grid ----

const std::string kHeader = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner -50\ncellsize 10\n";

TEST_F(Maps, AsciiGridStatesItsExtent) {
  EXPECT_EQ(rows_of(written("a.asc", kHeader + "1 2 3\n4 5 6\n")), (Rows{{1, 2, 3}, {4, 5, 6}}));
  ASSERT_TRUE(extent_);
  EXPECT_EQ(extent_->origin_m, Eigen::Vector2d(100, -50));
  EXPECT_EQ(extent_->size_m, Eigen::Vector2d(30, 20));
}

TEST_F(Maps, AsciiGridsCentreIsHalfACellInside) {
  EXPECT_EQ(
      rows_of(written("a.asc", "NCOLS 1\nNROWS 1\nXLLCENTER 105\nYLLCENTER -45\nCELLSIZE 10\n7")),
      (Rows{{7}}));
  EXPECT_EQ(extent_->origin_m, Eigen::Vector2d(100, -50));
}

TEST_F(Maps, AsciiGridsMissingDataAreZeroAndItsLineBreaksMeanNothing) {
  EXPECT_EQ(rows_of(written("a.asc", kHeader + "NODATA_value -1\n1 -1 3 4\n5\n-1.0")),
            (Rows{{1, 0, 3}, {4, 5, 0}}));
  EXPECT_EQ(rows_of(written("a.asc", kHeader + "-9999 2 3\r\n4 5 6\r\n")),
            (Rows{{0, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(rows_of(written("a.asc", kHeader + "NODATA_value nan\n1 nan 3 4 5 6")),
            (Rows{{1, 0, 3}, {4, 5, 6}}));
}

TEST_F(Maps, AsciiGridThatIsNoneIsRefused) {
  expect_said(written("a.asc", kHeader + "1 2 3\n4 5\n"),
              " ends before its last cell: 2 rows of 3");
  expect_said(written("a.asc", kHeader + "1 2 3\n4 5 6\n7\n"), " has more numbers than ncols");
  expect_said(written("a.asc", kHeader + "1 2 3\n4 -5 6\n"), ", line 7: -5 is negative");
  expect_said(written("a.asc", kHeader + "1 2 3\n4 x 6\n"), ", line 7: x is not a number");
  expect_said(written("a.asc", kHeader + "NODATA_value -1\n1 nan 3\n4 5 6\n"),
              "nan is not a finite");
  expect_said(written("a.asc", "ncols 3\nnrows 2\ncellsize 1\n1"),
              ": its header lacks xllcorner or xll");
  expect_said(written("a.asc", "1 2 3"), ": its header lacks ncols");
  expect_said(written("a.asc", kHeader + "xllcenter 4\n"),
              ": its header lacks xllcorner or xllcenter");
  expect_said(written("a.asc", kHeader + "ncols 3\n"), ", line 6: ncols is there twice");
  expect_said(written("a.asc", "ncols x\n"), ", line 1: ncols has no number");
  expect_said(written("a.asc", "ncols 3\nrows 2\n"), ", line 2: no key of an ESRI ASCII grid");
  expect_said(written("a.asc", "ncols 100000\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n"),
              " has 100000 columns and 1 rows");
  expect_said(written("a.asc", "ncols 1.5\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1"),
              ": ncols and nrows are not whole numbers");
  for (const char* cell : {"0", "-1", "nan", "inf"}) {
    expect_said(written("a.asc", "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize " +
                                     std::string(cell) + "\n1"),
                ": its header gives no extent");
  }
  expect_said(written("a.asc", "\x89PNG\r\n\x1a\n"), " is a PNG picture");
}

// ---- any ----

TEST_F(Maps, ThatAreNoFilesAreNamed) {
  expect_said(folder_ / "none.csv", ": there is no such file");
  fs::create_directories(folder_ / "folder.png");
  expect_said(folder_ / "folder.png", " is a folder, not a file");
  for (const char* name : {"a.png", "a.asc"}) expect_said(written(name, ""), " is empty");
  EXPECT_EQ(map_kind("a.Asc"), MapKind::kAsciiGrid);
  EXPECT_EQ(map_kind("a.TIFF"), MapKind::kGeoTiff);
  EXPECT_FALSE(map_kind("a.bmp"));
  EXPECT_FALSE(map_kind("png"));
}

}  // namespace
}  // namespace ergocast
