// SPDX-License-Identifier: BSD-3-Clause
// Writes NetCDF files in the classic format, so that tests need no library for it.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace ergocast::test {

enum class NetcdfType : std::uint32_t { kText = 2, kShort = 3, kFloat = 5, kDouble = 6 };

struct NetcdfVariable {
  std::string name;
  std::vector<std::string> dimensions;
  std::vector<double>
      values;  ///< the last dimension varies fastest; may be fewer than the dimensions ask for
  std::vector<std::pair<std::string, std::variant<std::string, double, std::vector<double>>>>
      attributes;
  NetcdfType type = NetcdfType::kDouble;
};

using NetcdfDimensions = std::vector<std::pair<std::string, std::uint32_t>>;

class NetcdfWriter {
 public:
  NetcdfWriter(const std::filesystem::path& file, const NetcdfDimensions& dimensions,
               const std::vector<NetcdfVariable>& variables) {
    // The header's length does not depend on the places of the data.
    std::uint64_t begin = header(dimensions, variables, 0).size();
    const std::string all = header(dimensions, variables, begin);
    std::ofstream out(file, std::ios::binary);
    out << all;
    for (const NetcdfVariable& variable : variables) out << data(variable);
  }

 private:
  static std::string number(std::uint64_t bits, int bytes) {
    std::string text;
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
      text += static_cast<char>(bits >> shift);
    return text;
  }
  static std::string word(std::uint64_t value) { return number(value, 4); }
  static std::string padded(std::string text) {
    text.resize((text.size() + 3) / 4 * 4);
    return text;
  }
  static std::string name(const std::string& text) { return word(text.size()) + padded(text); }

  static std::string value(double value, NetcdfType type) {
    if (type == NetcdfType::kShort)
      return number(static_cast<std::uint16_t>(static_cast<std::int16_t>(value)), 2);
    if (type == NetcdfType::kFloat)
      return word(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    return number(std::bit_cast<std::uint64_t>(value), 8);
  }
  static std::string data(const NetcdfVariable& variable) {
    std::string all;
    for (const double one : variable.values) all += value(one, variable.type);
    return padded(all);
  }
  static std::string attributes(const NetcdfVariable& variable) {
    std::string all = word(variable.attributes.empty() ? 0 : 0x0c);
    all += word(variable.attributes.size());
    for (const auto& [key, what] : variable.attributes) {
      all += name(key);
      if (const auto* text = std::get_if<std::string>(&what)) {
        all += word(static_cast<std::uint32_t>(NetcdfType::kText)) + name(*text);
      } else {
        const auto* const one = std::get_if<double>(&what);
        const auto numbers = one != nullptr ? std::vector{*one} : std::get<2>(what);
        all += word(static_cast<std::uint32_t>(NetcdfType::kDouble)) + word(numbers.size());
        for (const double number : numbers) all += value(number, NetcdfType::kDouble);
      }
    }
    return all;
  }
  static std::string header(const NetcdfDimensions& dimensions,
                            const std::vector<NetcdfVariable>& variables, std::uint64_t begin) {
    std::string all = std::string("CDF\2", 4) + word(0) + word(0x0a) + word(dimensions.size());
    for (const auto& [key, length] : dimensions) all += name(key) + word(length);
    all += word(0) + word(0) + word(0x0b) + word(variables.size());
    for (const NetcdfVariable& variable : variables) {
      const std::uint64_t bytes = data(variable).size();
      all += name(variable.name) + word(variable.dimensions.size());
      for (const std::string& wanted : variable.dimensions) {
        std::uint64_t id = 0;
        while (dimensions[id].first != wanted) ++id;
        all += word(id);
      }
      all += attributes(variable) + word(static_cast<std::uint32_t>(variable.type)) + word(bytes) +
             number(begin, 8);
      begin += bytes;
    }
    return all;
  }
};

}  // namespace ergocast::test
