// Parts of tables: some of their columns, one group of their rows.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "verification/evidence.h"

namespace foldproof {

/// The columns with these names, in this order; std::logic_error if one is not there.
Table with_columns(const Table& table, std::initializer_list<std::string_view> names);

/// The rows whose text in a column is `text`, without that column; std::logic_error if the column
/// is not there or holds numbers.
Table group_of(const Table& table, std::string_view column, std::string_view text);

/// Tables of the same columns, one below the other; a first column of texts says which is which.
Table stacked(Column names, const std::vector<std::pair<std::string, Table>>& tables);

/// The largest a/b over the rows; NaN if any is. 0 without rows, and if no ratio is above it.
double largest_ratio(const Table& table, std::string_view a, std::string_view b);

/// The largest |a/b - 1| over the rows; NaN if any is. 0 without rows.
double largest_deviation(const Table& table, std::string_view a, std::string_view b);

/// d log b / d log a between the table's last two rows; std::logic_error with fewer.
double last_exponent(const Table& table, std::string_view a, std::string_view b);

}  // namespace foldproof
