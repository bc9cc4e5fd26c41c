#include "reference/mesh/exact_sign.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

namespace foldproof {

namespace {

// A number as the exact sum of doubles in ascending size whose bits do not overlap. All steps below
// are exact:
//   a + b = s + e with s = fl(a + b), e = (a - (s - z)) + (b - z), z = s - a       (Knuth)
//   a * b = p + e with p = fl(a b), e = fma(a, b, -p)
using ExactSum = std::vector<double>;

void add(ExactSum& sum, double term) {
  ExactSum result;
  for (const double part : sum) {
    const double total = part + term, z = total - part;
    const double error = (part - (total - z)) + (term - z);
    if (error != 0) result.push_back(error);
    term = total;
  }
  if (term != 0) result.push_back(term);
  sum = std::move(result);
}

ExactSum difference(double a, double b) {
  ExactSum sum{a};
  add(sum, -b);
  return sum;
}

ExactSum product(const ExactSum& a, const ExactSum& b) {
  ExactSum sum;
  for (const double p : a) {
    for (const double q : b) {
      const double high = p * q;
      add(sum, std::fma(p, q, -high));
      add(sum, high);
    }
  }
  return sum;
}

ExactSum minus(ExactSum a, const ExactSum& b) {
  for (const double part : b) add(a, -part);
  return a;
}

/// The largest part decides the sign: the others together are smaller.
int sign_of(const ExactSum& sum) { return sum.empty() ? 0 : sum.back() > 0 ? 1 : -1; }

int exact_side_of_plane(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  ExactSum determinant;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const ExactSum minor = minus(product(difference(b[u], a[u]), difference(c[v], a[v])),
                                 product(difference(b[v], a[v]), difference(c[u], a[u])));
    for (const double part : product(minor, difference(d[axis], a[axis]))) add(determinant, part);
  }
  return sign_of(determinant);
}

}  // namespace

int side_of_plane(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const Vector3 u = b - a, v = c - a, w = d - a;
  const double determinant = u.cross(v).dot(w);
  const Vector3 U = u.cwiseAbs(), V = v.cwiseAbs(), W = w.cwiseAbs();
  const double size = W.x() * (U.y() * V.z() + U.z() * V.y()) +
                      W.y() * (U.z() * V.x() + U.x() * V.z()) +
                      W.z() * (U.x() * V.y() + U.y() * V.x());
  // differences, products and sums add fewer than eight roundings of half an epsilon to each term
  if (std::abs(determinant) > 8 * std::numeric_limits<double>::epsilon() * size)
    return determinant > 0 ? 1 : -1;
  return exact_side_of_plane(a, b, c, d);
}

int side_of_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a, v = c - a;
  const double area = u.x() * v.y() - u.y() * v.x();
  const double size = std::abs(u.x() * v.y()) + std::abs(u.y() * v.x());
  if (std::abs(area) > 8 * std::numeric_limits<double>::epsilon() * size) return area > 0 ? 1 : -1;
  return sign_of(minus(product(difference(b.x(), a.x()), difference(c.y(), a.y())),
                       product(difference(b.y(), a.y()), difference(c.x(), a.x()))));
}

}  // namespace foldproof
