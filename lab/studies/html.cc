// SPDX-License-Identifier: BSD-3-Clause
// Builds elements and tables from strings, and leaves out empty columns.
#include "lab/studies/html.h"

#include <algorithm>

namespace ergocast {
namespace {

bool silent(const Column& column) {
  return std::none_of(column.cells.begin(), column.cells.end(),
                      [](const auto& cell) { return cell.has_value(); });
}

std::string cell(const Column& column, const std::string& tag, const std::string& content) {
  return '<' + tag + (column.text ? " class=\"text\">" : ">") + content + "</" + tag + '>';
}

}  // namespace

std::string element(const std::string& name, const std::string& content) {
  return '<' + name + '>' + content + "</" + name + ">\n";
}

void Facts::add(const std::string& name, const std::optional<std::string>& value) {
  if (!value || value->empty()) return;
  html_ += "<div><dt>" + name + "</dt><dd>" + *value + "</dd></div>\n";
}

std::string table(std::vector<Column> columns, std::size_t rows) {
  std::erase_if(columns, silent);
  if (columns.empty()) return "";
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (const Column& column : columns) html += cell(column, "th", column.title);
  html += "</tr></thead><tbody>\n";
  for (std::size_t row = 0; row < rows; ++row) {
    html += "<tr>";
    for (const Column& column : columns) {
      html += cell(column, "td", column.cells[row].value_or("–"));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace ergocast
