#include "common/table.hpp"

#include <algorithm>

#include "common/text.hpp"

namespace pfvox::tools {

namespace {

constexpr std::size_t kGap = 2;

std::string padded(const std::string& text, std::size_t width, Align align) {
    const std::string space(width - displayWidth(text), ' ');
    return align == Align::Left ? text + space : space + text;
}

}  // namespace

void Table::addRow(std::vector<std::string> cells) {
    cells.resize(columns_.size());
    for (std::string& cell : cells) cell = escaped(cell);
    rows_.push_back(std::move(cells));
}

std::string Table::render(std::size_t indent) const {
    std::vector<std::string> titles;
    for (const Column& column : columns_) titles.push_back(column.title);

    std::vector<std::size_t> widths;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        std::size_t width = displayWidth(titles[c]);
        for (const auto& row : rows_) width = std::max(width, displayWidth(row[c]));
        widths.push_back(width);
    }

    std::string text;
    const auto addLine = [&](const std::vector<std::string>& cells) {
        std::string line(indent, ' ');
        for (std::size_t c = 0; c < cells.size(); ++c) {
            if (c > 0) line.append(kGap, ' ');
            line += padded(cells[c], widths[c], columns_[c].align);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    };
    addLine(titles);
    for (const auto& row : rows_) addLine(row);
    return text;
}

}  // namespace pfvox::tools
