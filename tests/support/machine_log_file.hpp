#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace wex::test {

/// The log that `wex machine --log` wrote, by column.
class MachineLogFile {
 public:
  explicit MachineLogFile(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string line, cell;
    std::getline(stream, line);
    std::vector<std::string> names;
    for (std::stringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
    while (std::getline(stream, line)) {
      std::stringstream cells(line);
      for (const std::string& name : names) {
        if (std::getline(cells, cell, ',')) columns_[name].push_back(cell);
      }
    }
  }
  [[nodiscard]] std::size_t size() const { return columns_.at("t").size(); }
  [[nodiscard]] const std::string& text(const char* column, std::size_t row) const {
    return columns_.at(column)[row];
  }
  [[nodiscard]] double number(const char* column, std::size_t row) const {
    return std::stod(text(column, row));
  }
  [[nodiscard]] bool ever(const std::string& mode) const {
    const auto& modes = columns_.at("mode");
    return std::find(modes.begin(), modes.end(), mode) != modes.end();
  }
  /// Row of the last command that was accepted before `end`; 0 if there was none.
  [[nodiscard]] std::size_t last_accepted(std::size_t end) const {
    std::size_t row = 0;
    for (std::size_t i = 1; i < end; ++i) {
      if (text("accepted", i) != text("accepted", i - 1)) row = i;
    }
    return row;
  }
  /// First row in a mode; size() if there is none.
  [[nodiscard]] std::size_t first(const std::string& mode) const {
    const auto& modes = columns_.at("mode");
    return std::find(modes.begin(), modes.end(), mode) - modes.begin();
  }
  /// Machine time from one row to the last one before `end` where a column is not 0 [ms].
  [[nodiscard]] double ms_until_zero(const char* column, std::size_t from, std::size_t end) const {
    double last_s = number("t", from);
    for (std::size_t i = from; i < end; ++i) {
      if (text(column, i) != "0") last_s = number("t", i);
    }
    return 1e3 * (last_s - number("t", from));
  }

 private:
  std::map<std::string, std::vector<std::string>> columns_;
};

}  // namespace wex::test
