// Numbers behind a verdict: tables of named columns with units, and maxima that keep NaN.
#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace foldproof {

/// A missing number: no floor, no slope, a gap in a curve.
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The unit of rounding errors.
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// One column of a table; the columns of a table have the same length.
struct Column {
  std::string name, unit;
  std::variant<std::vector<double>, std::vector<std::string>> values = {};
  double uncertainty = 0;  // the largest of its numbers, in `unit`; NaN if any is
};

/// A number and its uncertainty, as oracles::Estimate.
template <class Number>
concept Estimated = requires(const Number& number) {
  { number.value } -> std::convertible_to<double>;
  { number.uncertainty } -> std::convertible_to<double>;
};

/// One entry of a row: text, or a number with its uncertainty.
struct Cell {
  template <class Number>
  requires std::integral<Number> || std::floating_point<Number> Cell(Number number)
      : value(double(number)) {}
  template <Estimated Number>
  Cell(const Number& number)
      : value(double(number.value)), uncertainty(double(number.uncertainty)) {}
  template <class Text>
  requires std::convertible_to<Text, std::string_view> Cell(const Text& text)
      : value(std::string(std::string_view(text))) {}

  std::variant<double, std::string> value;
  double uncertainty = 0;
};

/// Rows of numbers and text: the evidence of a finding, or a table of a study.
///
///   Table table("method; step [s]; order [1]");  // or {{"method", ""}, {"step", "s"}, ...}
///   for (const double h : steps) table.row("A", h, order_at(h));
///   return judge_worst(table, 1e-12, "five roundings a step");
///
/// The first row determines which columns hold text. A row of another length or type, and a missing
/// column, throw std::logic_error with the names of the table and its columns.
class Table {
 public:
  std::string name, title;  // of a study's table; evidence needs none

  Table() = default;
  Table(std::initializer_list<Column> columns);
  explicit Table(std::string_view columns);
  Table(std::string name, std::string title, Table rows);

  /// Adds a row: one number, text or Estimate for each column, in their order.
  template <class... Cells>
  void row(const Cells&... cells) {
    append({Cell(cells)...});
  }

  /// This table with one more row, for evidence of one row:
  ///   Table{{"growth", "1"}, {"way there", "m"}}.with_row(growth, way)
  template <class... Cells>
  Table with_row(const Cells&... cells) && {
    row(cells...);
    return std::move(*this);
  }

  /// Adds a column as long as the existing ones, of a name that none of them has.
  void add(Column column);

  const std::vector<Column>& columns() const { return columns_; }
  size_t rows() const;

  const Column& column(std::string_view name) const;
  const std::vector<double>& numbers(std::string_view column) const;
  std::vector<std::string> texts(std::string_view column) const;

  /// The largest number of a column, or 0 if all are negative; NaN if any is, or if there is none.
  double worst(std::string_view column) const;

  /// The first row with that number, or the first NaN; needs at least one row with a value >= 0.
  size_t worst_row(std::string_view column) const;

 private:
  void append(std::initializer_list<Cell> cells);
  [[noreturn]] void reject(const std::string& why) const;

  std::vector<Column> columns_;
};

/// A table for errors in multiples of epsilon times a scale, one case per row: columns "case"
/// and "measured".
Table roundings_of(const std::string& scale);

/// The largest value with its sign; NaN if any is NaN, or if there is none.
double signed_largest(const std::vector<double>& values);

/// A maximum that propagates NaN.
class Worst {
 public:
  void observe(double value);
  double value() const { return worst_; }  // 0 if no value was observed

 private:
  double worst_ = 0;
};

}  // namespace foldproof
