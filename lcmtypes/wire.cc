// SPDX-License-Identifier: BSD-3-Clause
// Shortens and checks texts on the wire, because they appear in logs and on terminals.
#include "lcmtypes/wire.h"

#include <algorithm>
#include <string_view>

namespace ergocast {
namespace {

/// An average of 1 in 16 bits.
/// The units of a range. 1 is a whole number of them, so that c_00 = 1 stays exact.
constexpr double units_of(std::int32_t range) { return range == 1 ? 32767 : 32766; }
static_assert(32766 % kShiftedRange == 0);

/// The first control character for terminals: C0, DEL, or C1 in UTF-8.
std::string_view find_control(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x20 || c == 0x7F) return text.substr(i, 1);
    const bool has_next = c == 0xC2 && i + 1 < text.size();
    if (has_next && (text[i + 1] & 0xE0) == 0x80) return text.substr(i, 2);
  }
  return {};
}

}  // namespace

bool plausible_text(const std::string& text) { return find_control(text).empty(); }

std::string bounded(const std::string& text, int limit) {
  auto size = static_cast<std::size_t>(limit);
  // Does not cut a UTF-8 character in two.
  while (text.size() > size && size > 0 && (text[size] & 0xC0) == 0x80) --size;
  std::string cut = text.substr(0, size);
  cut.resize(std::min(cut.find('\0'), cut.size()));
  for (auto control = find_control(cut); !control.empty(); control = find_control(cut)) {
    cut.replace(static_cast<std::size_t>(control.data() - cut.data()), control.size(), " ");
  }
  return cut;
}

/// A sum that was read with the same time is written as the same bits.
void Writer::averages(const BlockSums& sums, double time_s, std::int32_t range, std::size_t count) {
  const double most = units_of(range);
  std::byte* const at = room(count * sizeof(std::int16_t));
  const double scale = time_s > 0 ? most / (range * time_s) : 0;
  const double* const values = sums.data();
  for (std::size_t k = 0; k < count; ++k) {
    const double units = k < sums.size() ? std::clamp(values[k] * scale, -most, most) : 0;
    const auto rounded = static_cast<std::int32_t>(units + (units < 0 ? -0.5 : 0.5));
    const auto bits = __builtin_bswap16(static_cast<std::uint16_t>(rounded));
    std::memcpy(at + 2 * k, &bits, sizeof bits);
  }
}

void Reader::averages(BlockSums& sums, double time_s, std::int32_t range, std::size_t count) {
  const double most = units_of(range);
  const std::byte* const at = take(count * sizeof(std::int16_t));
  if (at == nullptr) return;
  const double unit = range * time_s / most;
  double* const values = sums.set_all(count).data();
  bool possible = true;
  for (std::size_t k = 0; k < count; ++k) {
    std::uint16_t bits;
    std::memcpy(&bits, at + 2 * k, sizeof bits);
    const auto units = static_cast<std::int16_t>(__builtin_bswap16(bits));
    possible &= std::abs(units) <= most;
    values[k] = units * unit;
  }
  holds(possible);
}

/// The length counts the final NUL.
void Writer::text(const std::string& value, int limit) {
  const std::string sent = bounded(value, limit);
  number(static_cast<std::int32_t>(sent.size()) + 1);
  std::memcpy(room(sent.size() + 1), sent.c_str(), sent.size() + 1);
}

void Reader::text(std::string& value, int limit) {
  const std::size_t length = declared(limit + 1);
  const std::byte* const at = take(length);
  complete_ = complete_ && length > 0 && at[length - 1] == std::byte{0};
  value.assign(complete_ ? reinterpret_cast<const char*>(at) : "", complete_ ? length - 1 : 0);
  holds(plausible_text(value));
}

}  // namespace ergocast
