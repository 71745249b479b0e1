// SPDX-License-Identifier: BSD-3-Clause
// Starts control first, because the page's process inherits its end of the link.
#include "cli/operate/controlled_page.h"

#include <filesystem>
#include <span>

#include "runtime/process/key_file.h"
#include "runtime/process/sealed_file.h"

namespace ergocast::cli {
namespace {

Result<SealedFile> sealed(const std::string& name, const std::string& text) {
  return SealedFile::make(name, std::as_bytes(std::span(text)));
}

/// A key with which the page's process can verify messages, but not sign them.
Result<SealedFile> key_of_page(const MissionKey& key) {
  return sealed("page-key", key_text(key, false));
}

}  // namespace

Result<std::unique_ptr<ControlledPage>> ControlledPage::start(
    const BusOptions& team, const std::filesystem::path& run_dir, const PageOptions& page,
    bool with_control, PageProcess::Displays displays, ProgressDisplay& display) {
  auto controlled = std::make_unique<ControlledPage>();
  PageProcess::Setup setup;
  setup.program = std::filesystem::read_symlink("/proc/self/exe");
  setup.run_dir = run_dir;
  setup.url = team.url;
  setup.run = team.run;
  setup.page = page;
  setup.displays = std::move(displays);
  if (const MissionKey* key = team.authenticator.key()) {
    auto kept = key_of_page(*key);
    if (!kept) return failure(std::move(kept).error());
    setup.key = *std::move(kept);
  }
  if (page.tls) {
    auto certificate = sealed("page-certificate", page.tls->certificate());
    auto tls_key = sealed("page-tls-key", page.tls->key());
    if (!certificate || !tls_key) return failure((!certificate ? certificate : tls_key).error());
    setup.certificate = *std::move(certificate);
    setup.tls_key = *std::move(tls_key);
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
