// SPDX-License-Identifier: BSD-3-Clause
// The folder of a study: study.json describes what is compared, study.csv has one row for each run.
// Later commands can add rows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "studies/study_table.h"

namespace ergocast::cli {

/// Limit (Studies): missions of a study. Beyond it: `study` refuses the study.
inline constexpr std::uint64_t kMostStudyRuns = 1000000;

/// A part of a study. Its runs are numbered seed by seed, and within a seed by point.
struct StudyShard {
  std::uint64_t index = 1, of = 1;  ///< from 1; every `of`-th run belongs to the shard
  std::uint64_t first_seed = 1, last_seed = 1;
  std::string command;                ///< makes the whole study, without --out
  std::vector<std::string> missions;  ///< the command of one mission of each point

  bool has(std::uint64_t run) const { return run % of == index - 1; }
  /// "shard 2/4 of seeds 1:100".
  std::string name() const;
};

/// A study and the hashes of its compiled points, which distinguish two studies of equal names.
struct StudyIdentity {
  studies::Study study;
  std::vector<std::string> plan_hashes;  ///< one for each point
  std::string version;
  std::vector<std::string> settings{};  ///< of all points, as --set takes them
  std::optional<StudyShard> shard{};    ///< nothing: the whole study
};

/// The reason why these are not shards of one study, or not one study without shards; empty if they
/// are.
std::string difference(const StudyIdentity& ours, const StudyIdentity& theirs);

/// Reads and checks the study in `folder`; an error is one sentence.
Result<StudyIdentity> read_identity(const std::filesystem::path& folder);

class StudyDirectory {
 public:
  /// Makes the folder, or continues the same study in it. An incomplete last line of its table is
  /// removed. An error if the folder belongs to another study, contains other files, or is in use
  /// by another process.
  /// @param identity  outlives this object
  static Result<std::unique_ptr<StudyDirectory>> open(const std::filesystem::path& folder,
                                                      const StudyIdentity& identity);
  StudyDirectory(const StudyDirectory&) = delete;
  StudyDirectory& operator=(const StudyDirectory&) = delete;
  ~StudyDirectory();

  const std::vector<studies::StudyRow>& rows() const { return rows_; }
  /// The runs of rows(): point and seed, ascending.
  std::vector<std::pair<std::size_t, std::uint64_t>> done() const;

  /// Appends a row and writes it to the file at once, as a whole. An error if it cannot be written.
  std::optional<std::string> add(const studies::StudyRow& row);
  /// Sorts rows and file by point and seed. An error if it cannot be written.
  std::optional<std::string> sort();

 private:
  StudyDirectory(std::filesystem::path folder, const StudyIdentity& identity, int lock);
  std::optional<std::string> read_rows();

  std::filesystem::path folder_;
  studies::StudyTable table_;
  int lock_ = -1, file_ = -1;
  std::vector<studies::StudyRow> rows_;
};

}  // namespace ergocast::cli
