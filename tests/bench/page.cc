// SPDX-License-Identifier: BSD-3-Clause
// Measures the page in Chromium: the time until any tick of a long record is on the screen, and the
// main thread's time for a frame of a live team. `cpu_ms` is processor time of that thread for a
// seek or a frame, from reading a message to drawing; it depends less on other load.
#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "runtime/process/child.h"
#include "tests/support/browser.h"

namespace ergocast::bench {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::Browser;

constexpr const char* kProgram = ERGOCAST_PROGRAM_DIR "/ergocast";
const fs::path kScenario = fs::path(ERGOCAST_SCENARIO_DIR) / "quadrimodal_corners.textproto";
constexpr int kPort = 8790, kSeeks = 60;

/// A folder that is removed at the end.
struct Folder {
  Folder() {
    std::string name = fs::temp_directory_path() / "ergocast-bench-XXXXXX";
    path = mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  fs::path path;
};

Child start(const fs::path& log, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), kProgram);
  return Child::start({.command = arguments, .log = log, .signal_if_orphaned = SIGTERM}).value();
}

void wait_for(Child& child) {
  while (child.running()) std::this_thread::sleep_for(20ms);
}

double load() {
  double one = 0;
  return getloadavg(&one, 1) == 1 ? one : -1;
}

/// Random ticks, each drawn until its pixels can be read.
void Seek(benchmark::State& state) {
  const char* layer = state.range(1) == 0 ? "target" : "achieved";
  const char* tail = state.range(2) == 0 ? "3" : "7";  // 60 s, all
  Folder folder;
  Child mission =
      start(folder.path / "log", {"simulate", kScenario, "--agents", std::to_string(state.range(0)),
                                  "--out", folder.path / "run"});
  wait_for(mission);
  Browser browser(folder.path);
  browser.open("file://" + (folder.path / "run" / "report.html").string() + "#layer=" + layer +
               "&tail=" + tail);
  if (!browser.becomes("return Boolean(window.ergocast && ergocast.S.run.ready)")) {
    return state.SkipWithError("the report was not shown");
  }
  const std::string seek = "let s = 1; const times = []; for (let i = 0; i < " +
                           std::to_string(kSeeks) +
                           "; i++) { s = s * 48271 % 2147483647;"
                           "times.push(ergocast.draw(s / 2147483647 * ergocast.S.run.end)); }"
                           "return times";
  for (auto unused : state) {
    const double before_s = browser.main_thread_s();
    auto times = browser.run(seek).get<std::vector<double>>();
    state.counters["cpu_ms"] = 1000 * (browser.main_thread_s() - before_s) / kSeeks;
    std::sort(times.begin(), times.end());
    state.SetIterationTime(times[times.size() / 2] / 1000);
    state.counters["median_ms"] = times[times.size() / 2];
    state.counters["worst_ms"] = times.back();
  }
  state.counters["load"] = load();
}
BENCHMARK(Seek)
    ->ArgNames({"agents", "achieved", "all"})
    ->ArgsProduct({{64}, {0, 1}, {0, 1}})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// A team that runs ten ticks a second for 20 s.
void LiveFrame(benchmark::State& state) {
  Folder folder;
  Child mission =
      start(folder.path / "log", {"run", kScenario, "--agents", std::to_string(state.range(0)),
                                  "--realtime=1", "--duration", "100000", "--out",
                                  folder.path / "run", "--watch", "--port", std::to_string(kPort)});
  {
    Browser browser(folder.path);
    const std::string page = "http://127.0.0.1:" + std::to_string(kPort) + '/';
    while (browser.run("return document.title") == "" ||
           !browser.run("return Boolean(window.ergocast?.S)").get<bool>()) {
      browser.open("about:blank");
      try {
        browser.open(page);
      } catch (const std::exception&) {  // not served yet
        std::this_thread::sleep_for(200ms);
      }
    }
    browser.becomes("return Boolean(ergocast.S.run) && ergocast.S.run.rows > 100");
    for (auto unused : state) {
      browser.run("ergocast.clearFrames()");
      const double before = browser.main_thread_s();
      std::this_thread::sleep_for(20s);
      const double busy_ms = 1000 * (browser.main_thread_s() - before);
      auto frames = browser.run("return ergocast.frames()").get<std::vector<double>>();
      if (frames.empty()) return state.SkipWithError("no frames");
      std::sort(frames.begin(), frames.end());
      const double cpu_ms = busy_ms / static_cast<double>(frames.size());
      state.SetIterationTime(cpu_ms / 1000);
      state.counters["cpu_ms"] = cpu_ms;
      state.counters["script_ms"] = frames[frames.size() / 2];
      state.counters["frames_per_s"] = static_cast<double>(frames.size()) / 20;
    }
  }
  state.counters["load"] = load();
  for (int i = 0; i < 2; ++i) {  // the mission, then the page of its record
    mission.send(SIGINT);
    std::this_thread::sleep_for(1s);
  }
  while (mission.running()) {
    mission.send(SIGINT);
    std::this_thread::sleep_for(1s);
  }
}
BENCHMARK(LiveFrame)->ArgName("agents")->Arg(4)->Arg(64)->Iterations(1)->UseManualTime()->Unit(
    benchmark::kMillisecond);

}  // namespace
}  // namespace ergocast::bench
