// Ratios with their confidence, and the files they come from.
#include "studies/statistics.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/noise.h"
#include "studies/table.h"

namespace ergocast::studies {
namespace {

/// Numbers whose logarithms are normal about log(center) with deviation `spread`.
std::vector<double> scattered(std::uint32_t stream, std::size_t count, double center, double spread) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(center * std::exp(spread * normal_pair(7, Purpose::kFault, stream, i).x()));
  }
  return values;
}

TEST(RatioOf, EqualPairsIsOneWithoutDoubt) {
  const std::vector<double> values = scattered(1, 50, 2, 0.5);
  const Ratio ratio = ratio_of(values, values);
  EXPECT_EQ(ratio.value, 1);
  EXPECT_EQ(ratio.low, 1);
  EXPECT_EQ(ratio.high, 1);
}

TEST(RatioOf, HasTheIntervalOfTheStandardError) {
  constexpr std::size_t kPairs = 2000;
  const Ratio ratio = ratio_of(scattered(1, kPairs, 3, 0.5), scattered(2, kPairs, 2, 0.5));
  const double half = 1.96 * 0.5 * std::sqrt(2.0 / kPairs);
  EXPECT_NEAR(std::log(ratio.value), std::log(1.5), 3 * half);
  EXPECT_NEAR(std::log(ratio.high / ratio.value), half, 0.15 * half);
  EXPECT_NEAR(std::log(ratio.value / ratio.low), half, 0.15 * half);
}

TEST(RatioOf, IsTheSameForTheSameSeed) {
  const auto a = scattered(1, 101, 3, 0.5), b = scattered(2, 101, 2, 0.5);
  EXPECT_EQ(ratio_of(a, b, 5).low, ratio_of(a, b, 5).low);
  EXPECT_NE(ratio_of(a, b, 5).low, ratio_of(a, b, 6).low);
}

TEST(MedianOf, IsTheMiddle) {
  EXPECT_EQ(median_of({}), 0);
  EXPECT_EQ(median_of({5, 1, 9}), 5);
}

class TableFile : public ::testing::Test {
 protected:
  std::string problem(const std::string& text) {
    std::ofstream(file_) << text;
    try {
      read_table(file_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  ~TableFile() override { std::filesystem::remove(file_); }
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("table-" + std::to_string(::getpid()) + ".csv");
};

TEST_F(TableFile, GivesNumbersByColumn) {
  EXPECT_EQ(problem("seed,result,ergodic_metric\n1,fine,0.25\n2,fine,0.5\n"), "");
  EXPECT_EQ(read_table(file_).at("ergodic_metric"), (std::vector<double>{0.25, 0.5}));
}

TEST_F(TableFile, NamesWhatIsWrong) {
  EXPECT_NE(problem("seed,result\n1,fine\n2,violated\n").find("seed 2 violated"), std::string::npos);
  EXPECT_NE(problem("seed,result\n1\n").find("torn row"), std::string::npos);
  EXPECT_NE(problem("seed,result\n").find("no rows"), std::string::npos);
  EXPECT_NE(problem("").find("cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace ergocast::studies
