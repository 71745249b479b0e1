// SPDX-License-Identifier: BSD-3-Clause
// Sends plans to Python and gets figures back, both over one socket: 8 bytes of length, then the
// bytes. An answer begins with one byte, 0 if the rest is an error.
#include "cli/study/python_law.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string_view>

#include "cli/debian_python.h"
#include "cli/study/receive_whole.h"
#include "runtime/process/program_options.h"
#include "runtime/process/shipped_folder.h"

namespace ergocast::cli {
namespace {

/// Arguments: the folder of the package of a build, or "", and the law.
constexpr const char* kServe = R"(import os, sys
answers = os.dup(0)
sys.path[:0] = filter(None, sys.argv[1:2])
try:
    from ergocast import _study
except ModuleNotFoundError as missing:
    package = "python3-" + missing.name.split(".")[0]
    text = f"\0laws in Python need {package}; as root: apt-get install {package}".encode()
    os.write(answers, len(text).to_bytes(8, "little") + text)
    sys.exit(3)
_study.serve(sys.argv[2], answers))";
/// More than the figures of a mission, or an error.
constexpr std::uint64_t kMostAnswerBytes = 1 << 20;

bool send_whole(int socket, const void* from, std::size_t size) {
  const auto* bytes = static_cast<const std::byte*>(from);
  while (size > 0) {
    const ssize_t sent = send(socket, bytes, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

/// Becomes Python, with the socket as its standard input; what the law prints goes to standard
/// error. Each mission has one thread: a study has as many missions at once as it wants.
[[noreturn]] void become_python(int socket, const std::string& law) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  dup2(socket, STDIN_FILENO);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  for (const char* name : {"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"})
    setenv(name, "1", 0);
  std::vector<std::string> words{kPython, "-P", "-c", kServe, python_of_this_build(), law};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(kPython, arguments.data());
  _exit(127);
}

bool names_python_law(const FieldValue& field) {
  return field.path == "law.kind" && field.value.find(".py:") != std::string::npos;
}

}  // namespace

std::optional<std::string> take_python_law(std::vector<FieldValue>& fields) {
  const auto named = std::ranges::find_if(fields.rbegin(), fields.rend(), names_python_law);
  if (named == fields.rend()) return std::nullopt;
  const std::string law = named->value;
  std::erase_if(fields, [](const FieldValue& field) { return field.path == "law.kind"; });
  return law;
}

std::string file_of_law(const std::string& law) { return law.substr(0, law.rfind(':')); }

Result<std::unique_ptr<PythonLaw>> PythonLaw::start(const std::string& law) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return failure(law + ": " + std::strerror(errno));
  const pid_t pid = fork();
  if (pid == 0) become_python(ends[1], law);
  close(ends[1]);
  if (pid < 0) {
    close(ends[0]);
    return failure(law + ": " + std::strerror(errno));
  }
  std::unique_ptr<PythonLaw> started(new PythonLaw(pid, ends[0]));
  const auto greeting = started->answer();
  if (!greeting) return failure(law + ": " + greeting.error());
  const std::string ours = version() + ' ' + std::to_string(sizeof(studies::StudyFigures));
  const std::string theirs(reinterpret_cast<const char*>(greeting->data()), greeting->size());
  if (theirs == ours) return started;
  return failure(law + ": the module ergocast of " + kPython + " is version " + theirs +
                 ", and this program " + ours + " (install both from one build)");
}

PythonLaw::~PythonLaw() {
  close(socket_);  // Python ends
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

Result<std::vector<std::byte>> PythonLaw::answer() {
  std::uint64_t size = 0;
  char is_good = 0;
  if (!receive_whole(socket_, &size, sizeof size) || size < 1 || size > kMostAnswerBytes ||
      !receive_whole(socket_, &is_good, 1))
    return failure(std::string("its ") + kPython + " ended without an answer");
  std::vector<std::byte> bytes(size - 1);
  if (!receive_whole(socket_, bytes.data(), bytes.size()))
    return failure(std::string("its ") + kPython + " ended amid an answer");
  if (is_good != 0) return bytes;
  return failure(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Result<studies::StudyFigures> PythonLaw::run(std::span<const std::byte> plan) {
  const std::uint64_t size = plan.size();
  if (!send_whole(socket_, &size, sizeof size) || !send_whole(socket_, plan.data(), plan.size()))
    return failure(std::string("its ") + kPython + " has ended");
  const auto bytes = answer();
  if (!bytes) return failure(bytes.error());
  studies::StudyFigures figures;
  if (bytes->size() != sizeof figures) return failure(std::string("an answer of another length"));
  std::memcpy(&figures, bytes->data(), sizeof figures);
  return figures;
}

Result<studies::StudyFigures> run_under_python_law(const std::string& law,
                                                   std::span<const std::byte> plan) {
  static std::map<std::string, std::unique_ptr<PythonLaw>> started;
  auto& python = started[law];
  if (!python) {
    auto now = PythonLaw::start(law);
    if (!now) return failure(now.error());
    python = *std::move(now);
  }
  auto figures = python->run(plan);
  if (!figures) python.reset();  // the next mission has a new one
  return figures;
}

}  // namespace ergocast::cli
