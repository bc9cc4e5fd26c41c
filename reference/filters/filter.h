// The hook of BMF03 section 3, "modify the velocity in place": strain limits, collisions, sticking attach
// here.
#pragma once

#include <functional>
#include <variant>
#include <vector>

#include "reference/types.h"

namespace foldproof {

/// The times between which the corrected velocity moves the cloth; start == end for a velocity that only ends
/// a step.
struct Span {
  double start, end;  // s
};

/// A filter written on the spot.
struct CustomFilter {
  std::function<void(Span span, const State& s, PerParticle3& v)>
      modify;  // v: 3 x N [m/s], corrected in place

  void correct(Span span, const State& s, PerParticle3& v) const { modify(span, s, v); }
};

/// A filter corrects the velocity v that moves the cloth from s over the span. It must leave prescribed
/// particles alone.
template <class F>
concept MotionFilter = requires(const F filter, Span span, const State s, PerParticle3 v) {
  filter.correct(span, s, v);
};

using Filter = std::variant<CustomFilter>;
static_assert(MotionFilter<CustomFilter>);

/// Applies the filters in their order.
void correct(const std::vector<Filter>& filters, Span span, const State& s, PerParticle3& v);

}  // namespace foldproof
