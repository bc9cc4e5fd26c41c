// What a study shows: curves over an axis, and maps over two.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "verification/evidence.h"

namespace foldproof {

/// What a point of a curve stands for: measured, measured though a solve on the way did not finish,
/// or a run that diverged, which has an x but no y.
enum class Mark { measured, unfinished, diverged };

std::string_view name_of(Mark mark);  // "measured", "unfinished", "diverged"

/// A curve of a figure; floor is the level below which its y means nothing (NaN: none).
struct Curve {
  std::string label;
  std::vector<double> x, y;
  double floor;
  // observed order of each neighbouring pair; empty if orders make no sense
  std::vector<double> pair_orders;
  double slope = nan;            // expected of this curve in log-log, NaN: none
  std::vector<Mark> marks = {};  // one a point; empty: all measured

  void point(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
};

/// Two columns of a table as a curve, without a floor.
Curve curve_of(const std::string& label, const Table& table, std::string_view x,
               std::string_view y);

enum class Scale { linear, log };

struct Axis {
  std::string label, unit;
  Scale scale;
};

struct Figure {
  std::string name, title;
  Axis x, y;
  double slope;  // expected in log-log, NaN: none
  std::string caption;
  std::vector<Curve> curves;
};

/// A quantity over two parameters.
struct Map {
  std::string name, title;
  Axis x, y;
  std::vector<double> x_values, y_values;  // ascending, in the axes' units
  // in `unit`, row by row: [iy * x_values.size() + ix]; NaN: no value, as the caption says
  std::vector<double> values;
  std::string quantity, unit;  // what the values are
  Scale scale;                 // of the values
  std::string caption;
  std::vector<Curve> curves;  // drawn over the map, on its axes: limits known beforehand
};

}  // namespace foldproof
