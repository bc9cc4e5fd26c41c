#include "reference/mesh/nearest_point.h"

namespace foldproof {

namespace {

NearestFeature at_point(Feature feature, const Vector3& point, const Vector3& p) {
  return {-1, feature, point, (p - point).squaredNorm()};
}

}  // namespace

// The edges, and the lines through the corners at right angles to them, cut the plane into seven
// regions: in each, a different feature is nearest. Products of p's coordinates along the edges
// show in which region its projection lies (Ericson 2005, section 5.1.5).
NearestFeature nearest_on_triangle(const Corners3& corners, const Vector3& p) {
  const auto& [a, b, c] = corners;
  const Vector3 ab = b - a, ac = c - a;
  const double a_ab = ab.dot(p - a), a_ac = ac.dot(p - a);
  if (a_ab <= 0 && a_ac <= 0) return at_point(Feature::a, a, p);
  const double b_ab = ab.dot(p - b), b_ac = ac.dot(p - b);
  if (b_ab >= 0 && b_ac <= b_ab) return at_point(Feature::b, b, p);
  const double c_ab = ab.dot(p - c), c_ac = ac.dot(p - c);
  if (c_ac >= 0 && c_ab <= c_ac) return at_point(Feature::c, c, p);

  const double beyond_ab = a_ab * b_ac - b_ab * a_ac;  // the weight of c, times a positive number
  if (beyond_ab <= 0 && a_ab >= 0 && b_ab <= 0)
    return at_point(Feature::ab, a + a_ab / (a_ab - b_ab) * ab, p);
  const double beyond_ca = c_ab * a_ac - a_ab * c_ac;
  if (beyond_ca <= 0 && a_ac >= 0 && c_ac <= 0)
    return at_point(Feature::ca, a + a_ac / (a_ac - c_ac) * ac, p);
  const double beyond_bc = b_ab * c_ac - c_ab * b_ac;
  const double from_b = b_ac - b_ab, from_c = c_ab - c_ac;
  if (beyond_bc <= 0 && from_b >= 0 && from_c >= 0)
    return at_point(Feature::bc, b + from_b / (from_b + from_c) * (c - b), p);

  const double sum = beyond_ab + beyond_bc + beyond_ca;
  return at_point(Feature::face, a + beyond_ca / sum * ab + beyond_ab / sum * ac, p);
}

}  // namespace foldproof
