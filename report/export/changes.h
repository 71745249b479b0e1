// SPDX-License-Identifier: BSD-3-Clause
// What has changed in a mission, in words, for formats that have no keys of their own for it.
#pragma once

#include <string>
#include <vector>

#include "core/mission/amendments.h"
#include "report/export/record.h"

namespace ergocast {

struct ExportedChange {
  Amendment amendment;
  double t_s = 0;    ///< of its tick, as tracks have it
  std::string text;  ///< "law u_max_mps 8"
};

/// What an amendment changes, such as "the mission is paused".
std::string change_text(const ReceivedAmendment& one, const Mission& mission);

/// All amendments of the record that are not void, ascending by number.
std::vector<ExportedChange> changes_of(const ExportRecord& record);

}  // namespace ergocast
