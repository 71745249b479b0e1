// SPDX-License-Identifier: BSD-3-Clause
// report.html: one page without external resources.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/mission.h"
#include "logger/run_data.h"
#include "report/figures.h"

namespace ergocast {

/// A page in the report's style around `content`, which is HTML.
/// @param title  plain text
/// @param kind   the line above it, plain text
std::string framed_page(const std::string& title, const std::string& kind,
                        const std::string& header, const std::string& content);

/// The figures, two side by side.
std::string figures_section(const std::vector<Figure>& figures);

/// The page, well-formed also as XML. Keys that are missing in `summary`, or have another type, are
/// left out; all its text is escaped.
std::string report_page(const RunData& run, const Mission& mission,
                        const nlohmann::ordered_json& summary, const std::vector<Figure>& figures);

}  // namespace ergocast
