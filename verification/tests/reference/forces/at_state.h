// What a force gives at a state, with the shapes there if it has any.
#pragma once

#include "reference/forces/force.h"

namespace foldproof {

/// use(s) or use(s, shapes).
template <class F, class Use>
auto at_state(const F& force, const State& s, const Use& use) {
  if constexpr (HasShapes<F>)
    return use(s, force.shapes_at(s.x));
  else
    return use(s);
}

template <class F>
void add_elastic(const F& force, const State& s, PerParticle3& f) {
  at_state(force, s, [&](const auto&... at) { force.add_elastic(at..., f); });
}

template <class F>
void prepare_damping(const F& force, const State& s, DampingOperator& damping) {
  at_state(force, s, [&](const auto&... at) { force.prepare_damping(at..., damping); });
}

template <class F>
void add_stiffness_bound(const F& force, const State& s, PerParticle& rows) {
  at_state(force, s, [&](const auto&... at) { force.add_stiffness_bound(at..., rows); });
}

template <class F>
double energy_of(const F& force, const State& s) {
  return at_state(force, s, [&](const auto&... at) { return force.energy(at...); });
}

}  // namespace foldproof
