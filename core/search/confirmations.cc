// SPDX-License-Identifier: BSD-3-Clause
// Asks for new contacts whenever something is reported: looks alone confirm none.
#include "core/search/confirmations.h"

#include <algorithm>

#include "core/measure/target_mass.h"

namespace ergocast {

Confirmations::Knowledge::Knowledge(const Mission& mission)
    : efforts(mission),
      contacts(mission),
      basis(in_cosines(mission).basis),
      walls(mission.walls),
      reported(efforts.cells().cells.total(), 0),
      known(reported.size(), 0),
      newest(reported.size(), 0) {}

Confirmations::Confirmations(const Mission& mission) {
  if (!mission.sensor.has_false_alarms()) return;
  known_.emplace(mission);
  begin_target(in_cosines(mission).target_coefficients);
}

void Confirmations::begin_target(const Coefficients& target) {
  if (known_)
    known_->contacts.set_prior(
        target_mass(known_->basis, known_->walls, target, known_->efforts.cells().cells));
}

void Confirmations::note(std::span<const SearchNote> notes, std::span<const Hold> holds) {
  if (known_) known_->efforts.note(notes, holds);
}

/// Where no report counts any more, because all have faded or were forgotten, nothing is known: an
/// object that was reported there may have drifted away.
void Confirmations::forget() {
  for (std::size_t cell = 0; cell < known_->reported.size(); ++cell) {
    const TileCell at = known_->efforts.cells().tile_cell(static_cast<std::int32_t>(cell));
    if (known_->efforts.reports(at) > 0) continue;
    known_->reported[cell] = 0;
    known_->known[cell] = 0;
  }
}

ObjectSet Confirmations::see(AgentId id, Tick counted, const Eigen::Vector3d& x_m,
                             ObjectSet detected, std::int32_t cell) {
  if (!known_) return detected;
  const Author author{id, 0};
  known_->efforts.add_row(author);
  if (known_->efforts.set_now(counted)) forget();
  known_->efforts.look(author, counted, x_m);
  if (cell < 0 || static_cast<std::size_t>(cell) >= known_->reported.size()) return found_;
  known_->efforts.report(author, counted, cell);
  known_->reported[static_cast<std::size_t>(cell)] |= detected & (~detected + 1);  // the lowest
  known_->newest[static_cast<std::size_t>(cell)] = counted;
  known_->contacts.renew(known_->efforts);
  for (const std::size_t contact : known_->contacts.confirmed_contacts()) take_in(contact);
  return found_;
}

/// A contact that shares cells with an earlier one is the same.
void Confirmations::take_in(std::size_t contact) {
  ObjectSet here = 0;
  bool is_new = true;
  known_->contacts.for_neighbours(contact, [&](std::size_t cell) {
    here |= known_->reported[cell];
    is_new = is_new && known_->known[cell] == 0;
    known_->known[cell] = 1;
  });
  found_ |= here;
  if (here == 0 && is_new) ++wrong_;
}

std::vector<Contact> Confirmations::contacts() const {
  if (!known_) return {};
  const Efforts& efforts = known_->efforts;
  Contacts now = known_->contacts;
  now.renew(efforts);
  std::vector<Contact> all;
  for (const auto& [cell, probability, confirmed] : now.judged()) {
    Contact& one = all.emplace_back();
    one.cell = static_cast<std::int32_t>(cell);
    one.probability = probability;
    one.confirmed = confirmed;
    one.x_m = efforts.cells().middle_m(one.cell);
    now.for_neighbours(cell, [&](std::size_t near) {
      const TileCell at = efforts.cells().tile_cell(static_cast<std::int32_t>(near));
      one.reports += static_cast<std::int32_t>(efforts.reports(at));
      if (efforts.reports(at) > 0) one.newest = std::max(one.newest, known_->newest[near]);
    });
  }
  return all;
}

}  // namespace ergocast
