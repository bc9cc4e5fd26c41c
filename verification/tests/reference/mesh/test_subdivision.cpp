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

TEST_CASE("two levels are one of one, no level is the cloth itself, eight the most") {
  const TriangleMesh mesh = make_hinge(0.7, 0.3);
  // with new vertices on the edges 02, 03, 12, 13, 23
  const std::vector<Triangle> quarters{{0, 4, 5}, {4, 2, 8}, {5, 8, 3}, {4, 8, 5},
                                       {1, 7, 6}, {7, 3, 8}, {6, 8, 2}, {7, 8, 6}};
  for (const SubdivisionRule rule : {SubdivisionRule::midpoint, SubdivisionRule::loop}) {
    const Subdivision none = subdivision(mesh, rule, 0), first = subdivision(mesh, rule, 1);
    CHECK(none.triangles == mesh.triangles);
    CHECK(none.of(mesh.rest) == mesh.rest);
    CHECK(first.triangles == quarters);
    const TriangleMesh finer = make_triangle_mesh(first.of(mesh.rest), first.triangles);
    const Subdivision again = subdivision(finer, rule, 1), second = subdivision(mesh, rule, 2);
    CHECK(second.triangles == again.triangles);
    CHECK((second.of(mesh.rest) - again.of(finer.rest)).cwiseAbs().maxCoeff() < 1e-15);
  }
  CHECK(subdivision(mesh, SubdivisionRule::midpoint, 8).triangles.size() == 2 * 65536);
  for (const int levels : {-1, 9})
    CHECK_THROWS_WITH(subdivision(mesh, SubdivisionRule::loop, levels),
                      Catch::StartsWith("subdivision has 0 to 8 levels"));
}
