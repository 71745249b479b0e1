// SPDX-License-Identifier: BSD-3-Clause
// Bounds for the memory that a JSON text takes once it is parsed.
//
// A value of one byte, such as "[", takes a hundred bytes in memory. So a limit of the file's size
// is none of the memory. This counts values and levels while a parser makes them.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace ergocast {

/// Its text tells what there is too much of: "is nested in more than 64 levels".
struct JsonTooLarge : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A callback for nlohmann::json::parse(), which throws JsonTooLarge.
class JsonBounds {
 public:
  static constexpr int kDeepest = 64;

  explicit JsonBounds(std::size_t most_values) : most_values_(most_values) {}

  template <class Event, class Json>
  bool operator()(int depth, Event, Json&) {
    if (depth > kDeepest)
      throw JsonTooLarge("is nested in more than " + std::to_string(kDeepest) + " levels");
    // The end of a list or an object comes here, too.
    if (++events_ > 2 * most_values_)
      throw JsonTooLarge("has more than " + std::to_string(most_values_) + " values");
    return true;
  }

 private:
  std::size_t most_values_;
  std::size_t events_ = 0;
};

}  // namespace ergocast
