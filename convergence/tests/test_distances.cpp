#include <catch2/catch.hpp>

#include "convergence/any_case/distances.h"

using namespace foldproof;

TEST_CASE("distances of runs are root mean squares by mass, the worst over common frames") {
  PerParticle3 start(3, 2), later(3, 2);
  start << 0, 1, 0, -2, 0, 0.5;
  later = start;
  later.col(0) += Vector3(3, 0, 4);
  const PerParticle mass = Eigen::Array2d(1, 3);
  CHECK(longest_side(start) == 2);
  CHECK(mean_square_root(later - start, mass) == Approx(5.0 / 2));
  CHECK(largest_difference({start, start}, {start, later}, mass) == Approx(5.0 / 2));
  CHECK(largest_difference({start}, {start, later}, mass) == 0);
  CHECK(largest_motion({start, later, start}, mass) == Approx(5.0 / 2));
  later(1, 1) = std::nan("");
  CHECK(std::isnan(largest_difference({start, later}, {start, start}, mass)));
}
