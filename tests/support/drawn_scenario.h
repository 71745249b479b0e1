// SPDX-License-Identifier: BSD-3-Clause
// Random scenarios that use every field of scenario.proto, for tests that must hold for all of
// them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "scenario/scenario.pb.h"

namespace ergocast::test {

/// Writes the maps and polygons that the drawn scenarios use.
void write_files(const std::filesystem::path& folder);

/// A small mission: up to 24 agents, 24 × 24 modes and 60 ticks, with each optional field in every
/// second scenario. Not all are valid. If scenario.proto has a block or a text that
/// drawn_scenario.cc does not know, throws std::logic_error with its name.
proto::Scenario drawn_scenario(std::uint64_t seed);

/// "Law.epsilon" of each field that is set in `message`, or in what it holds.
std::set<std::string> fields_of(const google::protobuf::Message& message);
/// All fields that a scenario can have.
std::set<std::string> all_fields();

}  // namespace ergocast::test
