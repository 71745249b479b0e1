// SPDX-License-Identifier: BSD-3-Clause
// Three visitors of the tables of fields: one adds up CRC_EXTRA and sizes, one writes, one reads.
#include "bridges/mavlink/messages.h"

#include <algorithm>
#include <bit>
#include <string_view>
#include <type_traits>

#include "bridges/mavlink/checksum.h"

namespace ergocast::mavlink {
namespace {

template <class T>
constexpr std::string_view name_of_type() {
  if constexpr (std::is_same_v<T, float>) return "float";
  if constexpr (std::is_same_v<T, char>) return "char";
  if constexpr (std::is_same_v<T, std::int8_t>) return "int8_t";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "uint8_t";
  if constexpr (std::is_same_v<T, std::int16_t>) return "int16_t";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "uint16_t";
  if constexpr (std::is_same_v<T, std::int32_t>) return "int32_t";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "uint32_t";
  if constexpr (std::is_same_v<T, std::int64_t>) return "int64_t";
  return "";
}

/// CRC_EXTRA is the checksum of the message's name and of type, name and length of its fields, with
/// its two bytes combined.
struct Measure {
  Checksum sum;
  std::size_t base_bytes = 0, extension_bytes = 0;

  void add(std::string_view word) {
    sum.add(word);
    sum.add(" ");
  }
  template <class T>
  void field(const char* name, const T&) {
    add(name_of_type<T>());
    add(name);
    base_bytes += sizeof(T);
  }
  template <class T, std::size_t N>
  void field(const char* name, const std::array<T, N>& all) {
    add(name_of_type<T>());
    add(name);
    const char length = static_cast<char>(N);
    sum.add({&length, 1});
    base_bytes += sizeof all;
  }
  template <class T>
  void extension(const char*, const T&) {
    extension_bytes += sizeof(T);
  }
};

template <class M>
Type measured() {
  Measure io;
  io.add(M::kName);
  const M m;
  M::list(io, m);
  const auto extra = static_cast<std::uint8_t>((io.sum.value() & 0xFF) ^ (io.sum.value() >> 8));
  return {M::kId, M::kName, extra, io.base_bytes, io.base_bytes + io.extension_bytes};
}

template <std::size_t... kAt>
std::array<Type, sizeof...(kAt)> all_types(std::index_sequence<kAt...>) {
  return {measured<std::variant_alternative_t<kAt, Packet>>()...};
}

template <class T>
using Bits = std::conditional_t<
    sizeof(T) == 8, std::uint64_t,
    std::conditional_t<sizeof(T) == 4, std::uint32_t,
                       std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;

struct Write {
  std::vector<std::byte>& out;

  template <class T>
  void field(const char*, const T& value) {
    auto bits = std::bit_cast<Bits<T>>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i, bits = static_cast<Bits<T>>(bits >> 4 >> 4))
      out.push_back(static_cast<std::byte>(bits & 0xFF));
  }
  template <class T, std::size_t N>
  void field(const char* name, const std::array<T, N>& all) {
    for (const T& value : all) field(name, value);
  }
  void extension(const char* name, const auto& value) { field(name, value); }
};

struct Read {
  std::span<const std::byte> in;

  std::byte next() {
    if (in.empty()) return std::byte{0};
    const std::byte first = in.front();
    in = in.subspan(1);
    return first;
  }
  template <class T>
  void field(const char*, T& value) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bits |= std::to_integer<std::uint64_t>(next()) << (8 * i);
    value = std::bit_cast<T>(static_cast<Bits<T>>(bits));
  }
  template <class T, std::size_t N>
  void field(const char* name, std::array<T, N>& all) {
    for (T& value : all) field(name, value);
  }
  void extension(const char* name, auto& value) { field(name, value); }
};

template <std::size_t kAt = 0>
std::optional<Packet> read(std::uint32_t id, std::span<const std::byte> payload) {
  if constexpr (kAt == std::variant_size_v<Packet>) {
    return std::nullopt;
  } else {
    using M = std::variant_alternative_t<kAt, Packet>;
    if (id != M::kId) return read<kAt + 1>(id, payload);
    M m;
    Read io{payload};
    M::list(io, m);
    return m;
  }
}

}  // namespace

std::span<const Type> types() {
  static const auto all = all_types(std::make_index_sequence<std::variant_size_v<Packet>>());
  return all;
}

const Type* type_of(std::uint32_t id) {
  const auto all = types();
  const auto found = std::ranges::find(all, id, &Type::id);
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::byte> payload_of(const Packet& packet) {
  std::vector<std::byte> out;
  std::visit(
      [&](const auto& m) {
        Write io{out};
        m.list(io, m);
      },
      packet);
  while (out.size() > 1 && out.back() == std::byte{0}) out.pop_back();
  return out;
}

std::optional<Packet> packet_of(std::uint32_t id, std::span<const std::byte> payload) {
  return read(id, payload);
}

std::string text_of(const Text50& text) { return {text.begin(), std::ranges::find(text, '\0')}; }

}  // namespace ergocast::mavlink
