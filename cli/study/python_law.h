// SPDX-License-Identifier: BSD-3-Clause
// A law that a person has written in Python, for the missions of a study: law.kind=FILE.py:CLASS.
//
// A mission runs in a Python of its own, whose module ergocast has the code of this program
// (python/ergocast/_study.py). Each worker has one, so runs are as parallel as with our laws.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "scenario/scenario.h"
#include "studies/study_run.h"

namespace ergocast::cli {

/// Takes the last law.kind that names a law in Python out of `fields`, and all others with it.
/// Nothing if there is none.
std::optional<std::string> take_python_law(std::vector<FieldValue>& fields);

/// Limit (Studies): length of a law's file in Python [bytes]. Beyond it: `study` refuses the law.
inline constexpr std::size_t kMostLawBytes = std::size_t{1} << 24;

/// The file of FILE.py:CLASS.
std::string file_of_law(const std::string& law);

class PythonLaw {
 public:
  /// Starts Python with a law, FILE.py:CLASS. An error, which names the law, if Python cannot be
  /// started, the file cannot be run, or the class is no law.
  static Result<std::unique_ptr<PythonLaw>> start(const std::string& law);
  PythonLaw(const PythonLaw&) = delete;
  PythonLaw& operator=(const PythonLaw&) = delete;
  ~PythonLaw();

  /// Runs the mission of a compiled plan under a new object of the class; an error of the law.
  Result<studies::StudyFigures> run(std::span<const std::byte> plan);

 private:
  PythonLaw(pid_t pid, int socket) : pid_(pid), socket_(socket) {}
  Result<std::vector<std::byte>> answer();

  pid_t pid_;
  int socket_;
};

/// The same in a worker process: its Python starts with its first mission.
Result<studies::StudyFigures> run_under_python_law(const std::string& law,
                                                   std::span<const std::byte> plan);

}  // namespace ergocast::cli
