// SPDX-License-Identifier: BSD-3-Clause
// Writes texts in quotes, because they have commas.
#include "studies/curves.h"

#include <sstream>
#include <stdexcept>

#include "logger/run_record.h"

namespace ergocast::studies {

void write_curves(const std::filesystem::path& file, const std::vector<CurvePoint>& points) {
  std::ostringstream out;
  out.precision(8);
  out << "panel,series,kind,x,low,middle,high\n";
  for (const CurvePoint& p : points) {
    out << '"' << p.panel << "\",\"" << p.series << "\",\"" << p.kind << "\"," << p.x << ','
        << p.low << ',' << p.middle << ',' << p.high << '\n';
  }
  if (const auto problem = write_file(file, out.str())) throw std::runtime_error(*problem);
}

}  // namespace ergocast::studies
