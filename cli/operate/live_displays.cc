// SPDX-License-Identifier: BSD-3-Clause
// Opens addresses for Foxglove and TAK, and hands them from one process to another.
#include "cli/operate/live_displays.h"

#include <cstdlib>
#include <utility>

#include "cli/record/origin_option.h"
#include "cli/report_error.h"
#include "report/target_density.h"
#include "text/shortest.h"

namespace ergocast::cli {
namespace {

constexpr const char* kToken = "ERGOCAST_FOXGLOVE_TOKEN";

}  // namespace

void add_display_options(CLI::App& app, DisplayOptions& options) {
  add_cot_option(app, options.cot);
  add_foxglove_option(app, options.foxglove_port);
  add_origin_option(app, options.cot.origin);
}

std::optional<std::string> why_refused(const DisplayOptions& options, const PageOptions& page) {
  if (options.cot.origin && !options.cot.to && options.foxglove_port == 0)
    return "--origin is for --cot and --foxglove; give one of them";
  if (options.foxglove_port > 0 && options.foxglove_port == page.port)
    return "--foxglove and --port name the same port, " + std::to_string(options.foxglove_port) +
           "; the page needs its own";
  return std::nullopt;
}

std::vector<std::string> together(std::vector<std::string> one, std::vector<std::string> other) {
  for (std::string& name : other) one.push_back(std::move(name));
  return one;
}

Result<std::unique_ptr<LiveDisplays>, int> LiveDisplays::open(const DisplayOptions& options,
                                                              const PageOptions& page,
                                                              std::filesystem::path run_dir) {
  std::unique_ptr<LiveDisplays> made(new LiveDisplays(options, std::move(run_dir)));
  if (options.cot.to) {
    if (const auto code = made->open_cot()) return failure(*code);
  }
  if (options.foxglove_port > 0 || options.foxglove_socket > 0) {
    if (const auto code = made->open_foxglove(page)) return failure(*code);
  }
  return made;
}

std::optional<int> LiveDisplays::open_cot() {
  if (!origin_) {
    auto recorded = recorded_origin(run_dir_);
    if (!recorded) return report_error(kExitBadInput, recorded.error());
    origin_ = *recorded;
  }
  if (!origin_)
    return report_error(kExitBadInput,
                        run_dir_.empty()
                            ? "--cot: the scenario of this team is not on this host; say where its "
                              "(0, 0) is, with --origin LATITUDE,LONGITUDE"
                            : "--cot: the scenario has no origin; add origin { latitude_deg: … "
                              "longitude_deg: … } to it, or say --origin LATITUDE,LONGITUDE");
  auto output = CotOutput::open(*options_.cot.to, *origin_);
  if (!output) return report_error(kExitUnavailable, output.error());
  cot_ = *std::move(output);
  return std::nullopt;
}

std::optional<int> LiveDisplays::open_foxglove(PageOptions page) {
  page.port = options_.foxglove_port;
  page.port_option = "--foxglove";
  const char* token = std::getenv(kToken);
  auto socket = options_.foxglove_socket > 0 ? PageSocket::inherited(options_.foxglove_socket, page,
                                                                     token != nullptr ? token : "")
                                             : PageSocket::open(page);
  if (!socket) return report_error(kExitUnavailable, socket.error());
  socket_ = std::make_shared<PageSocket>(*std::move(socket));
  if (!origin_ && !run_dir_.empty()) origin_ = recorded_origin(run_dir_).value_or(std::nullopt);
  return std::nullopt;
}

PageProcess::Displays LiveDisplays::handed() const {
  PageProcess::Displays displays;
  displays.foxglove = socket_;
  if (socket_ && !socket_->token().empty())
    displays.environment.push_back(std::string(kToken) + '=' + socket_->token());
  if (options_.cot.to) displays.arguments = {"--cot", "udp://" + to_text(*options_.cot.to)};
  if (options_.cot.origin)
    displays.arguments.push_back("--origin=" + shortest(options_.cot.origin->latitude_deg) + ',' +
                                 shortest(options_.cot.origin->longitude_deg));
  return displays;
}

std::string LiveDisplays::foxglove_url() const {
  return socket_ ? ergocast::cli::foxglove_url(*socket_) : "";
}

void LiveDisplays::begin(std::function<void(const std::string&)> note) {
  if (!socket_) return;
  FoxgloveOutput::Setup setup{.origin = origin_, .target = {}, .note = std::move(note)};
  if (!run_dir_.empty())
    setup.target = read_target_density(run_dir_ / kTargetDensityFile).value_or(Field());
  foxglove_ = std::make_unique<FoxgloveOutput>(std::move(setup), std::move(*socket_));
  socket_.reset();
}

std::vector<TeamDisplay*> LiveDisplays::displays() {
  std::vector<TeamDisplay*> all;
  if (cot_) all.push_back(&*cot_);
  if (foxglove_) all.push_back(foxglove_.get());
  return all;
}

void LiveDisplays::serve(Instant now) {
  if (foxglove_) foxglove_->serve(now);
}

std::vector<std::string> LiveDisplays::clients() const {
  std::vector<std::string> names;
  if (foxglove_) names = foxglove_->clients();
  if (cot_) names.push_back(cot_->name());
  return names;
}

}  // namespace ergocast::cli
