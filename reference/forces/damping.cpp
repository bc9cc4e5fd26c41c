#include "reference/forces/damping.h"

namespace foldproof {

namespace {

void add_pairs(const std::vector<PairDamper>& pairs, const PerParticle3& v, PerParticle3& f) {
  for (const PairDamper& p : pairs) {
    const double rate = p.along.dot(v.col(p.b) - v.col(p.a));
    const Vector3 push = rate * p.along;
    f.col(p.a) += push;
    f.col(p.b) -= push;
  }
}

void add_hinges(const std::vector<HingeDamper>& hinges, const PerParticle3& v, PerParticle3& f) {
  for (const HingeDamper& h : hinges) {
    const auto [i1, i2, i3, i4] = h.particles;
    const Vector3 v3 = v.col(i3), v4 = v.col(i4);
    const Vector3 v34 = v3 - v4;

    // w.v, with the edge's velocity at the foot of each opposite vertex
    const Vector3 relative1 = v.col(i1) - v4 - h.weight1 * v34;
    const Vector3 relative2 = v.col(i2) - v4 - h.weight2 * v34;
    const double rate = h.w1.dot(relative1) + h.w2.dot(relative2);

    const Vector3 f1 = -rate * h.w1, f2 = -rate * h.w2;
    const Vector3 f3 = -(h.weight1 * f1 + h.weight2 * f2);
    f.col(i1) += f1;
    f.col(i2) += f2;
    f.col(i3) += f3;
    f.col(i4) -= f1 + f2 + f3;
  }
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
  add_pairs(pairs, v, f);
  add_hinges(hinges, v, f);
  add_targets(targets, v, f);
  for (const auto& add : custom) add(v, f);
}

}  // namespace foldproof
