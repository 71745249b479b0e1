// SPDX-License-Identifier: BSD-3-Clause
// Enumerates all combinations of values, compiles each scenario with them, and reports each problem
// once.
#include "cli/study/study_points.h"

#include <algorithm>
#include <map>
#include <set>

#include "cli/command_text.h"
#include "cli/debian_python.h"
#include "cli/study/python_law.h"
#include "plan/plan.h"
#include "runtime/process/program_options.h"
#include "studies/study_run.h"
#include "text/input_file.h"
#include "text/shell_word.h"

namespace ergocast::cli {
namespace {

constexpr std::size_t kMostPoints = 1000;

using Problems = std::vector<std::string>;

/// Problems of the request itself, before any file is read.
Problems problems_of(const StudyOptions& options) {
  Problems problems;
  std::set<std::string> fields, set;
  for (const FieldValue& field : options.settings) {
    set.insert(field.path);
    if (field.path == "seed")
      problems.push_back(field.flag + ": every point gets the same seeds (use --seeds)");
  }
  double points = static_cast<double>(options.scenarios.size());
  for (const Variation& variation : options.variations) {
    const std::string flag = "--vary " + variation.path;
    points *= static_cast<double>(variation.values.size());
    if (!fields.insert(variation.path).second) {
      problems.push_back(flag + ": is varied twice (give all its values in one --vary)");
    }
    if (set.contains(variation.path))
      problems.push_back(flag + ": --set sets it too (leave out one of them)");
    if (variation.path == "seed")
      problems.push_back(flag + ": every point gets the same seeds (use --seeds)");
    if (variation.path == "time.duration_s" && options.duration_s) {
      problems.push_back(flag + ": --duration sets it too (leave out one of them)");
    }
  }
  if (points > kMostPoints) {
    problems.push_back("--vary: " + std::to_string(static_cast<std::uint64_t>(points)) +
                       " combinations are above the limit " + std::to_string(kMostPoints) +
                       " (vary fewer fields at once)");
  }
  return problems;
}

/// Combination `index` of all values; the last field changes fastest.
std::vector<FieldValue> combination(const std::vector<Variation>& variations, std::size_t index) {
  std::vector<FieldValue> fields;
  for (auto variation = variations.rbegin(); variation != variations.rend(); ++variation) {
    const std::string& value = variation->values[index % variation->values.size()];
    index /= variation->values.size();
    fields.insert(fields.begin(),
                  {variation->path, value, "--vary " + variation->path + "=" + value});
  }
  return fields;
}

std::string words_of(const std::vector<FieldValue>& fields) {
  std::string text;
  for (const FieldValue& field : fields)
    text += (text.empty() ? "" : ", ") + field.path + "=" + field.value;
  return text;
}

/// Problems of one scenario's points. A problem of all points is reported for the file. Any other
/// problem is reported for its first point, unless it names a varied value itself.
class Complaints {
 public:
  void add(const std::vector<Problem>& problems, const std::string& point) {
    for (const Problem& problem : problems) add(to_string(problem), point);
  }
  void add(const std::string& problem, const std::string& point) {
    const auto [found, is_new] = first_.emplace(problem, Seen{point, 0});
    if (is_new) order_.push_back(problem);
    ++found->second.times;
  }
  void add_to(std::size_t points, Problems& out) const {
    for (const std::string& text : order_) {
      const Seen& seen = first_.at(text);
      const bool clear = seen.times == points || text.starts_with("--");
      out.push_back(clear ? text : text + ", with " + seen.point);
    }
  }

 private:
  struct Seen {
    std::string point;
    std::size_t times;
  };
  std::map<std::string, Seen> first_;
  std::vector<std::string> order_;
};

class Compiler {
 public:
  explicit Compiler(const StudyOptions& options) : options_(options) {
    for (const Variation& variation : options.variations) {
      combinations_ *= variation.values.size();
      points_.identity.study.fields.push_back(variation.path);
    }
    for (const FieldValue& field : options.settings)
      points_.identity.settings.push_back(field.path + '=' + field.value);
    points_.identity.version = version();
  }

