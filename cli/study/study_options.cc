// SPDX-License-Identifier: BSD-3-Clause
// Reads lists of values and shards as the command line of `study` has them.
#include "cli/study/study_options.h"

#include <algorithm>
#include <string_view>

#include "runtime/process/shipped_scenarios.h"
#include "scenario/parse/override_options.h"
#include "studies/study_table.h"
#include "text/read_number.h"

namespace ergocast::cli {
namespace {

/// "field=a,b,c".
Variation parse_variation(const std::string& text) {
  const auto refuse = [&text](const std::string& why) {
    throw CLI::ValidationError("--vary", "\"" + text + "\" " + why);
  };
  const auto [path, list] = split_field(text, "--vary", "FIELD=VALUE,VALUE…");
  Variation variation{path, {}};
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string value = list.substr(begin, end - begin);
    if (value.find_first_not_of(" \t") == std::string::npos) refuse("has an empty value");
    const auto& values = variation.values;
    if (std::find(values.begin(), values.end(), value) != values.end())
      refuse("has " + value + " twice");
    variation.values.push_back(value);
    begin = end + 1;
  }
  return variation;
}

/// "I/N".
StudyShard parse_shard(const std::string& text) {
  const std::string_view view = text;
  const std::size_t slash = std::min(view.find('/'), view.size());
  const auto index = read_number<std::uint64_t>(view.substr(0, slash));
  const auto of = read_number<std::uint64_t>(view.substr(std::min(slash + 1, view.size())));
  if (!index || !of || *index < 1 || *index > *of || *of > kMostStudyRuns) {
    throw CLI::ValidationError("--shard",
                               "\"" + text + "\" is not I/N with I from 1 to N, such as 2/8");
  }
  StudyShard shard;
  shard.index = *index;
  shard.of = *of;
  return shard;
}

/// `--measure NAME`, of which each adds a table.
void add_measure_option(CLI::App& command, std::vector<std::string>& measures) {
  std::vector<std::string> names;
  for (const studies::Quantity& quantity : studies::quantities()) names.push_back(quantity.column);
  command
      .add_option(
          "--measure", measures,
          "Also print this column of study.csv: its median, and its ratio to the first row's; "
          "once for each")
      ->check(CLI::IsMember(names))
      ->allow_extra_args(false)
      ->type_name("COLUMN");
}

}  // namespace

void add_study_options(CLI::App& command, StudyOptions& options) {
  command.add_option("SCENARIO", options.scenarios, "Scenario files, or names of shipped ones")
      ->transform(shipped_scenario())
      ->type_name("FILE");
  command
      .add_option_function<std::vector<std::string>>(
          "--vary",
          [&options](const std::vector<std::string>& texts) {
            for (const std::string& text : texts)
              options.variations.push_back(parse_variation(text));
          },
          "A field and its values, such as law.noise_intensity=0,0.1,1; once for each field")
      ->allow_extra_args(false)
      ->type_name("FIELD=VALUE,…");
  add_set_option(command, options.settings);
  add_seeds_option(command, options.seeds, "One mission of every combination for each seed")
      ->required();
  add_shard_option(
      command, options.shard,
      "Only part I of N of the missions; `study merge` joins the folders of all parts");
  command.add_option("--out", options.out, "The study's folder: new, or one to continue")
      ->required()
      ->type_name("DIR");
  command.add_option("--duration", options.duration_s, "Mission time [s]");
  add_jobs_option(command, options.jobs);
  add_measure_option(command, options.measures);
}

void add_shard_option(CLI::App& command, std::optional<StudyShard>& shard,
                      const std::string& meaning) {
  command
      .add_option_function<std::string>(
          "--shard", [&shard](const std::string& text) { shard = parse_shard(text); }, meaning)
      ->type_name("I/N");
}

CLI::App* add_merge(CLI::App& study, MergeOptions& options) {
  auto* command = study.add_subcommand("merge", "Join the folders of all shards of one study");
  command->add_option("FOLDER", options.shards, "The folder of each shard")
      ->required()
      ->type_name("DIR");
  command->add_option("--out", options.out, "The study's folder: new or empty")
      ->required()
      ->type_name("DIR");
  add_measure_option(*command, options.measures);
  command->preparse_callback([&study](std::size_t) {
    for (CLI::Option* option : study.get_options()) {
      if (option->count() > 0) throw CLI::ValidationError("merge", "stands before all options");
      option->required(false);
    }
  });
  return command;
}

}  // namespace ergocast::cli
