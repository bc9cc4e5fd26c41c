#include "reference/beyond/air.h"

#include <cmath>
#include <memory>

namespace foldproof {

namespace {

/// F = -(across n n^T + along (I - n n^T)) (v - w) on a triangle with the mean velocity v.
struct TriangleDrag {
  Vector3 n;             // normal
  double across, along;  // N s/m
};

/// The drags of all triangles at one state.
struct Drag {
  std::shared_ptr<const std::vector<Triangle>> triangles;
  std::vector<TriangleDrag> drags;

  /// f += the forces of air that moves with u_of(triangle) relative to it.
  template <class RelativeVelocity>
  void add(const RelativeVelocity& u_of, PerParticle3& f) const {
    for (size_t k = 0; k < drags.size(); ++k) {
      const auto& [n, across, along] = drags[k];
      const Vector3 u = u_of((*triangles)[k]);
      const double u_n = u.dot(n);
      const Vector3 third = (across * u_n * n + along * (u - u_n * n)) / 3;
      for (const int i : (*triangles)[k]) f.col(i) += third;
    }
  }

  /// The matrix of a triangle is J^T C J with J = (I, I, I)/3: each row sums to at most |C|/3.
  void add_rows(PerParticle& rows) const {
    for (size_t k = 0; k < drags.size(); ++k)
      for (const int i : (*triangles)[k]) rows[i] += std::max(drags[k].across, drags[k].along) / 3;
  }
};

Vector3 mean_of(const Triangle& t, const PerParticle3& v) {
  return (v.col(t[0]) + v.col(t[1]) + v.col(t[2])) / 3;
}

TriangleDrag drag_on(const Triangle& t, const State& s, const Air& air) {
  const Vector3 twice = (s.x.col(t[1]) - s.x.col(t[0])).cross(s.x.col(t[2]) - s.x.col(t[0]));
  const double twice_area = twice.norm();
  if (!(twice_area > 0)) return {Vector3::Zero(), 0, 0};
  const Vector3 n = twice / twice_area, u = air.wind - mean_of(t, s.v);
  const double u_n = u.dot(n), factor = air.density * twice_area / 4;
  return {n, factor * air.normal_drag * std::abs(u_n),
          factor * air.tangential_drag * (u - u_n * n).norm()};
}

}  // namespace

CustomForce make_air(std::vector<Triangle> triangles, const Air& air) {
  for (const double number : {air.density, air.normal_drag, air.tangential_drag})
    if (!(number >= 0) || !std::isfinite(number))
      throw InputError("air: density and drag must be finite numbers >= 0");
  if (!air.wind.allFinite()) throw InputError("air: the wind must be finite");
  const auto drag_at = [all = std::make_shared<const std::vector<Triangle>>(std::move(triangles)),
                        air](const State& s) {
    Drag drag{all, {}};
    for (const Triangle& t : *all) drag.drags.push_back(drag_on(t, s, air));
    return drag;
  };
  CustomForce force;
  if (!air.wind.isZero(0))
    force.elastic = [drag_at, w = air.wind](const State& s, PerParticle3& f) {
      drag_at(s).add([&](const Triangle&) { return w; }, f);
    };
  force.damping = [drag_at](const State& s) -> DampingOperator::Custom {
    const auto drag = std::make_shared<const Drag>(drag_at(s));
    return {[drag](const PerParticle3& v, PerParticle3& f) {
              drag->add([&](const Triangle& t) -> Vector3 { return -mean_of(t, v); }, f);
            },
            [drag](PerParticle& rows) { drag->add_rows(rows); }};
  };
  return force;
}

}  // namespace foldproof
