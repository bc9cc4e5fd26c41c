// Springs and their dampers: refusals.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/forces/degenerate.h"
#include "reference/mesh/shapes.h"
#include "verification/tests/reference/forces/force_differences.h"

using namespace foldproof;

TEST_CASE("a spring without length is refused with both of its ends, wherever it is used") {
  const StretchSprings list{{{0, 2, 0.3, 13, 0.31}, {3, 1, 0.3, 13, 0.31}}};
  State s{0.37, scattered(4, 0.4), scattered(4, 2.9)};
  s.x.col(1) = s.x.col(3);
  ForceDifferential differential;
  const auto refusal = Catch::Message("a spring has no length (particles 3 1)");
  CHECK_THROWS_MATCHES(list.shapes_at(s.x), DegenerateElement, refusal);
  CHECK_THROWS_MATCHES(list.add_elastic_differential(s, Definiteness::exact, differential),
                       DegenerateElement, refusal);
  CHECK_THROWS_MATCHES(list.add_force_differential(s, differential), DegenerateElement, refusal);
  s.x(2, 0) = std::nan("");
  CHECK_THROWS_WITH(list.shapes_at(s.x), Catch::Contains("particles 0 2"));
}
