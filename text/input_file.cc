// SPDX-License-Identifier: BSD-3-Clause
// Asks for the type of a file before it is opened and again afterwards, because its name may
// change.
#include "text/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ext/stdio_filebuf.h>

namespace ergocast {
namespace {

using Kind = FileProblem::Kind;

std::optional<FileProblem> problem_of(const struct stat& status) {
  if (S_ISREG(status.st_mode)) return std::nullopt;
  if (S_ISDIR(status.st_mode))
    return FileProblem{Kind::kNoFile, "is a folder, not a file", "name a file"};
  return FileProblem{Kind::kNoFile,
                     "is not a regular file: pipes, devices and sockets are not read",
                     "write what it holds into a file, and name that"};
}

FileProblem system_problem(int error) {
  if (error == ENOENT || error == ENOTDIR)
    return {Kind::kMissing, "there is no such file", "check the name and the folder"};
  return {Kind::kUnreadable, std::string("cannot be read: ") + std::strerror(error),
          "check its permissions"};
}

FileProblem too_large(std::size_t most_bytes) {
  return {Kind::kTooLarge, "is longer than the limit, " + std::to_string(most_bytes) + " bytes",
          "is it the right file?"};
}

/// An open file, or −1 and the problem.
int open_regular(const std::filesystem::path& file, std::optional<FileProblem>& problem) {
  struct stat status {};
  if (stat(file.c_str(), &status) == 0) problem = problem_of(status);
  if (problem) return -1;
  const int opened = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (opened < 0 || fstat(opened, &status) != 0) {
    problem = system_problem(errno);
  } else {
    problem = problem_of(status);
  }
  if (problem && opened >= 0) close(opened);
  return problem ? -1 : opened;
}

}  // namespace

std::optional<FileProblem> why_not_regular(const std::filesystem::path& file) {
  struct stat status {};
  return stat(file.c_str(), &status) == 0 ? problem_of(status) : std::nullopt;
}

Result<StdioFile, FileProblem> open_input(const std::filesystem::path& file) {
  std::optional<FileProblem> problem;
  const int opened = open_regular(file, problem);
  if (problem) return failure(*problem);
  if (std::FILE* stream = fdopen(opened, "rb")) return StdioFile(stream, &std::fclose);
  problem = system_problem(errno);
  close(opened);
  return failure(*problem);
}

Result<std::string, FileProblem> read_whole(const std::filesystem::path& file,
                                            std::size_t most_bytes) {
  auto opened = open_input(file);
  if (!opened) return failure(opened.error());
  std::FILE* const stream = opened->get();
  struct stat status {};
  // Some files of the system have a size of 0 and bytes nevertheless.
  const bool sized = fstat(fileno(stream), &status) == 0 && status.st_size > 0;
  const auto size = sized ? static_cast<std::size_t>(status.st_size) : std::size_t{0};
  if (size > most_bytes) return failure(too_large(most_bytes));
  std::string content;
  content.reserve(size);
  std::array<char, 1 << 16> piece;
  for (std::size_t got = 1; got > 0 && content.size() <= most_bytes;) {
    got = std::fread(piece.data(), 1, piece.size(), stream);
    content.append(piece.data(), got);
  }
  if (std::ferror(stream) != 0) return failure(system_problem(errno));
  if (content.size() > most_bytes) return failure(too_large(most_bytes));
  return content;
}

InputFile::InputFile(const std::filesystem::path& file) : std::istream(nullptr) {
  const int opened = open_regular(file, problem_);
  if (problem_) return;
  buffer_ =
      std::make_unique<__gnu_cxx::stdio_filebuf<char>>(opened, std::ios::in | std::ios::binary);
  rdbuf(buffer_.get());
}

LineEnd next_line(std::istream& in, std::string& line, std::size_t most_bytes) {
  line.clear();
  std::array<char, 4096> piece;
  while (line.size() < most_bytes) {
    in.getline(piece.data(), piece.size());
    const auto got = static_cast<std::size_t>(in.gcount());
    if (in.bad() || in.eof() || (got == 0 && in.fail())) {
      line.append(piece.data(), got);
      return line.empty() ? LineEnd::kNone : LineEnd::kFile;
    }
    if (!in.fail()) {  // the line break counts, but is not stored
      line.append(piece.data(), got - 1);
      return LineEnd::kBreak;
    }
    line.append(piece.data(), got);
    in.clear();
  }
  return LineEnd::kMore;
}

}  // namespace ergocast
