// SPDX-License-Identifier: BSD-3-Clause
// Takes away elements that use no others until none is left, or only circles are.
#include "target/geo/svg_references.h"

#include <string_view>

#include "target/geo/svg_names.h"
#include "target/geo/svg_shapes.h"

namespace ergocast {
namespace {

/// What painting makes of another element than these is nothing, without a word.
bool fits(std::string_view property, std::string_view element, const pugi::xml_node& node) {
  const bool gradient = element == "linearGradient" || element == "radialGradient";
  if (property == "fill" || property == "stroke") return gradient;
  if (property == "clip-path") return element == "clipPath";
  if (property.starts_with("marker")) return element == "marker";
  if (property == "mask") return element == "mask";
  if (local_name(node) != "use") return gradient;
  // librsvg does not give a drawing in a drawing the size of its <use>.
  if (element == "svg") return !node.attribute("width") && !node.attribute("height");
  return is_svg_shape(element) || element == "g" || element == "symbol" || element == "use" ||
         element == "a" || element == "switch";
}

}  // namespace

/// Empty if there is none.
std::string SvgReferences::flaw_of(const Reference& reference) const {
  const auto found = ids_.find(reference.id);
  if (found == ids_.end()) return "which is not there";
  const std::string& element = found->second;
  if (local_name(reference.node) == "pattern") return "";  // only its own users matter
  // librsvg leaves out those with small tiles.
  if (element == "pattern") return "which is a pattern and is not painted";
  if (fits(reference.property, element, reference.node)) return "";
  return "which is a <" + element + "> and is not painted there";
}

void SvgReferences::check(const SvgPlaces& places, PolygonFileProblems& problems) const {
  for (const Reference& one : references_)
    if (const std::string flaw = flaw_of(one); !flaw.empty())
      problems.add({places.of(one.node), one.property + " refers to #" + one.id + ", " + flaw,
                    one.property == "fill" || one.property == "stroke"
                        ? "give it a colour"
                        : "delete it, or draw #" + one.id + " anew"});
  if (!problems.empty()) return;
  std::map<std::string, std::size_t> waiting;
  std::map<std::string, std::vector<std::string>> users;
  std::vector<std::string> ready;
  for (const auto& [id, element] : ids_) {
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
  for (const Reference& one : references_)
    if (waiting.at(one.id) > 0)
      problems.add({places.of(one.node), "refers to itself through #" + one.id, "delete it"});
}

}  // namespace ergocast
