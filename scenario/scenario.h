// SPDX-License-Identifier: BSD-3-Clause
// What a person writes (scenario.proto, text format) and what the team gets (the compiled plan).
// The only place that knows Protobuf; this header does not show it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
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

  /// The scenario in a compiled plan, with the plan's μ and without description and target; of the
  /// same bytes, if it is compiled again. A sentence if they are not a plan, are another version's, or
  /// break a limit of the scenario: plans come from the network.
  static std::variant<Scenario, std::string> from_plan(std::span<const std::byte> plan) noexcept;

  /// The same with another seed, random starts drawn anew: what load() would give with that seed.
  Scenario with_seed(std::uint64_t seed) const;

  Scenario(const Scenario&);
  Scenario(Scenario&&) noexcept;
  Scenario& operator=(Scenario) noexcept;
  ~Scenario();

  /// Text that load() reads back to an equal scenario: every field with its value, maps with their
  /// whole paths. That of a plan lacks the target, without which load() refuses it.
  std::string print() const;

  /// What it may do, but will hardly want. Only of what load() and parse() have read.
  const std::vector<Problem>& warnings() const;

  const std::string& name() const;
  const std::string& description() const;

  /// Whole paths of the files its target needs besides its own. Empty for a plan.
  std::vector<std::filesystem::path> map_files() const;

  /// What is to be covered, in multiples of the uniform density, for people to look at: at most 256
  /// cells along the longer side of the domain. Empty for a plan.
  const DensityGrid& target_density() const;

  /// The mission in the form the cores use. μ is computed once, here.
  const Mission& mission() const;

  /// The compiled plan as the coordinator sends it: the mission with μ and all starts, no file
  /// needed by who receives it. Equal scenarios of one version give equal bytes.
  const std::vector<std::byte>& plan() const;

 private:
  struct State;
  explicit Scenario(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

/// The mission of from_plan(), or what is wrong with the plan.
std::variant<Mission, std::string> decode_plan(std::span<const std::byte> plan) noexcept;

/// 32 hex digits that name a plan: XXH3-128 of its bytes.
std::string plan_hash(std::span<const std::byte> plan);

}  // namespace ergocast
