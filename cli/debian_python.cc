// SPDX-License-Identifier: BSD-3-Clause
// Replaces this process by Python with a short program that imports a module and calls its main().
#include "cli/debian_python.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "cli/report_error.h"
#include "runtime/process/program_options.h"
#include "runtime/process/shipped_folder.h"

namespace ergocast::cli {
namespace {

/// Arguments: the folder of the package of a build, or "", the module, the text if something is
/// missing, and those of main().
constexpr const char* kCall = R"(import importlib, sys
folder, module, without = sys.argv[1:4]
sys.path[:0] = filter(None, [folder])
try:
    main = importlib.import_module(module).main
except ModuleNotFoundError as missing:
    package = "python3-" + missing.name.split(".")[0]
    print(f"{without} {package}; as root: apt-get install {package}", file=sys.stderr)
    sys.exit(3)
sys.exit(main(sys.argv[4:])))";

}  // namespace

int become_python(const std::string& module, const std::vector<std::string>& arguments,
                  const std::string& without) {
  std::fflush(stdout);
  // -P: what happens to lie in the working directory is not imported.
  std::vector<std::string> words{kPython, "-P",   "-c", kCall, python_of_this_build(),
                                 module,  without};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(kPython, pointers.data());
  return report_error(kExitUnavailable, without + " python3-ergocast; " + kPython + ": " +
                                            std::strerror(errno) +
                                            "; as root: apt-get install python3-ergocast");
}

}  // namespace ergocast::cli
