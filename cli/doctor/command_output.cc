// SPDX-License-Identifier: BSD-3-Clause
// Runs a command through the shell, with the folders of system programs on its path, and returns
// what it prints.
#include "cli/doctor/command_output.h"

#include <cstdio>
#include <memory>

namespace ergocast::doctor {

std::string output_of(const std::string& command) {
  const std::string line = "PATH=$PATH:/usr/sbin:/sbin; " + command;
  // The command needs a shell; it is constant, without any input.
  // NOLINTNEXTLINE(cert-env33-c)
  const std::unique_ptr<FILE, int (*)(FILE*)> output(popen(line.c_str(), "r"), pclose);
  std::string text;
  char piece[4096];
  while (output && std::fgets(piece, sizeof piece, output.get()) != nullptr) text += piece;
  return text;
}

}  // namespace ergocast::doctor
