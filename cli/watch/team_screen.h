// SPDX-License-Identifier: BSD-3-Clause
// The output of `ergocast status`.
#pragma once

#include <string>

#include "cli/team/team_view.h"

namespace ergocast::cli {

/// Shows pictures in sequence: in place on a terminal, one below the other elsewhere.
class TeamScreen {
 public:
  explicit TeamScreen(bool json);

  /// Shows it until the next one replaces it; on a terminal only as much as fits.
  void show(const TeamPicture& picture);
  void show(const std::string& text);
  /// Prints the picture in full; it is not replaced.
  void print(const TeamPicture& picture);

  /// The time between two calls of show().
  PacingClock::duration period() const;

 private:
  std::string text_of(const TeamPicture& picture) const;
  void make_room();

  bool terminal_, json_, colour_, shown_ = false;
  int lines_ = 0;  // on the terminal, to be overwritten
};

}  // namespace ergocast::cli
