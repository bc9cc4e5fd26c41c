// Subdivision: weights and triangles by Loop's rules, from the triangles alone.
#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "reference/mesh/shapes.h"
#include "reference/mesh/subdivision.h"

using namespace foldproof;

TEST_CASE("one level of Loop's rule has the weights worked out by hand, inside and on the border") {
  const auto check_loop = [](const std::vector<Triangle>& triangles,
                             const Eigen::MatrixXd& sixteenths) {
    PerParticle3 x(3, 4);
    x << 0, 2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 5;
    const TriangleMesh mesh = make_triangle_mesh(x, triangles);
    const Eigen::MatrixXd weights(subdivision(mesh, SubdivisionRule::loop, 1).weights);
    CHECK((16 * weights - sixteenths).cwiseAbs().maxCoeff() < 1e-14);
  };
  Eigen::MatrixXd closed(10, 4), open(9, 4);
  closed << 7, 3, 3, 3, 3, 7, 3, 3, 3, 3, 7, 3, 3, 3, 3, 7,  // particles
      6, 6, 2, 2, 6, 2, 6, 2, 6, 2, 2, 6, 2, 6, 6, 2, 2, 6, 2, 6, 2, 2, 6, 6;
  check_loop({{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}, closed);
  open << 12, 2, 2, 0, 2, 12, 0, 2, 2, 0, 12, 2, 0, 2, 2, 12,  // particles
      8, 8, 0, 0, 8, 0, 8, 0, 2, 6, 6, 2, 0, 8, 0, 8, 0, 0, 8, 8;
  check_loop({{0, 1, 2}, {1, 3, 2}}, open);
}
