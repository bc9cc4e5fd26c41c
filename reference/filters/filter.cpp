#include "reference/filters/filter.h"

namespace foldproof {

void correct(const std::vector<Filter>& filters, const Span& span, const State& s, PerParticle3& v,
             Work& work) {
  for (const Filter& filter : filters)
    std::visit([&](const auto& f) { f.correct(span, s, v, work); }, filter);
}

}  // namespace foldproof
