#include "studies/table.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace ergocast::studies {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

Table read_table(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) throw std::runtime_error(file.string() + ": cannot be read");
  const std::vector<std::string> columns = cells_of(line);
  Table table;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != columns.size()) throw std::runtime_error(file.string() + ": torn row: " + line);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (columns[i] != "result") {
        table[columns[i]].push_back(std::stod(cells[i]));
      } else if (cells[i] != "fine") {
        throw std::runtime_error(file.string() + ": seed " + cells[0] + " " + cells[i]);
      }
    }
  }
  if (table.empty()) throw std::runtime_error(file.string() + ": has no rows");
  return table;
}

}  // namespace ergocast::studies
