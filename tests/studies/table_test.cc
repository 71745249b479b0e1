// The files that figures are drawn from.
#include "studies/table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

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
  ~TableFile() override { std::filesystem::remove(file_); }
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("table-" + std::to_string(::getpid()) + ".csv");
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

}  // namespace
}  // namespace ergocast::studies
