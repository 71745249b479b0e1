// SPDX-License-Identifier: BSD-3-Clause
// Accepts ASCII letters, digits and a few signs, and replaces all other characters where it
// makes a name.
#include "scenario/names.h"

#include <algorithm>

namespace ergocast {
namespace {

/// ASCII only: std::isalnum depends on the locale.
bool may_lead(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}
bool may_follow(char c) { return may_lead(c) || c == '-' || c == '.'; }

}  // namespace

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxNameLength && may_lead(name.front()) &&
         std::all_of(name.begin(), name.end(), may_follow);
}

std::string name_from(std::string_view text) {
  std::string name(text.substr(0, kMaxNameLength));
  if (name.empty()) return "scenario";
  for (char& c : name) {
    if (!may_follow(c)) c = '_';
  }
  if (!may_lead(name.front())) name.front() = '_';
  return name;
}

}  // namespace ergocast
