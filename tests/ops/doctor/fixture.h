// SPDX-License-Identifier: BSD-3-Clause
// A folder that stands for /, /proc or /sys, and helpers to find findings.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "ops/doctor/finding.h"
#include "runtime/lcm_url.h"

namespace ergocast::doctor {

class Folder : public ::testing::Test {
 protected:
  Folder() {
    std::string name = std::filesystem::temp_directory_path() / "ergocast-test-XXXXXX";
    root_ = mkdtemp(name.data());
  }
  ~Folder() override {
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
  }
  void write(const std::string& file, const std::string& text) {
    std::filesystem::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file, std::ios::binary) << text;
  }
  std::filesystem::path root_;
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline LcmUrl url_of(const std::string& options, int port = 24000) {
  return std::get<LcmUrl>(
      LcmUrl::parse("udpm://239.255.76.67:" + std::to_string(port) + "?" + options));
}

}  // namespace ergocast::doctor
