// SPDX-License-Identifier: BSD-3-Clause
// team/plan.proto describes the bytes of the plan: Protobuf reads them with it and writes the same.
#include <google/protobuf/compiler/importer.h>
#include <google/protobuf/dynamic_message.h>
#include <gtest/gtest.h>

#include <map>

#include "core/mission_fields.h"
#include "team/plan.h"
#include "tests/team/rich_mission.h"

namespace ergocast {
namespace {

namespace pb = google::protobuf;

class PlanProto : public ::testing::Test, private pb::compiler::MultiFileErrorCollector {
 protected:
  PlanProto() : importer_(&tree_, this) {
    tree_.MapPath("", ERGOCAST_SOURCE_DIR);
    const auto* file = importer_.Import("team/plan.proto");
    plan_ = file == nullptr ? nullptr : file->FindMessageTypeByName("Plan");
  }

  pb::compiler::DiskSourceTree tree_;
  pb::compiler::Importer importer_;
  const pb::Descriptor* plan_;

 private:
  void AddError(const std::string& file, int line, int, const std::string& what) override {
    ADD_FAILURE() << file << ":" << line + 1 << ": " << what;
  }
};

/// Fails for each field of the message that its bytes do not say, and for each that it lacks.
void expect_all_said(const pb::Message& message) {
  const pb::Reflection& at = *message.GetReflection();
  EXPECT_TRUE(at.GetUnknownFields(message).empty())
      << message.GetDescriptor()->full_name() << ": "
      << at.GetUnknownFields(message).field(0).number() << " is not in team/plan.proto";
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const pb::FieldDescriptor* field = message.GetDescriptor()->field(i);
    const bool said =
        field->is_repeated() ? at.FieldSize(message, field) > 0 : at.HasField(message, field);
    EXPECT_TRUE(said) << field->full_name() << " is in no plan";
    if (said && field->type() == pb::FieldDescriptor::TYPE_MESSAGE)
      expect_all_said(at.GetMessage(message, field));
  }
}

/// The names of team/plan.proto by number, held against the list of a mission's fields.
class Names : public FieldVisitor {
 public:
  explicit Names(const pb::Descriptor& message) : message_(message) {}

  void number(int number, const char* name, auto&, const Limits&, bool = true) {
    expect(number, name);
  }
  void flag(int number, const char* name, auto&) { expect(number, name); }
  void choice(int number, const char* name, auto&, Words words) {
    const pb::FieldDescriptor* field = expect(number, name);
    if (field == nullptr) return;
    const pb::EnumDescriptor* values = field->enum_type();
    ASSERT_NE(values, nullptr) << name;
    ASSERT_EQ(values->value_count(), std::ssize(words)) << name;
    for (int i = 0; i < values->value_count(); ++i) {
      EXPECT_EQ(values->value(i)->name(), words.begin()[i]);
      EXPECT_EQ(values->value(i)->number(), i);
    }
  }
  void seed(int number, const char* name, auto&) { expect(number, name); }
  void name(int number, const char* name, auto&) { expect(number, name); }
  void part(int number, const char* name, auto& part) {
    const pb::FieldDescriptor* field = expect(number, name);
    if (field == nullptr) return;
    Names inner(*field->message_type());
    list_fields(inner, part);
  }

 private:
  /// A block of the scenario, such as agents, is none of the plan.
  const pb::FieldDescriptor* expect(int number, const std::string& name) {
    const pb::FieldDescriptor* field = message_.FindFieldByNumber(number);
    EXPECT_TRUE(field != nullptr && field->name() == name.substr(name.rfind('.') + 1))
        << number << " of " << message_.full_name() << " is not " << name;
    return field;
  }

  const pb::Descriptor& message_;
};

TEST_F(PlanProto, HasTheFieldsOfAMission) {
  ASSERT_NE(plan_, nullptr);
  Names names(*plan_);
  list_fields(names, test::rich_mission());
}

TEST_F(PlanProto, IsWhatAPlansBytesAre) {
  ASSERT_NE(plan_, nullptr);
  Mission mission = test::rich_mission();
  mission.wait_for_logger = true;
  const std::vector<std::byte> bytes = encode_plan(mission);
  pb::DynamicMessageFactory factory;
  const std::unique_ptr<pb::Message> message(factory.GetPrototype(plan_)->New());
  ASSERT_TRUE(message->ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
  expect_all_said(*message);
  const std::string again = message->SerializeAsString();
  EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(again)), bytes));
}

}  // namespace
}  // namespace ergocast
