// SPDX-License-Identifier: BSD-3-Clause
// The HTML elements of a report. Content is HTML: the caller must escape() its text.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace ergocast {

/// <name>content</name>
std::string element(const std::string& name, const std::string& content);

/// A list of names and values.
class Facts {
 public:
  explicit Facts(const std::string& css_class) : html_("<dl class=\"" + css_class + "\">\n") {}

  /// Adds nothing if `value` is missing.
  void add(const std::string& name, const std::optional<std::string>& value);
  std::string html() const { return html_ + "</dl>\n"; }

 private:
  std::string html_;
};

struct Column {
  std::string title;
  bool text = false;  ///< aligned as text, not as numbers
  std::vector<std::optional<std::string>> cells{};
};

/// A table without its empty columns.
/// @pre every column has `rows` cells
std::string table(std::vector<Column> columns, std::size_t rows);

}  // namespace ergocast
