// SPDX-License-Identifier: BSD-3-Clause
// Where `ergocast status` shows its pictures.
#pragma once

#include <string>

#include "cli/team_view.h"

namespace ergocast::cli {

/// One picture after the other: in place on a terminal, one below the other elsewhere.
class TeamScreen {
 public:
  explicit TeamScreen(bool json);

  /// Until the next one takes its place; on a terminal no more than fits.
  void show(const TeamPicture& picture);
  void show(const std::string& text);
  /// The whole of it, to stay.
  void print(const TeamPicture& picture);

  /// How often show() is worth its while.
  PacingClock::duration period() const;

 private:
  std::string text_of(const TeamPicture& picture) const;
  void make_room();

  bool terminal_, json_, colour_, shown_ = false;
  int lines_ = 0;  // on the terminal, to be drawn over
};

}  // namespace ergocast::cli
