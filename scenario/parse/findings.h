// SPDX-License-Identifier: BSD-3-Clause
// Collects the problems of a scenario with their lines in the file.
#pragma once

#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scenario/parse/error_recovery.h"
#include "scenario/parse/problem.h"
#include "text/shortest.h"

namespace ergocast {

/// Collects problems. Fields have paths such as "target.gaussians[2].sigma_m".
class Findings {
 public:
  /// @param file  the name of the source in the problems
  explicit Findings(std::string file) : file_(std::move(file)) {}

  /// The parser fills the result; until then no path has a line.
  google::protobuf::TextFormat::ParseInfoTree& new_locations() { return locations_.emplace(); }

  /// From now on problems of the field at `path` are the command line's, not the file's.
  void blame(const std::string& path, const std::string& flag) { flags_[path] = flag; }

  /// The flag that is blamed for the field at `path`; empty if none is.
  std::string blamed(const std::string& path) const {
    const auto found = flags_.find(path);
    return found == flags_.end() ? "" : found->second;
  }

  /// The field at `path` is in the file but cannot be read, so its value is unknown.
  void give_up(const std::string& path) { given_up_.insert(path); }
  const std::set<std::string>& given_up() const { return given_up_; }

  /// The field or block at `path` may be in the file under an unknown name, which is already a
  /// problem. So neither it nor its content is reported as missing.
  void excuse(const std::string& path) { excused_.insert(path); }
  const std::set<std::string>& excused() const { return excused_; }

  /// A problem at a place in the text; this function fills in its `where`.
  void add_at(Place place, Problem problem);

  /// A problem of one field. A field that is not in the file is located by its block.
  void add(const std::string& path, const std::string& what, std::string remedy);

  /// A problem of the file as a whole, or of a flag of the command line.
  void add_to_file(std::string what, std::string remedy);
  void add_to_flag(std::string flag, std::string what, std::string remedy);

  /// What a person should know if there is no problem.
  void note(const std::string& path, const std::string& what, std::string remedy) {
    notes_.push_back({path, what, std::move(remedy)});
  }
  /// Adds the notes as if they were problems: as warnings.
  void add_notes() {
    for (const Note& one : std::exchange(notes_, {})) add(one.path, one.what, one.remedy);
  }

  bool empty() const { return found_.empty(); }

  /// Sorted by their place in the file; those without a line come last.
  std::vector<Problem> take();

 private:
  struct Note {
    std::string path, what, remedy;
  };
  struct Found {
    Place place;
    Problem problem;
  };
  google::protobuf::TextFormat::ParseLocation locate(const std::string& path) const;

  std::vector<Note> notes_;
  std::string file_;
  std::optional<google::protobuf::TextFormat::ParseInfoTree> locations_;
  std::map<std::string, std::string> flags_;
  std::set<std::string> given_up_, excused_;
  std::vector<Found> found_;
};

}  // namespace ergocast
