// SPDX-License-Identifier: BSD-3-Clause
// The folder of a study: study.json says what is compared, study.csv has one row a run. It outlives
// the calls that add to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lab/studies/study_table.h"

namespace ergocast::cli {

/// A study and what its points are compiled to, which tells two studies of equal names apart.
struct StudyIdentity {
  studies::Study study;
  std::vector<std::string> plan_hashes;  ///< one a point
  std::string version;
};

class StudyDirectory {
 public:
  /// Makes the folder, or goes on in one where the same study has begun. A torn last line of its
  /// table is taken off. What is wrong otherwise: another study's folder, one with other files, one
  /// in which somebody else is at work.
  /// @param identity  outlives it
  static std::variant<std::unique_ptr<StudyDirectory>, std::string> open(
      const std::filesystem::path& folder, const StudyIdentity& identity);
  StudyDirectory(const StudyDirectory&) = delete;
  StudyDirectory& operator=(const StudyDirectory&) = delete;
  ~StudyDirectory();

  const std::vector<studies::StudyRow>& rows() const { return rows_; }
  /// The runs of rows(): point and seed, ascending.
  std::vector<std::pair<std::size_t, std::uint64_t>> done() const;

  /// A row more, in the file at once and whole. What is wrong, if it cannot be written.
  std::optional<std::string> add(const studies::StudyRow& row);
  /// Puts rows and file in the order of points and seeds. What is wrong, if it cannot be written.
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
