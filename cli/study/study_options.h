// SPDX-License-Identifier: BSD-3-Clause
// The options of `ergocast study` and `ergocast study merge`.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/mission_options.h"
#include "cli/study/study_directory.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

/// A field and the values that the study gives it.
struct Variation {
  std::string path;
  std::vector<std::string> values;
};

/// The options of `study`.
struct StudyOptions {
  std::vector<std::filesystem::path> scenarios;
  std::vector<FieldValue> settings;  ///< of every mission
  std::vector<Variation> variations;
  std::optional<double> duration_s;
  Seeds seeds;
  std::optional<StudyShard> shard;  ///< index and number only
  int jobs = 1;
  std::filesystem::path out;
  std::vector<std::string> measures;  ///< columns of study.csv
};

void add_study_options(CLI::App& command, StudyOptions& options);

/// --shard I/N.
void add_shard_option(CLI::App& command, std::optional<StudyShard>& shard,
                      const std::string& meaning);

/// The options of `study merge`.
struct MergeOptions {
  std::vector<std::filesystem::path> shards;  ///< their folders
  std::filesystem::path out;
  std::vector<std::string> measures;  ///< as of StudyOptions
};

/// The subcommand `merge` of `study`, whose options are not those of `study`.
CLI::App* add_merge(CLI::App& study, MergeOptions& options);

/// Makes the folder of the whole study of its shards; returns the program's exit code.
int merge_studies(const MergeOptions& options);

}  // namespace ergocast::cli
