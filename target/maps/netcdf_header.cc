// SPDX-License-Identifier: BSD-3-Clause
// Reads the lists of the header one after the other, and refuses each length that exceeds the rest
// of the file. https://docs.unidata.ucar.edu/nug/current/file_format_specifications.html
#include "target/maps/netcdf_header.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "text/input_file.h"

namespace ergocast {
namespace {

struct Overrun {};

std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  if (__builtin_mul_overflow(a, b, &result)) throw Overrun();
  return result;
}
std::uint64_t sum(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  if (__builtin_add_overflow(a, b, &result)) throw Overrun();
  return result;
}
std::uint64_t padded(std::uint64_t bytes) { return sum(bytes, 3) / 4 * 4; }

class HeaderReader {
 public:
  explicit HeaderReader(const std::filesystem::path& file) : in_(file) {
    in_.seekg(0, std::ios::end);
    left_ = static_cast<std::uint64_t>(std::max<std::streamoff>(0, in_.tellg()));
    in_.seekg(0);
  }

  NetcdfHeader read() {
    std::array<char, 3> word{};
    if (left_ < 4 || !in_.read(word.data(), word.size()) ||
        std::string_view(word.data(), word.size()) != "CDF")
      return {};
    version_ = in_.get();
    if (version_ != 1 && version_ != 2 && version_ != 5) return {};
    left_ -= 4;
    const std::uint64_t records = count();
    // A program that still writes the file does not store how many.
    const bool still_grows = records == (version_ == 5 ? ~std::uint64_t{0} : 0xffffffffU);
    records_ = still_grows ? 0 : records;
    read_dimensions();
    skip_attributes();
    read_variables();
    return ends();
  }

 private:
  struct Variable {
    std::string name;
    std::uint64_t bytes;  // of a record, or of all of it
    std::uint64_t begin;
    bool in_records;
  };

  std::uint64_t number(int bytes) {
    take(static_cast<std::uint64_t>(bytes));
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) value = value << 8 | static_cast<unsigned char>(in_.get());
    return value;
  }
  std::uint64_t count() { return number(version_ == 5 ? 8 : 4); }
  void take(std::uint64_t bytes) {
    if (bytes > left_) throw Overrun();
    left_ -= bytes;
  }
  void skip(std::uint64_t bytes) {
    take(bytes);
    in_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur);
  }
  /// How many entries follow; each has at least eight bytes.
  std::uint64_t list() {
    number(4);  // its tag, or zero
    const std::uint64_t entries = count();
    if (entries > left_ / 8) throw Overrun();
    return entries;
  }
  std::string name() {
    constexpr std::uint64_t kLongest = 256;  // NC_MAX_NAME
    const std::uint64_t bytes = count();
    if (bytes > kLongest) throw Overrun();
    take(padded(bytes));
    std::string text(padded(bytes), '\0');
    in_.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(bytes);
    return text;
  }

  std::uint64_t bytes_of_type() {
    constexpr std::array<std::uint64_t, 12> kBytes = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const std::uint64_t type = number(4);
    if (type == 0 || type >= kBytes.size()) throw Overrun();
    return kBytes[type];
  }

  void read_dimensions() {
    for (std::uint64_t left = list(); left > 0; --left) {
      name();
      lengths_.push_back(count());  // 0: it grows with the records
    }
  }

  void skip_attributes() {
    for (std::uint64_t left = list(); left > 0; --left) {
      name();
      const std::uint64_t bytes = bytes_of_type();
      skip(padded(product(count(), bytes)));
    }
  }

  void read_variables() {
    for (std::uint64_t left = list(); left > 0; --left) {
      Variable variable{name(), 1, 0, false};
      std::uint64_t dimensions = count();
      for (bool first = true; dimensions > 0; --dimensions, first = false) {
        const std::uint64_t id = count();
        if (id >= lengths_.size()) throw Overrun();
        const std::uint64_t length = lengths_[id];
        if (first && length == 0) {
          variable.in_records = true;
        } else {
          variable.bytes = product(variable.bytes, length);
        }
      }
      skip_attributes();
      variable.bytes = product(variable.bytes, bytes_of_type());
      count();  // its size again, which may be too large for this field
      variable.begin = number(version_ == 1 ? 4 : 8);
      variables_.push_back(std::move(variable));
    }
  }

  NetcdfHeader ends() const {
    std::uint64_t record = 0, in_records = 0;
    for (const Variable& variable : variables_) {
      if (!variable.in_records) continue;
      record = sum(record, padded(variable.bytes));
      ++in_records;
    }
    NetcdfHeader header;
    for (const Variable& variable : variables_) {
      if (in_records == 1 && variable.in_records) record = variable.bytes;  // it has no padding
      std::uint64_t end = sum(variable.begin, variable.bytes);
      if (variable.in_records) {
        end = records_ == 0 ? 0 : sum(end, product(record, records_ - 1));
      }
      header.bytes_up_to.emplace(variable.name, end);
    }
    return header;
  }

  InputFile in_;
  std::uint64_t left_ = 0;  // bytes of the file after those that were read
  int version_ = 0;
  std::uint64_t records_ = 0;
  std::vector<std::uint64_t> lengths_;  // of the dimensions
  std::vector<Variable> variables_;
};

}  // namespace

std::optional<NetcdfHeader> read_netcdf_header(const std::filesystem::path& file) {
  try {
    return HeaderReader(file).read();
  } catch (const Overrun&) {
    return std::nullopt;
  }
}

}  // namespace ergocast