  Result<StudyPoints, Problems> run() {
    for (const auto& file : options_.scenarios) compile(file);
    if (!problems_.empty()) return failure(problems_);
    for (const auto& [law, bytes] : law_files_) {
      const auto started = PythonLaw::start(law);
      if (!started) problems_.push_back(started.error());
    }
    if (!problems_.empty()) return failure(problems_);
    return std::move(points_);
  }

 private:
  void compile(const std::filesystem::path& file) {
    Complaints complaints;
    for (std::size_t i = 0; i < combinations_; ++i) {
      const std::vector<FieldValue> varied = combination(options_.variations, i);
      Overrides overrides{.duration_s = options_.duration_s, .fields = options_.settings};
      overrides.fields.insert(overrides.fields.end(), varied.begin(), varied.end());
      const std::string law = take_python_law(overrides.fields).value_or("");
      const auto loaded = Scenario::load(file, overrides);
      if (loaded) {
        if (!law.empty()) read_law(law);
        const auto why = law.empty() ? std::nullopt : studies::why_not_in_python(loaded->mission());
        if (why) complaints.add(law + ": " + *why, words_of(varied));
        add(*loaded, varied, file, law);
        points_.missions.push_back(
            (law.empty() ? std::string("ergocast run ")
                         : std::string(kPython) + " -m ergocast --law " + shell_word(law) + ' ') +
            shell_word(file.string()) + options_of(overrides));
      } else {
        complaints.add(loaded.error(), words_of(varied));
      }
    }
    complaints.add_to(combinations_, problems_);
  }

  /// Reads a law's file: a study is another one if the law has changed.
  void read_law(const std::string& law) {
    if (law_files_.contains(law)) return;
    const auto read = read_whole(file_of_law(law), kMostLawBytes);
    if (!read) problems_.push_back(read.error().sentence(file_of_law(law)));
    law_files_[law] = read.value_or("");
  }

  /// A number that identifies a point's mission, with any seed, and its law.
  std::string hash_of(const Scenario& scenario, const std::string& law) const {
    auto bytes = encode_plan(scenario.with_seed(0).mission());
    if (law.empty()) return plan_hash(bytes);
    for (const char letter : law + '\0' + law_files_.at(law))
      bytes.push_back(static_cast<std::byte>(letter));
    return plan_hash(bytes);
  }

  void add(const Scenario& scenario, const std::vector<FieldValue>& fields,
           const std::filesystem::path& file, const std::string& law) {
    studies::StudyPoint point;
    point.scenario = scenario.name();
    for (const FieldValue& field : fields) point.values.push_back(field.value);
    point.agents = static_cast<int>(scenario.mission().starts_m.size());
    const Timing& timing = scenario.mission().timing;
    point.duration_s = static_cast<double>(timing.tick_count) * timing.dt_s;
    const std::string hash = hash_of(scenario, law);
    const std::string text = file.string() + (fields.empty() ? "" : " with " + words_of(fields));
    const auto [twin, is_new] = plans_.emplace(hash, text);
    if (!is_new)
      problems_.push_back(text + ": is the same mission as " + twin->second +
                          " (leave out one of them)");
    const auto [namesake, alone] = names_.emplace(point.scenario, file);
    if (!alone && namesake->second != file) {
      problems_.push_back(file.string() + ": is called " + point.scenario + " like " +
                          namesake->second.string() + " (give one of them another name)");
    }
    points_.identity.study.points.push_back(std::move(point));
    points_.identity.plan_hashes.push_back(hash);
    points_.scenarios.push_back(scenario);
    points_.laws.push_back(law);
  }

  const StudyOptions& options_;
  std::size_t combinations_ = 1;
  std::map<std::string, std::string> plans_;
  std::map<std::string, std::string> law_files_;  // the bytes of each law in Python
  std::map<std::string, std::filesystem::path> names_;
  StudyPoints points_;
  Problems problems_;
};

}  // namespace

Result<StudyPoints, Problems> study_points(const StudyOptions& options) {
  Problems problems = problems_of(options);
  if (!problems.empty()) return failure(problems);
  return Compiler(options).run();
}

}  // namespace ergocast::cli
