// SPDX-License-Identifier: BSD-3-Clause
// The recorded trajectory of a mission of real processes, with the queries of tests.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "core/base/ids.h"

namespace ergocast::test {

struct RecordedRow {
  double x_m = 0, y_m = 0, vx_mps = 0, vy_mps = 0;
  bool stands() const { return vx_mps == 0 && vy_mps == 0; }
};

/// By tick, then agent.
using RecordedRows = std::map<Tick, std::map<AgentId, RecordedRow>>;

inline RecordedRows recorded_rows(const std::filesystem::path& run_dir) {
  RecordedRows rows;
  std::ifstream in(run_dir / "trajectory.csv");
  for (std::string line; std::getline(in, line);) {
    long long tick = 0;
    int agent = 0;
    RecordedRow row;
    const int read = std::sscanf(line.c_str(), "%lld,%*[^,],%d,%lf,%lf,%lf,%lf", &tick, &agent,
                                 &row.x_m, &row.y_m, &row.vx_mps, &row.vy_mps);
    if (read == 6) rows[tick][agent] = row;
  }
  return rows;
}

}  // namespace ergocast::test
