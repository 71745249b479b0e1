// SPDX-License-Identifier: BSD-3-Clause
// LCM's encoding: big-endian numbers, strings with their length and a final NUL, arrays after their
// lengths. A Writer appends fields; a Reader reads them in turn from untrusted bytes.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/block_sums.h"
#include "core/base/require.h"
#include "lcmtypes/message_authenticator.h"

namespace ergocast {

/// More messages, ticks or events of any kind than a run can have; sums of a few do not overflow.
inline constexpr std::int64_t kMostEver = std::int64_t{1} << 48;

/// The unsigned number of the same size, most significant byte first on the wire.
template <class Number>
using Bits =
    std::conditional_t<sizeof(Number) == 8, std::uint64_t,
                       std::conditional_t<sizeof(Number) == 4, std::uint32_t, std::uint16_t>>;

inline std::uint64_t swapped(std::uint64_t bits) { return __builtin_bswap64(bits); }
inline std::uint32_t swapped(std::uint32_t bits) { return __builtin_bswap32(bits); }
inline std::uint16_t swapped(std::uint16_t bits) { return __builtin_bswap16(bits); }

/// `text` as it is sent: at most `limit` characters, ending before a NUL, with a space in place of
/// each control character for terminals. Readers refuse other texts.
std::string bounded(const std::string& text, int limit);
/// Whether `text` has no control character for terminals.
bool plausible_text(const std::string& text);

class Writer {
 public:
  /// @param out  grows to the longest datagram; size() is the written part
  explicit Writer(std::vector<std::byte>& out) : out_(out) { out_.resize(kMaxDatagramBytes); }

  std::size_t size() const { return at_; }

  template <class Number>
  void number(Number value) {
    const auto bits = swapped(std::bit_cast<Bits<Number>>(value));
    std::memcpy(room(sizeof bits), &bits, sizeof bits);
  }
  void numbers(std::span<const double> values) {
    std::byte* const at = room(values.size_bytes());
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::uint64_t bits = swapped(std::bit_cast<std::uint64_t>(values[k]));
      std::memcpy(at + 8 * k, &bits, sizeof bits);
    }
  }
  /// @pre values.size() == count
  void sums(const BlockSums& values, std::size_t count) {
    ERGOCAST_REQUIRE(values.size() == count);
    numbers({values.data(), count});
  }
  /// Sums over `time_s` as averages of 16 bits each, which are parts of `range`.
  void averages(const BlockSums& sums, double time_s, std::int32_t range, std::size_t count);
  void each_number(std::span<const std::uint16_t> values) {
    for (const std::uint16_t value : values) number(value);
  }
  void count(std::int64_t value) { number(value); }
  void counts(std::span<const std::int64_t> values) {
    for (const std::int64_t value : values) count(value);
  }
  /// For counts that other processes can increase: a jump in a sender's numbering counts as losses.
  void capped_count(std::int64_t value) { number(std::min(value, kMostEver)); }
  void count_or_none(std::int64_t value) { number(value); }
  void finite(double value) { number(value); }
  void quantity(double value) { number(value); }
  void within(std::int32_t value, std::int32_t, std::int32_t) { number(value); }
  /// Between 0 and a limit of at most 127, in one byte.
  void small(std::int32_t value, std::int32_t) { *room(1) = static_cast<std::byte>(value); }
  void vector(const Eigen::Vector3d& value) { numbers({value.data(), 3}); }
  void flag(bool value) { *room(1) = static_cast<std::byte>(value); }
  template <class Enum>
  void enumerator(Enum value, Enum) {
    *room(1) = static_cast<std::byte>(value);
  }
  void bytes(std::span<const std::byte> value) {
    if (!value.empty()) std::memcpy(room(value.size()), value.data(), value.size());
  }
  void text(const std::string& value, int limit);
  void room_for_tag() { std::memset(room(kTagBytes), 0, kTagBytes); }
  void holds(bool) {}

  template <class Element>
  void length(const std::vector<Element>& elements, int limit) {
    ERGOCAST_REQUIRE(elements.size() <= static_cast<std::size_t>(limit));
    number(static_cast<std::int32_t>(elements.size()));
  }
  template <class Element, std::size_t kLimit>
  std::span<const Element> length(const std::array<Element, kLimit>& elements, std::int32_t count) {
    ERGOCAST_REQUIRE(count >= 0 && static_cast<std::size_t>(count) <= kLimit);
    number(count);
    return std::span(elements).first(static_cast<std::size_t>(count));
  }

