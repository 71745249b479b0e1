// SPDX-License-Identifier: BSD-3-Clause
// Formats numbers with few digits, narrow spaces and real minus signs, and escapes the
// characters of XML.
#include "report/markup.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace ergocast {
namespace {

constexpr const char* kMinus = "−";
constexpr const char* kNarrowSpace = "\u202f";

std::string plain_fixed(double value, int decimals) {
  char text[400];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals);
  return {text, end.ptr};
}

void trim_zeros(std::string& digits) {
  if (digits.find('.') == std::string::npos) return;
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
}

/// Groups of three digits before the point from 10 000 on, and a real minus sign.
std::string typeset(std::string digits) {
  const bool negative = digits.front() == '-';
  if (negative) digits.erase(0, 1);
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  if (whole >= 5) {
    for (std::size_t i = whole - 3; i > 0 && i<whole; i = i> 3 ? i - 3 : 0) {
      digits.insert(i, kNarrowSpace);
    }
  }
  return negative && digits != "0" ? kMinus + digits : digits;
}

std::string superscript(int number) {
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = number < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(number))) text += kDigits[digit - '0'];
  return text;
}

int decade_of(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

}  // namespace

std::string escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n') {
          out += "\ufffd";
        } else {
          out += c;
        }
    }
  }
  return out;
}

std::string readable(double value) {
  if (!std::isfinite(value)) return "–";
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (size < 1e15 && value == std::round(value)) return typeset(plain_fixed(value, 0));
  int decade = decade_of(value);
  if (decade >= -3 && decade < 6) {
    std::string digits = plain_fixed(value, std::max(0, 2 - decade));
    trim_zeros(digits);
    return typeset(digits);
  }
  std::string mantissa = plain_fixed(value / std::pow(10, decade), 2);
  if (mantissa == "10.00" || mantissa == "-10.00") {
    mantissa.erase(mantissa.find('0'), 1);
    ++decade;
  }
  trim_zeros(mantissa);
  return typeset(mantissa) + " × 10" + superscript(decade);
}

}  // namespace ergocast
