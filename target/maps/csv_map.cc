// SPDX-License-Identifier: BSD-3-Clause
// Scans the file once for its shape without storing a line, then reads it again row by row.
#include "target/maps/csv_map.h"

#include <cstdio>
#include <string_view>

#include "target/maps/map_text.h"
#include "text/input_file.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlanks = " \t\r";
/// 8192 numbers of more than a hundred characters.
constexpr long long kMaxLineBytes = 1 << 20;
/// Lines of another length that are named.
constexpr std::size_t kMostRagged = 20;

std::string in_line(const fs::path& file, long long line) {
  return file.string() + ", line " + std::to_string(line);
}

/// Counts rows and columns character by character, so that no line has to fit in memory.
class Shape {
 public:
  explicit Shape(const fs::path& file) : file_(file) {
    InputFile in(file);
    constexpr int kEnd = InputFile::traits_type::eof();
    if (std::streambuf* const bytes = in.rdbuf()) {
      for (int c = bytes->sgetc(); c != kEnd && !problem_; c = bytes->snextc()) take(c);
    }
    if (!problem_) end_line();
    if (!problem_) problem_ = ragged();
    if (!problem_) problem_ = check_dimensions(file, columns_, rows_);
    if (!problem_ && columns_ > 1 && blank_ends_ == rows_)
      problem_ = MapProblem{file.string() + ": every line ends in a comma",
                            "remove it: sed 's/,[[:space:]]*$//' in.csv > out.csv"};
  }

  const std::optional<MapProblem>& problem() const { return problem_; }
  int columns() const { return static_cast<int>(columns_); }
  int rows() const { return static_cast<int>(rows_); }

 private:
  void take(int c) {
    if (c == '\n') return end_line();
    if (kBlanks.find(static_cast<char>(c)) == std::string_view::npos) {
      written_ = true;
      after_comma_ = c == ',';
    }
    if (c == ',') ++commas_;
    if (++bytes_ <= kMaxLineBytes) return;
    problem_ = MapProblem{in_line(file_, line_) + " is longer than the limit, " +
                              std::to_string(kMaxLineBytes) + " bytes",
                          "is it a table of numbers?"};
  }

  void end_line() {
    if (written_) {
      ++rows_;
      if (after_comma_) ++blank_ends_;
      if (rows_ == 1) columns_ = commas_ + 1;
      if (commas_ + 1 != columns_ && ragged_.size() < kMostRagged)
        ragged_.push_back({in_line(file_, line_) + " has " + std::to_string(commas_ + 1) +
                               " numbers, the first one has " + std::to_string(columns_),
                           "give every line as many numbers, separated by commas"});
    }
    ++line_;
    commas_ = bytes_ = 0;
    written_ = false;
  }

  std::optional<MapProblem> ragged() const {
    if (ragged_.empty()) return {};
    MapProblem first = ragged_.front();
    first.more.assign(ragged_.begin() + 1, ragged_.end());
    return first;
  }

  const fs::path& file_;
  std::optional<MapProblem> problem_;
  std::vector<MapProblem> ragged_;
  long long columns_ = 0, rows_ = 0, line_ = 1, commas_ = 0, bytes_ = 0, blank_ends_ = 0;
  bool written_ = false, after_comma_ = false;
};

class CsvMap : public MapFile {
 public:
  CsvMap(const fs::path& file, const Shape& shape) : file_(file), stream_(file) {
    columns_ = shape.columns();
    rows_ = shape.rows();
  }

  std::optional<MapProblem> next_row(std::span<double> values) override {
    std::string line;
    do {
      ++line_;
      if (next_line(stream_, line, kMaxLineBytes + 1) == LineEnd::kNone) {
        return MapProblem{file_.string() + " changed while it was read", "try again"};
      }
    } while (trimmed(line).empty());
    std::string_view rest = line;
    for (double& value : values) {
      const std::string_view cell = rest.substr(0, rest.find(','));
      rest.remove_prefix(std::min(rest.size(), cell.size() + 1));
      value = 0;
      if (trimmed(cell).empty()) continue;
      const auto read = density_in(trimmed(cell), in_line(file_, line_));
      if (!read) return read.error();
      value = *read;
    }
    return {};
  }

 private:
  fs::path file_;
  InputFile stream_;
  long long line_ = 0;
};

}  // namespace

OpenedMap open_csv_map(const fs::path& file) {
  const Shape shape(file);
  if (shape.problem()) return failure(*shape.problem());
  return std::make_unique<CsvMap>(file, shape);
}

std::string csv_text(const Eigen::MatrixXd& grid) {
  std::string text;
  for (Eigen::Index j = grid.cols(); j-- > 0;) {
    for (Eigen::Index i = 0; i < grid.rows(); ++i) {
      char number[32];
      std::snprintf(number, sizeof number, "%s%.4g", i == 0 ? "" : ",", grid(i, j));
      text += number;
    }
    text += '\n';
  }
  return text;
}

}  // namespace ergocast
