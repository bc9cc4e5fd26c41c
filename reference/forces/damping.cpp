#include "reference/forces/damping.h"

namespace foldproof {

namespace {

void add_pair_forces(const Elements<PairDamper>& pairs, const PerParticle3& v, PerParticle3& f) {
  pairs.push(f, [&](const PairDamper& p, const auto& to) {
    const double rate = p.along.dot(v.col(p.b) - v.col(p.a));
    const Vector3 push = rate * p.along;
    to.add(p.a, push);
    to.add(p.b, -push);
  });
}

void add_hinge_forces(const Elements<HingeDamper>& hinges, const PerParticle3& v, PerParticle3& f) {
  hinges.push(f, [&](const HingeDamper& h, const auto& to) {
    const auto [i1, i2, i3, i4] = h.particles;
    const Vector3 v3 = v.col(i3), v4 = v.col(i4);
    const Vector3 v34 = v3 - v4;

    // w.v, with the edge's velocity at the foot of each opposite vertex
    const Vector3 relative1 = v.col(i1) - v4 - h.weight1 * v34;
    const Vector3 relative2 = v.col(i2) - v4 - h.weight2 * v34;
    const double rate = h.w1.dot(relative1) + h.w2.dot(relative2);

    const Vector3 f1 = -rate * h.w1, f2 = -rate * h.w2;
    const Vector3 f3 = -(h.weight1 * f1 + h.weight2 * f2);
    to.add(i1, f1);
    to.add(i2, f2);
    to.add(i3, f3);
    to.add(i4, -(f1 + f2 + f3));
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

void DampingOperator::add_product(const PerParticle3& v, PerParticle3& f) const {
  add_pair_forces(pairs, v, f);
  add_hinge_forces(hinges, v, f);
  add_targets(targets, v, f);
  for (const Custom& one : custom) one.add_product(v, f);
}

}  // namespace foldproof
