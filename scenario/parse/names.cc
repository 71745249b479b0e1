// SPDX-License-Identifier: BSD-3-Clause
// Makes a name of any text: each character that a name may not have becomes an underscore.
#include "scenario/parse/names.h"

#include "plan/mission_limits.h"

namespace ergocast {

std::string name_from(std::string_view text) {
  std::string name(text.substr(0, kMaxNameLength));
  if (name.empty()) return "scenario";
  for (char& c : name) {
    if (!is_name(std::string{'_', c})) c = '_';
  }
  if (!is_name(name)) name.front() = '_';
  return name;
}

}  // namespace ergocast
