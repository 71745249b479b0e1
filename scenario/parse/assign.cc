// SPDX-License-Identifier: BSD-3-Clause
// Follows a path through Protobuf's reflection, and has the text parser read the value.
#include "scenario/parse/assign.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "scenario/parse/explain.h"

namespace ergocast {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// A field of a block that exists.
struct Target {
  Message* message = nullptr;
  const FieldDescriptor* field = nullptr;
};

/// Keeps the parser's first error.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int, int, const std::string& message) override {
    if (!error_text) error_text = message;
  }
  std::optional<std::string> error_text;
};

class Assignment {
 public:
  Assignment(const FieldValue& field, proto::Scenario& scenario, Findings& findings)
      : field_(field), scenario_(scenario), findings_(findings) {}

  void run() {
    if (const std::string other = findings_.blamed(field_.path); !other.empty()) {
      return problem(other + " sets it too", "leave out one of them");
    }
    const std::optional<Target> target = find();
    if (!target) return;
    if (target->field->cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
      return problem("is a text", "name a field with a number or one of a few words");
    }
    findings_.blame(field_.path, field_.flag);
    write(*target);
  }

 private:
  void problem(const std::string& what, std::string remedy) {
    findings_.add_to_flag(field_.flag, what, std::move(remedy));
  }

  /// Follows the path, block by block.
  std::optional<Target> find() {
    Message* message = &scenario_;
    std::string_view rest = field_.path;
    while (true) {
      const std::string_view step = rest.substr(0, rest.find('.'));
      rest.remove_prefix(std::min(rest.size(), step.size() + 1));
      const std::size_t bracket = step.find('[');
      const FieldDescriptor* field = named(*message, std::string(step.substr(0, bracket)));
      if (field == nullptr) return std::nullopt;
      const bool is_block = field->message_type() != nullptr;
      if (is_block == rest.empty()) return at_a_block(*field);
      if (field->is_repeated() != (bracket != std::string_view::npos)) return count_wrong(*field);
      if (rest.empty()) return Target{message, field};
      message = field->is_repeated() ? element(*message, *field, step.substr(bracket))
                                     : message->GetReflection()->MutableMessage(message, field);
      if (message == nullptr) return std::nullopt;
    }
  }

  const FieldDescriptor* named(const Message& message, const std::string& name) {
    const auto& type = *message.GetDescriptor();
    if (const FieldDescriptor* field = type.FindFieldByName(name)) return field;
    const std::string what = "unknown field \"" + name + "\" in " + type.name();
    if (const auto meant = field_meant(type, name)) {
      const std::string block = meant->block.empty() ? block_of(name) : meant->block + ".";
      problem(what, "did you mean " + block + meant->field + "?");
    } else {
      problem(what, "the fields there are " + names_of_fields(type));
    }
    return nullptr;
  }

  /// The part of the path before `name`.
  std::string block_of(const std::string& name) const {
    return field_.path.substr(0, field_.path.find(name));
  }

  std::optional<Target> at_a_block(const FieldDescriptor& field) {
    if (field.message_type() == nullptr) {
      problem(field.name() + " has no fields of its own", "end the path there");
    } else {
      const std::string index = field.is_repeated() && !field_.path.ends_with(']') ? "[0]." : ".";
      problem("is a block", "name one of its fields, such as " + field_.path + index +
                                field.message_type()->field(0)->name());
    }
    return std::nullopt;
  }

  std::optional<Target> count_wrong(const FieldDescriptor& field) {
    if (field.is_repeated()) {
      problem("there may be several " + field.name(), "say which, such as " + field.name() + "[0]");
    } else {
      problem("there is only one " + field.name(), "leave out the brackets");
    }
    return std::nullopt;
  }

  Message* element(Message& message, const FieldDescriptor& field, std::string_view brackets) {
    const int size = message.GetReflection()->FieldSize(message, &field);
    int index = -1;
    const auto read =
        std::from_chars(brackets.data() + 1, brackets.data() + brackets.size(), index);
    const bool closed = std::string_view(read.ptr, brackets.data() + brackets.size()) == "]";
    if (closed && index >= 0 && index < size) {
      return message.GetReflection()->MutableRepeatedMessage(&message, &field, index);
    }
    const std::string lists = "the scenario lists " + std::to_string(size) + " " + field.name();
    problem(lists,
            size == 0 ? "list them first" : "write [0] to [" + std::to_string(size - 1) + "]");
    return nullptr;
  }

  void write(const Target& target) {
    const auto* words = target.field->enum_type();
    if (words != nullptr && words->FindValueByName(field_.value) == nullptr) {
      return problem("unknown value \"" + field_.value + "\"",
                     "write one of " + enum_names(*words));
    }
    FirstError error;
    google::protobuf::TextFormat::Parser parser;
    parser.RecordErrorsTo(&error);
    if (parser.ParseFieldValueFromString(field_.value, target.field, target.message)) return;
    const std::string message = error.error_text.value_or("Expected the value to end");
    BrokenField broken{};
    broken.text = field_.value;
    Problem explanation = explained(message, broken);
    problem(explanation.what, std::move(explanation.remedy));
  }

  const FieldValue& field_;
  proto::Scenario& scenario_;
  Findings& findings_;
};

}  // namespace

void assign(const FieldValue& field, proto::Scenario& scenario, Findings& findings) {
  Assignment(field, scenario, findings).run();
}

}  // namespace ergocast