 private:
  std::byte* room(std::size_t count) {
    ERGOCAST_REQUIRE(count <= kMaxDatagramBytes - at_);
    at_ += count;
    return out_.data() + at_ - count;
  }

  std::vector<std::byte>& out_;
  std::size_t at_ = 0;
};

/// Missing fields are read as 0. A length beyond its limit becomes 0.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  /// Whether all fields were present, with no bytes after the last.
  bool complete() const { return complete_ && bytes_.empty(); }
  /// Whether all values read are possible.
  bool plausible() const { return plausible_; }

  template <class Number>
  void number(Number& value) {
    Bits<Number> bits = 0;
    if (const std::byte* at = take(sizeof bits)) std::memcpy(&bits, at, sizeof bits);
    value = std::bit_cast<Number>(swapped(bits));
  }
  void numbers(std::span<double> values) {
    const std::byte* const at = take(values.size_bytes());
    if (at == nullptr) return;
    for (std::size_t k = 0; k < values.size(); ++k) {
      std::uint64_t bits;
      std::memcpy(&bits, at + 8 * k, sizeof bits);
      values[k] = std::bit_cast<double>(swapped(bits));
    }
  }
  void each_number(std::span<std::uint16_t> values) {
    for (std::uint16_t& value : values) number(value);
  }
  void sums(BlockSums& values, std::size_t count) { numbers(values.set_all(count)); }
  void averages(BlockSums& sums, double time_s, std::int32_t range, std::size_t count);
  void count(std::int64_t& value) { number(value), holds(value >= 0 && value <= kMostEver); }
  void counts(std::span<std::int64_t> values) {
    for (std::int64_t& value : values) count(value);
  }
  void capped_count(std::int64_t& value) { count(value); }
  void count_or_none(std::int64_t& value) {
    number(value), holds(value >= -1 && value <= kMostEver);
  }
  void finite(double& value) { number(value), holds(std::isfinite(value)); }
  void quantity(double& value) { number(value), holds(std::isfinite(value) && value >= 0); }
  void within(std::int32_t& value, std::int32_t least, std::int32_t most) {
    number(value), holds(value >= least && value <= most);
  }
  void small(std::int32_t& value, std::int32_t most) {
    value = std::to_integer<std::int32_t>(byte());
    holds(value >= 0 && value <= most);
  }
  void vector(Eigen::Vector3d& value) {
    numbers({value.data(), 3});
    holds(value.allFinite());
  }
  void flag(bool& value) { value = byte() != std::byte{0}; }
  template <class Enum>
  void enumerator(Enum& value, Enum last) {
    const auto read = static_cast<std::int8_t>(byte());
    const bool known = read >= 0 && read <= static_cast<int>(last);
    value = known ? static_cast<Enum>(read) : Enum();
    holds(known);
  }
  void bytes(std::span<std::byte> value) {
    const std::byte* const at = take(value.size());
    if (at != nullptr && !value.empty()) std::memcpy(value.data(), at, value.size());
  }
  void text(std::string& value, int limit);
  void room_for_tag() { take(kTagBytes); }
  void holds(bool condition) { plausible_ = plausible_ && condition; }

  template <class Element>
  void length(std::vector<Element>& elements, int limit) {
    elements.resize(declared(limit));
  }
  template <class Element, std::size_t kLimit>
  std::span<Element> length(std::array<Element, kLimit>& elements, std::int32_t& count) {
    count = static_cast<std::int32_t>(declared(static_cast<int>(kLimit)));
    return std::span(elements).first(static_cast<std::size_t>(count));
  }

 private:
  /// The next `count` bytes; null if there are fewer, and from then on.
  const std::byte* take(std::size_t count) {
    complete_ = complete_ && count <= bytes_.size();
    if (!complete_) return nullptr;
    const std::byte* const at = bytes_.data();
    bytes_ = bytes_.subspan(count);
    return at;
  }
  std::byte byte() {
    const std::byte* const at = take(1);
    return at == nullptr ? std::byte{0} : *at;
  }
  std::size_t declared(int limit) {
    std::int32_t count = 0;
    number(count);
    complete_ = complete_ && count >= 0 && count <= limit;
    return complete_ ? static_cast<std::size_t>(count) : 0;
  }

  std::span<const std::byte> bytes_;
  bool complete_ = true, plausible_ = true;
};

}  // namespace ergocast
