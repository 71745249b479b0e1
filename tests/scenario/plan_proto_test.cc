// SPDX-License-Identifier: BSD-3-Clause
// plan/plan.proto describes the bytes of the plan: Protobuf reads them with it and writes the same.
#include <gtest/gtest.h>

#include "plan/mission_fields.h"
#include "plan/plan.h"
#include "plan/plan.pb.h"
#include "tests/plan/rich_mission.h"

namespace ergocast {
namespace {

namespace pb = google::protobuf;

/// Fails for each field of the message that its bytes do not contain, and for each unknown field.
void expect_all_said(const pb::Message& message) {
  const pb::Reflection& at = *message.GetReflection();
  EXPECT_TRUE(at.GetUnknownFields(message).empty())
      << message.GetDescriptor()->full_name() << ": "
      << at.GetUnknownFields(message).field(0).number() << " is not in plan/plan.proto";
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const pb::FieldDescriptor* field = message.GetDescriptor()->field(i);
    const bool printed =
        field->is_repeated() ? at.FieldSize(message, field) > 0 : at.HasField(message, field);
    EXPECT_TRUE(printed) << field->full_name() << " is in no plan";
    if (!printed || field->type() != pb::FieldDescriptor::TYPE_MESSAGE) continue;
    expect_all_said(field->is_repeated() ? at.GetRepeatedMessage(message, field, 0)
                                         : at.GetMessage(message, field));
  }
}

/// Compares the names of plan/plan.proto by number with the list of a mission's fields.
class PlanNames : public FieldVisitor {
 public:
  explicit PlanNames(const pb::Descriptor& message) : message_(message) {}

  void number(int number, const char* name, auto&, const Limits&, bool = true) {
    expect(number, name);
  }
  void number_unless(int number, const char* name, auto&, const Limits&, double) {
    expect(number, name);
  }
  void height(int number, const char* name, auto&, const Limits&, double) { expect(number, name); }
  void flag(int number, const char* name, auto&) { expect(number, name); }
  void choice(int number, const char* name, auto&, Words words, bool = true) {
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
  void walls(int number, const char* name, auto&) { expect(number, name); }
  void part(int number, const char* name, auto& part) {
    const pb::FieldDescriptor* field = expect(number, name);
    if (field == nullptr) return;
    PlanNames inner(*field->message_type());
    list_fields(inner, part);
  }

 private:
  /// A block of the scenario, such as agents, is not a block of the plan.
  const pb::FieldDescriptor* expect(int number, const std::string& name) {
    const pb::FieldDescriptor* field = message_.FindFieldByNumber(number);
    EXPECT_TRUE(field != nullptr && field->name() == name.substr(name.rfind('.') + 1))
        << number << " of " << message_.full_name() << " is not " << name;
    return field;
  }

  const pb::Descriptor& message_;
};

TEST(PlanProto, HasTheFieldsOfAMission) {
  PlanNames names(*proto::Plan::descriptor());
  const Mission mission;
  list_fields(names, mission);
}

TEST(PlanProto, IsWhatAPlansBytesAre) {
  Mission rich = test::rich_mission_in_space();
  rich.wait_for_logger = true;
  proto::Plan all;
  for (const Mission& mission :
       {rich, test::with_inertia(rich), test::with_wings(test::rich_mission()),
        test::with_walls(test::rich_mission()), test::with_free_domain(test::rich_mission()),
        test::with_lease(test::rich_mission()), test::with_stations(rich)}) {
    const std::vector<std::byte> bytes = encode_plan(mission);
    proto::Plan plan;
    ASSERT_TRUE(plan.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
    const std::string again = plan.SerializeAsString();
    EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(again)), bytes));
    all.MergeFrom(plan);
  }
  proto::Plan::Kind kind;
  for (const proto::Plan::Kind& one : all.kinds()) kind.MergeFrom(one);
  *all.mutable_kinds(0) = kind;
  expect_all_said(all);
}

}  // namespace
}  // namespace ergocast
