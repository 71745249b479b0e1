// SPDX-License-Identifier: BSD-3-Clause
// A folder that stands for /, /proc or /sys, and helpers to find findings.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "cli/doctor/finding.h"
#include "runtime/bus/lcm_url.h"
#include "tests/support/temp_folder.h"

namespace ergocast::doctor {

class Folder : public ::testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) {
    std::filesystem::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file, std::ios::binary) << text;
  }
  const test::TempFolder own_;
  const std::filesystem::path& root_ = own_.path();
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline LcmUrl url_of(const std::string& options, int port = 24000) {
  return LcmUrl::parse("udpm://239.255.76.67:" + std::to_string(port) + "?" + options).value();
}

}  // namespace ergocast::doctor
