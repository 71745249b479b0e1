// SPDX-License-Identifier: BSD-3-Clause
// What rules say of a scenario's fields, each mistake once.
#pragma once

#include <set>
#include <string>

#include "scenario/fields.h"
#include "scenario/findings.h"

namespace ergocast {

/// "path[index]".
std::string indexed(const std::string& path, int index);

/// `value` rounded up, or down, to four digits: a limit that a person would like to type.
double rounded_up(double value);
double rounded_down(double value);

/// Reports problems and remembers where they are.
class Checks {
 public:
  explicit Checks(Findings& findings) : findings_(findings), unsound_(findings.given_up()) {}

  void problem(const std::string& path, const std::string& what, std::string remedy);

  /// Whether nothing is wrong yet at `path` or below it. Fields are compared with each other only
  /// where each is sound by itself: one mistake is one problem.
  bool sound(const std::string& path) const;

  /// Whether nothing is wrong anywhere.
  bool nothing_found() const { return findings_.empty(); }

  /// A field that nobody could read is not missing, nor is one in a block that nobody could read.
  void missing(const std::string& path, const std::string& what, std::string remedy);

  /// Whether `value` is in `range`; if not, that is a problem.
  /// @param wanted  what to write instead, where the range is not what matters
  bool in_range(const std::string& path, double value, const Range& range,
                const std::string& wanted = "");

 private:
  Findings& findings_;
  std::set<std::string> unsound_;
};

}  // namespace ergocast
