// SPDX-License-Identifier: BSD-3-Clause
// Redraws the picture in place on a terminal, and prints pictures one after the other elsewhere.
#include "cli/watch/team_screen.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "cli/team/team_text.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

std::size_t terminal_height() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 3 ? size.ws_row : 24;
}

bool wants_no_colour() {
  const char* no_color = std::getenv("NO_COLOR");
  return no_color != nullptr && *no_color != '\0';
}

}  // namespace

TeamScreen::TeamScreen(bool json)
    : terminal_(!json && isatty(STDOUT_FILENO) == 1),
      json_(json),
      colour_(terminal_ && !wants_no_colour()) {}

PacingClock::duration TeamScreen::period() const { return terminal_ ? 500ms : 1000ms; }

std::string TeamScreen::text_of(const TeamPicture& picture) const {
  return json_ ? team_json(picture) + '\n' : team_table(picture, colour_);
}

void TeamScreen::make_room() {
  if (lines_ > 0) std::printf("\x1b[%dA\x1b[J", lines_);
  if (shown_ && !terminal_ && !json_) std::putchar('\n');
  lines_ = 0;
  shown_ = true;
}

void TeamScreen::show(const TeamPicture& picture) { show(text_of(picture)); }

void TeamScreen::show(const std::string& text) {
  make_room();
  if (terminal_) {
    const std::string seen = cut_to_height(text, terminal_height() - 1);
    lines_ = static_cast<int>(std::count(seen.begin(), seen.end(), '\n'));
    // Line wrapping is off, so that a line stays one line on a narrow terminal.
    std::printf("\x1b[?7l%s\x1b[?7h", seen.c_str());
  } else {
    std::fputs(text.c_str(), stdout);
  }
  std::fflush(stdout);
}

void TeamScreen::print(const TeamPicture& picture) {
  make_room();
  std::fputs(text_of(picture).c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace ergocast::cli
