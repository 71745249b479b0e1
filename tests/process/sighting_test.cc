// SPDX-License-Identifier: BSD-3-Clause
// `ergocast amend --sighting` and `--dismiss`: real agents obey, log and record them, their
// simulation repeats them, and a team goes to where something was sighted.
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

const std::vector<std::string> kSearch{"--set", "law.kind=SEARCH",
                                       "--set", "sensor.radius_m=100",
                                       "--set", "sensor.false_alarms_per_s=0.05"};
constexpr const char* kSighting = "sighting at (1000.0, 1000.0) m, sigma 150 m, share 0.7";

class Sightings : public RunningMission {
 protected:
  static std::vector<std::string> with(std::vector<std::string> words) {
    words.insert(words.end(), kSearch.begin(), kSearch.end());
    return words;
  }
  /// What `ergocast status` lists.
  nlohmann::json contacts() {
    EXPECT_EQ(ergocast({"status", "--json", "--lcm-url", kUrl}), 0) << output();
    return nlohmann::json::parse(output())["contacts"];
  }
  /// The time of the newest report at the place of a contact; the greatest number if none is there.
  double newest_at(const nlohmann::json& contact) {
    for (const auto& one : contacts())
      if (one["x_m"] == contact["x_m"] && one["y_m"] == contact["y_m"]) return one["t_s"];
    return std::numeric_limits<double>::max();
  }
  static std::string text(const nlohmann::json& contact, const char* form) {
    char place[80];
    std::snprintf(place, sizeof place, form, contact["x_m"].get<double>(),
                  contact["y_m"].get<double>());
    return place;
  }
  /// A place with no contact within three cells of 100 m.
  static std::string free_place(const nlohmann::json& contacts) {
    for (int x_m = 50; x_m < 2000; x_m += 100) {
      for (int y_m = 50; y_m < 2000; y_m += 100) {
        const bool free = std::all_of(contacts.begin(), contacts.end(), [&](const auto& one) {
          return std::hypot(one["x_m"].template get<double>() - x_m,
                            one["y_m"].template get<double>() - y_m) > 300;
        });
        if (free) return std::to_string(x_m) + "," + std::to_string(y_m);
      }
    }
    ADD_FAILURE() << "contacts are everywhere: " << contacts;
    return "0,0";
  }
  /// The share of the agents' rows from t = 150 s to 250 s that are within 150 m of the middle.
  static double share_near(const std::filesystem::path& run) {
    int near = 0, all = 0;
    for (const auto& [tick, row] : recorded_rows(run)) {
      if (tick < 1500 || tick >= 2500) continue;
      for (const auto& [id, one] : row) {
        ++all;
        near += std::hypot(one.x_m - 1000, one.y_m - 1000) < 150 ? 1 : 0;
      }
    }
    EXPECT_GT(all, 0);
    return static_cast<double>(near) / std::max(1, all);
  }
};

TEST_F(Sightings, AreObeyedLoggedRecordedAndRepeated) {
  Child mission = launch_endless(scenario(), with({"--lockstep", "--lcm-url", kUrl}));
  ASSERT_EQ(amend({"--sighting", "1000,1000,150,0.7", "--dry-run"}), 0) << output();
  EXPECT_TRUE(answered("it would be amendment 0")) << output();
  ASSERT_EQ(amend({"--sighting", "1000,1000,150,0.7"}), 0) << output();
  EXPECT_TRUE(answered(std::string("amendment 0, ") + kSighting + ", holds since")) << output();
  ASSERT_TRUE(eventually([&] { return !contacts().empty(); })) << output();
  const auto contact = contacts()[0];
  const std::string place = text(contact, "%.10g,%.10g"),
                    dismissed = "contact at " + text(contact, "(%.1f, %.1f)") + " m dismissed";
  ASSERT_EQ(amend({"--dismiss", place}), 0) << output();
  EXPECT_TRUE(answered("amendment 1, " + dismissed + ", holds since")) << output();
  // What is reported there later is another contact.
  EXPECT_TRUE(eventually([&] { return newest_at(contact) > contact["t_s"]; })) << output();
  ASSERT_TRUE(logs("coordinator", kSighting)) << log_of("coordinator");
  ASSERT_TRUE(logs("coordinator", dismissed)) << log_of("coordinator");
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered(kSighting)) << output();
  EXPECT_TRUE(answered(dismissed)) << output();
  EXPECT_EQ(amend({"--cancel", "1"}), 4) << output();
  EXPECT_TRUE(answered("dismissed a contact")) << output();
  ASSERT_TRUE(moves_on()) << printed();
  ASSERT_EQ(amend({"--cancel", "0"}), 0) << output();
  ASSERT_TRUE(moves_on()) << printed();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  const auto amendments = summary()["amendments"];
  ASSERT_EQ(amendments.size(), 3U);
  EXPECT_EQ(amendments[0]["share"], 0.7);
  EXPECT_EQ(amendments[1]["kind"], "dismiss");
  EXPECT_EQ(amendments[1]["x_m"], contact["x_m"]);
  EXPECT_FALSE(summary()["contacts"].empty());
  EXPECT_NE(text_of(out() / "report.html").find(dismissed), std::string::npos);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(answered("identical to its simulation")) << output();
  EXPECT_EQ(ergocast({"export", out(), "--to", "mcap"}), 0) << output();
}

