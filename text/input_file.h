// SPDX-License-Identifier: BSD-3-Clause
// Opens files that a user names for reading: the only way to do so.
//
// Only regular files are opened, and opening never waits. A pipe without a writer would hold the
// program, a device may never end, and opening one may change it.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <istream>
#include <memory>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace ergocast {

/// Why a file is not read, without its name.
struct FileProblem {
  enum class Kind { kMissing, kNoFile, kUnreadable, kTooLarge };
  Kind kind;
  std::string what;    ///< "is a folder, not a file"
  std::string remedy;  ///< "name a file"

  /// "FILE: what; remedy"
  std::string sentence(const std::filesystem::path& file) const {
    return file.string() + ": " + what + "; " + remedy;
  }
};

/// Why this module would not open `file`; nothing if it would, or if the file is missing.
std::optional<FileProblem> why_not_regular(const std::filesystem::path& file);

using StdioFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// The file for the functions of C.
Result<StdioFile, FileProblem> open_input(const std::filesystem::path& file);

/// All bytes of a file of at most `most_bytes`. A larger file is refused before it takes memory.
Result<std::string, FileProblem> read_whole(const std::filesystem::path& file,
                                            std::size_t most_bytes);

/// The file as a stream, which is bad() if there is a problem().
class InputFile : public std::istream {
 public:
  explicit InputFile(const std::filesystem::path& file);

  const std::optional<FileProblem>& problem() const { return problem_; }

 private:
  std::unique_ptr<std::filebuf> buffer_;
  std::optional<FileProblem> problem_;
};

/// What follows the text that next_line() returns.
enum class LineEnd {
  kBreak,  ///< a line break, which has been read as well
  kMore,   ///< more of the same line
  kFile,   ///< the end of the file: the line has no line break
  kNone,   ///< there is no text, because the file has ended before
};

/// The next line, or a piece of one that is longer than about `most_bytes`.
LineEnd next_line(std::istream& in, std::string& line, std::size_t most_bytes);

}  // namespace ergocast
