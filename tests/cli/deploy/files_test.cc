// SPDX-License-Identifier: BSD-3-Clause
// Bash and Compose can read the files of `ergocast deploy`.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "cli/deploy/deploy.h"
#include "runtime/process/program_options.h"
#include "tests/support/temp_folder.h"
#include "text/shell_word.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

class DeployFiles : public ::testing::Test {
 protected:
  DeployFiles() {
    mission_.name = "survey";
    mission_.folder = "/home/it's \"$HOME\"/`x`\ny";
    mission_.files = {"survey.textproto", "maps/lake.png"};
    mission_.url = LcmUrl::parse("udpm://239.1.2.3:7000?ttl=1&recv_buf_size=4096").value();
    hosts_ =
        parse_hosts("ground ops@10.0.0.1 coordinator logger sim\nrover pi@10.0.0.2 agent 0 3\n",
                    "hosts")
            .value();
  }

  /// Both files of a mission key, with a name that needs quoting; their content is their own name.
  void make_keys() {
    mission_.keys = folder_ / "our team's";
    for (const char* end : {".key", ".coordinator.key"})
      std::ofstream(mission_.keys.string() + end) << end + 1 << "\n";
  }

  /// The output of a shell command; the file's text is in $file.
  std::string output(const std::string& command, const std::string& text = "") {
    std::ofstream(folder_ / "file") << text;
    const std::string all = "file=" + (folder_ / "file").string() + "; { " + command + "\n} >" +
                            (folder_ / "out").string() + " 2>&1";
    status_ = std::system(("bash -c " + shell_word(all)).c_str());
    std::ifstream in(folder_ / "out");
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const test::TempFolder own_;
  const fs::path& folder_ = own_.path();
  DeployMission mission_;
  std::vector<DeployHost> hosts_;
  int status_ = 0;
};

/// A branch of a fake ssh's `case`: each host has our version.
std::string same_version() {
  return "*'ergocast --version'*) echo \"ergocast " + version() + " (LCM 1.3.1)\"; return;; ";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(DeployFiles, AShellWordIsReadBackWhateverItHolds) {
  for (const std::string word :
       {"", "plain", "A=b", "~", "a b", "it's", "$(id)`id`", "\\\"", "-n", "a\nb", "*?&;|<>"}) {
    EXPECT_EQ(output("printf '%s|' " + shell_word(word)), word + '|');
  }
}

TEST_F(DeployFiles, ScriptsAreSoundAndKeepEveryPathInOneWord) {
  for (const auto& files : {ssh_files(hosts_, mission_), systemd_files(hosts_, mission_)}) {
    ASSERT_EQ(files.size(), 1U);
    EXPECT_TRUE(files[0].executable);
    EXPECT_EQ(output("bash -n \"$file\"", files[0].text), "") << files[0].text;
    // Without a command a script only prints its usage, and its variables have the given values.
    const std::string printed = output("set -- ; . \"$file\"", files[0].text + "\n");
    EXPECT_TRUE(has(printed, "Usage: ")) << printed;
    const std::string settings = files[0].text.substr(0, files[0].text.find("\n# Calls"));
    EXPECT_EQ(output(". \"$file\"; printf '%s|' \"$scenario_folder\" \"${scenario_files[@]}\" "
                     "\"$url\" \"${hosts[@]}\"",
                     settings),
              mission_.folder.string() + "|survey.textproto|maps/lake.png|" + mission_.url.base() +
                  "|ops@10.0.0.1|pi@10.0.0.2|");
  }
}

TEST_F(DeployFiles, TheSshScriptNamesEveryProcessAndTheCoordinatorLast) {
  const std::string script = ssh_files(hosts_, mission_)[0].text;
  const auto from = script.find("each_process() {"), to = script.find("}\n", from);
  const std::string table = script.substr(from, to + 2 - from);
  EXPECT_EQ(output(". \"$file\"; show() { echo \"$@\"; }; each_process show", table),
            "ops@10.0.0.1 logger ergocast-logger --out record\n"
            "ops@10.0.0.1 sim ergocast-sim\n"
            "pi@10.0.0.2 agent-0 ergocast-agent --id 0\n"
            "pi@10.0.0.2 agent-3 ergocast-agent --id 3\n"
            "ops@10.0.0.1 coordinator ergocast-coordinator ./survey.textproto\n");
}

TEST_F(DeployFiles, ScriptsNameTheHostToUpdateAndStartNothing) {
  const std::string ours = version();
  const std::string start = "set -- start; . \"$file\"";
  for (const std::string& script :
       {ssh_files(hosts_, mission_)[0].text, systemd_files(hosts_, mission_)[0].text}) {
    const auto answers = [&](const std::string& ground, const std::string& rover) {
      return output(
          start, "ssh() { case $2 in ops*) " + ground + ";; *) " + rover + ";; esac; }\n" + script);
    };
    const std::string same = "echo 'ergocast " + ours + " (LCM 1.3.1)'";
    EXPECT_EQ(answers(same, "echo 'ergocast 0.2.0 (LCM 1.3.1, built)'"),
              "pi@10.0.0.2 has ergocast 0.2.0, and " + ours +
                  " wrote this script: update pi@10.0.0.2 to " + ours + "\n");
    EXPECT_NE(status_, 0);
    EXPECT_EQ(answers("echo 'ergocast 0.10.0 (LCM 1.3.1)'", "return 255"),
              "ops@10.0.0.1 has ergocast 0.10.0, and " + ours +
                  " wrote this script: update the other hosts to 0.10.0, and write the script "
                  "again\npi@10.0.0.2 does not answer, or has no ergocast: install ergocast " +
                  ours + " on pi@10.0.0.2\n");
    EXPECT_NE(status_, 0);
  }
}

TEST_F(DeployFiles, TheSshScriptGivesEveryProcessItsOwnKey) {
  make_keys();
  const std::string script = ssh_files(hosts_, mission_)[0].text;
  const std::string starts =
      output("set -- start; . \"$file\" | grep -o '^starting .*'",
             // A fake ssh: nothing runs yet, and it lists what it would start.
             "ssh() { case $* in " + same_version() +
                 "*nohup*) echo \"starting ${3#*nohup }\";; *pid*) return 1;; "
                 "*.key*) echo \"$1 $(cat)\" >>\"$file.keys\";; esac; }\ntar() { :; }\n" +
                 script);
  EXPECT_TRUE(has(starts, "ergocast-agent --id 3 --key-file ../mission.key --lcm-url"));
  EXPECT_TRUE(has(starts, "ergocast-sim --key-file ../mission.key"));
  EXPECT_TRUE(has(starts, "ergocast-logger --out record --key-file ../mission.key"));
  EXPECT_TRUE(has(starts, "./survey.textproto --key-file ../mission.coordinator.key")) << starts;
  EXPECT_EQ(output("cat \"$file.keys\""),
            "ops@10.0.0.1 key\npi@10.0.0.2 key\nops@10.0.0.1 coordinator.key\n");
}

/// A server, and two sites with a relay each.
constexpr const char* kSites =
    "server ops@10.9.0.1 hub=hub.example.org:7700\n"
    "ground ops@10.0.0.1 relay coordinator logger sim\n"
    "rover pi@10.0.0.2 relay=500 agent 0 3\n";

TEST_F(DeployFiles, TheSshScriptStartsRelaysFirstAndEndsThemLast) {
  make_keys();
  hosts_ = parse_hosts(kSites, "hosts").value();
  // A fake ssh for which a process runs from its start until it is ended.
  const std::string script =
      "ssh() { case $* in " + same_version() +
      "  *nohup*) local p=${3#*echo *>}; p=${p%%.pid*}; touch \"$file.$2.$p\"; echo \"start $2 "
      "$p\";;"
      "  *kill*) local p=${3%%.pid*}; p=${p##*/}; rm \"$file.$2.$p\"; echo \"end $2 $p\";;"
      "  *pid=*) local p=${3%%.pid*}; p=${p##*/}; [ -e \"$file.$2.$p\" ];;"
      "  *-n*) ;; *) cat >/dev/null;; esac; }\n"
      "tar() { :; }\nsleep() { rm -f \"$file\".*.{sim,logger,agent-*}; }\n" +
      ssh_files(hosts_, mission_)[0].text;
  const std::string start = output("set -- start; . \"$file\" | grep ^start", script);
  EXPECT_TRUE(
      start.starts_with("start ops@10.9.0.1 relay\nstart ops@10.0.0.1 relay\n"
                        "start pi@10.0.0.2 relay\nstart ops@10.0.0.1 logger\n"))
      << start;
  EXPECT_TRUE(start.ends_with("start ops@10.0.0.1 coordinator\n")) << start;
  const std::string again = output("set -- start; . \"$file\"", script);
  EXPECT_TRUE(has(again, "logger is still running") && !has(again, "end ops@")) << again;
  EXPECT_EQ(output("set -- stop; . \"$file\"", script),
            "end ops@10.0.0.1 coordinator\nend ops@10.9.0.1 relay\n"
            "end ops@10.0.0.1 relay\nend pi@10.0.0.2 relay\n");
}

TEST_F(DeployFiles, ServicesAndContainersHaveTheRelaysOptions) {
  make_keys();
  hosts_ = parse_hosts(kSites, "hosts").value();
  const std::string script = systemd_files(hosts_, mission_)[0].text;
  const std::string ssh =
      "ssh() { case $* in " + same_version() +
      "esac; if [ \"$1\" = -n ]; then echo \"$3\"; else case $2 in *tee*) grep RELAY;; *) cat "
      ">/dev/null;; esac; fi; }\ntar() { :; }\n";
  EXPECT_EQ(output("set -- setup; . \"$file\"", ssh + script),
            "ERGOCAST_RELAY=--hub --listen :7700\n"
            "ERGOCAST_RELAY=--to hub.example.org:7700\n"
            "ERGOCAST_RELAY=--to hub.example.org:7700 --max-rate 500\n");
  EXPECT_TRUE(has(output("set -- start; . \"$file\"", ssh + script),
                  "sudo systemctl start ergocast-relay\n"
                  "sudo systemctl start ergocast-relay ergocast-logger ergocast-sim\n"));
  const auto files = compose_files(hosts_, mission_);
  ASSERT_EQ(files.size(), 3U);
  EXPECT_TRUE(has(files[0].text, "\"ergocast-relay\", \"--hub\", \"--listen\", \":7700\"]"));
  EXPECT_TRUE(has(files[0].text, "source: \"./mission.key\""));
  EXPECT_TRUE(has(files[2].text, "\"--max-rate\", \"500\"]")) << files[2].text;
}

TEST_F(DeployFiles, TheTableOfModesGoesToEveryHostAndToAllButTheWorld) {
  mission_.modes = "modes-0123456789abcdef.bin";
  std::ofstream(folder_ / mission_.modes) << "table";
  const auto scripts = {ssh_files(hosts_, mission_)[0].text,
                        systemd_files(hosts_, mission_)[0].text};
  for (const std::string& script : scripts) {
    const auto set = script.find("copy_modes") != script.npos ? "start" : "setup";
    const std::string printed =
        output(std::string("set -- ") + set + "; . \"$file\"; cat \"$file.modes\"",
               "ssh() { case $* in " + same_version() +
                   "*nohup*) echo \"starting ${3#*nohup }\";; *pid*) return 1;; "
                   "*modes-*) echo \"$1 $(cat)\" >>\"$file.modes\";; *) cat >/dev/null;; esac; }\n"
                   "tar() { :; }\n" +
                   script);
    EXPECT_TRUE(has(printed, "ops@10.0.0.1 table\npi@10.0.0.2 table\n")) << printed;
    if (std::string(set) != "start") continue;
    EXPECT_TRUE(has(printed, "ergocast-agent --id 3 --modes ../modes-0123456789abcdef.bin"))
        << printed;
    EXPECT_TRUE(has(printed, "ergocast-sim --lcm-url")) << printed;
  }
  for (const TextFile& file : compose_files(hosts_, mission_)) {
    EXPECT_TRUE(has(file.text, "source: \"./modes-0123456789abcdef.bin\"")) << file.text;
    EXPECT_TRUE(has(file.text, "ERGOCAST_MODES: /modes.bin")) << file.text;
  }
}

TEST_F(DeployFiles, TheSystemdScriptSetsUpEveryHost) {
  // A fake ssh that prints what it would do.
  const std::string ssh = "ssh() { case $* in " + same_version() +
                          "'-n '*) echo \"$2: $3\";; *) echo \"$1: $2\"; cat;; esac; }\n";
  std::string script = systemd_files(hosts_, mission_)[0].text;
  const std::string start = output("set -- start; . \"$file\"", ssh + script);
  EXPECT_EQ(start,
            "ops@10.0.0.1: sudo systemctl start ergocast-logger ergocast-sim\n"
            "pi@10.0.0.2: sudo systemctl start ergocast-agent@0 ergocast-agent@3\n"
            "ops@10.0.0.1: sudo systemctl start ergocast-coordinator\n");
  EXPECT_EQ(status_, 0);
  const std::string enable = output("set -- enable; . \"$file\"", ssh + script);
  EXPECT_FALSE(has(enable, "coordinator")) << enable;
  fs::create_directories(folder_ / "maps");
  std::ofstream(folder_ / "survey.textproto") << "x";
  std::ofstream(folder_ / "maps/lake.png") << "x";
  for (const char* file : {"survey.textproto", "maps/lake.png"})
    fs::permissions(folder_ / file, fs::perms::owner_read);
  mission_.folder = folder_;
  script = systemd_files(hosts_, mission_)[0].text;
  const std::string setup =
      output("set -- setup; . \"$file\"",
             "ssh() { case $* in " + same_version() +
                 "*) echo \"$1\";; esac; case $2 in *tee*) cat;; *) tar -tv | tr "
                 "-s ' ' | cut -d ' ' -f 1,6;; esac; }\n" +
                 script);
  const std::string settings = "LCM_DEFAULT_URL=" + mission_.url.base() +
                               "\nERGOCAST_SCENARIO=/etc/ergocast/mission/survey.textproto\n";
  EXPECT_EQ(setup, "ops@10.0.0.1\n" + settings + "pi@10.0.0.2\n" + settings +
                       "ops@10.0.0.1\n-r--r--r-- survey.textproto\n-r--r--r-- maps/lake.png\n");
}

TEST_F(DeployFiles, TheSystemdScriptHandsTheKeysToTheServices) {
  make_keys();
  mission_.folder = folder_;
  std::ofstream(folder_ / "survey.textproto") << "x";
  mission_.files = {"survey.textproto"};
  const std::string ssh =
      "ssh() { case $* in " + same_version() +
      "*.key*) echo \"$1 $(cat) $2\" | tr '\\n' ' '; echo;; *) cat >/dev/null;; "
      "esac; }\n";
  const std::string script = ssh + systemd_files(hosts_, mission_)[0].text;
  const std::string setup = output("set -- setup; . \"$file\"", script);
  EXPECT_EQ(status_, 0) << setup;
  std::istringstream lines(setup);
  std::string line;
  const std::vector<std::vector<std::string>> expected = {
      {"ops@10.0.0.1 key ", "umask 077", "mission.key", "/ergocast-.service.d",
       "/mission-key.conf"},
      {"pi@10.0.0.2 key ", "umask 077", "mission.key", "/ergocast-.service.d", "/mission-key.conf"},
      {"ops@10.0.0.1 coordinator.key ", "mission.coordinator.key",
       "/ergocast-coordinator.service.d", "/signing-key.conf"}};
  for (const auto& parts : expected) {
    ASSERT_TRUE(std::getline(lines, line)) << setup;
    for (const std::string& part : parts) EXPECT_TRUE(has(line, part)) << part << "\n" << setup;
  }
  EXPECT_FALSE(std::getline(lines, line)) << setup;
  mission_.keys.clear();
  EXPECT_EQ(output("set -- setup; . \"$file\"", ssh + systemd_files(hosts_, mission_)[0].text), "");
}

TEST_F(DeployFiles, ComposeMountsTheTeamsKeyAndForTheCoordinatorItsOwn) {
  make_keys();
  hosts_[0].logger = hosts_[0].sim = false;
  const auto files = compose_files(hosts_, mission_);
  const std::string team = "source: \"./mission.key\"\n        target: /mission.key\n";
  const std::string own = "source: \"./mission.coordinator.key\"\n        target: /mission.key\n";
  EXPECT_FALSE(has(files[0].text, "./mission.key")) << files[0].text;
  EXPECT_TRUE(has(files[0].text, own)) << files[0].text;
  EXPECT_TRUE(has(files[1].text, team)) << files[1].text;
  EXPECT_FALSE(has(files[1].text, "coordinator")) << files[1].text;
  for (const TextFile& file : files) {
    EXPECT_TRUE(has(file.text, "    ERGOCAST_KEY_FILE: /mission.key\n")) << file.text;
    EXPECT_TRUE(has(file.text, "our team's")) << file.text;
  }
}

TEST_F(DeployFiles, ComposeHasAFileForEveryHostOnItsOwnNetwork) {
  const auto files = compose_files(hosts_, mission_);
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].name, "ground.compose.yaml");
  EXPECT_EQ(files[1].name, "rover.compose.yaml");
  for (const TextFile& file : files) {
    EXPECT_TRUE(has(file.text, "version: \"3.8\"\n"));
    EXPECT_TRUE(has(file.text, "network_mode: host\n"));
    EXPECT_TRUE(has(file.text, "LCM_DEFAULT_URL: \"" + mission_.url.base() + "\"\n"));
  }
  EXPECT_TRUE(
      has(files[0].text, "entrypoint: [\"ergocast-coordinator\", \"/mission/survey.textproto\"]"));
  EXPECT_TRUE(has(files[0].text, "source: \"/home/it's \\\"$$HOME\\\"/`x`\\x0ay\"\n"))
      << files[0].text;
  EXPECT_TRUE(has(files[1].text, "  agent-3:\n"));
  EXPECT_FALSE(has(files[1].text, "coordinator:"));
}

TEST_F(DeployFiles, ComposeOfOneHostHasABridge) {
  const auto hosts = parse_hosts("box coordinator logger sim agents=2", "hosts").value();
  const auto files = compose_files(hosts, mission_);
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files[0].name, "compose.yaml");
  EXPECT_FALSE(has(files[0].text, "network_mode"));
  const auto site = parse_hosts("box hub=box:7700 relay coordinator sim agents=2", "hosts").value();
  EXPECT_TRUE(has(compose_files(site, mission_)[0].text, "network_mode: host"))
      << "the other sites join there";
}

TEST_F(DeployFiles, ComposeReadsWhatItIsGiven) {
  if (std::system("docker-compose --version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "docker-compose is missing";
  make_keys();
  for (const TextFile& file : compose_files(hosts_, mission_)) {
    const std::string printed = output("docker-compose -f \"$file\" config", file.text);
    EXPECT_EQ(status_, 0) << printed;
  }
}

}  // namespace
}  // namespace ergocast
