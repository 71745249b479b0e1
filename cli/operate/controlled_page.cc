// SPDX-License-Identifier: BSD-3-Clause
// Starts control first, because the page's process inherits its end of the link.
#include "cli/operate/controlled_page.h"

#include <filesystem>
#include <span>

#include "runtime/process/key_file.h"
#include "runtime/process/sealed_file.h"

namespace ergocast::cli {
namespace {

/// The page's process checks what it receives, and cannot sign.
Result<SealedFile> key_of_page(const MissionKey& key) {
  const std::string text = key_text(key, false);
  return SealedFile::make("page-key", std::as_bytes(std::span(text)));
}

}  // namespace

Result<std::unique_ptr<ControlledPage>> ControlledPage::start(const BusOptions& team,
                                                              const std::filesystem::path& run_dir,
                                                              const PageOptions& page,
                                                              bool with_control,
                                                              ProgressDisplay& display) {
  auto controlled = std::make_unique<ControlledPage>();
  PageProcess::Setup setup;
  setup.program = std::filesystem::read_symlink("/proc/self/exe");
  setup.run_dir = run_dir;
  setup.url = team.url;
  setup.run = team.run;
  setup.page = page;
  if (const MissionKey* key = team.authenticator.key()) {
    auto sealed = key_of_page(*key);
    if (!sealed) return failure(std::move(sealed).error());
    setup.key = *std::move(sealed);
  }
  if (with_control) {
    auto opened = Control::open(team, [&display](const std::string& line) { display.print(line); });
    if (!opened) return failure(std::move(opened).error());
    controlled->control_ = *std::move(opened);
    setup.control = &controlled->control_->page_end();
    setup.control_token = controlled->control_->token();
  }
  auto started = PageProcess::start(setup, display);
  if (!started) return failure(std::move(started).error());
  controlled->page_ = *std::move(started);
  return controlled;
}

void ControlledPage::attend(Instant now) {
  page_->attend(now);
  if (control_) control_->attend(now);
}

}  // namespace ergocast::cli
