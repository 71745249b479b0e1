// SPDX-License-Identifier: BSD-3-Clause
// Parses until no error is left or none can be cut out, and prints numbers in the fewest digits.
#include "scenario/parse/text.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/stubs/strutil.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <optional>

#include "scenario/parse/error_recovery.h"
#include "scenario/parse/explain.h"
#include "scenario/parse/source.h"
#include "scenario/parse/utf8.h"

namespace ergocast {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

/// The parser's message, which quotes the file and may be as long as the file.
struct Complaint {
  Place place;
  std::string message;

  Complaint(int line, int column, const std::string& words)
      : place{std::max(line, 0), std::max(column, 0)}, message(words.substr(0, 300)) {}
};

/// The result of one parse: the first error, and the warnings.
class Collector : public google::protobuf::io::ErrorCollector {
 public:
  static constexpr std::size_t kMaxWarnings = 40;

  void AddError(int line, int column, const std::string& message) override {
    if (!error) error.emplace(line, column, message);
  }
  void AddWarning(int line, int column, const std::string& message) override {
    if (warnings.size() < kMaxWarnings) warnings.emplace_back(line, column, message);
  }

  std::optional<Complaint> error;
  std::vector<Complaint> warnings;
};

/// Blocks are nested at most five deep; the limit protects our stack from malicious files.
constexpr int kMaxDepth = 16;

/// Whether the parser can accept `text`; if not, reports a problem.
bool fit_to_parse(std::string_view text, Findings& findings) {
  if (text.size() > kMaxScenarioBytes) {
    findings.add_to_file(
        "is longer than the limit, " + std::to_string(kMaxScenarioBytes) + " bytes",
        "is it a scenario?");
    return false;
  }
  if (const std::size_t bad = first_bad_utf8(text); bad != std::string_view::npos) {
    findings.add_at(place_of(text, bad), {"", "this is not UTF-8", "save the file as UTF-8"});
    return false;
  }
  if (const std::optional<std::size_t> deep = too_deep(text, kMaxDepth)) {
    findings.add_at(place_of(text, *deep),
                    {"", "blocks lie deeper than the limit, " + std::to_string(kMaxDepth),
                     "a scenario's blocks lie at most five deep"});
    return false;
  }
  return true;
}

void parse_once(const std::string& text, proto::Scenario& scenario, Findings& findings,
                Collector& collector) {
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&collector);
  parser.WriteLocationsTo(&findings.new_locations());
  parser.AllowUnknownField(true);
  parser.SetRecursionLimit(kMaxDepth);
  google::protobuf::io::ArrayInputStream stream(text.data(), static_cast<int>(text.size()));
  parser.Parse(&stream, &scenario);
}

/// Reports a syntax error and removes it from `text`.
/// @return false if it cannot be removed
bool repair(const Complaint& error, std::string& text, Findings& findings) {
  const std::optional<BrokenField> broken =
      broken_field(text, offset_of(text, error.place), error.message);
  if (broken) {
    findings.add_at(place_of(text, broken->culprit), explained(error.message, *broken));
    const bool first_stands = error.message.starts_with("Non-repeated field");
    if (!first_stands) findings.give_up(broken->path);
    std::replace_if(
        text.begin() + static_cast<std::ptrdiff_t>(broken->begin),
        text.begin() + static_cast<std::ptrdiff_t>(broken->end), [](char c) { return c != '\n'; },
        ' ');
    return true;
  }
  if (const std::optional<std::size_t> open = unclosed_block(text)) {
    findings.add_at(place_of(text, *open), {"", "this block is not closed", "add a }"});
    text += "\n}";
    return true;
  }
  findings.add_at(error.place, explained(error.message));
  return false;
}

