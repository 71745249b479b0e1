// SPDX-License-Identifier: BSD-3-Clause
// The mock autopilots of reference/fleet.cjs as a process whose time is the test's.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ergocast::mavlink {

class MockFleet {
 public:
  using Bytes = std::vector<std::byte>;
  static constexpr std::chrono::milliseconds kStep{20};

  struct Step {
    std::vector<std::pair<std::size_t, Bytes>> frames;
    std::vector<std::array<double, 3>> at;  ///< latitude, longitude, height of each vehicle
    nlohmann::json states;
    std::vector<std::array<double, 3>> wanted_mps;  ///< north, east and up, of each autopilot
  };
  /// Place and velocity to the north, to the east and upwards, from where the vehicle began.
  using Body = std::array<double, 6>;

  /// @param options  those of vehicle.cjs, for each vehicle
  MockFleet(const std::string& program, const std::string& folder, const nlohmann::json& options) {
    std::array<int, 2> to{}, from{};
    if (pipe(to.data()) != 0 || pipe(from.data()) != 0) throw std::runtime_error("no pipe");
    child_ = fork();
    if (child_ == 0) {
      dup2(to[0], STDIN_FILENO);
      dup2(from[1], STDOUT_FILENO);
      for (const int fd : {to[0], to[1], from[0], from[1]}) close(fd);
      execlp("node", "node", program.c_str(), folder.c_str(), nullptr);
      _exit(127);
    }
    close(to[0]);
    close(from[1]);
    in_ = fdopen(to[1], "w");
    out_ = fdopen(from[0], "r");
    write(options);
  }
  MockFleet(const MockFleet&) = delete;
  MockFleet& operator=(const MockFleet&) = delete;
  ~MockFleet() {
    std::fclose(in_);
    std::fclose(out_);
    std::free(line_);
    waitpid(child_, nullptr, 0);
  }

  /// Passes on what the vehicles and pilots get, and then 20 ms.
  /// @param bodies  where the vehicles are then; none: they move by dynamics of their own
  Step step(std::chrono::nanoseconds time, const std::vector<std::pair<std::size_t, Bytes>>& frames,
            const std::vector<std::pair<std::size_t, std::string>>& pilot, bool states,
            const std::vector<Body>& bodies) {
    auto hex = nlohmann::json::array();
    for (const auto& [vehicle, bytes] : frames) hex.push_back({vehicle, hex_of(bytes)});
    write({{"ns", std::to_string(time.count())},
           {"frames", std::move(hex)},
           {"pilot", pilot},
           {"states", states},
           {"bodies", bodies}});
    if (getline(&line_, &size_, out_) < 0) throw std::runtime_error("the mock fleet has ended");
    const auto read = nlohmann::json::parse(line_);
    Step step;
    for (const auto& one : read["frames"])
      step.frames.emplace_back(one[0], bytes_of(one[1].get_ref<const std::string&>()));
    step.at = read["at"];
    step.states = read["states"];
    step.wanted_mps = read["wanted"];
    return step;
  }

 private:
  void write(const nlohmann::json& line) {
    const std::string text = line.dump() + "\n";
    if (std::fputs(text.c_str(), in_) < 0 || std::fflush(in_) != 0)
      throw std::runtime_error("the mock fleet reads nothing");
  }
  static std::string hex_of(const Bytes& bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text;
    for (const std::byte byte : bytes) {
      text += kDigits[std::to_integer<unsigned>(byte) >> 4];
      text += kDigits[std::to_integer<unsigned>(byte) & 15];
    }
    return text;
  }
  static Bytes bytes_of(const std::string& hex) {
    const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
      bytes.push_back(static_cast<std::byte>(digit(hex[i]) * 16 + digit(hex[i + 1])));
    return bytes;
  }

  pid_t child_ = -1;
  std::FILE *in_ = nullptr, *out_ = nullptr;
  char* line_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace ergocast::mavlink
