// SPDX-License-Identifier: BSD-3-Clause
// One thread listens and feeds the team's picture, those of the server read it; a lock between them
// is held for the encoding of a bounded number of rows.
#include "cli/live_watch.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <utility>

#include "cli/live_team.h"
#include "cli/log_lines.h"
#include "cli/recorded_team.h"
#include "cli/team_monitor.h"
#include "report/page.h"
#include "report/report.h"
#include "report/web_page.h"
#include "runtime/clock.h"
#include "team/plan.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr auto kPollPeriod = 50ms;
constexpr auto kLook = 250ms;
constexpr int kFramesAtOnce = 8;
/// Agents report the end before the coordinator tells its reason.
constexpr auto kLastFrame = 1s;

class Watch final : public LiveWatch {
 public:
  explicit Watch(Source source) : source_(std::move(source)), logs_(source_.run_dir / "log") {
    if (source_.bus.run != 0 && source_.mission) adopt(source_.bus.run, false);
  }
  ~Watch() override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
    server_.reset();
  }

  std::optional<std::string> open(const PageServer::Options& options) {
    auto opened = listen_to_teams(source_.bus, hear(false), hear(true));
    if (auto* problem = std::get_if<std::string>(&opened)) return std::move(*problem);
    transport_ = std::get<0>(std::move(opened));
    auto started = PageServer::start(
        options, {[this] { return page(); }, content_security_policy(run_web_page()),
                  [this] { return record(); }, [this] { return stream(); }});
    if (auto* problem = std::get_if<std::string>(&started)) return std::move(*problem);
    server_ = std::get<0>(std::move(started));
    thread_ = std::thread([this] { listen(); });
    return {};
  }

  std::string url() const override { return server_->url(); }
  bool over() const override { return over_; }
  void say(const std::string& line) override {
    const std::scoped_lock lock(mutex_);
    if (team_) team_->log(line);
  }
  void finish() override {
    Json data;
    if (!source_.run_dir.empty() && source_.mission) {
      auto read = recorded_page_data(source_.run_dir, *source_.mission);
      if (auto* found = std::get_if<Json>(&read)) data = std::move(*found);
    }
    const std::scoped_lock lock(mutex_);
    data_ = std::move(data);
    finished_ = true;
  }

 private:
  void adopt(RunId run, bool replay) {
    replay_ = replay;
    team_.emplace(run, now(), source_.bus.seal.keyed(), replay);
    if (source_.mission) team_->begin(*source_.mission, source_.density);
  }

  Hear hear(bool replay) {
    return [this, replay](const Message& message, Bus bus, AgentId transmitter) {
      hear(message, bus, transmitter, replay);
    };
  }

  void hear(const Message& message, Bus bus, AgentId transmitter, bool replay) {
    const RunId run = header_of(message).run;
    if (run == 0) return;
    const std::scoped_lock lock(mutex_);
    if (!team_) adopt(run, replay);
    if (run == team_->run()) {
      if (replay == replay_) team_->receive(message, bus, transmitter, now());
    } else if (others_.size() < kMostRuns && others_.insert(run).second) {
      team_->log("run " + to_hex(run) + " is heard on this URL, too; --run-id " + to_hex(run) +
                 " shows it");
    }
  }

  void listen() {
    lower_priority();
    Instant next_look = now();
    std::optional<Instant> over_since;
    while (!stopping_) {
      transport_->deliver_until(now() + kPollPeriod, -1);
      if (now() < next_look) continue;
      next_look = now() + kLook;
      transport_->renew_membership();
      const std::vector<std::string> lines =
          source_.run_dir.empty() ? std::vector<std::string>() : logs_.take();
      const std::scoped_lock lock(mutex_);
      if (!team_) continue;
      for (const std::string& line : lines) team_->log(line);
      team_->look(now());
      if (team_->over() && !over_since) over_since = now();
      over_ = over_since && now() - *over_since >= kLastFrame;
    }
  }

  std::string page() const {
    const std::scoped_lock lock(mutex_);
    const bool recorded = !data_.is_null();
    const std::string title =
        recorded ? data_["record"]["mission"]["name"].get<std::string>() : "live";
    return html_file(run_web_page(), title, recorded ? data_ : Json{{"live", true}});
  }

  std::optional<std::string> record() const {
    const std::scoped_lock lock(mutex_);
    if (data_.is_null()) return {};
    return data_["record"].dump(-1, ' ', true, Json::error_handler_t::replace);
  }

  PageServer::Stream stream() {
    return [this, cursor = LiveTeam::Cursor(),
            ended = false]() mutable -> std::optional<std::string> {
      if (ended) return {};
      std::string text;
      const std::scoped_lock lock(mutex_);
      bool more = team_.has_value();
      for (int i = 0; more && i < kFramesAtOnce; ++i) text += team_->frame(cursor, more);
      if (finished_ && !more) {
        ended = true;
        const Json end = {{"record", !data_.is_null()}, {"text", team_ ? team_->end_text() : ""}};
        text +=
            "event: end\ndata: " + end.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n\n";
      }
      return text;
    };
  }

  Source source_;
  LogLines logs_;
  std::unique_ptr<Transport> transport_;
  mutable std::mutex mutex_;
  std::optional<LiveTeam> team_;
  bool replay_ = false;
  std::set<RunId> others_;
  Json data_;  // of the record; null: none yet
  bool finished_ = false;
  std::atomic<bool> stopping_ = false, over_ = false;
  std::thread thread_;
  std::unique_ptr<PageServer> server_;
};

}  // namespace

std::variant<std::unique_ptr<LiveWatch>, std::string> LiveWatch::start(
    Source source, const PageServer::Options& options) {
  auto watch = std::make_unique<Watch>(std::move(source));
  if (auto problem = watch->open(options)) return std::move(*problem);
  return std::unique_ptr<LiveWatch>(std::move(watch));
}

std::variant<Json, std::string> recorded_page_data(const std::filesystem::path& run_dir,
                                                   const Mission& mission) {
  auto record = read_page_record(run_dir, mission, recorded_team(run_dir, mission));
  if (auto* problem = std::get_if<std::string>(&record)) return std::move(*problem);
  std::vector<std::string> lines = LogLines(run_dir / "log").take();
  if (lines.size() > LiveTeam::kMostLines) {
    lines.erase(lines.begin(), lines.end() - static_cast<std::ptrdiff_t>(LiveTeam::kMostLines));
  }
  return Json{{"record", std::get<Json>(std::move(record))}, {"log", std::move(lines)}};
}

}  // namespace ergocast::cli
