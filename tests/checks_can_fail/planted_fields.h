// SPDX-License-Identifier: BSD-3-Clause
// Every field of a scenario outside its limits, missing, or with a word that it does not have.
#pragma once

#include <google/protobuf/message.h>

#include <functional>
#include <set>
#include <string>

#include "scenario/parse/fields.h"
#include "scenario/scenario.pb.h"
#include "tests/checks_can_fail/planted_scenarios.h"

namespace ergocast::test {

class PlantedFields : public PlantedScenarios {
 protected:
  /// Each field at its limits, and missing.
  void plant_in_fields();

 private:
  using Block = google::protobuf::Message;
  using FieldDescriptor = google::protobuf::FieldDescriptor;

  proto::Scenario rich_scenario() const;
  void expect_said(const std::string& path, const std::string& what,
                   const std::function<void(Block&, const FieldDescriptor&)>& spoil);
  void expect_value_refused(const std::string& path, double value, const std::string& what);
  void expect_limits(const FieldDescriptor& field, const std::string& path, const FieldRule& rule);
  void plant_in_fields_of_rich(std::set<std::string>& covered);

  const char* rich_ = nullptr;  // the scenario with all fields
};

}  // namespace ergocast::test
