#include "verification/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace foldproof {

namespace {

size_t length_of(const Column& column) {
  return std::visit([](const auto& values) { return values.size(); }, column.values);
}

bool holds_texts(const Column& column) { return column.values.index() == 1; }

const char* kind_of(bool texts) { return texts ? "texts" : "numbers"; }

void append_to(Column& column, const Cell& cell) {
  const auto append = [&](const auto& value) {
    using Values = std::vector<std::decay_t<decltype(value)>>;
    if (length_of(column) == 0) column.values = Values();
    std::get<Values>(column.values).push_back(value);
  };
  std::visit(append, cell.value);
  if (!std::isnan(column.uncertainty) && !(cell.uncertainty <= column.uncertainty))
    column.uncertainty = cell.uncertainty;
}

}  // namespace

Table::Table(std::initializer_list<Column> columns) {
  for (const Column& column : columns) add(column);
}

Table::Table(std::string_view columns) {
  for (size_t from = 0; from < columns.size();) {
    const size_t end = std::min(columns.find("; ", from), columns.size());
    const std::string_view column = columns.substr(from, end - from);
    const size_t unit = column.ends_with(']') ? column.rfind(" [") : column.size();
    add({std::string(column.substr(0, unit)),
         unit < column.size() ? std::string(column.substr(unit + 2, column.size() - unit - 3))
                              : ""});
    from = end + 2;
  }
}

Table::Table(std::string name, std::string title, Table rows)
    : name(std::move(name)), title(std::move(title)), columns_(std::move(rows.columns_)) {}

void Table::reject(const std::string& why) const {
  std::string names;
  for (const Column& column : columns_) names += (names.empty() ? "" : ", ") + column.name;
  throw std::logic_error(fmt::format("table '{}' of columns [{}]: {}", name, names, why));
}

size_t Table::rows() const { return columns_.empty() ? 0 : length_of(columns_.front()); }

void Table::add(Column column) {
  if (!columns_.empty() && length_of(column) != rows())
    reject(fmt::format("{} values in column '{}' for {} rows", length_of(column), column.name,
                       rows()));
  for (const Column& other : columns_)
    if (other.name == column.name) reject(fmt::format("two columns '{}'", column.name));
  columns_.push_back(std::move(column));
}

void Table::append(std::initializer_list<Cell> cells) {
  if (cells.size() != columns_.size())
    reject(fmt::format("a row of {} for {} columns", cells.size(), columns_.size()));
  const bool is_first = rows() == 0;
  for (size_t k = 0; k < cells.size(); ++k) {
    const bool is_text = cells.begin()[k].value.index() == 1;
    if (!is_first && is_text != holds_texts(columns_[k]))
      reject(fmt::format("column '{}' holds {}, and row {} gives it {}", columns_[k].name,
                         kind_of(!is_text), rows() + 1, kind_of(is_text)));
  }
  for (size_t k = 0; k < cells.size(); ++k) append_to(columns_[k], cells.begin()[k]);
}

const Column& Table::column(std::string_view wanted) const {
  for (const Column& column : columns_)
    if (column.name == wanted) return column;
  reject(fmt::format("there is no column '{}'", wanted));
}

const std::vector<double>& Table::numbers(std::string_view wanted) const {
  const Column& found = column(wanted);
  if (holds_texts(found)) reject(fmt::format("column '{}' holds texts", wanted));
  return std::get<0>(found.values);
}

std::vector<std::string> Table::texts(std::string_view wanted) const {
  const Column& found = column(wanted);
  if (length_of(found) == 0) return {};
  if (!holds_texts(found)) reject(fmt::format("column '{}' holds numbers", wanted));
  return std::get<1>(found.values);
}

double Table::worst(std::string_view wanted) const {
  Worst worst;
  for (const double value : numbers(wanted)) worst.observe(value);
  return rows() == 0 ? nan : worst.value();
}

size_t Table::worst_row(std::string_view wanted) const {
  const double sought = worst(wanted);
  const std::vector<double>& values = numbers(wanted);
  for (size_t k = 0; k < values.size(); ++k)
    if (values[k] == sought || std::isnan(values[k])) return k;
  reject(fmt::format("no row of column '{}' is at least 0", wanted));
}

Table roundings_of(const std::string& scale) {
  return {{"case", ""}, {"measured", "epsilon " + scale}};
}

double signed_largest(const std::vector<double>& values) {
  if (values.empty()) return nan;
  double largest = values.front();
  for (const double value : values)
    if (!std::isnan(largest) && !(value <= largest)) largest = value;
  return largest;
}

void Worst::observe(double value) {
  if (!std::isnan(worst_) && !(value <= worst_)) worst_ = value;
}

}  // namespace foldproof
