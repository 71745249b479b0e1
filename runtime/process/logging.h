// SPDX-License-Identifier: BSD-3-Clause
// Sets up a process's log: its destination and format.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace spdlog {
class logger;
}

namespace ergocast {

/// The values of --log-level, from everything to errors only.
inline const std::vector<std::string> kLogLevels{"trace", "debug", "info", "warn", "error"};

/// Writes one line per event on the standard error stream: time, level, process, text. On the
/// journal's stream, a syslog priority replaces time and level on each line of the text. A line
/// repeated within 5 s is counted and not written again.
/// @param level  one of kLogLevels
void set_up_logging(const std::string& process_name, const std::string& level);

/// Appends to a file in the format of the standard error stream; null if it cannot be opened. A
/// write that fails is not reported: a full disk is reported elsewhere.
std::shared_ptr<spdlog::logger> open_log_file(const std::filesystem::path& file,
                                              const std::string& process_name);

/// Whether `fd` is the stream that systemd names in $JOURNAL_STREAM.
/// @param journal_stream  that variable's value, "device:inode"; null: not set
bool is_journal(const char* journal_stream, int fd);

/// `text` in the journal's format: "<N>process: line", for each of its lines that is not empty.
std::string journal_lines(int priority, const std::string& process_name, const std::string& text);

}  // namespace ergocast