TEST_F(Sightings, MakeASimulatedTeamGoThere) {
  const auto file = scenario("duration_s: 250");
  const auto simulate = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> words{"simulate", file, "--out", folder_ / name};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(ergocast(with(std::move(words))), 0) << output();
    return share_near(folder_ / name);
  };
  const double without = simulate("without", {});
  EXPECT_GT(simulate("sighted", {"--sighting", "150:1000,1000,100"}), 3 * without + 0.05);
  simulate("dismissed", {"--dismiss", "150:1000,1000"});
  EXPECT_EQ(ergocast({"verify", folder_ / "dismissed"}), 0) << output();
  EXPECT_EQ(ergocast({"verify", folder_ / "sighted"}), 0) << output();
}

TEST_F(Sightings, NameWhatIsWrong) {
  Child mission = launch_held(scenario("duration_s: 10"), {"--lcm-url", kUrl});
  const auto refuses = [&](std::vector<std::string> arguments, const std::string& why) {
    EXPECT_EQ(amend(std::move(arguments)), 2) << output();
    EXPECT_TRUE(answered(why)) << output();
  };
  refuses({"--dismiss", "500,500"}, "its sensors have no false alarms");
  refuses({"--sighting", "500,500"}, "a sighting is for a team with law.kind SEARCH");
  refuses({"--dismiss", "500"}, "is no place");
  for (const char* wrong : {"500", "5,5,0", "5,5,9,1", "5,5,9,0.5,1", "5,x"})
    refuses({"--sighting", wrong}, "is no sighting");
  refuses({"--sighting", "5,5", "--end", "60s"}, "--end");
  refuses({"--dismiss", "5,5", "--at", "60s"}, "--at");
  EXPECT_EQ(ergocast({"simulate", scenario("duration_s: 10"), "--dismiss", "1:5,5"}), 2)
      << output();
  EXPECT_TRUE(answered("its sensors have no false alarms")) << output();
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

/// The logger names 16 contacts, and this team has more. While it is paused, the list is that of
/// the pause's first tick, once that is recorded.
TEST_F(Sightings, WarnOfAPlaceThatIsNotNamedIfTheListIsFull) {
  Child mission = launch_endless(scenario(), with({"--lockstep", "--lcm-url", kUrl}));
  EXPECT_TRUE(eventually([&] { return contacts().size() == 16; })) << output();
  EXPECT_TRUE(nlohmann::json::parse(output())["more_contacts"]) << output();
  ASSERT_EQ(ergocast({"status", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(answered("and 8 or more less likely ones")) << output();
  ASSERT_EQ(ergocast({"pause", "--lcm-url", kUrl}), 0) << output();
  const auto dismissed_at = [&](const std::string& place) {
    EXPECT_EQ(amend({"--dismiss", place}), 0) << output();
    EXPECT_TRUE(answered("dismissed, holds since")) << output();
    return answered("there may be no contact at this place: the logger names only the 16");
  };
  bool warns_of_free = false, warns_of_named = true;
  EXPECT_TRUE(eventually([&] {
    const nlohmann::json before = contacts();
    warns_of_free = dismissed_at(free_place(before));
    if (contacts() != before) return false;
    warns_of_named = dismissed_at(text(before[0], "%.10g,%.10g"));
    return true;
  })) << output();
  EXPECT_TRUE(warns_of_free);
  EXPECT_FALSE(warns_of_named);
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
}

TEST_F(Sightings, AreRefusedInABox) {
  Child mission = launch_held(scenario_file("cube_corners"), {"--lcm-url", kUrl});
  const auto refused = [&](std::vector<std::string> arguments, const std::string& why) {
    EXPECT_EQ(ergocast(std::move(arguments)), 2) << output();
    EXPECT_TRUE(answered(why)) << output();
  };
  const std::string box = "a sighting is a place in a plane, and the domain is a box",
                    none = "the mission has no contacts, because its sensors have no false alarms";
  refused({"amend", "--sighting", "50,50", "--lcm-url", kUrl}, box);
  refused({"amend", "--dismiss", "50,50", "--lcm-url", kUrl}, none);
  refused({"simulate", scenario_file("cube_corners"), "--sighting", "1:50,50"}, box);
  refused({"simulate", scenario_file("cube_corners"), "--dismiss", "1:50,50"}, none);
  refused({"check", scenario_file("cube_corners"), "--set", "sensor.false_alarms_per_s=0.1"},
          "reports belong to a plane, and the domain is a box");
  release();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
}

TEST_F(Sightings, NameWhatIsWrongWithAPlace) {
  std::vector<std::string> silent = with({"--lcm-url", kUrl});
  silent.back() = "sensor.false_alarms_per_s=1e-9";
  Child mission = launch_held(scenario("duration_s: 10"), silent);
  const auto refuses = [&](std::vector<std::string> arguments, const std::string& why) {
    EXPECT_EQ(amend(std::move(arguments)), 2) << output();
    EXPECT_TRUE(answered(why)) << output();
  };
  refuses({"--sighting", "5000,500"}, "the place is outside the domain");
  refuses({"--sighting", "500,500,2e7"}, "SIGMA_M is above 1e7");
  refuses({"--dismiss", "5000,500"}, "the place is outside the domain");
  refuses({"--dismiss", "500,500"}, "there is no contact at this place");
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

}  // namespace
}  // namespace ergocast::test
