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
    value(field, bytes_of(numbers.data(), numbers.size()));
  }
  void value_if_any(int field, const Coefficients& numbers) {
    if (numbers.size() > 0) value(field, numbers);
  }
  void places_if_any(int xy, int z, const std::vector<Eigen::Vector3d>& places_m) {
    if (!places_m.empty()) places(xy, z, places_m);
  }
  /// A plan has no heights if all are 0.
  void places(int xy, int z, const std::vector<Eigen::Vector3d>& places_m) {
    std::string bytes, heights;
    for (const Eigen::Vector3d& x_m : places_m) {
      bytes += bytes_of(x_m.data(), 2);
      heights += bytes_of(x_m.data() + 2, 1);
    }
    value(xy, bytes);
    if (heights.find_first_not_of('\0') != std::string::npos) value(z, heights);
  }
  void unless(int field, auto value, double usual) {
    if (value != usual || usual == 0) this->value(field, value);
  }
  PlanWriter open(int) const { return {}; }
  /// Writes each kind as a block under the same number.
  void blocks(int field, const std::vector<AgentKind>& kinds, const auto& write) {
    for (const AgentKind& kind : kinds) {
      PlanWriter block;
      write(block, kind);
      const std::string bytes = block.bytes();
      fields_[field] += tag(field, kBlock) + varint(bytes.size()) + bytes;
    }
  }
  void rings(int field, const Rings& rings) {
    for (const Ring& ring : rings) {
      std::string corners;
      for (const Eigen::Vector2d& corner_m : ring) corners += bytes_of(corner_m.data(), 2);
      PlanWriter block;
      block.value(kRingCorners, corners);
      const std::string bytes = block.bytes();
      fields_[field] += tag(field, kBlock) + varint(bytes.size()) + bytes;
    }
  }
  /// An empty block differs from an absent one.
  void optional(int field, const std::optional<VehicleLimits>& part, const auto& write) {
    if (!part) return;
    PlanWriter block;
    write(block, *part);
    value(field, block.bytes());
  }
  void close(int field, const PlanWriter& block) {
    if (const std::string bytes = block.bytes(); !bytes.empty()) value(field, bytes);
  }

  std::string bytes() const {
    std::string all;
    for (const auto& [field, bytes] : fields_) all += bytes;
    return all;
  }

 private:
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
  void value_if_any(int field, Coefficients& coefficients) const { value(field, coefficients); }
  void places_if_any(int xy, int z, std::vector<Eigen::Vector3d>& places_m) const {
    places(xy, z, places_m);
  }
  void places(int xy, int z, std::vector<Eigen::Vector3d>& places_m) const {
    const std::vector<double> numbers = numbers_at(xy), heights = numbers_at(z);
    for (std::size_t i = 0; i < numbers.size() / 2; ++i) {
      const double height = i < heights.size() ? heights[i] : 0;
      places_m.emplace_back(numbers[2 * i], numbers[2 * i + 1], height);
    }
  }
  template <class T>
  void unless(int field, T& value, double usual) const {
    this->value(field, value);
    if (value == 0) value = static_cast<T>(usual);
  }
  PlanReader open(int field) const { return PlanReader(at(field).bytes); }
  void blocks(int field, std::vector<AgentKind>& kinds, const auto& read) const {
    const auto [first, end] = fields_.equal_range(static_cast<std::uint64_t>(field));
    for (auto at = first; at != end; ++at) {
      const PlanReader block(at->second.bytes);
      read(block, kinds.emplace_back());
    }
  }
  void rings(int field, Rings& rings) const {
    const auto [first, end] = fields_.equal_range(static_cast<std::uint64_t>(field));
    for (auto at = first; at != end; ++at) {
      const std::vector<double> numbers = PlanReader(at->second.bytes).numbers_at(kRingCorners);
      Ring& ring = rings.emplace_back();
      for (std::size_t i = 1; i < numbers.size(); i += 2)
        ring.emplace_back(numbers[i - 1], numbers[i]);
    }
  }
  void optional(int field, std::optional<VehicleLimits>& part, const auto& read) const {
    if (!fields_.contains(static_cast<std::uint64_t>(field))) return;
    const PlanReader block = open(field);
    read(block, part.emplace());
  }
  void close(int, const PlanReader&) const {}

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

  void number(int field, const char*, auto& value, const Limits&, bool = true) {
    wire_.value(field, value);
  }
  void number_unless(int field, const char*, auto& value, const Limits&, double usual) {
    wire_.unless(field, value, usual);
  }
  void height(int field, const char*, auto& value, const Limits&, double in_plane) {
    wire_.unless(field, value, in_plane);
  }
  void flag(int field, const char*, auto& value) { wire_.value(field, value); }
  void choice(int field, const char*, auto& value, Words, bool = true) {
    wire_.value(field, value);
  }
  void seed(int field, const char*, auto& value) { wire_.value(field, value); }
  void name(int field, const char*, auto& value) { wire_.value(field, value); }
  void part(int field, const char*, auto& part) {
    Wire block = wire_.open(field);
    PlanFields inner(block);
    list_fields(inner, part);
    wire_.close(field, block);
  }
  void contraction_center(int x, int z, auto& x_m) {
    wire_.value(x, x_m.x());
    wire_.value(x + 1, x_m.y());
    wire_.value(z, x_m.z());
  }
  void duration(int field, auto& timing) { wire_.value(field, timing.tick_count); }
  void target(int field, auto& target) { wire_.value(field, target); }
  void kinds(int field, const char*, auto& kinds) {
    wire_.blocks(field, kinds, [](auto& block, auto& kind) {
      PlanFields<std::remove_reference_t<decltype(block)>> inner(block);
      list_fields(inner, kind);
    });
  }
  void kind_name(int field, const char*, auto& name) { wire_.value(field, name); }
  void own_vehicle(int field, const char*, auto& vehicle) {
    wire_.optional(field, vehicle, [](auto& block, auto& present) {
      PlanFields<std::remove_reference_t<decltype(block)>> inner(block);
      list_fields(inner, present);
    });
  }
  void starts(int xy, int z, auto& starts_m) { wire_.places(xy, z, starts_m); }
  void stations(int xy, int z, const char*, auto& places_m) {
    wire_.places_if_any(xy, z, places_m);
  }
  void walls(int field, const char*, auto& walls) { wire_.rings(field, walls); }
  void hidden_flag(int field, auto& value) { wire_.value(field, value); }
  void hash(int field, auto& value) { wire_.value(field, value); }
  void other_target(int field, auto& target) { wire_.value_if_any(field, target); }

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
