// SPDX-License-Identifier: BSD-3-Clause
// Bounds for the memory that a JSON text takes once it is parsed.
//
// A value of one byte, such as "[", takes a hundred bytes in memory. So a limit of the file's size
// does not limit the memory. The text is read twice: first its values and levels are counted, which
// takes no memory. The parser's callback could count them in one pass, but takes a time that grows
// with the square of a list's length.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ergocast {

/// Its text describes the excess: "is nested in more than 64 levels".
struct JsonTooLarge : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Counts what nlohmann::json::sax_parse() reports of a text, and stops it above a limit.
class JsonBounds {
 public:
  /// Limit (Files of a scenario): levels of nested values in any JSON file. Beyond it: the file is
  /// refused.
  static constexpr int kDeepest = 64;

  explicit JsonBounds(std::size_t most_values) : most_values_(most_values) {}

  /// The excess; empty if there is none.
  const std::string& problem() const { return problem_; }

  bool null() { return count(); }
  bool boolean(bool) { return count(); }
  bool number_integer(std::int64_t) { return count(); }
  bool number_unsigned(std::uint64_t) { return count(); }
  bool number_float(double, const std::string&) { return count(); }
  bool string(std::string&) { return count(); }
  template <class Bytes>
  bool binary(Bytes&) {
    return count();
  }
  bool key(std::string&) { return true; }
  bool start_object(std::size_t) { return open(); }
  bool start_array(std::size_t) { return open(); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  /// The parser of the text reports it.
  template <class Error>
  bool parse_error(std::size_t, const std::string&, const Error&) {
    return false;
  }

 private:
  bool count() {
    if (++values_ > most_values_)
      problem_ = "has more than " + std::to_string(most_values_) + " values";
    return problem_.empty();
  }
  bool open() {
    if (++depth_ > kDeepest)
      problem_ = "is nested in more than " + std::to_string(kDeepest) + " levels";
    return count();
  }
  bool close() {
    --depth_;
    return true;
  }

  std::size_t most_values_;
  std::size_t values_ = 0;
  int depth_ = 0;
  std::string problem_;
};

/// @throws JsonTooLarge, and what Json::parse() throws
template <class Json>
Json parse_bounded(std::string_view text, std::size_t most_values) {
  JsonBounds bounds(most_values);
  Json::sax_parse(text, &bounds);
  if (!bounds.problem().empty()) throw JsonTooLarge(bounds.problem());
  return Json::parse(text);
}

}  // namespace ergocast
