// SPDX-License-Identifier: BSD-3-Clause
// Reads each file from where it stopped, and sorts the lines by the time with which they begin.
#include "cli/team/log_lines.h"

#include <algorithm>
#include <string_view>

#include "text/input_file.h"

namespace ergocast::cli {
namespace {

/// Limit (Page): length of a log line on the page [bytes]. Beyond it: the rest is cut off.
constexpr std::size_t kLongestLine = 400;

/// Adds the complete lines of `text`; returns their size in bytes.
std::size_t add_lines(std::string_view text, std::vector<std::string>& lines) {
  std::size_t begin = 0;
  for (auto end = text.find('\n'); end != text.npos; end = text.find('\n', begin)) {
    if (end > begin) lines.emplace_back(text.substr(begin, std::min(end - begin, kLongestLine)));
    begin = end + 1;
  }
  return begin;
}

}  // namespace

std::vector<std::string> LogLines::take() {
  std::vector<std::string> lines;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    const auto size = entry.is_regular_file(error) ? entry.file_size(error) : 0;
    std::uintmax_t& read = read_[entry.path()];
    if (error || size <= read) continue;
    if (size - read > kMostBytes) read = size - kMostBytes;
    std::string text(size - read, '\0');
    InputFile file(entry.path());
    file.seekg(static_cast<std::streamoff>(read));
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
    read += add_lines(text, lines);
  }
  const auto time = [](const std::string& line) { return std::string_view(line).substr(0, 23); };
  std::stable_sort(lines.begin(), lines.end(),
                   [&](const std::string& a, const std::string& b) { return time(a) < time(b); });
  return lines;
}

}  // namespace ergocast::cli
