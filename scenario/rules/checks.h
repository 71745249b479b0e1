// SPDX-License-Identifier: BSD-3-Clause
// Reports what is wrong with a scenario's fields, each mistake once.
#pragma once

#include <set>
#include <string>

#include "scenario/parse/fields.h"
#include "scenario/parse/findings.h"

namespace ergocast {

/// "path[index]".
std::string indexed(const std::string& path, int index);

/// `value` rounded up, or down, to four digits: a limit that is easy to type.
double rounded_up(double value);
double rounded_down(double value);

/// Reports problems and records the paths of their fields.
class Checks {
 public:
  explicit Checks(Findings& findings) : findings_(findings), unsound_(findings.given_up()) {}

  void problem(const std::string& path, const std::string& what, std::string remedy);

  /// Reports a field or block that only boxes may have, in a plane.
  void of_a_box_alone(const std::string& path);

  /// Whether no problem is known yet at `path` or below it. Rules between fields apply only to
  /// fields that are valid by themselves: one mistake is one problem.
  bool sound(const std::string& path) const;

  /// Whether no problem is known at all.
  bool nothing_found() const { return findings_.empty(); }

  /// Reports a missing field, unless the field or its block is in the file but unreadable.
  void missing(const std::string& path, const std::string& what, std::string remedy);

  /// Whether `value` is in `range`; if not, reports a problem.
  /// @param wanted  what to write instead, if the range is no useful advice
  bool in_range(const std::string& path, double value, const Range& range,
                const std::string& wanted = "");

 private:
  Findings& findings_;
  std::set<std::string> unsound_;
};

}  // namespace ergocast
