// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with a scenario, and which line of the file is to blame.
#pragma once

#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scenario/salvage.h"
#include "scenario/scenario.h"
#include "text/shortest.h"

namespace ergocast {

/// Collects problems. Fields are named by paths such as "target.gaussians[2].sigma_m".
class Findings {
 public:
  /// @param file  what problems call the source
  explicit Findings(std::string file) : file_(std::move(file)) {}

  /// For the parser to fill; until then no path has a line.
  google::protobuf::TextFormat::ParseInfoTree& new_locations() { return locations_.emplace(); }

  /// From now on problems of the field at `path` are the command line's, not the file's.
  void blame(const std::string& path, const std::string& flag) { flags_[path] = flag; }

  /// The field at `path` is in the file but cannot be read: nobody knows its value.
  void give_up(const std::string& path) { given_up_.insert(path); }
  const std::set<std::string>& given_up() const { return given_up_; }

  /// The field or block at `path` may stand in the file under a name that nobody knows, which is a
  /// problem already: neither it nor what is in it is said to be missing.
  void excuse(const std::string& path) { excused_.insert(path); }
  const std::set<std::string>& excused() const { return excused_; }

  /// A problem at a place in the text; its `where` is filled in here.
  void add_at(Place place, Problem problem);

  /// A problem of one field. A field that is not in the file is located by the block it belongs in.
  void add(const std::string& path, const std::string& what, std::string remedy);

  /// A problem of the file as a whole, or of a flag of the command line.
  void add_to_file(std::string what, std::string remedy);
  void add_to_flag(std::string flag, std::string what, std::string remedy);

  bool empty() const { return found_.empty(); }

  /// In the order of the file; those without a line come last.
  std::vector<Problem> take();

 private:
  struct Found {
    Place place;
    Problem problem;
  };
  google::protobuf::TextFormat::ParseLocation locate(const std::string& path) const;

  std::string file_;
  std::optional<google::protobuf::TextFormat::ParseInfoTree> locations_;
  std::map<std::string, std::string> flags_;
  std::set<std::string> given_up_, excused_;
  std::vector<Found> found_;
};

}  // namespace ergocast
