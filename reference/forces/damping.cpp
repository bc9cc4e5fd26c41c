#include "reference/forces/damping.h"

namespace foldproof {

namespace {

template <class Damper>
Damper* append(size_t count, const Sharing& sharing, std::vector<Damper, Unfilled<Damper>>& dampers,
               Sharing& kept) {
  const size_t before = dampers.size();
  kept = before == 0 ? sharing : Sharing();
  dampers.resize(before + count);
  return dampers.data() + before;
}

void add_pair_forces(const DampingOperator& damping, const PerParticle3& v, PerParticle3& f) {
  for_each_run(damping.pair_sharing, damping.pairs, [&](auto part, const auto& own) {
    for (const PairDamper& p : part) {
      const double rate = p.along.dot(v.col(p.b) - v.col(p.a));
      const Vector3 push = rate * p.along;
      if (own.has(p.a)) f.col(p.a) += push;
      if (own.has(p.b)) f.col(p.b) -= push;
    }
  });
}

void add_hinge_forces(const DampingOperator& damping, const PerParticle3& v, PerParticle3& f) {
  for_each_run(damping.hinge_sharing, damping.hinges, [&](auto part, const auto& own) {
    for (const HingeDamper& h : part) {
      const auto [i1, i2, i3, i4] = h.particles;
      const Vector3 v3 = v.col(i3), v4 = v.col(i4);
      const Vector3 v34 = v3 - v4;

      // w.v, with the edge's velocity at the foot of each opposite vertex
      const Vector3 relative1 = v.col(i1) - v4 - h.weight1 * v34;
      const Vector3 relative2 = v.col(i2) - v4 - h.weight2 * v34;
      const double rate = h.w1.dot(relative1) + h.w2.dot(relative2);

      const Vector3 f1 = -rate * h.w1, f2 = -rate * h.w2;
      const Vector3 f3 = -(h.weight1 * f1 + h.weight2 * f2);
      if (own.has(i1)) f.col(i1) += f1;
      if (own.has(i2)) f.col(i2) += f2;
      if (own.has(i3)) f.col(i3) += f3;
      if (own.has(i4)) f.col(i4) -= f1 + f2 + f3;
    }
  });
}

void add_targets(const std::vector<TargetDamper>& targets, const PerParticle3& v, PerParticle3& f) {
  for (const TargetDamper& t : targets) {
    const Vector3 pull = t.coefficient * (frame_velocity(t.frames, v) - v.col(t.particle));
    f.col(t.particle) += pull;
    add_corner_forces(t.frames, -pull, f);
  }
}

}  // namespace

PairDamper* DampingOperator::add_pairs(size_t count, const Sharing& sharing) {
  return append(count, sharing, pairs, pair_sharing);
}

HingeDamper* DampingOperator::add_hinges(size_t count, const Sharing& sharing) {
  return append(count, sharing, hinges, hinge_sharing);
}

void DampingOperator::add_product(const PerParticle3& v, PerParticle3& f) const {
  add_pair_forces(*this, v, f);
  add_hinge_forces(*this, v, f);
  add_targets(targets, v, f);
  for (const auto& add : custom) add(v, f);
}

}  // namespace foldproof
