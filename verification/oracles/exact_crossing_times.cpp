#include "verification/oracles/exact_crossing_times.h"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <vector>

#include "verification/oracles/whole_polynomial.h"

namespace foldproof::oracles {

namespace {

/// The differences of the two features' corners, in order round the polygon.
template <class Scalar>
std::vector<Triple<Scalar>> differences(Features features, const Quad<Scalar>& x) {
  if (features == Features::vertex_and_triangle) return {x[1] - x[0], x[2] - x[0], x[3] - x[0]};
  return {x[0] - x[2], x[0] - x[3], x[1] - x[3], x[1] - x[2]};
}

/// The polynomials that decide whether the origin is in the polygon, see above.
template <class Scalar>
struct Polygon {
  Scalar height;                                     // n . d_0
  Triple<Scalar> n;                                  // across the polygon
  std::vector<Triple<Scalar>> turns, other_crosses;  // d_i x d_{i+1}; d_i x d_k of the other pairs
  std::vector<Scalar> products, other_products;      // d_i . d_k, in the same order
};

template <class Scalar>
Triple<Scalar> across(const std::vector<Triple<Scalar>>& d) {
  return cross(d[1] - d[0], d[2] - d[0]);
}

template <class Scalar>
Polygon<Scalar> polygon_of(const std::vector<Triple<Scalar>>& d) {
  Polygon<Scalar> polygon;
  polygon.n = across(d);
  polygon.height = dot(polygon.n, d[0]);
  for (std::size_t i = 0; i < d.size(); ++i) {
    const Triple<Scalar>& next = d[(i + 1) % d.size()];
    polygon.turns.push_back(cross(d[i], next));
    polygon.products.push_back(dot(d[i], next));
  }
  for (std::size_t i = 0; i + 2 < d.size() && d.size() == 4; ++i) {
    polygon.other_crosses.push_back(cross(d[i], d[i + 2]));
    polygon.other_products.push_back(dot(d[i], d[i + 2]));
  }
  return polygon;
}

/// Is the origin in the segment between the corners of some pair?
template <class Scalar, class Sign>
bool is_between(const std::vector<Triple<Scalar>>& crosses, const std::vector<Scalar>& products,
                const Sign& sign) {
  for (std::size_t k = 0; k < crosses.size(); ++k)
    if (sign(products[k]) <= 0 && sign(crosses[k].x) == 0 && sign(crosses[k].y) == 0 &&
        sign(crosses[k].z) == 0)
      return true;
  return false;
}

/// Is the origin in the polygon, seen along an axis on which n has the sign s?
template <class Scalar, class Sign>
bool turns_one_way(const Polygon<Scalar>& polygon, Scalar Triple<Scalar>::*axis, int s,
                   const Sign& sign) {
  for (const Triple<Scalar>& turn : polygon.turns)
    if (s * sign(turn.*axis) < 0) return false;
  return true;
}

/// sign: of a scalar, at the time in question.
template <class Scalar, class Sign>
bool holds_origin(const Polygon<Scalar>& polygon, const Sign& sign) {
  if (sign(polygon.height) != 0) return false;
  for (const auto axis : {&Triple<Scalar>::x, &Triple<Scalar>::y, &Triple<Scalar>::z})
    if (const int s = sign(polygon.n.*axis)) return turns_one_way(polygon, axis, s, sign);
  return is_between(polygon.turns, polygon.products, sign) ||
         is_between(polygon.other_crosses, polygon.other_products, sign);
}

/// The polynomials at whose roots the answer can change, none of them zero.
std::vector<Polynomial> events(const Polygon<Polynomial>& polygon) {
  if (!polygon.height.is_zero()) return {polygon.height};
  std::vector<Polynomial> all = polygon.products;
  all.insert(all.end(), polygon.other_products.begin(), polygon.other_products.end());
  std::vector<Triple<Polynomial>> vectors = polygon.turns;
  vectors.insert(vectors.end(), polygon.other_crosses.begin(), polygon.other_crosses.end());
  vectors.push_back(polygon.n);
  for (const Triple<Polynomial>& vector : vectors)
    all.insert(all.end(), {vector.x, vector.y, vector.z});
  std::erase_if(all, [](const Polynomial& p) { return p.is_zero(); });
  return all;
}

bool ever_holds_origin(const Polygon<Polynomial>& polygon) {
  for (const int end : {0, 1})
    if (holds_origin(polygon, [&](const Polynomial& p) { return sign_at(p, Dyadic{end, 0}); }))
      return true;
  for (const Polynomial& event : events(polygon)) {
    if (definite_sign(event) != 0) continue;
    for (const Root& root : roots_within(event))
      if (holds_origin(polygon, [&](const Polynomial& p) { return sign_at(p, root); })) return true;
  }
  return false;
}

/// Are all d_i on one side of a plane normal to an axis, at the start and at the end, and so
/// throughout?
bool separated_by_an_axis(const std::vector<Exact>& at_start, const std::vector<Exact>& at_end) {
  for (const auto axis : {&Exact::x, &Exact::y, &Exact::z})
    for (const int side : {-1, 1}) {
      const auto is_there = [&](const Exact& d) { return (d.*axis).sign() == side; };
      if (std::all_of(at_start.begin(), at_start.end(), is_there) &&
          std::all_of(at_end.begin(), at_end.end(), is_there))
        return true;
    }
  return false;
}

Quad<Whole> sum(const Quad<Whole>& p, const Quad<Whole>& q) {
  return {p[0] + q[0], p[1] + q[1], p[2] + q[2], p[3] + q[3]};
}

Quad<Polynomial> over_time(const ExactMotion& motion) {
  Quad<Polynomial> x;
  for (std::size_t i = 0; i < 4; ++i) {
    const Exact &p = motion.start[i], &w = motion.displacement[i];
    x[i] = {Polynomial({p.x, w.x}), Polynomial({p.y, w.y}), Polynomial({p.z, w.z})};
  }
  return x;
}

Quad<Whole> exact_points(const FourPoints& x, int exponent) {
  Quad<Whole> points;
  for (std::size_t i = 0; i < 4; ++i) points[i] = exact(x.col(Eigen::Index(i)), exponent);
  return points;
}

}  // namespace

ExactMotion exact_motion(const FourPoints& start, const FourPoints& displacement) {
  const int k =
      common_exponent({start.col(0), start.col(1), start.col(2), start.col(3), displacement.col(0),
                       displacement.col(1), displacement.col(2), displacement.col(3)});
  return {exact_points(start, k), exact_points(displacement, k)};
}

// x = start + t end displacement; end = whole / 2^halvings
ExactMotion until(const ExactMotion& motion, double end) {
  const int exponent = common_exponent({Vector3(end, 0, 0)});
  const Whole numerator = whole(end, exponent), denominator = Whole(1) << unsigned(-exponent);
  ExactMotion shorter;
  for (std::size_t i = 0; i < 4; ++i) {
    shorter.start[i] = denominator * motion.start[i];
    shorter.displacement[i] = numerator * motion.displacement[i];
  }
  return shorter;
}

ExactMotion motion_between(const std::array<std::array<Fraction, 3>, 8>& points) {
  Whole common = 1;
  for (const auto& point : points)
    for (const Fraction& f : point) common = lcm(common, f.denominator);
  const auto whole_point = [&](std::size_t i) {
    const auto times_common = [&](const Fraction& f) {
      return Whole(f.numerator * (common / f.denominator));
    };
    return Exact{times_common(points[i][0]), times_common(points[i][1]),
                 times_common(points[i][2])};
  };
  ExactMotion motion;
  for (std::size_t i = 0; i < 4; ++i) {
    motion.start[i] = whole_point(i);
    motion.displacement[i] = whole_point(i + 4) - motion.start[i];
  }
  return motion;
}

bool ever_meet(Features features, const ExactMotion& motion) {
  if (separated_by_an_axis(differences(features, motion.start),
                           differences(features, sum(motion.start, motion.displacement))))
    return false;
  const std::vector<Triple<Polynomial>> d = differences(features, over_time(motion));
  return definite_sign(dot(across(d), d[0])) == 0 && ever_holds_origin(polygon_of(d));
}

bool meet(Features features, const FourPoints& x) {
  const int k = common_exponent({x.col(0), x.col(1), x.col(2), x.col(3)});
  return holds_origin(polygon_of(differences(features, exact_points(x, k))), sign_of);
}

}  // namespace foldproof::oracles
