// SPDX-License-Identifier: BSD-3-Clause
// Writes and reads the list of a mission's fields, and accepts only what it would have written.
#include "plan/plan.h"

#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <string_view>

#include "core/base/require.h"
#include "modes/provide.h"
#include "plan/mission_fields.h"

namespace ergocast {
namespace {

constexpr const char* kRemedy = ": install the same version on every host";

/// The error for bytes without a readable version.
std::string unreadable_plan() {
  return std::string(
             "the mission's plan is damaged or of a much newer version than this program, "
             "which is " ERGOCAST_VERSION) +
         kRemedy;
}

/// The error for a plan that names this version but breaks its rules.
std::string broken_plan() {
  return std::string("the mission's plan is of version " ERGOCAST_VERSION
                     ", but breaks that version's rules: it is damaged or another build's") +
         kRemedy;
}

/// Whether the text is a possible version: arbitrary received text must not reach a terminal.
bool is_version(const std::string& text) {
  return !text.empty() && text.size() <= static_cast<std::size_t>(kMaxVersionLength) &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

// Protobuf's wire format: each field is its number with the kind of its bytes, then the bytes. A
// plan has the fields in ascending order, and none that is 0.
constexpr int kVersionField = 1, kRingCorners = 1;
constexpr unsigned kVarint = 0, kFixed64 = 1, kBlock = 2;
// Doubles are copied as they are.
static_assert(std::endian::native == std::endian::little);

template <class T>
concept Whole = std::is_integral_v<T> || std::is_enum_v<T>;

class PlanWriter {
 public:
  void value(int field, Whole auto value) {
    if (const auto whole = static_cast<std::uint64_t>(value); whole != 0)
      fields_[field] = tag(field, kVarint) + varint(whole);
  }
  /// −0 is not 0.
  void value(int field, double value) {
    if (std::bit_cast<std::uint64_t>(value) != 0)
      fields_[field] = tag(field, kFixed64) + bytes_of(&value, 1);
  }
  void value(int field, const std::string& bytes) {
    fields_[field] = tag(field, kBlock) + varint(bytes.size()) + bytes;
  }
  void value(int field, const Coefficients& numbers) {
    if (numbers.size() > 0) value(field, bytes_of(numbers.data(), numbers.size()));
  }
  void value(int field, const Rings& rings) {
    for (const Ring& ring : rings) {
      std::string corners;
      for (const Eigen::Vector2d& corner_m : ring) corners += bytes_of(corner_m.data(), 2);
      PlanWriter block;
      block.value(kRingCorners, corners);
      add(field, block.bytes());
    }
  }
  /// Omits the number if it equals `usual`.
  void number(int field, auto value, double usual) {
    if (value != usual || usual == 0) this->value(field, value);
  }
  /// A plan has no heights if all are 0.
  void places(int xy, int z, const std::vector<Eigen::Vector3d>& places_m) {
    if (places_m.empty()) return;
    std::string bytes, heights;
    for (const Eigen::Vector3d& x_m : places_m) {
      bytes += bytes_of(x_m.data(), 2);
      heights += bytes_of(x_m.data() + 2, 1);
    }
    value(xy, bytes);
    if (heights.find_first_not_of('\0') != std::string::npos) value(z, heights);
  }
  void part(int field, const auto& part, const auto& write) {
    if (const std::string bytes = block_of(part, write); !bytes.empty()) add(field, bytes);
  }
  /// An empty block differs from an absent one.
  void part(int field, const std::optional<VehicleLimits>& part, const auto& write) {
    if (part) add(field, block_of(*part, write));
  }
  void part(int field, const std::vector<AgentKind>& kinds, const auto& write) {
    for (const AgentKind& kind : kinds) add(field, block_of(kind, write));
  }

  std::string bytes() const {
    std::string all;
    for (const auto& [field, bytes] : fields_) all += bytes;
    return all;
  }

 private:
  static std::string block_of(const auto& part, const auto& write) {
    PlanWriter block;
    write(block, part);
    return block.bytes();
  }
  /// Adds a block to those under the same number.
  void add(int field, const std::string& block) {
    fields_[field] += tag(field, kBlock) + varint(block.size()) + block;
  }
  static std::string varint(std::uint64_t value) {
    std::string bytes;
    for (; value >= 0x80; value >>= 7) bytes += static_cast<char>(value | 0x80);
    return bytes + static_cast<char>(value);
  }
  static std::string tag(int field, unsigned kind) {
    return varint(static_cast<unsigned>(field) << 3 | kind);
  }
  static std::string bytes_of(const double* numbers, Eigen::Index count) {
    return {reinterpret_cast<const char*>(numbers),
            sizeof(double) * static_cast<std::size_t>(count)};
  }

  std::map<int, std::string> fields_;
};

/// Accepts any bytes; a missing field is 0. decode_plan() encodes what was read again, and compares
/// that with the bytes.
class PlanReader {
 public:
  explicit PlanReader(std::string_view bytes) {
    while (const auto key = varint(bytes)) {
      const unsigned kind = *key & 7;
      // The value, or how many bytes it has.
      const std::optional<std::uint64_t> whole = kind == kFixed64 ? sizeof(double) : varint(bytes);
      if (!whole || kind > kBlock) return;
      const std::size_t size = kind == kVarint ? 0 : *whole;
      if (size > bytes.size()) return;
      fields_.emplace(*key >> 3, Value{*whole, bytes.substr(0, size)});
      bytes.remove_prefix(size);
    }
  }

  template <Whole T>
  void value(int field, T& value) const {
    value = static_cast<T>(at(field).whole);
  }
  void value(int field, double& value) const {
    const std::vector<double> numbers = numbers_at(field);
    value = numbers.empty() ? 0 : numbers[0];
  }
  void value(int field, std::string& bytes) const { bytes = at(field).bytes; }
  void value(int field, Coefficients& coefficients) const {
    const std::vector<double> numbers = numbers_at(field);
    coefficients = Eigen::Map<const Coefficients>(numbers.data(), std::ssize(numbers));
  }
  void value(int field, Rings& rings) const {
    for_each_block(field, [&rings](const PlanReader& block) {
      const std::vector<double> numbers = block.numbers_at(kRingCorners);
      Ring& ring = rings.emplace_back();
      for (std::size_t i = 1; i < numbers.size(); i += 2)
        ring.emplace_back(numbers[i - 1], numbers[i]);
    });
  }
  void value(int field, IndexedRings& rings) const {
    Rings read;
    value(field, read);
    rings = std::move(read);
  }
  template <class T>
  void number(int field, T& value, double usual) const {
    this->value(field, value);
    if (usual != 0 && value == 0) value = static_cast<T>(usual);
  }
  void places(int xy, int z, std::vector<Eigen::Vector3d>& places_m) const {
    const std::vector<double> numbers = numbers_at(xy), heights = numbers_at(z);
    for (std::size_t i = 0; i < numbers.size() / 2; ++i) {
      const double height = i < heights.size() ? heights[i] : 0;
      places_m.emplace_back(numbers[2 * i], numbers[2 * i + 1], height);
    }
  }
  void part(int field, auto& part, const auto& read) const {
    read(PlanReader(at(field).bytes), part);
  }
  void part(int field, std::optional<VehicleLimits>& part, const auto& read) const {
    if (fields_.contains(static_cast<std::uint64_t>(field)))
      read(PlanReader(at(field).bytes), part.emplace());
  }
  void part(int field, std::vector<AgentKind>& kinds, const auto& read) const {
    for_each_block(field, [&](const PlanReader& block) { read(block, kinds.emplace_back()); });
  }

 private:
  struct Value {
    std::uint64_t whole = 0;
    std::string_view bytes;
  };

  /// Takes a number off the beginning of `bytes`; nothing if there is none.
  static std::optional<std::uint64_t> varint(std::string_view& bytes) {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64 && !bytes.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(bytes.front());
      bytes.remove_prefix(1);
      value |= (byte & 0x7full) << shift;
      if (byte < 0x80) return value;
    }
    return std::nullopt;
  }
  void for_each_block(int field, const auto& read) const {
    const auto [first, end] = fields_.equal_range(static_cast<std::uint64_t>(field));
    for (auto at = first; at != end; ++at) read(PlanReader(at->second.bytes));
  }
  Value at(int field) const {
    const auto found = fields_.find(static_cast<std::uint64_t>(field));
    return found == fields_.end() ? Value() : found->second;
  }
  std::vector<double> numbers_at(int field) const {
    const std::string_view bytes = at(field).bytes;
    std::vector<double> numbers(bytes.size() / sizeof(double));
    std::copy_n(bytes.data(), numbers.size() * sizeof(double),
                reinterpret_cast<char*>(numbers.data()));
    return numbers;
  }

  std::multimap<std::uint64_t, Value> fields_;
};

/// Passes each field on to `wire`, a PlanWriter or a PlanReader.
template <class Wire>
class PlanFields : public FieldVisitor {
 public:
  explicit PlanFields(Wire& wire) : wire_(wire) {}

