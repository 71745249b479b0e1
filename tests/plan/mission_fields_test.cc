// SPDX-License-Identifier: BSD-3-Clause
// The list of a mission's fields is complete.
#include "plan/mission_fields.h"

#include <gtest/gtest.h>

#include <utility>

namespace ergocast {
/// Used only where nothing is evaluated, so it has no definition.
struct Anything {
  template <class T>
  operator T() const;
};

namespace {

/// How many values an aggregate can be made of: its members.
template <class T, std::size_t... I>
constexpr std::size_t members(std::index_sequence<I...>) {
  if constexpr (requires { T{(void(I), Anything())...}; }) {
    return members<T>(std::make_index_sequence<sizeof...(I) + 1>());
  } else {
    return sizeof...(I) - 1;
  }
}
template <class T>
constexpr std::size_t members() {
  return members<T>(std::index_sequence<>());
}

/// Counts the fields of one part.
class Count : public FieldVisitor {
 public:
  std::size_t fields = 0;

  void number(const Field&, auto&) { ++fields; }
  void choice(const Field&, auto&, Words) { ++fields; }
  void flag(const Field&, auto&) { ++fields; }
  void text(const Field&, auto&) { ++fields; }
  void part(const Field&, auto&) { ++fields; }
  void places(const Field&, const Field&, auto&) { ++fields; }
  void derived(const Field&, auto&) { ++fields; }
};

template <class Part>
std::size_t listed() {
  Count count;
  const Part part;
  list_fields(count, part);
  return count.fields;
}

TEST(MissionFields, AreAllMembers) {
  EXPECT_EQ(listed<ControlLaw>(), members<ControlLaw>());
  EXPECT_EQ(listed<Timing>(), members<Timing>());
  EXPECT_EQ(listed<Mission>(), members<Mission>());
  EXPECT_EQ(listed<AgentKind>(), members<AgentKind>());
  EXPECT_EQ(listed<Box>(), 3 * members<Box>());  // a vector each
  EXPECT_EQ(listed<Basis>(), members<Basis>() - 1) << "no plan carries the table itself";
  EXPECT_EQ(listed<VehicleLimits>(), members<VehicleLimits>());
  EXPECT_EQ(listed<Separation>(), members<Separation>());
  EXPECT_EQ(listed<HiddenObjects>(), members<HiddenObjects>());
  EXPECT_EQ(listed<ObjectMotion>(), members<ObjectMotion>());
  EXPECT_EQ(listed<Battery>(), members<Battery>());
  EXPECT_EQ(listed<TeamSites>(), members<TeamSites>());
}

}  // namespace
}  // namespace ergocast
