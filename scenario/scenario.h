// SPDX-License-Identifier: BSD-3-Clause
// What a person writes (scenario.proto, text format), made a mission. The place that knows
// Protobuf's text; this header does not show it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "target/density_picture.h"
#include "core/mission.h"

namespace ergocast {

/// One thing wrong with a scenario.
struct Problem {
  std::string where;   ///< "file:line:column" or "file: field.path"
  std::string what;    ///< what is wrong, with the limit it breaks
  std::string remedy;  ///< what to write instead
};
/// "where: what (remedy)", one line.
std::string to_string(const Problem& problem);

/// A number, word or truth value for the field at `path`, such as "law.epsilon" or
/// "agents.starts[0].x_m", as the text format writes it.
struct FieldValue {
  std::string path, value;
  std::string flag;  ///< what its problems blame
};

/// What the command line says over the file.
struct Overrides {
  std::optional<std::uint64_t> seed{};
  std::optional<double> duration_s{};
  std::optional<Pace> pace{};
  std::optional<double> realtime_factor{};
  /// The team's size: the listed starts are cut, or random ones added.
  std::optional<int> agents{};
  /// In this order, after all others.
  std::vector<FieldValue> fields{};
};

inline constexpr std::size_t kMaxScenarioBytes = std::size_t{1} << 20;

/// A scenario without problems, all defaults filled in, random starts drawn.
class Scenario {
 public:
  /// Reads a file of at most kMaxScenarioBytes, puts `overrides` over it, validates the result and
  /// integrates its target, for which maps are read. All problems at once.
  static std::variant<Scenario, std::vector<Problem>> load(const std::filesystem::path& file,
                                                           const Overrides& overrides = {});
  /// The same for text; `file` is what the problems call it, and maps are in its folder.
  static std::variant<Scenario, std::vector<Problem>> parse(std::string_view text,
                                                            const std::string& file,
                                                            const Overrides& overrides = {});

  /// The same with another seed, random starts drawn anew: what load() would give with that seed.
  Scenario with_seed(std::uint64_t seed) const;

  Scenario(const Scenario&);
  Scenario(Scenario&&) noexcept;
  Scenario& operator=(Scenario) noexcept;
  ~Scenario();

  /// Text that load() reads back to an equal scenario: every field with its value, maps with their
  /// whole paths.
  std::string print() const;

  /// What it may do, but will hardly want. Only of what load() and parse() have read.
  const std::vector<Problem>& warnings() const;

  const std::string& name() const;
  const std::string& description() const;

  /// Whole paths of the files its target needs besides its own.
  std::vector<std::filesystem::path> map_files() const;

  /// What is to be covered, in multiples of the uniform density, for people to look at: at most 256
  /// cells along the longer side of the domain.
  const DensityGrid& target_density() const;

  /// The mission in the form the cores use, within_limits() of core/mission_limits.h. μ is computed
  /// once, here.
  const Mission& mission() const;

 private:
  struct State;
  explicit Scenario(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

}  // namespace ergocast
