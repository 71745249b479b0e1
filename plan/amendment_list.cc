// SPDX-License-Identifier: BSD-3-Clause
// Copies numbers one after the other, with the length before each list.
#include "plan/amendment_list.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "plan/mission_limits.h"

namespace ergocast {
namespace {

// Numbers are copied as they are.
static_assert(std::endian::native == std::endian::little);

/// No list has more elements than that; the numbers of a target are the most.
constexpr std::uint32_t kMostElements = kMaxModes;

class ListWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void value(const T& number) {
    const auto* const at = reinterpret_cast<const std::byte*>(&number);
    bytes_.insert(bytes_.end(), at, at + sizeof number);
  }
  template <class Elements>
  void list(const Elements& elements, const auto& write) {
    value(static_cast<std::uint32_t>(elements.size()));
    for (const auto& element : elements) write(*this, element);
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

/// Missing numbers are read as 0.
class ListReader {
 public:
  explicit ListReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  /// Whether all numbers were there, and no bytes after the last.
  bool complete() const { return complete_ && bytes_.empty(); }

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void value(T& number) {
    complete_ = complete_ && sizeof number <= bytes_.size();
    if (!complete_) return;
    std::memcpy(&number, bytes_.data(), sizeof number);
    bytes_ = bytes_.subspan(sizeof number);
  }
  template <class Elements>
  void list(Elements& elements, const auto& read) {
    std::uint32_t count = 0;
    value(count);
    // Each element has bytes of its own, so a forged length allocates nothing.
    complete_ = complete_ && count <= kMostElements && count <= bytes_.size();
    elements.resize(static_cast<decltype(elements.size())>(complete_ ? count : 0));
    for (auto& element : elements) read(*this, element);
  }

 private:
  std::span<const std::byte> bytes_;
  bool complete_ = true;
};

constexpr auto kNumber = [](auto& io, auto& number) { io.value(number); };

/// Where a zone is.
void place_fields(auto& io, auto& zone) {
  io.value(zone.low_m);
  io.value(zone.high_m);
  io.list(zone.corners_m, [](auto& wire, auto& corner_m) {
    wire.value(corner_m.x());
    wire.value(corner_m.y());
  });
}

constexpr auto kNote = [](auto& io, auto& note) {
  io.value(note.x_m.x());
  io.value(note.x_m.y());
  io.value(note.sigma_m);
  io.value(note.share);
};

constexpr auto kLawNumbers = [](auto& io, auto& numbers) {
  io.value(numbers.u_max_mps);
  io.value(numbers.noise_intensity);
  io.value(numbers.noise_ceiling);
};

/// All fields of a list, for the writer and the reader.
void list_fields(auto& io, auto& amendments) {
  io.value(amendments.named);
  io.list(amendments.recent, [](auto& wire, auto& one) {
    wire.value(one.number);
    wire.value(one.kind);
    wire.value(one.from);
    wire.value(one.hash);
    wire.list(one.by, kNumber);
    wire.value(one.ordered_by);
  });
  io.list(amendments.holds, [](auto& wire, auto& hold) {
    wire.value(hold.from);
    wire.value(hold.until);
  });
  io.list(amendments.targets, [](auto& wire, auto& change) {
    wire.value(change.number);
    wire.value(change.from);
    wire.list(change.target, kNumber);
    wire.list(change.cosine, kNumber);
  });
  io.list(amendments.ends, [](auto& wire, auto& change) {
    wire.value(change.number);
    wire.value(change.from);
    wire.value(change.tick_count);
  });
  io.list(amendments.zones, [](auto& wire, auto& zone) {
    wire.value(zone.number);
    wire.value(zone.closed);
    wire.value(zone.from);
    wire.value(zone.until);
    wire.value(zone.cancelled);
    place_fields(wire, zone);
  });
  io.list(amendments.laws, [](auto& wire, auto& change) {
    wire.value(change.number);
    wire.value(change.from);
    wire.list(change.kinds, kLawNumbers);
  });
  io.list(amendments.notes, [](auto& wire, auto& note) {
    wire.value(note.number);
    wire.value(note.from);
    kNote(wire, note);
  });
}

bool is_kind(const Amendment& amendment) {
  return amendment.kind >= AmendmentKind::kPause && amendment.kind <= AmendmentKind::kDismiss;
}

}  // namespace

std::vector<std::byte> encode_amendments(const Amendments& list) {
  if (list.empty()) return {};
  ListWriter writer;
  list_fields(writer, list);
  return writer.take();
}

std::optional<Amendments> decode_amendments(std::span<const std::byte> bytes,
                                            const Mission& mission) noexcept try {
  Amendments list;
  if (bytes.empty()) return list;
  ListReader reader(bytes);
  list_fields(reader, list);
  if (!reader.complete() || !std::ranges::all_of(list.recent, is_kind)) return std::nullopt;
  if (list.empty() || !are_amendments(list, mission)) return std::nullopt;
  if (!std::ranges::all_of(list.ends, [&mission](const EndChange& change) {
        return is_tick_count(change.tick_count, mission.timing);
      }))
    return std::nullopt;
  if (!std::ranges::all_of(list.laws,
                           [&mission](const LawChange& change) { return is_law(change, mission); }))
    return std::nullopt;
  return list;
} catch (...) {
  return std::nullopt;  // memory is missing
}

std::vector<std::byte> encode_end(Tick tick_count) {
  ListWriter writer;
  writer.value(tick_count);
  return writer.take();
}

std::optional<Tick> decode_end(std::span<const std::byte> bytes, const Mission& mission) noexcept {
  Tick tick_count = 0;
  ListReader reader(bytes);
  reader.value(tick_count);
  if (!reader.complete() || !is_tick_count(tick_count, mission.timing)) return std::nullopt;
  return tick_count;
}

std::vector<std::byte> encode_reopening(std::int32_t number) {
  ListWriter writer;
  writer.value(number);
  return writer.take();
}

std::optional<std::int32_t> decode_reopening(std::span<const std::byte> bytes) noexcept {
  std::int32_t number = 0;
  ListReader reader(bytes);
  reader.value(number);
  if (!reader.complete() || number < 0) return std::nullopt;
  return number;
}

std::size_t target_bytes(const Mission& mission) {
  const auto count = static_cast<std::size_t>(mission.basis.mode_count());
  return sizeof(double) * (mission.basis.free_domain ? 2 * count : count);
}

std::vector<std::byte> encode_target(const TargetChange& change) {
  ListWriter writer;
  for (const Coefficients* numbers : {&change.target, &change.cosine})
    for (const double number : *numbers) writer.value(number);
  return writer.take();
}

std::optional<TargetChange> decode_target(std::span<const std::byte> bytes,
                                          const Mission& mission) noexcept try {
  if (bytes.size() != target_bytes(mission)) return std::nullopt;
  TargetChange change;
  change.target.resize(mission.basis.mode_count());
  if (mission.basis.free_domain) change.cosine.resize(mission.basis.mode_count());
  ListReader reader(bytes);
  for (Coefficients* numbers : {&change.target, &change.cosine})
    for (double& number : *numbers) reader.value(number);
  if (!is_target(change.target, change.cosine, mission)) return std::nullopt;
  return change;
} catch (...) {
  return std::nullopt;  // memory is missing
}

std::vector<std::byte> encode_search_note(const SearchNote& note) {
  ListWriter writer;
  kNote(writer, note);
  return writer.take();
}

std::optional<SearchNote> decode_search_note(std::span<const std::byte> bytes,
                                             const Mission& mission) noexcept {
  SearchNote note;
  ListReader reader(bytes);
  kNote(reader, note);
  if (!reader.complete() || !is_search_note(note, mission)) return std::nullopt;
  return note;
}

std::vector<std::byte> encode_law(const LawChange& change) {
  ListWriter writer;
  for (const LawNumbers& numbers : change.kinds) kLawNumbers(writer, numbers);
  return writer.take();
}

std::optional<LawChange> decode_law(std::span<const std::byte> bytes,
                                    const Mission& mission) noexcept try {
  LawChange change = plans_law(mission);
  ListReader reader(bytes);
  for (LawNumbers& numbers : change.kinds) kLawNumbers(reader, numbers);
  if (!reader.complete() || !is_law(change, mission)) return std::nullopt;
  return change;
} catch (...) {
  return std::nullopt;  // memory is missing
}

std::vector<std::byte> encode_zone(const Zone& zone) {
  ListWriter writer;
  const Tick lasts = zone.until - zone.from;
  writer.value(lasts);
  place_fields(writer, zone);
  return writer.take();
}

std::optional<Zone> decode_zone(std::span<const std::byte> bytes, const Box& domain) noexcept try {
  Zone zone;
  ListReader reader(bytes);
  reader.value(zone.until);
  place_fields(reader, zone);
  if (!reader.complete() || !is_zone(zone, domain)) return std::nullopt;
  return zone;
} catch (...) {
  return std::nullopt;  // memory is missing
}

}  // namespace ergocast
