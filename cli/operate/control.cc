// SPDX-License-Identifier: BSD-3-Clause
// Connects the ControlDesk with the team's buses and with the page's process.
#include "cli/operate/control.h"

#include <chrono>
#include <nlohmann/json.hpp>

#include "cli/operate/amend_process.h"
#include "cli/watch/page_socket.h"
#include "runtime/bus/clock.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// The most requests in one turn; the others follow in the next.
constexpr int kRequestsAtOnce = 64;
/// More than the link holds: after a sleep the whole queue is read at once.
constexpr int kMostQueued = 4096;
/// The state is repeated with this period, so a restarted page's process receives it.
constexpr auto kStatePeriod = 500ms;
/// Requests of so long ago do not count, but for a stop at once. The desk cannot see their age
/// after this process was stopped, because it has received no tick meanwhile.
constexpr auto kSleep = 5s;

}  // namespace

Result<std::unique_ptr<Control>> Control::open(const BusOptions& team,
                                               std::function<void(const std::string&)> print) {
  auto links = ControlLink::pair();
  if (!links) return failure("no page with control: the system has no descriptors left");
  std::unique_ptr<Control> control(new Control(team, std::move(*links), std::move(print)));
  auto opened = listen_to_teams(
      team,
      [monitored = &control->team_](const Message& message, Bus bus, AgentId transmitter) {
        if (header_of(message).run == monitored->run())
          monitored->receive(message, bus, transmitter, now());
      },
      [](const Message&, Bus, AgentId) {});
  if (!opened) return failure(std::move(opened).error());
  control->transport_ = *std::move(opened);
  return control;
}

Control::Control(const BusOptions& team, std::pair<ControlLink, ControlLink> links,
                 std::function<void(const std::string&)> print)
    : links_(std::move(links)),
      print_(std::move(print)),
      token_(random_token()),
      team_(team.run, now()),
      desk_(host_name(), team.authenticator.keyed(),
            [team](const ControlRequest& request, const std::string& by) {
              return request.zone ? std::make_unique<AmendProcess>(team, *request.zone, by)
                                  : std::make_unique<AmendProcess>(team, *request.target, by);
            }) {}

void Control::attend(Instant now) {
  transport_->deliver_until(now, -1);
  const bool slept = last_attended_ && now - *last_attended_ > kSleep;
  last_attended_ = now;
  if (slept) desk_.wake(now);
  for (int i = 0; i < (slept ? kMostQueued : kRequestsAtOnce); ++i) {
    const auto text = links_.first.receive();
    if (!text) break;
    const auto request = ControlRequest::parse(*text);
    if (!request) continue;
    if (slept)
      desk_.receive_late(*request, team_, now);
    else
      desk_.receive(*request, team_, now);
  }
  Outbox out;
  desk_.advance(team_, now, out);
  transport_->publish(out);
  print_lines();
  std::string state = state_text();
  if (state == state_ && now < next_state_) return;
  if (links_.first.send(state)) state_ = std::move(state);
  next_state_ = now + kStatePeriod;
}

void Control::end(Instant now) {
  attend(now);
  desk_.end(team_, now);
  print_lines();
  links_.first.send(state_text());
}

void Control::print_lines() {
  for (const std::string& line : desk_.take_lines()) print_(line);
}

std::string Control::state_text() const {
  return desk_.state().dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

}  // namespace ergocast::cli
