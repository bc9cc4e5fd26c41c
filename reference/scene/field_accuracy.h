// The resolution of a stored field that meets an accuracy, by measured errors.
#pragma once

#include <functional>
#include <string>

#include "reference/level_set/solid.h"

namespace foldproof {

/// A field with `cells` cells along the body's longest side.
struct MeasuredField {
  Solid solid;
  int cells;
  double error;  // see field_error [m]
  double bytes;
};

/// Fields larger than this are not built for an accuracy.
constexpr double largest_field = 512.0 * 1024 * 1024;  // bytes

/// The largest difference between the field's distance and the exact one [m] at 8000 points within
/// three cells of the surface, spread evenly over its area and to either side. A maximum over
/// samples, not a bound.
double field_error(const MeshDistance& exact, const Solid& field, double cell);

/// Bytes of a grid or an octree; 0 for other solids.
double field_bytes(const Solid& field);

/// Builds fields of 16 cells and more, until the error is at most `accuracy` [m]. Each has 1.25 to
/// 2 times as many cells as the one before, by the rate of a kink, whose error is proportional to
/// the cell width. Throws InputError with the error reached if the next field would be larger than
/// `most_bytes`.
///   exact      the body
///   longest    side of its bounds [m]
///   make       the field with a given number of cells
MeasuredField field_of_accuracy(const MeshDistance& exact, double longest, double accuracy,
                                const std::function<Solid(int cells)>& make,
                                double most_bytes = largest_field);

/// "48 cells, error 0.8 mm, 3.1 MB".
std::string describe(const MeasuredField& field);

}  // namespace foldproof
