// SPDX-License-Identifier: BSD-3-Clause
// Formats log lines for a terminal or for the journal, and escapes characters that would control a
// terminal.
#include "runtime/process/logging.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/dup_filter_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <sstream>
#include <utility>

#include "text/printable.h"

namespace ergocast {
namespace {

constexpr auto kRepeatedWithin = std::chrono::seconds(5);

int syslog_priority(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::trace:
    case spdlog::level::debug:
      return 7;
    case spdlog::level::info:
      return 6;
    case spdlog::level::warn:
      return 4;
    default:
      return 3;
  }
}

class JournalSink final : public spdlog::sinks::base_sink<std::mutex> {
 private:
  void sink_it_(const spdlog::details::log_msg& event) override {
    const std::string lines =
        journal_lines(syslog_priority(event.level),
                      std::string(event.logger_name.data(), event.logger_name.size()),
                      printable({event.payload.data(), event.payload.size()}));
    std::fwrite(lines.data(), 1, lines.size(), stderr);
  }
  void flush_() override { std::fflush(stderr); }
};

/// The text of an event, safe for a terminal: it may quote files and messages of other hosts.
class PrintableText final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& event, const std::tm&,
              spdlog::memory_buf_t& line) override {
    const std::string text = printable({event.payload.data(), event.payload.size()});
    line.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<PrintableText>();
  }
};

std::shared_ptr<spdlog::sinks::sink> stderr_sink() {
  if (is_journal(std::getenv("JOURNAL_STREAM"), STDERR_FILENO))
    return std::make_shared<JournalSink>();
  return std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
}

}  // namespace

std::shared_ptr<spdlog::logger> open_log_file(const std::filesystem::path& file,
                                              const std::string& process_name) {
  try {
    auto log = std::make_shared<spdlog::logger>(
        process_name, std::make_shared<spdlog::sinks::basic_file_sink_st>(file.string()));
    log->set_pattern("%Y-%m-%dT%H:%M:%S.%e %l %n: %v");
    log->flush_on(spdlog::level::info);
    log->set_error_handler([](const std::string&) {});
    return log;
  } catch (const spdlog::spdlog_ex&) {
    return nullptr;
  }
}

bool is_journal(const char* journal_stream, int fd) {
  struct stat info {};
  if (journal_stream == nullptr || fstat(fd, &info) != 0) return false;
  return std::to_string(info.st_dev) + ':' + std::to_string(info.st_ino) == journal_stream;
}

std::string journal_lines(int priority, const std::string& process_name, const std::string& text) {
  std::istringstream stream(text);
  std::string lines;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty()) continue;
    lines += '<' + std::to_string(priority) + '>' + process_name + ": " + line + '\n';
  }
  return lines;
}

void set_up_logging(const std::string& process_name, const std::string& level) {
  auto once = std::make_shared<spdlog::sinks::dup_filter_sink_mt>(kRepeatedWithin);
  once->add_sink(stderr_sink());
  auto logger = std::make_shared<spdlog::logger>(process_name, once);
  auto pattern = std::make_unique<spdlog::pattern_formatter>();
  pattern->add_flag<PrintableText>('*').set_pattern("%Y-%m-%dT%H:%M:%S.%e %^%l%$ %n: %*");
  logger->set_formatter(std::move(pattern));
  logger->set_level(spdlog::level::from_str(level));
  logger->flush_on(spdlog::level::trace);
  spdlog::set_default_logger(logger);
}

}  // namespace ergocast
