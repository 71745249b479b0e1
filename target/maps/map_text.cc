// SPDX-License-Identifier: BSD-3-Clause
// Reads a file word by word, keeps the beginning of long words, and checks that each number is a
// valid density.
#include "target/maps/map_text.h"

#include <cmath>

#include "text/read_number.h"

namespace ergocast {

std::string_view trimmed(std::string_view text) {
  constexpr const char* kAround = " \t\r";
  const std::size_t first = text.find_first_not_of(kAround);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kAround) - first + 1);
}

std::string quoted_word(std::string_view word) {
  constexpr std::size_t kMost = 40;
  std::string text;
  for (const char c : word.substr(0, kMost)) text += c >= ' ' && c <= '~' ? c : '?';
  return word.size() > kMost ? text + "..." : text;
}

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return read_number<double>(text);
}

std::optional<MapProblem> check_density(double value, const std::string& where) {
  if (value >= 0 && value <= kMaxMapValue) return {};
  const char* remedy = "write 0 where nothing is wanted or known";
  if (!std::isfinite(value)) return MapProblem{where + " is not a finite number", remedy};
  if (value < 0) return MapProblem{where + " is negative, which no density can be", remedy};
  return MapProblem{where + " is above the limit 1e30", "divide all numbers by one factor"};
}

Result<double, MapProblem> density_in(std::string_view text, const std::string& where) {
  const std::optional<double> value = number_in(text);
  if (!value && text.find(';') != text.npos) {
    return failure(MapProblem{where + ": semicolons separate the numbers",
                              "write points and commas: tr ',;' '.,' < in.csv > out.csv"});
  }
  if (!value && number_in(text.substr(0, text.find_first_of(" \t")))) {
    return failure(MapProblem{where + ": blanks or tabs separate the numbers",
                              "write commas: tr -s ' \\t' ',' < in.csv > out.csv"});
  }
  if (!value) {
    return failure(MapProblem{where + ": " + quoted_word(text) + " is not a number",
                              "write numbers only, with a point for decimals", true});
  }
  if (auto problem = check_density(*value, where + ": " + quoted_word(text))) {
    problem->ends_row = true;
    return failure(*problem);
  }
  return *value;
}

std::string_view WordReader::next() {
  constexpr std::size_t kMost = 64;
  constexpr int kEnd = InputFile::traits_type::eof();
  if (file_.rdbuf() == nullptr) return {};  // the file has been removed meanwhile
  std::streambuf& bytes = *file_.rdbuf();
  const auto is_space = [](int c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
  word_.clear();
  int c = bytes.sgetc();
  for (; is_space(c); c = bytes.snextc()) line_ += c == '\n' ? 1 : 0;
  for (; c != kEnd && !is_space(c); c = bytes.snextc()) {
    if (word_.size() < kMost) word_ += static_cast<char>(c);
  }
  return word_;
}

}  // namespace ergocast
