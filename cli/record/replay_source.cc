// SPDX-License-Identifier: BSD-3-Clause
// Decodes each logged message to get its kind and tick; its bytes stay unchanged.
#include "cli/record/replay_source.h"

#include <algorithm>

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"

namespace ergocast::cli {
namespace {

/// Where each kind of message was sent (docs/reference/messages.md): the log does not say.
std::vector<Bus> buses_of(const Message& message) {
  if (std::holds_alternative<WorldState>(message)) return {Bus::kWorld};
  if (std::holds_alternative<Command>(message)) return {Bus::kCommand};
  if (std::holds_alternative<RecordAck>(message)) return {Bus::kCommand};
  if (std::holds_alternative<Hello>(message) && header_of(message).sender == kWorld)
    return {Bus::kWorld};
  if (std::holds_alternative<MissionPart>(message) || std::holds_alternative<Stop>(message))
    return {Bus::kSwarm, Bus::kCommand};
  return {Bus::kSwarm};
}

}  // namespace

Result<ReplaySource> ReplaySource::open(const std::filesystem::path& run_dir,
                                        const Mission& mission,
                                        const MessageAuthenticator& authenticator) {
  auto reader = EventLogReader::open(run_dir);
  if (!reader) return failure(reader.error());
  return ReplaySource(*std::move(reader), mission, authenticator);
}

const ReplayedMessage* ReplaySource::refuse(Refusal why) {
  std::string remedy = "the file is damaged, or another version wrote it";
  if (why == Refusal::kRun)
    remedy = "it belongs to another run, of which the log was copied into this folder";
  if (why == Refusal::kTag && !authenticator_.keyed())
    remedy = "the run had a mission key, or the file is damaged: give --key-file";
  if (why == Refusal::kTag && authenticator_.keyed()) remedy = "the run had another mission key";
  if (why == Refusal::kUnkeyed) remedy = "the run had no mission key: leave --key-file out";
  problem_ = reader_.place() + ": not a message of this run (" + std::string(to_string(why)) +
             "); " + remedy;
  return nullptr;
}

const ReplayedMessage* ReplaySource::next() {
  if (problem_) return nullptr;
  const LoggedEvent* event = reader_.next();
  if (event == nullptr) {
    problem_ = reader_.problem();
    return nullptr;
  }
  const auto decoded = decode(event->bytes, run_, authenticator_, event->channel, &signatures_);
  if (!decoded) return refuse(decoded.error());
  const Message& message = *decoded;
  if (!transmitter_of(message, event->channel)) return refuse(Refusal::kType);
  run_ = header_of(message).run;
  if (std::holds_alternative<WorldState>(message)) {
    const double t_s = static_cast<double>(header_of(message).tick) * dt_s_;
    message_.t_s = std::max(message_.t_s, t_s);
  }
  message_.buses = buses_of(message);
  message_.channel = replayed(event->channel);
  message_.bytes = event->bytes;
  keep(message);
  return &message_;
}

void ReplaySource::keep(const Message& message) {
  const auto* part = std::get_if<MissionPart>(&message);
  if (part == nullptr && !std::holds_alternative<AgentStatus>(message) &&
      !std::holds_alternative<TeamStatus>(message) && !std::holds_alternative<RecordAck>(message)) {
    return;
  }
  if (part != nullptr && part->revision < revision_) return;
  if (part != nullptr && part->revision > revision_) {
    revision_ = part->revision;
    std::erase_if(newest_, [&](const auto& one) { return one.first.first == message_.channel; });
  }
  newest_[{message_.channel, part != nullptr ? part->part : 0}] = message_;
}

std::vector<const ReplayedMessage*> ReplaySource::newest() const {
  std::vector<const ReplayedMessage*> messages;
  for (const auto& [key, message] : newest_) messages.push_back(&message);
  return messages;
}

}  // namespace ergocast::cli
