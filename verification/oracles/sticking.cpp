#include "verification/oracles/sticking.h"

#include "verification/oracles/scalars.h"
#include "verification/oracles/triple.h"

namespace foldproof::oracles {

namespace {

constexpr int most = 21;  // coordinates of a particle and of two triangles' corners
using Number = Dual<Digits50, most>;
using Point = Triple<Number>;

Point variables(const Vector3& p, int first) {
  return {variable<Digits50, most>(p.x(), first), variable<Digits50, most>(p.y(), first + 1),
          variable<Digits50, most>(p.z(), first + 2)};
}

Number constant(double value) { return Number(Digits50(value)); }

/// Position in the frame of the triangle (a, b, c), from the coordinates `place`.
Point placed(const Point& a, const Point& b, const Point& c, const Vector3& place) {
  const Point n = unit(cross(b - a, c - a));
  return a + constant(place[0]) * (b - a) + constant(place[1]) * (c - a) + constant(place[2]) * n;
}

double nearest(const Digits50& value) { return rounded(value).value; }

}  // namespace

StickingAnswer sticking_answer(const StuckParticle& stuck) {
  const int count = int(stuck.corners.size()), size = 3 + 9 * count;
  const Point x = variables(stuck.x, 0);
  Point sum{};
  for (int k = 0; k < count; ++k) {
    const auto& [a, b, c] = stuck.corners[size_t(k)];
    const int first = 3 + 9 * k;
    sum = sum + placed(variables(a, first), variables(b, first + 3), variables(c, first + 6),
                       stuck.places[size_t(k)]);
  }
  const Point target = sum / constant(count), u = target - x;
  const Number d2 = dot(u, u), far2 = constant(stuck.far) * constant(stuck.far),
               k0 = constant(stuck.stiffness);
  const Number energy = k0 * (d2 / constant(2) - d2 * d2 / (constant(2) * far2) +
                              d2 * d2 * d2 / (constant(6) * far2 * far2));
  const Number left = constant(1) - d2 / far2, stiffness = k0 * left * left;

  StickingAnswer answer;
  answer.target = {nearest(target.x.value), nearest(target.y.value), nearest(target.z.value)};
  answer.derivative.resize(3, 9 * count);
  for (int j = 0; j < 9 * count; ++j)
    answer.derivative.col(j) << nearest(target.x.derivative[size_t(3 + j)]),
        nearest(target.y.derivative[size_t(3 + j)]), nearest(target.z.derivative[size_t(3 + j)]);
  answer.stiffness = nearest(stiffness.value);
  answer.energy = nearest(energy.value);
  answer.force.resize(size);
  for (int j = 0; j < size; ++j) answer.force[j] = -nearest(energy.derivative[size_t(j)]);
  return answer;
}

}  // namespace foldproof::oracles
