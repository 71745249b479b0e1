// SPDX-License-Identifier: BSD-3-Clause
// Compiles the Gaussian of a sighting as a target, and adds its coefficients to those that hold.
#include "cli/record/sighting.h"

#include <algorithm>
#include <array>

#include "cli/record/new_target.h"
#include "core/measure/detection.h"
#include "core/search/efforts.h"
#include "text/read_number.h"
#include "text/shortest.h"

namespace ergocast::cli {
namespace {

constexpr double kUsualShare = 0.5;

/// The numbers between commas, at most four; none if one of them is no number.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = read_number<double>(text.substr(begin, end - begin));
    if (!number || numbers.size() == kSearchNoteNumbers) return {};
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

Coefficients mixed(const Coefficients& holds, const Coefficients& sighted, double share) {
  Coefficients sum = (1 - share) * holds + share * sighted;
  if (sum.size() > 0) sum[0] = 1;  // which both have, and the sum up to rounding
  return sum;
}

/// Half a wave of the finest mode, along the coarser axis.
double finest_length_m(const Mission& mission) {
  const Eigen::Vector3d& size_m = mission.domain.size_m;
  return std::max(size_m.x() / mission.basis.modes_x, size_m.y() / mission.basis.modes_y);
}

std::vector<Problem> bad(std::string what, std::string remedy) {
  return {Problem{"--sighting", std::move(what), std::move(remedy)}};
}

}  // namespace

std::optional<Eigen::Vector2d> place_from(std::string_view text) {
  const std::vector<double> numbers = numbers_in(text);
  if (numbers.size() != 2) return std::nullopt;
  return Eigen::Vector2d(numbers[0], numbers[1]);
}

std::optional<SearchNote> sighting_from(std::string_view text) {
  const std::vector<double> numbers = numbers_in(text);
  if (numbers.size() < 2) return std::nullopt;
  SearchNote sighting{.x_m = {numbers[0], numbers[1]}, .share = kUsualShare};
  if (numbers.size() > 2) sighting.sigma_m = numbers[2];
  if (numbers.size() > 3) sighting.share = numbers[3];
  const bool has_sigma = numbers.size() > 2;
  if ((has_sigma && !(sighting.sigma_m > 0)) || !(sighting.share > 0 && sighting.share < 1))
    return std::nullopt;
  return sighting;
}

Result<SightedTarget, std::vector<Problem>> target_with(const Mission& mission,
                                                        const TargetChange& holds,
                                                        SearchNote sighting) {
  if (!mission.domain.planar())
    return failure(bad("a sighting is a place in a plane, and the domain is a box",
                       "give the team another target with --target"));
  if (mission.law.kind != LawKind::kSearch)
    return failure(
        bad("a sighting is for a team with law.kind SEARCH, and this one has another law",
            "give the team another target with --target"));
  if (sighting.sigma_m == 0)
    sighting.sigma_m = std::max(2 * sensor_radius_m(mission), finest_length_m(mission));
  if (!mission.domain.contains(on_ground(sighting.x_m)))
    return failure(bad("the place is outside the domain", "name a place of the domain, in metres"));
  if (!is_search_note(sighting, mission))
    return failure(bad("SIGMA_M is above 1e7", "name a smaller standard deviation"));
  const auto parsed =
      parse_new_target(mission, "target { gaussians { mean_x_m: " + shortest(sighting.x_m.x()) +
                                    " mean_y_m: " + shortest(sighting.x_m.y()) +
                                    " sigma_m: " + shortest(sighting.sigma_m) + " } }");
  if (!parsed) return failure(parsed.error());
  const TargetChange sighted = target_change_of(*parsed);
  return SightedTarget{{.target = mixed(holds.target, sighted.target, sighting.share),
                        .cosine = mixed(holds.cosine, sighted.cosine, sighting.share)},
                       sighting,
                       parsed->warnings()};
}

std::optional<Problem> why_not_dismissed(const Mission& mission, const SearchNote& dismissal) {
  if (is_search_note(dismissal, mission)) return std::nullopt;
  if (!mission.sensor.has_false_alarms())
    return Problem{"--dismiss",
                   "the mission has no contacts, because its sensors have no false alarms",
                   "leave it out, or start a mission with sensor.false_alarms_per_s"};
  return Problem{"--dismiss", "the place is outside the domain",
                 "name that of a contact, in metres"};
}

namespace {

bool is_listed(const Mission& mission, const SearchNote& dismissal, const RecordAck& recorded) {
  const auto contacts = recorded.all_contacts();
  const auto forgotten = forgotten_cells(dismissal, SearchCells(mission));
  return std::ranges::any_of(forgotten, [&](std::int32_t cell) {
    return std::ranges::find(contacts, cell, &Contact::cell) != contacts.end();
  });
}

bool may_lack_some(const RecordAck& recorded) {
  return recorded.contact_count >= recorded.contact_room();
}

}  // namespace

std::optional<Problem> why_no_contact(const Mission& mission, const SearchNote& dismissal,
                                      const RecordAck& recorded) {
  if (may_lack_some(recorded) || is_listed(mission, dismissal, recorded)) return std::nullopt;
  return Problem{"--dismiss", "there is no contact at this place",
                 recorded.contact_count == 0
                     ? "wait until sensors report something"
                     : "name the place of one that `ergocast status` lists"};
}

std::optional<Problem> why_perhaps_no_contact(const Mission& mission, const SearchNote& dismissal,
                                              const RecordAck& recorded) {
  if (!may_lack_some(recorded) || is_listed(mission, dismissal, recorded)) return std::nullopt;
  return Problem{"--dismiss",
                 "there may be no contact at this place: the logger names only the " +
                     std::to_string(recorded.contact_count) + " likeliest ones",
                 "without one, the dismissal has no effect"};
}

}  // namespace ergocast::cli
