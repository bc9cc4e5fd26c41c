// Figures of a study: curves over one axis, and maps over two.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "verification/evidence.h"

namespace foldproof {

/// Status of a point of a curve: measured; measured, but a solve did not converge; or a diverged
/// run, which has an x but no y.
enum class Mark { measured, unfinished, diverged };

std::string_view name_of(Mark mark);  // "measured", "unfinished", "diverged"

/// A curve of a figure; floor: the level below which y is meaningless (NaN: none).
struct Curve {
  std::string label;
  std::vector<double> x = {}, y = {};
  double floor = nan;
  // observed order of each pair of neighbours; empty if meaningless
  std::vector<double> pair_orders = {};
  double slope = nan;            // expected of this curve in log-log, NaN: none
  std::vector<Mark> marks = {};  // one per point; empty: all measured

  void point(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
};

/// Two columns of a table as a curve, without a floor.
Curve curve_of(const std::string& label, const Table& table, std::string_view x,
               std::string_view y);

/// The values of a function at these x values, without a floor.
template <class Function>
Curve curve_over(std::string label, const std::vector<double>& places, const Function& value) {
  Curve curve{std::move(label), places};
  for (const double place : places) curve.y.push_back(value(place));
  return curve;
}

enum class Scale { linear, log };

struct Axis {
  std::string label, unit;
  Scale scale = Scale::linear;
};

struct Figure {
  std::string name, title;
  Axis x, y;
  double slope = nan;  // expected in log-log, NaN: none
  std::string caption;
  std::vector<Curve> curves;

  Figure() = default;
  Figure(std::string name_, std::string title_, Axis x_, Axis y_, double slope_,
         std::string caption_, std::vector<Curve> curves_ = {})
      : name(std::move(name_)),
        title(std::move(title_)),
        x(std::move(x_)),
        y(std::move(y_)),
        slope(slope_),
        caption(std::move(caption_)),
        curves(std::move(curves_)) {}
  Figure(std::string name_, std::string title_, Axis x_, Axis y_, std::string caption_,
         std::vector<Curve> curves_ = {})
      : Figure(name_, title_, x_, y_, nan, caption_, std::move(curves_)) {}
};

/// A quantity over two parameters.
struct Map {
  std::string name, title;
  Axis x, y;
  std::vector<double> x_values, y_values;  // ascending, in the axes' units
  // in `unit`, row by row: [iy * x_values.size() + ix]; NaN: no value; the caption says why
  std::vector<double> values;
  std::string quantity, unit;  // name and unit of the values
  Scale scale;                 // of the values
  std::string caption;
  std::vector<Curve> curves;  // drawn over the map, on its axes: limits known in advance
};

}  // namespace foldproof
