// SPDX-License-Identifier: BSD-3-Clause
// Writes the parts of a table behind its header, and checks every number that is read back.
#include "modes/table.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace ergocast {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::array<char, 8> kMagic = {'E', 'R', 'G', 'O', 'M', 'O', 'D', 'E'};
constexpr std::uint32_t kFormat = 1;
/// No grid has more cells on a side, and no table has more modes.
constexpr std::uint32_t kMostOnSide = 640, kMostModes = 4096;

struct TableHeader {
  std::array<char, 8> magic = kMagic;
  std::uint32_t format = kFormat;
  std::uint32_t columns = 0, rows = 0, modes = 0, cells = 0, padding = 0;
  std::array<double, 2> origin_m{}, size_m{};
  std::uint64_t key = 0;
  std::array<char, 32> version{};
};
static_assert(sizeof(TableHeader) == 104);

std::array<char, 32> own_version() {
  std::array<char, 32> version{};
  constexpr std::string_view kVersion = ERGOCAST_VERSION;
  std::copy_n(kVersion.data(), std::min(kVersion.size(), version.size() - 1), version.data());
  return version;
}

template <class Number>
void append(std::vector<std::byte>& bytes, const Number* numbers, std::size_t count) {
  const std::size_t begin = (bytes.size() + 7) / 8 * 8;
  bytes.resize(begin + count * sizeof(Number));
  std::memcpy(bytes.data() + begin, numbers, count * sizeof(Number));
}

std::vector<double> mean_squares_of(const std::vector<float>& values, std::size_t modes) {
  std::vector<double> squares(modes);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<double>(values[i]);
    squares[i % modes] += value * value;
  }
  const std::size_t cells = values.size() / modes;
  for (double& square : squares) square /= static_cast<double>(cells);
  return squares;
}

/// Reads numbers from the front. After too few bytes it is broken.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class Number>
  std::span<const Number> take(std::size_t count) {
    const std::size_t begin = (at_ + 7) / 8 * 8, size = count * sizeof(Number);
    if (broken_ || begin > bytes_.size() || size > bytes_.size() - begin) {
      broken_ = true;
      return {};
    }
    at_ = begin + size;
    return {reinterpret_cast<const Number*>(bytes_.data() + begin), count};
  }
  bool whole() const { return !broken_ && at_ == bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  bool broken_ = false;
};

bool is_sound(const TableHeader& header) {
  const auto within = [](std::uint32_t number, std::uint32_t low, std::uint32_t high) {
    return number >= low && number <= high;
  };
  bool sound = within(header.columns, 1, kMostOnSide) && within(header.rows, 1, kMostOnSide) &&
               within(header.modes, 2, kMostModes) &&
               within(header.cells, 1, header.columns * header.rows);
  for (const int axis : {0, 1}) {
    const double size_m = header.size_m[static_cast<std::size_t>(axis)];
    sound = sound && std::isfinite(header.origin_m[static_cast<std::size_t>(axis)]) &&
            std::isfinite(size_m) && size_m > 0;
  }
  return sound;
}

bool all_between(std::span<const std::int32_t> numbers, std::int32_t end) {
  return std::ranges::all_of(numbers, [=](std::int32_t n) { return n >= 0 && n < end; });
}

/// Whether every number is one that a table may have, so that no reader has to check again.
bool is_sound(const FreeModes& modes) {
  const auto& nu = modes.eigenvalues_per_m2;
  const auto positive = [](double number) { return std::isfinite(number) && number > 0; };
  // Somewhere |e_k| is 1. Half of that is for rounding.
  const double least = 0.5 / modes.cell_count;
  const auto mean_square = [=](double number) { return number >= least && number <= 1; };
  const auto bounded = [](float value) { return std::abs(value) <= 1; };
  bool sound = all_between(modes.owner, modes.cell_count) &&
               all_between(modes.around, modes.cell_count) &&
               all_between(modes.place, modes.columns * modes.rows) && nu[0] == 0 &&
               std::all_of(nu.begin() + 1, nu.end(), positive) && std::ranges::is_sorted(nu) &&
               std::ranges::all_of(modes.mean_squares, mean_square) &&
               std::ranges::all_of(modes.values, bounded);
  for (int cell = 0; cell < modes.cell_count; ++cell) sound = sound && *modes.values_of(cell) == 1;
  return sound;
}

}  // namespace

std::vector<std::byte> encode_table(const FreeGrid& grid, const EigenModes& modes,
                                    std::uint64_t key) {
  TableHeader header;
  header.columns = static_cast<std::uint32_t>(grid.columns);
  header.rows = static_cast<std::uint32_t>(grid.rows);
  header.modes = static_cast<std::uint32_t>(modes.values.cols());
  header.cells = static_cast<std::uint32_t>(grid.cell_count());
  header.origin_m = {grid.origin_m.x(), grid.origin_m.y()};
  header.size_m = {grid.size_m.x(), grid.size_m.y()};
  header.key = key;
  header.version = own_version();
  std::vector<float> values;
  for (int cell = 0; cell < grid.cell_count(); ++cell) {
    for (int k = 0; k < modes.values.cols(); ++k)
      values.push_back(static_cast<float>(modes.values(cell, k)));
  }
  const auto mean_squares = mean_squares_of(values, header.modes);
  std::vector<std::byte> bytes;
  append(bytes, &header, 1);
  append(bytes, grid.owner.data(), grid.owner.size());
  append(bytes, grid.place.data(), grid.place.size());
  append(bytes, grid.around.data(), grid.around.size());
  append(bytes, modes.eigenvalues_per_m2.data(), header.modes);
  append(bytes, mean_squares.data(), mean_squares.size());
  append(bytes, values.data(), values.size());
  return bytes;
}

Result<ModesTable> decode_table(std::span<const std::byte> bytes,
                                std::shared_ptr<const void> storage) {
  const std::string damaged = "it is no table of modes, or a damaged one";
  TableHeader header;
  if (bytes.size() < sizeof header) return failure(damaged);
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != kMagic) return failure(damaged);
  if (header.format != kFormat || header.version != own_version()) {
    return failure("it is another version's table of modes: this program is " ERGOCAST_VERSION);
  }
  if (!is_sound(header)) return failure(damaged);
  auto modes = std::make_shared<FreeModes>();
  modes->origin_m << header.origin_m[0], header.origin_m[1];
  modes->size_m << header.size_m[0], header.size_m[1];
  modes->columns = static_cast<int>(header.columns);
  modes->rows = static_cast<int>(header.rows);
  modes->mode_count = static_cast<int>(header.modes);
  modes->cell_count = static_cast<int>(header.cells);
  modes->key = header.key;
  const std::size_t cells = header.cells;
  Reader reader(bytes.subspan(sizeof header));
  modes->owner = reader.take<std::int32_t>(std::size_t{header.columns} * header.rows *
                                           kPartsPerCell * kPartsPerCell);
  modes->place = reader.take<std::int32_t>(cells);
  modes->around = reader.take<std::int32_t>(9 * cells);
  modes->eigenvalues_per_m2 = reader.take<double>(header.modes);
  modes->mean_squares = reader.take<double>(header.modes);
  modes->values = reader.take<float>(cells * header.modes);
  if (!reader.whole() || !is_sound(*modes)) return failure(damaged);
  modes->hash = XXH3_64bits(bytes.data(), bytes.size());
  modes->file = bytes;
  modes->storage = std::move(storage);
  return ModesTable(std::move(modes));
}

}  // namespace ergocast
