// SPDX-License-Identifier: BSD-3-Clause
// Resolves a path through the parser's locations to a line and column, and sorts the problems by
// place.
#include "scenario/parse/findings.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>

#include "scenario/scenario.pb.h"

namespace ergocast {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::TextFormat;

constexpr Place kNowhere{std::numeric_limits<int>::max(), 0};

/// One step of a path: "gaussians[2]" or "sigma_m".
struct Step {
  std::string field;
  int index = 0;
};

/// Removes the first step of `path` and returns it.
Step first_step(std::string_view& path) {
  const std::string_view text = path.substr(0, path.find('.'));
  path.remove_prefix(std::min(path.size(), text.size() + 1));
  const std::size_t bracket = text.find('[');
  Step step{std::string(text.substr(0, bracket)), 0};
  if (bracket != std::string_view::npos) {
    std::from_chars(text.data() + bracket + 1, text.data() + text.size(), step.index);
  }
  return step;
}

}  // namespace

std::string to_string(const Problem& problem) {
  return problem.where + ": " + problem.what + " (" + problem.remedy + ")";
}

TextFormat::ParseLocation Findings::locate(const std::string& path) const {
  TextFormat::ParseLocation found;
  const TextFormat::ParseInfoTree* tree = locations_ ? &*locations_ : nullptr;
  const Descriptor* message = proto::Scenario::descriptor();
  std::string_view rest = path;
  while (tree != nullptr && message != nullptr && !rest.empty()) {
    const Step step = first_step(rest);
    const FieldDescriptor* field = message->FindFieldByName(step.field);
    // The tree requires −1 for the index of a field that is not repeated.
    const int index = field->is_repeated() ? step.index : -1;
    const TextFormat::ParseLocation here = tree->GetLocation(field, index);
    if (here.line < 0) break;
    found = here;
    message = field->message_type();
    tree = message == nullptr ? nullptr : tree->GetTreeForNested(field, index);
  }
  return found;
}

void Findings::add_at(Place place, Problem problem) {
  problem.where =
      file_ + ":" + std::to_string(place.line + 1) + ":" + std::to_string(place.column + 1);
  found_.push_back({place, std::move(problem)});
}

void Findings::add(const std::string& path, const std::string& what, std::string remedy) {
  if (const auto flag = flags_.find(path); flag != flags_.end()) {
    return add_to_flag(flag->second, what, std::move(remedy));
  }
  const TextFormat::ParseLocation at = locate(path);
  if (at.line < 0) {
    found_.push_back({kNowhere, {file_ + ": " + path, what, std::move(remedy)}});
  } else {
    add_at({at.line, at.column}, {"", path + ": " + what, std::move(remedy)});
  }
}

void Findings::add_to_file(std::string what, std::string remedy) {
  found_.push_back({kNowhere, {file_, std::move(what), std::move(remedy)}});
}

void Findings::add_to_flag(std::string flag, std::string what, std::string remedy) {
  found_.push_back({kNowhere, {std::move(flag), std::move(what), std::move(remedy)}});
}

std::vector<Problem> Findings::take() {
  std::stable_sort(found_.begin(), found_.end(),
                   [](const Found& a, const Found& b) { return a.place < b.place; });
  std::vector<Problem> problems;
  for (Found& found : found_) problems.push_back(std::move(found.problem));
  found_.clear();
  return problems;
}

}  // namespace ergocast