  void number(const Field& field, auto& value) {
    wire_.number(field.number, value, field.when.otherwise);
  }
  void choice(const Field& field, auto& value, Words) { wire_.value(field.number, value); }
  void flag(const Field& field, auto& value) { wire_.value(field.number, value); }
  void text(const Field& field, auto& value) { wire_.value(field.number, value); }
  void derived(const Field& field, auto& value) { wire_.value(field.number, value); }
  void part(const Field& field, auto& part) {
    wire_.part(field.number, part, [](auto&& block, auto& fields) {
      PlanFields<std::remove_reference_t<decltype(block)>> inner(block);
      list_fields(inner, fields);
    });
  }
  void places(const Field& xy, const Field& z, auto& places_m) {
    wire_.places(xy.number, z.number, places_m);
  }
  void places(const Field& xy, const Field& z, MaybeConst<Eigen::Vector3d> auto& x_m) {
    wire_.value(xy.number, x_m.x());
    wire_.value(xy.number + 1, x_m.y());
    wire_.value(z.number, x_m.z());
  }

 private:
  Wire& wire_;
};

}  // namespace

std::vector<std::byte> encode_plan(const Mission& mission) {
  PlanWriter plan;
  plan.value(kVersionField, std::string(ERGOCAST_VERSION));
  PlanFields fields(plan);
  list_fields(fields, mission);
  const std::string bytes = plan.bytes();
  // within_limits() keeps it below this size.
  ERGOCAST_REQUIRE(bytes.size() <= kMaxPlanBytes);
  const auto all = std::as_bytes(std::span(bytes));
  return {all.begin(), all.end()};
}

Result<Mission> decode_plan(std::span<const std::byte> bytes) noexcept try {
  if (bytes.size() > kMaxPlanBytes) return failure(unreadable_plan());
  const PlanReader plan({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  // Only the version itself can read the other fields.
  std::string version;
  plan.value(kVersionField, version);
  if (!is_version(version)) return failure(unreadable_plan());
  if (version != ERGOCAST_VERSION) {
    return failure("the mission's plan is of version " + version +
                   ", this program is " ERGOCAST_VERSION + kRemedy);
  }
  Mission mission;
  PlanFields fields(plan);
  list_fields(fields, mission);
  // A mission has exactly one encoding: bytes that differ from it were not written by
  // encode_plan().
  if (!within_limits(mission) || !std::ranges::equal(encode_plan(mission), bytes))
    return failure(broken_plan());
  return mission;
} catch (...) {
  return failure("out of memory");
}

Result<Mission> decode_plan_with_table(std::span<const std::byte> plan) noexcept try {
  auto decoded = decode_plan(plan);
  if (!decoded) return decoded;
  if (auto problem = provide_table(*decoded)) return failure(*problem);
  return decoded;
} catch (...) {
  return failure("out of memory");
}

std::string plan_hash(std::span<const std::byte> plan) {
  XXH128_canonical_t hash;
  XXH128_canonicalFromHash(&hash, XXH3_128bits(plan.data(), plan.size()));
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : hash.digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace ergocast
