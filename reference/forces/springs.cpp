#include "reference/forces/springs.h"

#include <algorithm>
#include <cmath>

#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

SpringShape shape_of(const Spring& spring, const PerParticle3& x) {
  const Vector3 d = x.col(spring.b) - x.col(spring.a);
  const double length = d.norm();
  if (!(length > 0)) throw DegenerateElement("a spring has no length", {spring.a, spring.b});
  return {d, length};
}

}  // namespace

SpringShapes StretchSprings::shapes_at(const PerParticle3& x) const {
  return springs.map([&](const Spring& spring) { return shape_of(spring, x); });
}

void StretchSprings::add_elastic(const State&, const SpringShapes& shapes, PerParticle3& f) const {
  springs.push(shapes, f, [](const Spring& spring, const SpringShape& shape, const auto& to) {
    const double extension = shape.length - spring.rest_length;
    const Vector3 pull = spring.stiffness * extension / shape.length * shape.d;
    to.add(spring.a, pull);
    to.add(spring.b, -pull);
  });
}

double StretchSprings::fastest_strain_rate(const State& s, const SpringShapes& shapes) const {
  return springs.largest(shapes, [&](const Spring& spring, const SpringShape& shape) {
    const double rate = shape.d.dot(s.v.col(spring.b) - s.v.col(spring.a)) / shape.length;
    return std::abs(rate) / spring.rest_length;
  });
}

double StretchSprings::energy(const State&, const SpringShapes& shapes) const {
  return springs.sum(shapes, [](const Spring& spring, const SpringShape& shape) {
    const double extension = shape.length - spring.rest_length;
    return 0.5 * spring.stiffness * extension * extension;
  });
}

void StretchSprings::prepare_damping(const State&, const SpringShapes& shapes,
                                     DampingOperator& damping) const {
  const auto damps = [](const Spring& spring) { return spring.damping != 0; };
  if (std::ranges::none_of(springs, damps)) return;
  damping.pairs.append(
      springs.map(shapes, [](const Spring& spring, const SpringShape& shape) -> PairDamper {
        return {spring.a, spring.b, std::sqrt(spring.damping) / shape.length * shape.d};
      }));
}

void StretchSprings::add_elastic_differential(const State& s, Definiteness definiteness,
                                              ForceDifferential& differential) const {
  differential.pairs.reserve(differential.pairs.size() + springs.size());
  for (const Spring& spring : springs) {
    const auto [d, length] = shape_of(spring, s.x);
    const Vector3 along = d / length;
    // tension over length
    double across = spring.stiffness * (length - spring.rest_length) / length;
    if (definiteness == Definiteness::semidefinite) across = std::max(0.0, across);
    const Eigen::Matrix3d projector = along * along.transpose();
    differential.pairs.push_back(
        {spring.a, spring.b,
         -spring.stiffness * projector - across * (Eigen::Matrix3d::Identity() - projector)});
  }
}

void StretchSprings::add_force_differential(const State& s, ForceDifferential& differential) const {
  const size_t first = differential.pairs.size();
  add_elastic_differential(s, Definiteness::exact, differential);
  for (size_t k = 0; k < springs.size(); ++k) {
    const Spring& spring = springs[k];
    if (spring.damping == 0) continue;
    const auto [d, length] = shape_of(spring, s.x);
    const Vector3 n = d / length, dv = s.v.col(spring.b) - s.v.col(spring.a);
    // dn = turn dd
    const Eigen::Matrix3d turn = (Eigen::Matrix3d::Identity() - n * n.transpose()) / length;
    differential.pairs[first + k].block -=
        spring.damping * (n * (dv.transpose() * turn) + n.dot(dv) * turn);
    differential.symmetric = false;
  }
}

StretchSprings make_springs(const TriangleMesh& mesh, const StretchMaterial& material) {
  if (!(material.stiffness >= 0))
    throw InputError("springs: stiffness must be a number >= 0 [N/m]");
  if (!(material.damping >= 0)) throw InputError("springs: damping must be a number >= 0 [N s/m]");
  if (!(material.rest_length_scale > 0)) throw InputError("springs: rest_length_scale must be > 0");

  const Eigen::VectorXd lengths = rest_lengths(mesh), areas = edge_areas(mesh);
  StretchSprings result;
  result.springs.reserve(mesh.edges.size());
  for (size_t e = 0; e < mesh.edges.size(); ++e) {
    const double shape = areas[e] / (lengths[e] * lengths[e]);  // A_e/L0^2 of the rest shape [1]
    result.springs.push_back({mesh.edges[e].a, mesh.edges[e].b,
                              material.rest_length_scale * lengths[e], material.stiffness * shape,
                              material.damping * shape});
  }
  return result;
}

}  // namespace foldproof
