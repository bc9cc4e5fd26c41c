// Numbers behind a verdict: columns with units, tables of them, and maxima that keep NaN.
#pragma once

#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace foldproof {

/// A number that is not there: no floor, no slope, a gap in a curve.
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The unit that roundings are counted in.
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// One column of evidence; the columns of a finding have the same length.
struct Column {
  std::string name, unit;
  std::variant<std::vector<double>, std::vector<std::string>> values;
};

struct Table {
  std::string name, title;
  std::vector<Column> columns;
};

/// A maximum that keeps NaN: once a NaN was seen, it stays.
class Worst {
 public:
  void see(double value);
  double value() const { return worst_; }  // 0 if nothing was seen

 private:
  double worst_ = 0;
};

}  // namespace foldproof
