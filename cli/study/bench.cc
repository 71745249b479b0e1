// SPDX-License-Identifier: BSD-3-Clause
// `ergocast bench`: completes the options and becomes Python, whose module ergocast.bench.command
// runs the studies and makes the table.
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/debian_python.h"
#include "cli/study/study_options.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

struct BenchOptions {
  bool quick = false, own = false, published = false;
  std::vector<std::string> targets, laws;
  std::vector<int> agents;
  std::vector<fs::path> added;
  std::optional<Seeds> seeds;
  std::optional<StudyShard> shard;
  int jobs = 1;
  fs::path out;
};

template <class Texts>
std::string joined(const Texts& texts) {
  std::string list;
  for (const auto& text : texts) list += (list.empty() ? "" : ",") + text;
  return list;
}

std::string agents_text(const BenchOptions& options) {
  if (options.agents.empty()) return options.quick ? "4" : "1,4,16";
  std::vector<std::string> texts;
  for (const int agents : options.agents) texts.push_back(std::to_string(agents));
  return joined(texts);
}

std::string seeds_text(const BenchOptions& options) {
  const Seeds seeds = options.seeds.value_or(Seeds{1, options.quick ? 3U : 30U});
  return std::to_string(seeds.first) + ':' + std::to_string(seeds.last);
}

int bench(const BenchOptions& options) {
  std::string targets = joined(options.targets);
  if (targets.empty() && options.quick) targets = "four_peaks,uniform,two_far";
  std::error_code error;
  std::vector<std::string> words{"--program", fs::read_symlink("/proc/self/exe", error),
                                 "--out",     options.out,
                                 "--targets", targets,
                                 "--agents",  agents_text(options),
                                 "--seeds",   seeds_text(options),
                                 "--jobs",    std::to_string(options.jobs)};
  if (options.own) words.emplace_back("--own");
  if (options.published) words.emplace_back("--published");
  if (const auto& shard = options.shard) {
    words.push_back("--shard");
    words.push_back(std::to_string(shard->index) + '/' + std::to_string(shard->of));
  }
  for (const std::string& law : options.laws) words.push_back("--law=" + law);
  for (const fs::path& file : options.added) words.push_back("--add=" + file.string());
  return become_python("ergocast.bench.command", words, "no bench: it needs");
}

}  // namespace

void add_bench(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "bench", "Compare laws of papers, and yours, on nine targets; needs python3-ergocast");
  auto options = std::make_shared<BenchOptions>();
  command->add_option("--out", options->out, "The folder of the bench: new, or one to continue")
      ->required()
      ->type_name("DIR");
  command->add_flag("--quick", options->quick,
                    "By default three targets, four agents and three seeds: minutes");
  auto* law = command
                  ->add_option("--law", options->laws,
                               "Also this law in Python, on every target; once for each")
                  ->allow_extra_args(false)
                  ->type_name("FILE.py:CLASS");
  command->add_flag("--own", options->own, "Only the laws of --law; --published brings the others")
      ->needs(law);
  command->add_flag("--published", options->published,
                    "Also the published rows, those of docs/results/bench.md");
  command
      ->add_option("--add", options->added,
                   "Also the rows of this file, which has the form of rows.csv; once for each")
      ->check(CLI::ExistingFile)
      ->allow_extra_args(false)
      ->type_name("FILE.csv");
  command->add_option("--only", options->targets, "These targets (default: all)")
      ->delimiter(',')
      ->type_name("TARGET,…");
  command->add_option("--agents", options->agents, "Team sizes (default: 1,4,16)")
      ->delimiter(',')
      ->check(CLI::Range(1, 1000))
      ->type_name("N,…");
  auto seeds = std::make_shared<Seeds>();
  auto* seeds_option = add_seeds_option(
      *command, *seeds, "One mission of every combination for each seed (default: 1:30)");
  add_shard_option(*command, options->shard,
                   "Only part I of N of each study; one --out serves all parts");
  add_jobs_option(*command, options->jobs);
  command->callback([&action, options, seeds, seeds_option] {
    if (seeds_option->count() > 0) options->seeds = *seeds;
    action = [options] { return bench(*options); };
  });
}

}  // namespace ergocast::cli
