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

TEST(PlanProto, IsWhatAPlansBytesAre) {
  Mission rich = test::rich_mission_in_space();
  rich.wait_for_logger = true;
  Mission high = test::with_places(test::rich_mission());
  high.objects.places_m[0].z() = 1;  // as no plan that is accepted
  proto::Plan all;
  for (const Mission& mission :
       {rich, test::with_inertia(rich), test::with_wings(test::rich_mission()),
        test::with_walls(test::rich_mission()), test::with_free_domain(test::rich_mission()),
        test::with_lease(test::rich_mission()), test::with_stations(rich), high,
        test::with_false_alarms(test::rich_mission()), test::with_sites(test::rich_mission())}) {
    const std::vector<std::byte> bytes = encode_plan(mission);
    proto::Plan plan;
    ASSERT_TRUE(plan.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
    const std::string again = plan.SerializeAsString();
    EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(again)), bytes));
    all.MergeFrom(plan);
  }
  proto::Plan::Kind kind;
  for (const proto::Plan::Kind& one : all.kind()) kind.MergeFrom(one);
  *all.mutable_kind(0) = kind;
  expect_all_said(all);
}

}  // namespace
}  // namespace ergocast
