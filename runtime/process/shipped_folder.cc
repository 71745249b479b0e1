// SPDX-License-Identifier: BSD-3-Clause
// Searches the folders of an installation and of the source tree, relative to the running program.
#include "runtime/process/shipped_folder.h"

namespace ergocast {

namespace fs = std::filesystem;

fs::path shipped_folder(const std::string& name, const std::string& in_tree) {
  std::error_code error;
  const fs::path programs = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const std::string& way : {"../share/ergocast/" + name, "../../../" + in_tree}) {
    const fs::path folder = (programs / way).lexically_normal();
    if (fs::is_directory(folder, error)) return folder;
  }
  return {};
}

fs::path spy_jar() {
  std::error_code error;
  const fs::path programs = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* folder : {"../cli/spy", "../share/ergocast/java"}) {
    const fs::path jar = (programs / folder / "ergocast-spy.jar").lexically_normal();
    if (fs::exists(jar, error)) return jar;
  }
  return {};
}

fs::path python_of_this_build() {
  std::error_code error;
  const fs::path programs = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path folder = (programs / "../python").lexically_normal();
  return fs::exists(folder / "ergocast" / "plot.py", error) ? folder : fs::path();
}

}  // namespace ergocast
