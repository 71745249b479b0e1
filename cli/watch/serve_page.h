// SPDX-License-Identifier: BSD-3-Clause
// What the commands that serve a page have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>

#include "cli/watch/page_server.h"
#include "runtime/process/signals.h"

namespace ergocast::cli {

/// --port, --listen, --tls-cert and --tls-key.
void add_page_options(CLI::App& app, PageOptions& options);
/// --control.
void add_control_option(CLI::App& app, bool& control);
/// Reads the certificate and its key, if they are named. An error names the remedy; another is
/// control that other hosts reach without TLS.
std::optional<std::string> read_certificate(PageOptions& options, bool control);
/// Serves until Ctrl-C or SIGTERM comes, at a low priority.
/// @param wait  waits until the server, or what it shows, has something to do, at most 0.1 s
void serve_until_stop(PageServer& server, StopSignals& signals, const std::function<void()>& wait);

}  // namespace ergocast::cli
