// SPDX-License-Identifier: BSD-3-Clause
// Each result that `ergocast verify` can report, from a record that was falsified for it.
#include <functional>
#include <span>
#include <sstream>

#include "logger/mission_text.h"
#include "plan/plan.h"
#include "tests/checks_can_fail/expect_said.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

void edit(const fs::path& file, const std::function<void(std::string&)>& change) {
  std::string text = text_of(file);
  change(text);
  write(file, text);
}

void edit_lines(const fs::path& file, const std::function<void(Lines&)>& change) {
  std::istringstream in(text_of(file));
  Lines lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  change(lines);
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  write(file, text);
}

void edit_summary(const fs::path& run, const std::function<void(Json&)>& change) {
  Json summary = Json::parse(text_of(run / "summary.json"));
  change(summary);
  write(run / "summary.json", summary.dump(2));
}

/// Makes the record look like a run over LCM, which `verify` checks for events that it cannot
/// repeat.
void call_it_a_run(
    const fs::path& run, const std::function<void(Json&)>& change = [](Json&) {}) {
  edit_summary(run, [&](Json& summary) {
    summary["run_id"] = "0123456789abcdef";
    change(summary);
  });
}

void change_a_cell(const fs::path& table) {
  edit_lines(table,
             [](Lines& lines) { lines.at(3).back() = lines.at(3).back() == '9' ? '8' : '9'; });
}

struct Lie {
  std::string printed;
  int exit_code;
  std::function<void(const fs::path& run)> falsify;
};

/// Falsifies the summary and the events that make a run unrepeatable.
std::vector<Lie> lies_of_the_summary() {
  const auto agent = [](const char* key, const Json& value) {
    return [key, value](Json& summary) { summary["agents"][0][key] = value; };
  };
  return {
      {"its summary names no agents", 2,
       [](const fs::path& run) { call_it_a_run(run, [](Json& s) { s.erase("agents"); }); }},
      {"its roster has 5 entries", 2,
       [](const fs::path& run) {
         call_it_a_run(run, [](Json& s) { s["agents"].push_back(s["agents"][0]); });
       }},
      {"left or was evicted at tick 5", 2,
       [=](const fs::path& run) { call_it_a_run(run, agent("active_until", 5)); }},
      {"did not count for a while", 2,
       [=](const fs::path& run) { call_it_a_run(run, agent("coverage_switched_at", 7)); }},
      {"another program than ergocast-sim", 2,
       [](const fs::path& run) {
         call_it_a_run(run, [](Json& s) { s["processes"] = {{{"name", "world"}}}; });
       }},
      {"the operator recalled agent 1 at tick 3", 2,
       [](const fs::path& run) {
         call_it_a_run(run, [](Json& s) {
           s["recalls"] = {{{"agent", 1}, {"from_tick", 3}, {"sent_out", false}}};
         });
       }},
      {"joined at tick 3", 2,
       [=](const fs::path& run) { call_it_a_run(run, agent("active_from", 3)); }},
      {"is not one that ergocast wrote", 2,
       [](const fs::path& run) {
         call_it_a_run(run, [](Json& s) { s["agents"][0].erase("id"); });
       }},
      {"its agents followed \"Spiral\", a law of its user", 2,
       [](const fs::path& run) { edit_summary(run, [](Json& s) { s["own_law"] = "Spiral"; }); }},
      {"summary.json, /ticks", 1,
       [](const fs::path& run) { edit_summary(run, [](Json& s) { s["ticks"] = 49; }); }},
      {"summary.json, /scenario_hash", 1,
       [](const fs::path& run) { edit_summary(run, [](Json& s) { s["scenario_hash"] = "0"; }); }},
      {"so restarts are unknown", 0, [](const fs::path& run) { fs::remove(run / "summary.json"); }},
  };
}

