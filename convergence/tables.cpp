#include "convergence/tables.h"

#include <cmath>

namespace foldproof {

namespace {

/// A column with those of its values whose rows were chosen.
Column chosen_values(const Column& column, const std::vector<size_t>& rows) {
  Column chosen{column.name, column.unit, {}, column.uncertainty};
  std::visit(
      [&](const auto& values) {
        std::decay_t<decltype(values)> kept;
        for (const size_t row : rows) kept.push_back(values[row]);
        chosen.values = std::move(kept);
      },
      column.values);
  return chosen;
}

/// Adds the values of one column to those of another of the same kind.
void append_values(const Column& from, Column& to) {
  std::visit(
      [&](const auto& values) {
        auto& all = std::get<std::decay_t<decltype(values)>>(to.values);
        all.insert(all.end(), values.begin(), values.end());
      },
      from.values);
  if (!std::isnan(to.uncertainty) && !(from.uncertainty <= to.uncertainty))
    to.uncertainty = from.uncertainty;
}

}  // namespace

Table with_columns(const Table& table, std::initializer_list<std::string_view> names) {
  Table part;
  for (const std::string_view name : names) part.add(table.column(name));
  return part;
}

Table group_of(const Table& table, std::string_view column, std::string_view text) {
  std::vector<size_t> rows;
  const std::vector<std::string> keys = table.texts(column);
  for (size_t k = 0; k < keys.size(); ++k)
    if (keys[k] == text) rows.push_back(k);
  Table group;
  for (const Column& each : table.columns())
    if (each.name != column) group.add(chosen_values(each, rows));
  return group;
}

Table stacked(Column names, const std::vector<std::pair<std::string, Table>>& tables) {
  std::vector<std::string> keys;
  std::vector<Column> columns = tables.front().second.columns();
  for (const auto& [name, table] : tables) {
    keys.insert(keys.end(), table.rows(), name);
    if (&table == &tables.front().second) continue;
    for (Column& column : columns) append_values(table.column(column.name), column);
  }
  names.values = std::move(keys);
  Table all;
  all.add(std::move(names));
  for (Column& column : columns) all.add(std::move(column));
  return all;
}

double largest_ratio(const Table& table, std::string_view a, std::string_view b) {
  const std::vector<double>&numerators = table.numbers(a), &denominators = table.numbers(b);
  Worst ratio;
  for (size_t k = 0; k < table.rows(); ++k) ratio.observe(numerators[k] / denominators[k]);
  return ratio.value();
}

double largest_deviation(const Table& table, std::string_view a, std::string_view b) {
  const std::vector<double>&numerators = table.numbers(a), &denominators = table.numbers(b);
  Worst deviation;
  for (size_t k = 0; k < table.rows(); ++k)
    deviation.observe(std::abs(numerators[k] / denominators[k] - 1));
  return deviation.value();
}

double last_exponent(const Table& table, std::string_view a, std::string_view b) {
  const size_t n = table.rows();
  if (n < 2) throw std::logic_error("an exponent needs two rows");
  const std::vector<double>&x = table.numbers(a), &y = table.numbers(b);
  return std::log(y[n - 1] / y[n - 2]) / std::log(x[n - 1] / x[n - 2]);
}

}  // namespace foldproof
