// SPDX-License-Identifier: BSD-3-Clause
// The numbers in scenario.proto's comments are those of the table of fields.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <regex>
#include <string>

#include "scenario/fields.h"
#include "scenario/scenario.pb.h"

namespace ergocast {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

/// The comment of each field by "Message.field": the lines above it, or above the fields that it
/// follows without a comment, and the rest of its line.
std::map<std::string, std::string> read_comments() {
  std::ifstream file(ERGOCAST_SOURCE_DIR "/scenario/scenario.proto");
  const std::regex message_line(R"(^message (\w+) \{)");
  const std::regex field_line(R"(^  (?:optional|repeated) \w+ (\w+) = \d+;(?:\s*//(.*))?$)");
  std::map<std::string, std::string> comments;
  std::string message, comment;
  bool comment_ended = false;
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (std::regex_search(line, match, message_line)) message = match[1], comment.clear();
    if (const auto at = line.find_first_not_of(' ');
        at != std::string::npos && line.compare(at, 2, "//") == 0) {
      if (comment_ended) comment.clear();
      comment_ended = false;
      comment += line.substr(at + 2);
    } else if (std::regex_match(line, match, field_line)) {
      comments[message + '.' + match[1].str()] = comment + ' ' + match[2].str();
      comment_ended = true;
    }
  }
  return comments;
}

/// Whether `comment` has `value` as a separate number in any notation: 1e7 or 10000000.
bool says(const std::string& comment, double value) {
  const std::regex number(R"((?:^|[^\w.])(-?\d+(?:\.\d+)?(?:e-?\d+)?)(?![\w]))");
  for (std::sregex_iterator at(comment.begin(), comment.end(), number), end; at != end; ++at) {
    if (std::strtod((*at)[1].str().c_str(), nullptr) == value) return true;
  }
  return false;
}

/// Fields whose limits depend on other fields or are in their message's comment: the table only
/// prevents overflow.
bool limits_stand_elsewhere(const std::string& name) {
  return name == "Gaussian.sigma_m" || name.starts_with("Covariance.") ||
         name.starts_with("Start.") || name.starts_with("Vertex.") ||
         name.starts_with("Domain.origin_") || name == "Law.noise_ceiling" ||
         name == "World.disturbance_intensity" || name == "Law.contraction_gain_per_s" ||
         name == "Agents.random_count" || name == "Agents.quorum";
}

bool says_limits(const std::string& comment, const Range& range) {
  if (range.coordinate) return says(comment, range.high);  // "at most … from 0"
  const bool low = range.low_excluded ? comment.find("above 0") != std::string::npos ||
                                            comment.find("Above 0") != std::string::npos
                                      : says(comment, range.low);
  return low && says(comment, range.high);
}

bool says_default(const std::string& comment, double value) {
  std::smatch match;
  return std::regex_search(comment, match, std::regex(R"(Default:? ([-\d.e]*\d))")) &&
         std::strtod(match[1].str().c_str(), nullptr) == value;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

template <class Visit>
void each_number(const Visit& visit) {
  const auto* file = proto::Scenario::descriptor()->file();
  for (int i = 0; i < file->message_type_count(); ++i) {
    const Descriptor& message = *file->message_type(i);
    for (int j = 0; j < message.field_count(); ++j) {
      const FieldDescriptor& field = *message.field(j);
      if (const FieldRule* rule = rule_of(field)) visit(message.name() + '.' + field.name(), *rule);
    }
  }
}

TEST(ProtoComments, NameTheLimitsOfTheTable) {
  const auto comments = read_comments();
  int held = 0;
  each_number([&](const std::string& name, const FieldRule& rule) {
    ASSERT_TRUE(comments.contains(name)) << name;
    if (limits_stand_elsewhere(name)) return;
    EXPECT_TRUE(says_limits(comments.at(name), rule.range))
        << name << " is " << rule.range.text() << ", its comment:" << comments.at(name);
    ++held;
  });
  EXPECT_GT(held, 25);
}

TEST(ProtoComments, NameTheDefaultsOfTheTable) {
  const auto comments = read_comments();
  each_number([&](const std::string& name, const FieldRule& rule) {
    if (rule.absence != Absence::kDefaulted) return;
    EXPECT_TRUE(says_default(comments.at(name), rule.default_value))
        << name << " has the default " << rule.default_value
        << ", its comment:" << comments.at(name);
  });
}

TEST(ProtoComments, SayWhatIsRequired) {
  const auto comments = read_comments();
  each_number([&](const std::string& name, const FieldRule& rule) {
    if (rule.absence != Absence::kRefused || name.starts_with("Vertex.") ||
        name.starts_with("Start.")) {
      return;  // those two have it in the comment of the message
    }
    EXPECT_NE(lower(comments.at(name)).find("required"), std::string::npos) << name;
  });
}

}  // namespace
}  // namespace ergocast
