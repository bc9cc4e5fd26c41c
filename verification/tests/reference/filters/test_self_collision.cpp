// The self-collision filter at a rim, and which pairs are tangled.
#include <catch2/catch.hpp>

#include "reference/filters/self_collision.h"

using namespace foldproof;

namespace {

SelfCollision filter_of(const TriangleMesh& mesh, const SelfCollisionSettings& settings,
                        const PerParticle& inverse_mass) {
  PerParticle mass = PerParticle::Constant(inverse_mass.size(), 0.8);
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    if (inverse_mass[i] > 0) mass[i] = 1 / inverse_mass[i];
  return {settings, make_cloth_tree(mesh), mass, inverse_mass};
}

State at_rest(const PerParticle3& x) { return {0.3, x, PerParticle3::Zero(3, x.cols())}; }

const Span step{1, 1.1, 0.1};
}  // namespace

TEST_CASE("a vertex within the thickness of a rim is stopped before it, not pushed back") {
  // it slides over a triangle that is nearer, so that the rim bears no load
  PerParticle3 x(3, 9), v = PerParticle3::Zero(3, 9);
  x << 0, -1, -1, 0.05, 0.05, 4, -3, 1, -3, 0, 0.3, -0.4, -2, 2, 0, -3, 0, 3, 0.04, 2, 2.2, 0.04,
      0.04, 0.04, 0, 0, 0;
  v(0, 0) = 0.5;
  PerParticle w = PerParticle::Zero(9);
  w.head(3).setConstant(0.7);
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
  Work work;
  filter_of(mesh, {0.06, 0, 0, 8, true}, w).correct(step, at_rest(x), v, work);
  CHECK(work.crossings == 1);
  CHECK(v.norm() < 1e-13);
}

TEST_CASE("particles are tangled in triangles that cross, and pairs whose particles all are go") {
  const std::vector<Triangle> mesh{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {2, 9, 10}};
  const std::vector<char> tangled = tangled_particles({{0, 2}}, mesh, 12);
  CHECK(tangled == std::vector<char>{1, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0});
  std::vector<FeaturePair> pairs{{PairKind::edge_edge, {0, 1, 6, 7}},
                                 {PairKind::vertex_triangle, {3, 6, 7, 8}},
                                 {PairKind::vertex_triangle, {1, 6, 7, 8}},
                                 {PairKind::edge_edge, {0, 1, 6, 11}}};
  remove_tangled_pairs(tangled, pairs);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].particles == std::array<int, 4>{3, 6, 7, 8});
  CHECK(pairs[1].particles == std::array<int, 4>{0, 1, 6, 11});
}
