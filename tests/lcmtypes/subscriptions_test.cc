// SPDX-License-Identifier: BSD-3-Clause
// The subscriptions of team/subscriptions.h, on LCM's channels and in ARCHITECTURE.md.
#include "team/subscriptions.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "lcmtypes/channels.h"
#include "tests/lcmtypes/sample_messages.h"

namespace ergocast {
namespace {

using namespace test;
using Names = std::set<std::string>;

/// The names of the roles in ARCHITECTURE.md; the logger receives everything, so no line of the
/// table has it.
constexpr const char* kNames[kRoleCount] = {"agents", "coordinator", "world", "driver",
                                            "",       "run",         "status"};

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" `"), last = text.find_last_not_of(" `");
  return first == text.npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> split(const std::string& line, char at) {
  std::vector<std::string> parts;
  std::istringstream in(line);
  for (std::string part; std::getline(in, part, at);) parts.push_back(trimmed(part));
  return parts;
}

/// "agents (`--now`), coordinator" without the text in brackets.
Names listeners(const std::string& cell) {
  Names names;
  for (const std::string& part : split(cell, ','))
    names.insert(trimmed(part.substr(0, part.find('('))));
  names.erase("");
  return names;
}

/// The table under "### Channels": listeners by channel and bus.
std::map<std::string, std::vector<Names>> documented() {
  std::ifstream file(ERGOCAST_SOURCE_DIR "/ARCHITECTURE.md");
  std::map<std::string, std::vector<Names>> table;
  std::string line;
  while (std::getline(file, line) && line != "### Channels") {
  }
  while (std::getline(file, line) && !line.starts_with("##")) {
    if (!line.starts_with("| `ERGOCAST_")) continue;
    const auto cells = split(line, '|');
    if (cells.size() != 4 + kBusCount) {
      ADD_FAILURE() << "not a row of the table: " << line;
      continue;
    }
    for (std::size_t bus = 0; bus < kBusCount; ++bus)
      table[cells[1]].push_back(listeners(cells[4 + bus]));
  }
  return table;
}

TEST(Subscriptions, AreThoseOfTheDocument) {
  const auto sent = documented();
  EXPECT_EQ(sent.size(), kMessageTypeCount);
  for (std::size_t type = 0; type < kMessageTypeCount; ++type) {
    const ChannelName& name = channel_names()[type];
    const std::string channel = std::string(name.text) + (name.per_agent ? "<id>" : "");
    ASSERT_TRUE(sent.contains(channel)) << channel;
    for (std::size_t bus = 0; bus < kBusCount; ++bus) {
      Names types;
      for (std::size_t role = 0; role < kRoleCount; ++role) {
        if ((kSubscriptions[role][bus] >> type & 1) != 0) types.insert(kNames[role]);
      }
      EXPECT_EQ(types.erase(""), 1U) << "the logger receives everything, also " << channel;
      EXPECT_EQ(sent.at(channel)[bus], types) << channel << " on bus " << bus;
    }
  }
}

TEST(Subscriptions, AreTheChannelsOfTheirTypesAndNoOthers) {
  for (const Subscriptions& subscriptions : kSubscriptions) {
    for (std::size_t bus = 0; bus < kBusCount; ++bus) {
      for (const Message& message : every_message()) {
        EXPECT_EQ(is_channel_of(subscriptions[bus], channel_of(message)),
                  subscribes(subscriptions, static_cast<Bus>(bus), message))
            << channel_of(message) << " on bus " << bus;
      }
      for (const char* nobodys : {"", "ERGOCAST_", "ERGOCAST_SOMETHING", "ERGOCAST_HELLO_",
                                  "ERGOCAST_HELL", "ERGOCAST_CONTRIBUTION"}) {
        EXPECT_FALSE(is_channel_of(subscriptions[bus], nobodys)) << nobodys;
      }
    }
  }
}

}  // namespace
}  // namespace ergocast
