// SPDX-License-Identifier: BSD-3-Clause
// Chromium without a screen, through its driver.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "runtime/process/child.h"

namespace ergocast::test {

/// One browser with one window, which takes evil.example for a name of this host, and trusts every
/// certificate. Each call waits for its answer; a failure throws the driver's message.
class Browser {
 public:
  /// @param folder  for its profile and its driver's log
  /// @param webgl  whether it offers WebGL, which it computes without a graphics card
  explicit Browser(const std::filesystem::path& folder, bool webgl = false);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void open(const std::string& url);
  /// Runs a script in each page that is opened from now on, before the page's own scripts.
  void run_first(const std::string& script);
  void resize(int width, int height);
  /// What a script returns: "return document.title".
  nlohmann::json run(const std::string& script);
  /// Waits until a script returns true.
  bool becomes(const std::string& script);
  /// A key as WebDriver names it, on the element that has the focus: "d", "\uE014" (right).
  /// @param held  a key that is held meanwhile, such as Shift
  void press(const std::string& key, const std::string& held = "");
  void click(const std::string& selector);
  /// Presses the mouse in the middle of an element, or so many pixels beside it, moves it by
  /// `right` and `down` pixels, and releases it.
  void drag(const std::string& selector, int right, int down, int from_right = 0,
            int from_down = 0);
  /// Errors in its console since the last call, also of the page's policy.
  std::vector<std::string> errors();
  /// Processor time of the page's main thread since the first call [s].
  double main_thread_s();
  void save_screenshot(const std::filesystem::path& png);

 private:
  nlohmann::json ask(const std::string& method, const std::string& path,
                     const nlohmann::json& body = nlohmann::json::object());

  std::optional<Child> driver_;
  std::string session_;
};

}  // namespace ergocast::test
