// SPDX-License-Identifier: BSD-3-Clause
// The conventions and numbers of a mission in sentences, for the details of the page.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/mission/mission.h"

namespace ergocast {

/// [[name, text], …]: the values that determine φ² and the page's drawing.
/// @param mission      in cosines
/// @param free_domain  whether its agents steer by the modes of a free domain
nlohmann::ordered_json conventions(const Mission& mission, bool free_domain);

}  // namespace ergocast
