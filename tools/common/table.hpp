// Table: columns of text for people, aligned by display width.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pfvox::tools {

enum class Align { Left, Right };

struct Column {
    std::string title;
    Align align = Align::Left;
};

class Table {
  public:
    explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

    /// Adds a row; missing cells at its end stay empty.
    void addRow(std::vector<std::string> cells);
    bool empty() const { return rows_.empty(); }

    /// Title line, then the rows, each ended by a newline and indented by `indent` spaces.
    std::string render(std::size_t indent = 0) const;

  private:
    std::vector<Column> columns_;
    std::vector<std::vector<std::string>> rows_;
};

}  // namespace pfvox::tools
