// SPDX-License-Identifier: BSD-3-Clause
// Takes away elements that use no others until none is left, or only circles are.
#include "target/geo/svg_references.h"

namespace ergocast {

void SvgReferences::check(const SvgPlaces& places) const {
  for (const auto& [node, id] : references_) {
    if (!ids_.contains(id))
      places.fail(node, "refers to #" + id + ", which is not there", "delete it, or draw #" + id);
    // librsvg leaves out those with small tiles.
    if (patterns_.contains(id))
      places.fail(node, "has a pattern, which is not painted", "give it a colour");
  }
  std::map<std::string, std::size_t> waiting;
  std::map<std::string, std::vector<std::string>> users;
  std::vector<std::string> ready;
  for (const std::string& id : ids_) {
    const auto used = uses_.find(id);
    waiting[id] = used == uses_.end() ? 0 : used->second.size();
    if (waiting[id] == 0) ready.push_back(id);
    if (used == uses_.end()) continue;
    for (const std::string& other : used->second) users[other].push_back(id);
  }
  std::size_t done = 0;
  for (; !ready.empty(); ++done) {
    const std::string id = ready.back();
    ready.pop_back();
    for (const std::string& user : users[id])
      if (--waiting[user] == 0) ready.push_back(user);
  }
  if (done == ids_.size()) return;
  for (const auto& [node, id] : references_)
    if (waiting.at(id) > 0) places.fail(node, "refers to itself through #" + id, "delete it");
}

}  // namespace ergocast
