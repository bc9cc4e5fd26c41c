#include "reference/filters/filter.h"

namespace foldproof {

void correct(const std::vector<Filter>& filters, Span span, const State& s, PerParticle3& v) {
  for (const Filter& filter : filters)
    std::visit([&](const auto& part) { part.correct(span, s, v); }, filter);
}

}  // namespace foldproof
