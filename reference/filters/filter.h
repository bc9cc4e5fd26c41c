// The hook of BMF03 section 3, "modify the velocity in place": strain limits and
// collisions attach here.
#pragma once

#include <functional>
#include <variant>
#include <vector>

#include "reference/filters/object_collision.h"
#include "reference/filters/self_collision.h"
#include "reference/filters/strain_limit.h"
#include "reference/types.h"

namespace foldproof {

/// A filter given as a function.
struct CustomFilter {
  // v: 3 x N [m/s], corrected in place
  std::function<void(const Span& span, const State& s, PerParticle3& v)> modify;

  void correct(const Span& span, const State& s, PerParticle3& v, Work&) const {
    modify(span, s, v);
  }
};

/// A filter corrects the velocity v that moves the cloth from s over the span. It must not change
/// prescribed particles.
template <class F>
concept MotionFilter = requires(const F filter, const Span span, const State s, PerParticle3 v,
                                Work work) {
  filter.correct(span, s, v, work);
};

using Filter = std::variant<StrainLimiter, ObjectCollision, SelfCollision, CustomFilter>;
static_assert(MotionFilter<StrainLimiter> && MotionFilter<ObjectCollision> &&
              MotionFilter<SelfCollision> && MotionFilter<CustomFilter>);

/// Applies the filters in order.
void correct(const std::vector<Filter>& filters, const Span& span, const State& s, PerParticle3& v,
             Work& work);

}  // namespace foldproof
