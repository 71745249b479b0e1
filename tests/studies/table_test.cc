// SPDX-License-Identifier: BSD-3-Clause
// The files from which figures are drawn.
#include "studies/table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "tests/support/temp_folder.h"

namespace ergocast::studies {
namespace {

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
  const test::TempFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "table.csv";
};

TEST_F(TableFile, GivesNumbersByColumn) {
  EXPECT_EQ(problem("seed,result,ergodic_metric\n1,fine,0.25\n2,fine,0.5\n"), "");
  EXPECT_EQ(read_table(file_).at("ergodic_metric"), (std::vector<double>{0.25, 0.5}));
}

TEST_F(TableFile, NamesWhatIsWrong) {
  EXPECT_NE(problem("seed,result\n1,fine\n2,violated\n").find("seed 2 violated"),
            std::string::npos);
  EXPECT_NE(problem("seed,result\n1\n").find("torn row"), std::string::npos);
  EXPECT_NE(problem("seed,result\n").find("no rows"), std::string::npos);
  EXPECT_NE(problem("").find("cannot be read"), std::string::npos);
}

TEST_F(TableFile, GivesAStudyPointByPoint) {
  std::ofstream(file_)
      << "scenario,law.epsilon,seed,ergodic_metric,escape_time_0_s,escape_time_1_s\n"
         "corners,0.1,1,0.5,3,inf\ncorners,0.1,2,0.25,2,\nrandom,0.1,1,0.125,,\n";
  const std::vector<StudyRuns> points = read_study(file_);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].names, (std::vector<std::string>{"corners", "0.1"}));
  EXPECT_EQ(points[0].of("ergodic_metric"), (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(points[0].escape_times_s(),
            (std::vector<double>{2, 3, std::numeric_limits<double>::infinity()}));
  EXPECT_TRUE(points[1].escape_times_s().empty());
}

TEST_F(TableFile, ThatIsNoStudyIsNamed) {
  std::ofstream(file_) << "a,b\n1,2\n";
  EXPECT_THROW(read_study(file_), std::runtime_error);
}

}  // namespace
}  // namespace ergocast::studies
