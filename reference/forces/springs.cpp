#include "reference/forces/springs.h"

#include <algorithm>
#include <cmath>

#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

double checked_length(const Vector3& d, const Spring& spring) {
  const double length = d.norm();
  if (!(length > 0)) throw DegenerateElement("a spring has no length", {spring.a, spring.b});
  return length;
}

/// Writes the dampers of those springs that damp; returns the place after the last.
PairDamper* add_dampers(std::span<const Spring> springs, const State& s, PairDamper* to) {
  for (const Spring& spring : springs) {
    if (spring.damping == 0) continue;
    const Vector3 d = s.x.col(spring.b) - s.x.col(spring.a);
    const double length = checked_length(d, spring);
    *to++ = {spring.a, spring.b, std::sqrt(spring.damping) / length * d};
  }
  return to;
}

}  // namespace

void StretchSprings::use_threads(int threads, Eigen::Index particles) {
  std::vector<std::array<int, 4>> ends;
  for (const Spring& spring : springs) ends.push_back({spring.a, spring.b, spring.a, spring.b});
  sharing = share_out(threads, particles, ends);
  const auto damps = [](const Spring& spring) { return spring.damping != 0; };
  damper_sharing = std::ranges::all_of(springs, damps) ? sharing : Sharing();
}

void StretchSprings::add_elastic(const State& s, PerParticle3& f) const {
  for_each_run(sharing, springs, [&](std::span<const Spring> part, const auto& own) {
    for (const Spring& spring : part) {
      const Vector3 d = s.x.col(spring.b) - s.x.col(spring.a);
      const double length = checked_length(d, spring);
      const Vector3 pull = spring.stiffness * (length - spring.rest_length) / length * d;
      if (own.has(spring.a)) f.col(spring.a) += pull;
      if (own.has(spring.b)) f.col(spring.b) -= pull;
    }
  });
}

double StretchSprings::energy(const State& s) const {
  return sum_over(threads_of(sharing), springs, [&](const Spring& spring) {
    const double extension = (s.x.col(spring.b) - s.x.col(spring.a)).norm() - spring.rest_length;
    return 0.5 * spring.stiffness * extension * extension;
  });
}

void StretchSprings::prepare_damping(const State& s, DampingOperator& damping) const {
  PairDamper* to = damping.add_pairs(springs.size(), damper_sharing);
  if (!damper_sharing)
    damping.pairs.resize(size_t(add_dampers(springs, s, to) - damping.pairs.data()));
  else
    for_each_range(threads_of(sharing), springs, [&](std::span<const Spring> part, size_t first) {
      add_dampers(part, s, to + first);
    });
}

void StretchSprings::add_elastic_differential(const State& s, Definiteness definiteness,
                                              ForceDifferential& differential) const {
  differential.pairs.reserve(differential.pairs.size() + springs.size());
  for (const Spring& spring : springs) {
    const Vector3 d = s.x.col(spring.b) - s.x.col(spring.a);
    const double length = checked_length(d, spring);
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
    const Vector3 d = s.x.col(spring.b) - s.x.col(spring.a),
                  dv = s.v.col(spring.b) - s.v.col(spring.a);
    const double length = checked_length(d, spring);
    const Vector3 n = d / length;
    // dn = turn dd
    const Eigen::Matrix3d turn = (Eigen::Matrix3d::Identity() - n * n.transpose()) / length;
    differential.pairs[first + k].block -=
        spring.damping * (n * (dv.transpose() * turn) + n.dot(dv) * turn);
    differential.symmetric = false;
  }
}

void StretchSprings::add_stiffness_bound(const State& s, PerParticle& rows) const {
  // One spring's stiffness matrix is k along d and tension/|d| across it; a row of it sums to at
  // most twice the larger.
  for_each_run(sharing, springs, [&](std::span<const Spring> part, const auto& own) {
    for (const Spring& spring : part) {
      const double length = checked_length(s.x.col(spring.b) - s.x.col(spring.a), spring);
      const double across = spring.stiffness * std::abs(length - spring.rest_length) / length;
      const double row = 2 * std::max(spring.stiffness, across);
      if (own.has(spring.a)) rows[spring.a] += row;
      if (own.has(spring.b)) rows[spring.b] += row;
    }
  });
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
