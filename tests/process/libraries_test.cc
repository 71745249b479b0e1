// SPDX-License-Identifier: BSD-3-Clause
// The libraries of the programs. The programs on a robot have no reader of scenarios, maps or
// pictures and no projection of the earth. No program has LCM's library; we read and write its
// formats ourselves.
#include <array>
#include <memory>

#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

/// The output of `ldd` for a program, which includes indirect libraries.
std::string loaded_by(const std::string& program) {
  const std::string command = "LC_ALL=C ldd '" + (program_folder() / program).string() + "' 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  std::string printed;
  for (std::array<char, 512> part;
       pipe && fgets(part.data(), part.size(), pipe.get()) != nullptr;) {
    printed += part.data();
  }
  return printed;
}
bool loads(const std::string& printed, const std::string& library) {
  return printed.find(library + ".so") != std::string::npos;
}

TEST(Libraries, ProgramsThatReadNoScenarioLoadNoParserAndNoPictures) {
  for (const char* program : {"ergocast-agent", "ergocast-sim", "ergocast-logger"}) {
    const std::string printed = loaded_by(program);
    for (const char* library : {"liblcm", "libnetcdf", "libproj", "libprotobuf", "libprotobuf-lite",
                                "libpng16", "libz"}) {
      EXPECT_FALSE(loads(printed, library)) << program << " loads " << library << ":\n" << printed;
    }
  }
}

}  // namespace
}  // namespace ergocast::test