std::vector<Lie> lies_of_the_tables() {
  const auto keep = [](const fs::path& run, const char* table, int ticks, int without = -1) {
    edit_lines(run / table, [=](Lines& lines) {
      std::erase_if(lines, [=](const std::string& row) {
        const int tick = std::isdigit(row[0]) != 0 ? std::stoi(row) : -1;
        return tick > ticks || (tick >= 0 && tick == without);
      });
    });
  };
  return {
      {", first at tick 0, agent ", 1,
       [](const fs::path& run) { change_a_cell(run / "trajectory.csv"); }},
      {"but the file ends after tick 30", 1,
       [=](const fs::path& run) { keep(run, "trajectory.csv", 30); }},
      {"goes on after the plan's last tick", 1,
       [](const fs::path& run) {
         edit_lines(run / "trajectory.csv", [](Lines& l) { l.push_back("999" + l.back()); });
       }},
      {"lacks rows, first those of tick 20", 1,
       [=](const fs::path& run) { keep(run, "trajectory.csv", 1000, 20); }},
      {"ends amid tick", 1,
       [](const fs::path& run) {
         edit_summary(run, [](Json& s) { s["result"] = "stopped"; });
         edit_lines(run / "trajectory.csv", [](Lines& lines) { lines.resize(lines.size() - 2); });
       }},
      // The record of a killed logger, with a gap after its last metrics.
      {"1 ticks before that are missing", 0,
       [=](const fs::path& run) {
         fs::remove(run / "summary.json");
         keep(run, "trajectory.csv", 48, 45);
         keep(run, "metrics.csv", 40);
       }},
      {"metrics.csv:4, column", 1, [](const fs::path& run) { change_a_cell(run / "metrics.csv"); }},
      {"goes on after the trajectory's end", 1,
       [](const fs::path& run) {
         edit_lines(run / "metrics.csv", [](Lines& l) { l.push_back("999" + l.back()); });
       }},
      {"ends before the trajectory does", 1,
       [](const fs::path& run) {
         edit_lines(run / "metrics.csv", [](Lines& lines) { lines.pop_back(); });
       }},
      {"the header is", 1,
       [](const fs::path& run) {
         edit_lines(run / "metrics.csv", [](Lines& lines) { lines[0] = "time"; });
       }},
      {"is longer than any row", 1,
       [](const fs::path& run) {
         edit_lines(run / "metrics.csv",
                    [](Lines& lines) { lines.insert(lines.begin() + 3, std::string(20000, '1')); });
       }},
      {"cannot be opened", 2, [](const fs::path& run) { fs::remove(run / "trajectory.csv"); }},
  };
}

Mission plan_in(const fs::path& run) {
  const std::string plan = text_of(run / "plan.binpb");
  return decode_plan(std::as_bytes(std::span(plan))).value();
}
void write_plan(const fs::path& run, const Mission& mission) {
  const std::vector<std::byte> plan = encode_plan(mission);
  write(run / "plan.binpb", {reinterpret_cast<const char*>(plan.data()), plan.size()});
}

