#include "verification/oracles/whole_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace foldproof::oracles {

namespace {

/// value = mantissa 2^exponent, the mantissa odd; {0, 0} for zero.
struct Parts {
  std::int64_t mantissa;
  int exponent;
};

Parts parts_of(double value) {
  if (value == 0) return {0, 0};
  int exponent;
  const auto mantissa = std::int64_t(std::ldexp(std::frexp(value, &exponent), 53));
  const int zeros = std::countr_zero(std::uint64_t(mantissa));
  return {mantissa / (std::int64_t(1) << zeros), exponent - 53 + zeros};
}

}  // namespace

int common_exponent(std::initializer_list<Vector3> points) {
  int common = std::numeric_limits<int>::max();
  for (const Vector3& p : points)
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] != 0) common = std::min(common, parts_of(p[axis]).exponent);
  return common == std::numeric_limits<int>::max() ? 0 : common;
}

Whole whole(double value, int exponent) {
  const Parts parts = parts_of(value);
  if (parts.mantissa == 0) return 0;
  return Whole(parts.mantissa) << unsigned(parts.exponent - exponent);
}

Exact exact(const Vector3& p, int exponent) {
  return {whole(p.x(), exponent), whole(p.y(), exponent), whole(p.z(), exponent)};
}

}  // namespace foldproof::oracles
