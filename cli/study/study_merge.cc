// SPDX-License-Identifier: BSD-3-Clause
// `ergocast study merge`: checks that the folders are all shards of one study, complete and without
// repetition. Writes the folder that one command would have made.
#include <cstdio>
#include <map>

#include "cli/report_error.h"
#include "cli/study/study_directory.h"
#include "cli/study/study_options.h"
#include "cli/study/study_results.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

/// One folder of the command line.
struct Part {
  fs::path folder;
  StudyIdentity identity;
  const StudyShard& shard() const { return *identity.shard; }
};

/// The shards in the order of the command line, or the error of the first folder that is no shard.
Result<std::vector<Part>> parts_of(const std::vector<fs::path>& folders) {
  std::vector<Part> parts;
  for (const fs::path& folder : folders) {
    auto read = read_identity(folder);
    const std::string name = folder.string() + ": ";
    if (!read) return failure(name + read.error());
    parts.push_back({folder, *std::move(read)});
    if (!parts.back().identity.shard)
      return failure(name + "is no shard of a study (give --shard to it)");
  }
  return parts;
}

/// The reason why the parts are not all shards of one study, each once; nullopt if they are.
std::optional<std::string> mismatch(const std::vector<Part>& parts) {
  const Part& first = parts.front();
  const StudyShard& one = first.shard();
  if (first.identity.version != version()) {
    return first.folder.string() + ": was run with ergocast " + first.identity.version +
           ", this is " + version() + " (merge with the version that ran it)";
  }
  std::map<std::uint64_t, fs::path> by_index;
  for (const Part& part : parts) {
    const StudyShard& shard = part.shard();
    const std::string name = part.folder.string() + ": ";
    if (const auto why = difference(first.identity, part.identity); !why.empty())
      return name + why + "; it is no shard of the study in " + first.folder.string();
    if (shard.of != one.of || shard.first_seed != one.first_seed ||
        shard.last_seed != one.last_seed) {
      return name + "is " + shard.name() + ", but " + first.folder.string() + " is " + one.name();
    }
    const auto [twin, is_new] = by_index.emplace(shard.index, part.folder);
    if (!is_new)
      return name + "is " + shard.name() + ", and so is " + twin->second.string() +
             " (name each shard once)";
  }
  if (by_index.size() == one.of) return std::nullopt;
  std::uint64_t missing = 1;
  while (by_index.contains(missing)) ++missing;
  return std::to_string(one.of - by_index.size()) + " of " + std::to_string(one.of) +
         " shards are missing, the first is " + std::to_string(missing) + '/' +
         std::to_string(one.of) + " (name its folder, too)";
}

/// The rows of a complete shard, or an error.
Result<std::vector<studies::StudyRow>> rows_of(const Part& part) {
  const auto opened = StudyDirectory::open(part.folder, part.identity);
  if (!opened) return failure(opened.error());
  const StudyDirectory& directory = **opened;
  const StudyShard& shard = part.shard();
  const std::uint64_t points = part.identity.study.points.size();
  std::uint64_t runs = (shard.last_seed - shard.first_seed + 1) * points, own = 0;
  for (std::uint64_t run = 0; run < runs; ++run) own += shard.has(run) ? 1 : 0;
  const auto done = directory.done();
  for (std::size_t i = 0; i < done.size(); ++i) {
    const auto& [point, seed] = done[i];
    const bool foreign = seed < shard.first_seed || seed > shard.last_seed ||
                         !shard.has((seed - shard.first_seed) * points + point);
    if (foreign || (i > 0 && done[i] == done[i - 1])) {
      return failure(part.folder.string() + ": its study.csv has a run that is " +
                     (foreign ? "of another shard" : "there already") + ", of seed " +
                     std::to_string(seed) + " (remove the line)");
    }
  }
  if (done.size() == own) return directory.rows();
  return failure(part.folder.string() + ": " + std::to_string(own - done.size()) + " of its " +
                 std::to_string(own) + " runs are missing (the command that made it runs them)");
}

Result<std::vector<studies::StudyRow>> all_rows(const std::vector<Part>& parts) {
  std::vector<studies::StudyRow> rows;
  for (const Part& part : parts) {
    auto read = rows_of(part);
    if (!read) return failure(read.error());
    const auto& more = *read;
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

}  // namespace

int merge_studies(const MergeOptions& options) {
  const auto read = parts_of(options.shards);
  if (!read) return report_error(kExitBadInput, read.error());
  const auto& parts = *read;
  if (const auto problem = mismatch(parts)) return report_error(kExitBadInput, *problem);
  const auto merged = all_rows(parts);
  if (!merged) return report_error(kExitBadInput, merged.error());

  std::error_code error;
  if (fs::exists(options.out, error) && !fs::is_empty(options.out, error)) {
    return report_error(kExitBadInput, "--out " + options.out.string() +
                                           ": is not empty; give a new folder, or empty this one");
  }
  StudyIdentity whole = parts.front().identity;
  whole.shard.reset();
  const auto opened = StudyDirectory::open(options.out, whole);
  if (!opened) return report_error(kExitBadInput, opened.error());
  StudyDirectory& directory = **opened;
  std::optional<std::string> problem;
  for (const auto& row : *merged) {
    if (!problem) problem = directory.add(row);
  }
  const StudyShard& shard = parts.front().shard();
  if (!problem) {
    problem = conclude(directory, {whole.study, shard.command, shard.missions, shard.first_seed,
                                   options.out, options.measures});
  }
  if (problem) return report_error(kExitFailed, *problem);
  std::printf("\n%zu runs of %zu shards in %s\nreport: %s\n", directory.rows().size(), parts.size(),
              (options.out / "study.csv").c_str(),
              (fs::absolute(options.out) / "report.html").c_str());
  return kExitDone;
}

}  // namespace ergocast::cli
