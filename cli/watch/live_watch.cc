// SPDX-License-Identifier: BSD-3-Clause
// Feeds received messages to the team's picture, and divides it into frames for the browsers.
#include "cli/watch/live_watch.h"

#include <chrono>
#include <exception>
#include <future>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "cli/team/live_team.h"
#include "cli/team/log_lines.h"
#include "cli/team/recorded_team.h"
#include "cli/team/team_monitor.h"
#include "cli/watch/client_list.h"
#include "plan/plan.h"
#include "report/report.h"
#include "report/web_page.h"
#include "runtime/bus/clock.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr auto kPageTurn = 50ms;  // the maximum between two calls of the page's server
constexpr auto kLook = 250ms;
/// Limit (Page): frames for one browser in a turn of 0.1 s. Beyond it: the rest follows in the next
/// turns.
constexpr int kFramesAtOnce = 8;
/// Agents report the end before the coordinator reports its reason.
constexpr auto kLastFrame = 1s;

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

Connections::Text shared_text(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

/// The page of a record, and the record's data for pages that were already open.
struct RecordedPage {
  Connections::Text page, record;
};

/// Nullopt if the record cannot be read, or if memory is missing.
RecordedPage read_page(const std::filesystem::path& run_dir, const Mission& mission) {
  try {
    const auto read = recorded_page_data(run_dir, mission);
    if (read) {
      return {recorded_page(*read), shared_text(dumped((*read)["record"]))};
    }
  } catch (const std::exception&) {
    // The page keeps the data that it has received.
  }
  return {};
}

class Watch final : public LiveWatch {
 public:
  explicit Watch(Source source)
      : source_(std::move(source)),
        logs_(source_.run_dir / "log"),
        page_(shared_text(html_file(run_web_page(), "live", Json{{"live", true}}))) {
    if (source_.bus.run != 0 && source_.mission) adopt(source_.bus.run, false);
  }

  std::optional<std::string> open() {
    auto opened = listen_to_teams(source_.bus, receiver(false), receiver(true), LiveTeam::kRole);
    if (!opened) return opened.error();
    transport_ = *std::move(opened);
    return {};
  }

  PageServer::Content content() override {
    return {[this] { return page_; }, content_security_policy(run_web_page()),
            [this] { return record_; }, [this] { return stream(); }};
  }
  void listen(int wake_fd) override;
  void log(const std::string& line) override {
    if (team_) team_->log(line);
  }
  RunId run() const override { return team_ ? team_->run() : 0; }
  bool over() const override { return over_; }
  void finish() override {
    if (source_.run_dir.empty() || !source_.mission) {
      finished_ = true;
    } else if (!reading_.valid() && !finished_) {
      reading_ = std::async(std::launch::async, read_page, source_.run_dir, *source_.mission);
    }
  }

 private:
  void adopt(RunId run, bool replay) {
    replay_ = replay;
    team_.emplace(run, now(), source_.bus.authenticator.keyed(), replay);
    if (source_.mission) team_->begin(*source_.mission, source_.density);
  }

  OnMessage receiver(bool replay) {
    return [this, replay](const Message& message, Bus bus, AgentId transmitter) {
      receive(message, bus, transmitter, replay);
    };
  }

  void receive(const Message& message, Bus bus, AgentId transmitter, bool replay) {
    const RunId run = header_of(message).run;
    if (run == 0) return;
    if (!team_) adopt(run, replay);
    if (run == team_->run()) {
      if (replay != replay_) return;
      team_->receive(message, bus, transmitter, now());
      const auto* world = std::get_if<WorldState>(&message);
      if (world == nullptr) return;
      for (TeamDisplay* display : source_.displays) display->show(*world, team_->follower());
    } else if (others_.size() < kMostRuns && others_.insert(run).second) {
      team_->log("run " + to_hex(run) + " is on this URL, too; --run-id " + to_hex(run) +
                 " shows it");
    }
  }

  void look();
  Connections::Stream stream() {
    return [this, cursor = LiveTeam::Cursor(),
            ended = false]() mutable -> std::optional<std::string> {
      if (ended) return {};
      std::string text;
      bool more = team_.has_value();
      for (int i = 0; more && i < kFramesAtOnce; ++i) text += team_->frame(cursor, more);
      if (finished_ && !more) {
        ended = true;
        const Json end = {{"record", record_ != nullptr}, {"text", team_ ? team_->end_text() : ""}};
        text += "event: end\ndata: " + dumped(end) + "\n\n";
      }
      return text;
    };
  }

  Source source_;
  LogLines logs_;
  std::unique_ptr<Transport> transport_;
  std::optional<LiveTeam> team_;
  bool replay_ = false;
  std::set<RunId> others_;
  Connections::Text page_, record_;
  Instant next_look_{};
  std::optional<Instant> over_since_;
  bool over_ = false, finished_ = false;
  std::future<RecordedPage> reading_;
};

void Watch::listen(int wake_fd) {
  transport_->deliver_until(now() + kPageTurn, wake_fd);
  if (now() < next_look_) return;
  next_look_ = now() + kLook;
  transport_->renew_membership();
  look();
  if (!reading_.valid() || reading_.wait_for(0s) != std::future_status::ready) return;
  RecordedPage read = reading_.get();
  if (read.page) page_ = std::move(read.page);
  record_ = std::move(read.record);
  finished_ = true;
}

void Watch::look() {
  if (!team_) return;
  if (!source_.run_dir.empty()) {
    const std::vector<std::string> lines = logs_.take();
    for (const std::string& line : lines) team_->log(line);
    for (TeamDisplay* display : source_.displays) display->show(lines);
  }
  team_->name_clients(named_clients(team_->run()));
  const TeamPicture picture = team_->look(now());
  if (team_->mission() != nullptr)
    for (TeamDisplay* display : source_.displays) display->show(picture, team_->follower());
  if (team_->over() && !over_since_) over_since_ = now();
  over_ = over_since_ && now() - *over_since_ >= kLastFrame;
}

}  // namespace

Result<std::unique_ptr<LiveWatch>> LiveWatch::open(Source source) {
  auto watch = std::make_unique<Watch>(std::move(source));
  if (auto problem = watch->open()) return failure(*problem);
  return std::unique_ptr<LiveWatch>(std::move(watch));
}

Connections::Text recorded_page(const Json& data) {
  const auto title = data["record"]["mission"]["name"].get<std::string>();
  return shared_text(html_file(run_web_page(), title, data));
}

Result<Json> recorded_page_data(const std::filesystem::path& run_dir, const Mission& mission) {
  auto record = read_page_record(run_dir, mission, recorded_team(run_dir, mission));
  if (!record) return failure(record.error());
  std::vector<std::string> lines = LogLines(run_dir / "log").take();
  if (lines.size() > LiveTeam::kMostLines) {
    lines.erase(lines.begin(), lines.end() - static_cast<std::ptrdiff_t>(LiveTeam::kMostLines));
  }
  return Json{{"record", *std::move(record)}, {"log", std::move(lines)}};
}

}  // namespace ergocast::cli
