// SPDX-License-Identifier: BSD-3-Clause
// Our codec for a test that compares it with another implementation: a message a line, as JSON.
//
//   mavlink-lines write SEED [KEY]   messages with random fields, and their frames in hexadecimal
//   mavlink-lines read [KEY]         reads frames in hexadecimal; prints the messages in them
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "bridges/mavlink/frame_reader.h"
#include "bridges/mavlink/frame_writer.h"

namespace {

using namespace ergocast::mavlink;
using nlohmann::json;

constexpr std::uint64_t kTime = 30'000'000'000'000;

/// Numbers of any size; every third is 0, so that zeros at the end are cut.
struct Draw {
  std::mt19937_64& dice;

  template <class T>
  void field(const char*, T& value) {
    if (dice() % 3 == 0) return value = 0, void();
    if constexpr (std::is_same_v<T, float>) {
      value = std::ldexp(static_cast<float>(static_cast<std::int32_t>(dice())),
                         static_cast<int>(dice() % 60) - 50);
    } else {
      value = static_cast<T>(dice());
    }
  }
  void field(const char*, Text50& text) {
    const std::size_t length = dice() % 51;
    for (std::size_t i = 0; i < 50; ++i)
      text[i] = i < length ? static_cast<char>('a' + dice() % 26) : '\0';
  }
  template <std::size_t N>
  void field(const char* name, Cells<N>& all) {
    for (auto& value : all) field(name, value);
  }
  void extension(const char* name, auto& value) { field(name, value); }
};

struct Show {
  json& out;

  template <class T>
  void field(const char* name, const T& value) {
    if constexpr (sizeof(T) == 8) {
      out[name] = std::to_string(value);
    } else {
      out[name] = value;
    }
  }
  void field(const char* name, const Text50& text) { out[name] = text_of(text); }
  template <std::size_t N>
  void field(const char* name, const Cells<N>& all) {
    out[name] = all;
  }
  void extension(const char* name, const auto& value) { field(name, value); }
};

json shown(const Packet& packet, const Source& from) {
  json fields;
  const char* name = std::visit(
      [&](const auto& m) {
        Show io{fields};
        m.list(io, m);
        return m.kName;
      },
      packet);
  return {
      {"name", name}, {"system", from.system}, {"component", from.component}, {"fields", fields}};
}

std::string hex_of(const std::vector<std::byte>& bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    for (const int half : {std::to_integer<int>(byte) >> 4, std::to_integer<int>(byte) & 15})
      text += "0123456789abcdef"[half];
  }
  return text;
}

std::vector<std::byte> bytes_of(const std::string& hex) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::byte>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

std::optional<SigningKey> key_in(int argc, char** argv, int place) {
  if (argc <= place) return std::nullopt;
  SigningKey key{};
  const auto bytes = bytes_of(argv[place]);
  std::copy_n(bytes.begin(), std::min(bytes.size(), key.size()), key.begin());
  return key;
}

template <std::size_t... kAt>
std::vector<Packet> one_of_each(std::index_sequence<kAt...>) {
  return {Packet(std::in_place_index<kAt>)...};
}

void write(unsigned seed, const std::optional<SigningKey>& key) {
  std::mt19937_64 dice(seed);
  FrameWriter writer(key, kTime);
  for (Packet& packet : one_of_each(std::make_index_sequence<std::variant_size_v<Packet>>())) {
    std::visit(
        [&](auto& m) {
          Draw io{dice};
          m.list(io, m);
        },
        packet);
    const Source from{static_cast<std::uint8_t>(dice()), static_cast<std::uint8_t>(dice())};
    json line = shown(packet, from);
    line["frame"] = hex_of(writer.frame_of(packet, from));
    std::cout << line.dump() << "\n";
  }
}

void read(const std::optional<SigningKey>& key) {
  FrameReader reader(key, kTime);
  for (std::string line; std::getline(std::cin, line);) {
    std::vector<Received> all;
    reader.read(bytes_of(line), all);
    for (const Received& one : all) std::cout << shown(one.packet, one.from).dump() << "\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2 && std::string(argv[1]) == "write") {
    write(static_cast<unsigned>(std::stoul(argv[2])), key_in(argc, argv, 3));
  } else if (argc > 1 && std::string(argv[1]) == "read") {
    read(key_in(argc, argv, 2));
  } else {
    return 2;
  }
  return 0;
}
