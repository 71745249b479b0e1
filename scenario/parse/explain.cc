// SPDX-License-Identifier: BSD-3-Clause
// Recognises the parser's messages by their beginnings, and suggests the nearest field or value
// name.
#include "scenario/parse/explain.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/scenario.pb.h"
#include "text/likeness.h"

namespace ergocast {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;

/// The distance of `wrong` from `name`. A forgotten unit is the most likely mistake.
int unlikeness(std::string_view wrong, std::string_view name) {
  if (name.starts_with(std::string(wrong) + "_")) return 0;
  return edit_distance(wrong, name);
}

/// The field of `message` that `wrong` most likely means, or null.
const FieldDescriptor* nearest_field(const Descriptor& message, const std::string& wrong) {
  const FieldDescriptor* best = nullptr;
  int least = most_typos_in(wrong) + 1;
  for (int i = 0; i < message.field_count(); ++i) {
    const int distance = unlikeness(wrong, message.field(i)->name());
    if (distance >= least) continue;
    best = message.field(i);
    least = distance;
  }
  return best;
}

/// The path of the block below `message` that has a field of exactly this name; empty if none.
std::string block_with(const Descriptor& message, const std::string& field,
                       const std::string& path) {
  if (!path.empty() && message.FindFieldByName(field) != nullptr) return path;
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& child = *message.field(i);
    if (child.message_type() == nullptr) continue;
    std::string found = block_with(*child.message_type(), field,
                                   path.empty() ? child.name() : path + "." + child.name());
    if (!found.empty()) return found;
  }
  return {};
}

std::string remedy_for_unknown_field(const std::string& type, const std::string& field) {
  const Descriptor* message = proto::Scenario::descriptor()->file()->FindMessageTypeByName(type);
  if (message == nullptr) return "remove it";
  const std::optional<MeantField> meant = field_meant(*message, field);
  if (!meant) return "the fields here are " + names_of_fields(*message);
  if (meant->block.empty()) return "did you mean " + meant->field + "?";
  return "write it inside " + meant->block + " { }";
}

/// The values of an enumeration field of this name, in any block; empty if there is none.
std::string values_of(const Descriptor& message, const std::string& field) {
  const FieldDescriptor* found = message.FindFieldByName(field);
  if (found != nullptr && found->enum_type() != nullptr) return enum_names(*found->enum_type());
  for (int i = 0; i < message.field_count(); ++i) {
    if (message.field(i)->message_type() == nullptr) continue;
    std::string values = values_of(*message.field(i)->message_type(), field);
    if (!values.empty()) return values;
  }
  return {};
}

std::string name_of_last(const std::string& path) { return path.substr(path.rfind('.') + 1); }

/// The first two texts in double quotes; empty if missing.
std::pair<std::string, std::string> quoted_in(const std::string& message) {
  std::array<std::string, 2> found;
  std::size_t end = std::string::npos;
  for (std::string& text : found) {
    const std::size_t begin = message.find('"', end + 1);
    if (begin == std::string::npos) break;
    end = std::min(message.find('"', begin + 1), message.size());
    text = message.substr(begin + 1, end - begin - 1);
  }
  return {found[0], found[1]};
}

/// The problem of a text that the field does not accept; `wanted` is the parser's word for the
/// type.
Problem wrong_value(const std::string& subject, const std::string& text,
                    const std::string& wanted) {
  const std::string what = subject + text + " is not ";
  if (wanted == "string") return {"", what + "a quoted text", "put it in quotes"};
  if (wanted == "double") return {"", what + "a number", "write a number such as 0.5"};
  if (text.starts_with("-")) return {"", what + "0 or above", "write a number such as 16"};
  return {"", what + "a whole number", "write a number such as 16"};
}

}  // namespace

std::optional<MeantField> field_meant(const Descriptor& message, const std::string& wrong) {
  if (const FieldDescriptor* near = nearest_field(message, wrong))
    return MeantField{"", near->name()};
  const std::string block = block_with(*proto::Scenario::descriptor(), wrong, "");
  if (block.empty()) return std::nullopt;
  return MeantField{block, wrong};
}

std::string names_of_fields(const Descriptor& message) {
  std::string names;
  for (int i = 0; i < message.field_count(); ++i) {
    names += (i == 0 ? "" : ", ") + message.field(i)->name();
  }
  return names;
}

std::string enum_names(const EnumDescriptor& type) {
  std::string names;
  for (int i = 0; i < type.value_count(); ++i) {
    names += (i == 0 ? "" : i + 1 == type.value_count() ? " or " : ", ") + type.value(i)->name();
  }
  return names;
}

Problem explained(const std::string& message, const BrokenField& broken) {
  const std::string subject = broken.path.empty() ? "" : broken.path + ": ";
  const auto [first, second] = quoted_in(message);
  if (message.find("has no field named") != std::string::npos) {
    const std::string type = first.substr(first.rfind('.') + 1);
    return {"", "unknown field \"" + second + "\" in " + type,
            remedy_for_unknown_field(type, second)};
  }
  if (message.starts_with("Unknown enumeration value")) {
    return {"", subject + "unknown value \"" + broken.text + "\"",
            "write one of " + values_of(*proto::Scenario::descriptor(), name_of_last(broken.path))};
  }
  if (message.starts_with("Invalid value for boolean")) {
    return {"", subject + broken.text + " is neither true nor false", "write true or false"};
  }
  for (const char* wanted : {"double", "integer", "string"}) {
    if (message.starts_with(std::string("Expected ") + wanted + ", got: ")) {
      return wrong_value(subject, broken.text, wanted);
    }
  }
  if (message.starts_with("Integer out of range")) {
    return {"", subject + broken.text + " is out of range", "write a smaller number"};
  }
  if (broken.decimal_comma) {
    return {"", subject + broken.text + " has a comma", "write a point instead"};
  }
  if (message.starts_with("Non-repeated field")) {
    return {"", subject + "is written more than once", "keep one of them"};
  }
  if (message.starts_with("Ignoring extension")) return {"", "unknown extension", "remove it"};
  if (message.starts_with("Interpreting non ascii codepoint"))
    return {"", subject + "a character outside of quotes is not ASCII",
            "write straight quotes and plain blanks: word processors replace them"};
  return {"", subject + message, "correct the text here"};
}

}  // namespace ergocast
