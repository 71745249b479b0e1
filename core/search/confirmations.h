// SPDX-License-Identifier: BSD-3-Clause
// What a team with false alarms has found: the objects in contacts that all its looks and reports
// together confirm. An agent may know a little less at a time, because its teammates' looks reach
// it later.
//
// A contact with no report of an object is wrong: it is made of false alarms.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/measure/finds.h"
#include "core/mission/mission.h"
#include "core/search/contact.h"
#include "core/search/contacts.h"
#include "core/search/efforts.h"

namespace ergocast {

class Confirmations {
 public:
  /// Every detection confirms at once what it detects.
  Confirmations() = default;
  explicit Confirmations(const Mission& mission);

  /// From now on `target` says how likely objects are where: μ in the basis (2).
  void begin_target(const Coefficients& target);
  /// Takes in all notes of the mission. What a team forgets confirms nothing any more, and a
  /// contact that is confirmed there later is another one.
  void note(std::span<const SearchNote> notes, std::span<const Hold> holds);
  /// An agent that covers is at `x_m` in tick `counted`; ticks ascend.
  /// @param detected  what its sensor detects
  /// @param cell      what it reports; one that does not exist, such as kNoCell: nothing
  /// @return the objects that are found by now, among them those that were found earlier
  ObjectSet see(AgentId id, Tick counted, const Eigen::Vector3d& x_m, ObjectSet detected,
                std::int32_t cell);
  /// How many contacts that were confirmed are wrong.
  int wrong() const { return wrong_; }
  /// The contacts by what is known now, the likeliest first, confirmed ones before others. Costs a
  /// renewal of Contacts.
  std::vector<Contact> contacts() const;

 private:
  /// What is known in a mission with false alarms.
  struct Knowledge {
    explicit Knowledge(const Mission& mission);

    Efforts efforts;
    Contacts contacts;
    Basis basis;  // (2)
    IndexedRings walls;
    // By cell, from reports of which some still count:
    std::vector<ObjectSet> reported;
    std::vector<char> known;   // whether it is of a contact that was confirmed
    std::vector<Tick> newest;  // the tick of the newest report
  };
  void forget();
  void take_in(std::size_t contact);

  std::optional<Knowledge> known_;
  ObjectSet found_ = 0;
  int wrong_ = 0;
};

}  // namespace ergocast