std::vector<Lie> lies_of_the_sources() {
  return {
      {"damaged or of a much newer version", 2,
       [](const fs::path& run) { write(run / "plan.binpb", "rubbish"); }},
      {"is of version 9.9.9, this program is", 2,
       [](const fs::path& run) {
         edit(run / "plan.binpb", [](std::string& plan) {
           plan.replace(0, 2 + plan.at(1),
                        "\x0a\x05"
                        "9.9.9");
         });
       }},
      {"but breaks that version's rules", 2,
       [](const fs::path& run) {
         Mission mission = plan_in(run);
         mission.basis.modes_x = 1000;
         write_plan(run, mission);
       }},
      {"not what scenario.textproto compiles to", 1,
       [](const fs::path& run) {
         edit(run / "scenario.textproto",
              [](std::string& text) { text.insert(text.find("seed: ") + 6, "1"); });
       }},
      {"scenario.textproto:", 1,
       [](const fs::path& run) {
         edit(run / "scenario.textproto", [](std::string& text) { text += "# more\n"; });
       }},
      {"(the file has ended)", 1,
       [](const fs::path& run) {
         edit_lines(run / "target_density.csv", [](Lines& lines) { lines.pop_back(); });
       }},
      {"is longer than what it should hold", 1,
       [](const fs::path& run) {
         edit(run / "target_density.csv",
              [](std::string& text) { text.append(std::size_t{2} << 20, ' '); });
       }},
      {"report.html:", 1,
       [](const fs::path& run) {
         edit(run / "report.html", [](std::string& text) { text += "!"; });
       }},
      {"scenario.textproto           is not there", 0,
       [](const fs::path& run) { fs::remove(run / "scenario.textproto"); }},
      // The record of a manually started logger that has received only the plan.
      {"all but the target, which it lacks", 0,
       [](const fs::path& run) {
         write(run / "scenario.textproto", mission_text(plan_in(run)));
         fs::remove(run / "target_density.csv");
         edit(run / "report.html", [](std::string& text) { text += "!"; });
       }},
  };
}

class VerifyCanFail : public OwnHost {
 protected:
  void record(std::vector<std::string> arguments, const fs::path& run) {
    arguments.insert(arguments.end(), {"--duration", "5", "--out", run});
    ASSERT_EQ(ergocast(arguments), 0) << output();
  }
  void expect(const fs::path& run, int exit_code, const std::string& printed) {
    EXPECT_EQ(ergocast({"verify", run}), exit_code) << printed << ":\n" << output();
    EXPECT_NE(output().find(printed), std::string::npos) << printed << ":\n" << output();
    said_.push_back(output());
  }
  void expect_seen(const Lie& lie) {
    const fs::path run = folder_ / "falsified";
    fs::remove_all(run);
    fs::copy(out(), run, fs::copy_options::recursive);
    lie.falsify(run);
    expect(run, lie.exit_code, lie.printed);
  }

  std::vector<std::string> said_;
};

TEST_F(VerifyCanFail, InEachOfItsFindings) {
  const auto scenario = scenario_file("quadrimodal_corners");
  record({"simulate", scenario}, out());
  expect(out(), 0, "identical to its simulation");
  for (const auto& lies : {lies_of_the_summary(), lies_of_the_tables(), lies_of_the_sources()}) {
    for (const Lie& lie : lies) expect_seen(lie);
  }

  const fs::path over_lcm = folder_ / "over_lcm", in_real_time = folder_ / "in_real_time",
                 with_map = folder_ / "with_map";
  record({"run", scenario}, over_lcm);
  expect(over_lcm, 0, ", the machine and the network");
  record({"simulate", scenario, "--realtime"}, in_real_time);
  call_it_a_run(in_real_time);
  expect(in_real_time, 2, "it ran in real time");
  write(folder_ / "even.csv", "1,2\n");
  std::string text = text_of(scenario);
  text.replace(
      text.find("gaussians"), 0,
      "maps { file: \"even.csv\" origin_x_m: 0 origin_y_m: 0 size_x_m: 2000 size_y_m: 2000 }\n");
  write(folder_ / "with_map.textproto", text);
  record({"simulate", folder_ / "with_map.textproto"}, with_map);
  fs::remove(folder_ / "even.csv");
  expect(with_map, 0, "its maps are missing");

  // The file also has the words of --help.
  ASSERT_EQ(ergocast({"verify", "--help"}), 0) << output();
  said_.push_back(output());

  expect_all_said({"cli/record/verify.cc", "cli/record/record_comparison.cc",
                   "cli/record/trajectory_comparison.cc", "logger/table_lines.cc", "plan/plan.cc"},
                  said_, {{"plan/plan.cc", "out of memory", "nothing here is large enough"}},
                  Words::kMayBeShared);
}

}  // namespace
}  // namespace ergocast::test
