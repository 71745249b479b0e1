// SPDX-License-Identifier: BSD-3-Clause
// The WebDriver protocol: a JSON object in, one out.
#include "tests/support/browser.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "tests/support/http.h"

namespace ergocast::test {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

constexpr int kPort = 9515;  // on the network of the test
constexpr auto kPatience = 300s;

/// Waits for `condition`, or until the driver has ended.
bool waits_for(const auto& condition, Child& driver) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (!driver.running() || std::chrono::steady_clock::now() > deadline) return condition();
    std::this_thread::sleep_for(20ms);
  }
  return true;
}

std::string bytes_of(const std::string& base64) {
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : base64) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto value = digits.find(c);
    if (value == digits.npos) break;
    bits = bits << 6 | static_cast<unsigned>(value);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

}  // namespace

Browser::Browser(const std::filesystem::path& folder, bool webgl) {
  const std::vector<std::string> command{"/usr/bin/chromedriver",
                                         "--port=" + std::to_string(kPort)};
  const auto log = folder / "chromedriver.log";
  driver_ = Child::start({command, log, SIGKILL}).value();
  if (!waits_for([] { return get(kPort, "/status").status == 200; }, *driver_)) {
    throw std::runtime_error("chromedriver " + driver_->fate() + " and does not answer:\n" +
                             last_lines(log, 25));
  }
  json options;
  options["binary"] = "/usr/bin/chromium-headless-shell";
  options["args"] = {"--no-sandbox",
                     "--disable-dev-shm-usage",
                     "--hide-scrollbars",
                     "--disable-extensions",
                     "--disable-background-networking",
                     "--disable-component-update",
                     "--disable-sync",
                     "--no-first-run",
                     "--mute-audio",
                     "--ignore-certificate-errors",
                     "--host-resolver-rules=MAP evil.example 127.0.0.1",
                     "--user-data-dir=" + (folder / "profile").string()};
  if (webgl) {
    for (const char* flag :
         {"--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"}) {
      options["args"].push_back(flag);
    }
  } else {
    for (const char* flag : {"--disable-gpu", "--disable-webgl"}) options["args"].push_back(flag);
  }
  const json capabilities = {{"browserName", "chrome-headless-shell"},
                             {"goog:chromeOptions", options},
                             {"goog:loggingPrefs", {{"browser", "ALL"}}},
                             {"timeouts", {{"script", 300000}, {"pageLoad", 300000}}}};
  session_ =
      "/session/" + ask("POST", "/session", {{"capabilities", {{"alwaysMatch", capabilities}}}})
                        .at("sessionId")
                        .get<std::string>();
  resize(1300, 900);
}

Browser::~Browser() {
  try {
    ask("DELETE", "");
  } catch (const std::exception&) {  // it ends anyway
  }
  driver_->send(SIGTERM);
  waits_for([this] { return !driver_->running(); }, *driver_);
}

json Browser::ask(const std::string& method, const std::string& path, const json& body) {
  const HttpAnswer answer =
      http(kPort, method, session_ + path,
           {"Host: 127.0.0.1:" + std::to_string(kPort), "Content-Type: application/json"},
           method == "POST" ? body.dump() : "");
  if (answer.status != 200) {
    throw std::runtime_error(path + ": " + std::to_string(answer.status) + ' ' +
                             answer.body.substr(0, 600));
  }
  return json::parse(answer.body).at("value");
}

void Browser::open(const std::string& url) { ask("POST", "/url", {{"url", url}}); }

void Browser::run_first(const std::string& script) {
  ask("POST", "/goog/cdp/execute",
      {{"cmd", "Page.addScriptToEvaluateOnNewDocument"}, {"params", {{"source", script}}}});
}

void Browser::resize(int width, int height) {
  ask("POST", "/goog/cdp/execute",
      {{"cmd", "Emulation.setDeviceMetricsOverride"},
       {"params",
        {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}}}});
}

json Browser::run(const std::string& script) {
  return ask("POST", "/execute/sync", {{"script", script}, {"args", json::array()}});
}

bool Browser::becomes(const std::string& script) {
  // A look costs the browser time, so there are fewer than of other conditions.
  constexpr auto kBetweenLooks = std::chrono::milliseconds(50);
  const auto look = [&] {
    if (run(script) == true) return true;
    std::this_thread::sleep_for(kBetweenLooks);
    return false;
  };
  return waits_for(look, *driver_);
}

void Browser::press(const std::string& key, const std::string& held) {
  json actions = json::array();
  if (!held.empty()) actions.push_back({{"type", "keyDown"}, {"value", held}});
  for (const char* type : {"keyDown", "keyUp"}) actions.push_back({{"type", type}, {"value", key}});
  if (!held.empty()) actions.push_back({{"type", "keyUp"}, {"value", held}});
  json keyboard = {{"type", "key"}, {"id", "keyboard"}, {"actions", actions}};
  ask("POST", "/actions", {{"actions", json::array({keyboard})}});
}

void Browser::click(const std::string& selector) {
  const json found = ask("POST", "/element", {{"using", "css selector"}, {"value", selector}});
  ask("POST", "/element/" + found.begin()->get<std::string>() + "/click");
}

void Browser::drag(const std::string& selector, int right, int down, int from_right,
                   int from_down) {
  const json found = ask("POST", "/element", {{"using", "css selector"}, {"value", selector}});
  json steps = json::array();
  steps.push_back(
      {{"type", "pointerMove"}, {"origin", found}, {"x", from_right}, {"y", from_down}});
  steps.push_back({{"type", "pointerDown"}, {"button", 0}});
  steps.push_back({{"type", "pointerMove"}, {"origin", "pointer"}, {"x", right}, {"y", down}});
  steps.push_back({{"type", "pointerUp"}, {"button", 0}});
  const json mouse = {{"type", "pointer"}, {"id", "mouse"}, {"actions", steps}};
  ask("POST", "/actions", {{"actions", json::array({mouse})}});
}

std::vector<std::string> Browser::errors() {
  std::vector<std::string> messages;
  for (const json& entry : ask("POST", "/se/log", {{"type", "browser"}})) {
    if (entry.at("level") == "SEVERE") messages.push_back(entry.at("message"));
  }
  return messages;
}

double Browser::main_thread_s() {
  const auto ask_for = [this](const char* command, const json& parameters) {
    return ask("POST", "/goog/cdp/execute", {{"cmd", command}, {"params", parameters}});
  };
  ask_for("Performance.enable", {{"timeDomain", "threadTicks"}});
  const json metrics = ask_for("Performance.getMetrics", json::object());
  for (const json& metric : metrics.at("metrics")) {
    if (metric.at("name") == "TaskDuration") return metric.at("value").get<double>();
  }
  throw std::runtime_error("the browser does not know TaskDuration");
}

void Browser::save_screenshot(const std::filesystem::path& png) {
  std::ofstream(png, std::ios::binary) << bytes_of(ask("GET", "/screenshot"));
}

}  // namespace ergocast::test
