// SPDX-License-Identifier: BSD-3-Clause
// The pieces of HTML that a report is made of. Content is HTML: escape() is the caller's duty.
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

  /// Nothing to say is not said.
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

/// A table of the columns that have anything to say.
/// @pre every column has `rows` cells
std::string table(std::vector<Column> columns, std::size_t rows);

}  // namespace ergocast