/// A field under a wrong name is not reported as missing under its right one. If the right name is
/// unknown, no field of the block is reported as missing.
void excuse_what_was_meant(const Complaint& unknown, const std::string& text, Findings& findings) {
  const auto field = broken_field(text, offset_of(text, unknown.place), unknown.message);
  if (!field) return;
  const Descriptor* block = proto::Scenario::descriptor();
  std::string path;
  std::string_view rest = field->path;
  for (auto dot = rest.find('.'); block != nullptr && dot != rest.npos; dot = rest.find('.')) {
    const std::string step(rest.substr(0, dot));
    const FieldDescriptor* inner = block->FindFieldByName(step.substr(0, step.find('[')));
    block = inner == nullptr ? nullptr : inner->message_type();
    path += (path.empty() ? "" : ".") + step;
    rest.remove_prefix(dot + 1);
  }
  if (block == nullptr) return;
  const auto meant = field_meant(*block, std::string(rest.substr(0, rest.find('['))));
  if (meant && meant->block.empty()) {
    findings.excuse(path + (path.empty() ? "" : ".") + meant->field);
  } else if (!path.empty()) {
    findings.excuse(path);
  }
}

/// Numbers in the fewest digits, text unchanged.
class Readable : public TextFormat::FastFieldValuePrinter {
 public:
  void PrintString(const std::string& value, TextFormat::BaseTextGenerator* out) const override {
    out->PrintLiteral("\"");
    out->PrintString(google::protobuf::strings::Utf8SafeCEscape(value));
    out->PrintLiteral("\"");
  }
  void PrintDouble(double value, TextFormat::BaseTextGenerator* out) const override {
    out->PrintString(shortest(value));
  }
};

/// A start or a vertex in one line, because there may be many of them.
template <class Point>
class OneLine : public TextFormat::FastFieldValuePrinter {
 public:
  void PrintMessageStart(const Message&, int, int, bool,
                         TextFormat::BaseTextGenerator* out) const override {
    out->PrintLiteral(" { ");
  }
  bool PrintMessageContent(const Message& message, int, int, bool,
                           TextFormat::BaseTextGenerator* out) const override {
    const auto& point = static_cast<const Point&>(message);
    out->PrintString("x_m: " + shortest(point.x_m()) + " y_m: " + shortest(point.y_m()));
    if constexpr (requires { point.has_z_m(); }) {
      if (point.has_z_m()) out->PrintString(" z_m: " + shortest(point.z_m()));
    }
    return true;
  }
  void PrintMessageEnd(const Message&, int, int, bool,
                       TextFormat::BaseTextGenerator* out) const override {
    out->PrintLiteral(" }\n");
  }
};

}  // namespace

bool read_text(std::string_view file, proto::Scenario& scenario, Findings& findings) {
  constexpr int kMaxErrors = 40;  // fewer than the commands print, so that later problems are shown
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (file.starts_with(kByteOrderMark)) file.remove_prefix(kByteOrderMark.size());
  if (!fit_to_parse(file, findings)) return false;
  std::string text(file);
  for (int errors = 0; errors < kMaxErrors; ++errors) {
    Collector collector;
    parse_once(text, scenario, findings, collector);
    const bool broken = collector.error.has_value();
    if (broken && repair(*collector.error, text, findings)) continue;
    for (const Complaint& warning : collector.warnings) {
      findings.add_at(warning.place, explained(warning.message));
      excuse_what_was_meant(warning, text, findings);
    }
    if (broken || collector.warnings.size() < Collector::kMaxWarnings) return !broken;
    break;
  }
  findings.add_to_file("has more mistakes than these", "correct them first");
  return false;
}

std::string print_text(const proto::Scenario& scenario) {
  TextFormat::Printer printer;
  printer.SetDefaultFieldValuePrinter(new Readable);  // the printer owns all of them
  printer.RegisterFieldValuePrinter(proto::Agents::descriptor()->FindFieldByName("starts"),
                                    new OneLine<proto::Start>);
  for (const auto* ring : {proto::Polygon::descriptor(), proto::Ring::descriptor()}) {
    printer.RegisterFieldValuePrinter(ring->FindFieldByName("vertices"),
                                      new OneLine<proto::Vertex>);
  }
  std::string text;
  printer.PrintToString(scenario, &text);
  return text;
}

}  // namespace ergocast
