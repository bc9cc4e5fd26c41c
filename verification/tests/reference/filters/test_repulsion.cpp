// Repulsion of close layers: impulses of a pair, friction, and which pairs bear load.
#include <catch2/catch.hpp>

#include "reference/filters/repulsion.h"

using namespace foldproof;

namespace {

PerParticle values(std::initializer_list<double> of) {
  PerParticle w(Eigen::Index(of.size()));
  std::copy(of.begin(), of.end(), w.data());
  return w;
}

const FeaturePair vertex_over_triangle{PairKind::vertex_triangle, {0, 1, 2, 3}};

// A vertex over a triangle in the plane z = 0.5: 0.006 above the point with the weights
// 0.2, 0.3 and 0.5.
const Eigen::Vector4d weights(1, -0.2, -0.3, -0.5);
PerParticle3 vertex_and_triangle() {
  PerParticle3 x(3, 4);
  x.col(1) << 0.1, 0.2, 0.5;
  x.col(2) << 1.1, 0.3, 0.5;
  x.col(3) << 0.2, 1.4, 0.5;
  x.col(0) = 0.2 * x.col(1) + 0.3 * x.col(2) + 0.5 * x.col(3) + Vector3(0, 0, 0.006);
  return x;
}

/// The relative velocity sum w_i v_i after repulsion at thickness 0.01, in a step of 0.02; it
/// starts as `relative`.
struct Repelled {
  long pairs;
  Vector3 relative;
};
Repelled repelled(const Vector3& relative, double stiffness, double friction) {
  const PerParticle inverse_mass = values({0.3, 0.7, 0.2, 0.4});
  PerParticle3 v(3, 4);
  v.rightCols(3) << 0.3, -0.1, 0.6, 0.2, 0.9, -0.4, -0.7, 0.5, 0.1;
  v.col(0) = relative - v.rightCols(3) * weights.tail(3);
  const SelfCollisionSettings settings{0.01, stiffness, friction, 8, true};
  Repelled result{};
  result.pairs =
      repel({vertex_over_triangle}, vertex_and_triangle(), settings, 0.02, inverse_mass, v, 1);
  result.relative = v * weights;
  return result;
}

/// How many of the pairs repel each other weakly at rest, in a step of 0.5.
long count_repelled(const std::vector<FeaturePair>& pairs, const PerParticle3& x, double thickness,
                    int threads = 1) {
  PerParticle3 v = PerParticle3::Zero(3, x.cols());
  return repel(pairs, x, {thickness, 1e-3, 0, 8, true}, 0.5, PerParticle::Constant(x.cols(), 0.3),
               v, threads);
}

PerParticle3 columns(std::initializer_list<Vector3> of) {
  PerParticle3 x(3, Eigen::Index(of.size()));
  Eigen::Index i = 0;
  for (const Vector3& column : of) x.col(i++) = column;
  return x;
}

}  // namespace

TEST_CASE("self-collision has no thickness, stiffness or friction unless the case names them") {
  const SelfCollisionSettings settings;
  CHECK(settings.thickness == 0);
  CHECK(settings.stiffness == 0);
  CHECK(settings.friction == 0);
  CHECK(settings.rounds == 8);
  CHECK(settings.untangle);
}

TEST_CASE("a pair's impulses change its relative velocity as asked, shared by weights and masses") {
  const FeaturePair pair{PairKind::edge_edge, {4, 1, 2, 0}};
  const Eigen::Vector4d w(0.25, 0.75, -0.4, -0.6);
  const PerParticle inverse_mass = values({0.5, 0, 0.3, 9, 0.2});
  const Vector3 change(0.3, -0.7, 1.1);
  PerParticle3 v(3, 5);
  v << 1, 2, 3, 4, 5, 6, 7, 8, 9, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5;
  const PerParticle3 before = v;
  push_apart(pair, w, change, inverse_mass, v);
  const double compliance = 0.0625 * 0.2 + 0.16 * 0.3 + 0.36 * 0.5;
  CHECK((v.col(4) - before.col(4) - 0.25 * 0.2 / compliance * change).norm() < 1e-14);
  CHECK(v.col(1) == before.col(1));
  CHECK((v.col(2) - before.col(2) + 0.4 * 0.3 / compliance * change).norm() < 1e-14);
  CHECK((v.col(0) - before.col(0) + 0.6 * 0.5 / compliance * change).norm() < 1e-14);
  CHECK(v.col(3) == before.col(3));

  v = before;
  push_apart(pair, w, change, PerParticle::Zero(5), v);
  CHECK(v == before);
  // nor is there an impulse where the only free particle has no weight
  push_apart(pair, {1, 0, -0.4, -0.6}, change, values({0, 0.3, 0, 9, 0}), v);
  CHECK(v == before);
}

TEST_CASE("friction acts across the normal, up to its coefficient times the push and to rest") {
  const Vector3 N(0, 0.6, 0.8), along(0.3, 0.32, -0.24);  // perpendicular, length 0.5
  const Vector3 relative = along - 1.7 * N;
  CHECK((friction_impulse(relative, N, 0.4, 0.3) + 0.12 / 0.5 * along).norm() < 1e-15);
  CHECK((friction_impulse(relative, N, 1.5, 0.3) + 0.9 * along).norm() < 1e-15);
  CHECK((friction_impulse(relative, N, 1.9, 0.3) + along).norm() < 1e-15);
  CHECK((friction_impulse(relative, N, 19, 0.7) + along).norm() < 1e-15);
  CHECK(friction_impulse(Vector3(0, 0, -3), Vector3(0, 0, 1), 1.9, 0.3) == Vector3::Zero());
}

TEST_CASE("repulsion stops an approach and takes away a tenth of the overlap in a step at most") {
  // overlap 0.004, so a tenth of it over the step is 0.02; the compliance is 0.3 + 0.04 * 0.7 +
  // 0.09 * 0.2 + 0.25 * 0.4
  const double compliance = 0.446, step = 0.02, overlap = 0.004;
  SECTION("stiff") {
    const Repelled after = repelled({0.2, -0.1, -0.3}, 1e9, 0);
    CHECK(after.pairs == 1);
    CHECK((after.relative - Vector3(0.2, -0.1, 0.02)).norm() < 1e-12);
  }
  SECTION("soft") {
    const Repelled after = repelled({0.2, -0.1, -0.3}, 90, 0);
    const double rate = step * 90 * overlap * compliance;
    REQUIRE(rate < 0.01);
    CHECK((after.relative - Vector3(0.2, -0.1, rate)).norm() < 1e-12);
  }
  SECTION("parting, but slowly") {
    const Repelled stiff = repelled({0.2, -0.1, 0.015}, 1e9, 0);
    CHECK(stiff.pairs == 1);
    CHECK((stiff.relative - Vector3(0.2, -0.1, 0.02)).norm() < 1e-12);
    const Repelled soft = repelled({0.2, -0.1, 0.015}, 90, 0);
    CHECK((soft.relative - Vector3(0.2, -0.1, 0.015 + step * 90 * overlap * compliance)).norm() <
          1e-12);
  }
  SECTION("parting fast enough") {
    const Repelled after = repelled({0.2, -0.1, 0.021}, 1e9, 0.7);
    CHECK(after.pairs == 0);
    CHECK((after.relative - Vector3(0.2, -0.1, 0.021)).norm() < 1e-14);
  }
  SECTION("with friction against the push") {
    const Repelled after = repelled({0.3, -0.4, -0.08}, 1e9, 0.6);
    CHECK((after.relative - Vector3(0.3 * (1 - 0.12), -0.4 * (1 - 0.12), 0.02)).norm() < 1e-12);
  }
}

TEST_CASE("a pair repels below the thickness only, and not where it touches") {
  const PerParticle3 x = columns({{0.5, 0.5, 0.25}, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}});
  CHECK(count_repelled({vertex_over_triangle}, x, 0.2500001) == 1);
  PerParticle3 v = PerParticle3::Zero(3, 4);
  v(2, 0) = -3;
  const PerParticle3 before = v;
  const PerParticle inverse_mass = PerParticle::Constant(4, 0.3);
  CHECK(repel({vertex_over_triangle}, x, {0.25, 2, 0, 8, true}, 0.5, inverse_mass, v, 1) == 0);
  CHECK(v == before);
  PerParticle3 touching = x;
  touching(2, 0) = 0;
  CHECK(count_repelled({vertex_over_triangle}, touching, 0.25) == 0);
  // a pair of prescribed particles is left alone and not counted
  CHECK(repel({vertex_over_triangle}, x, {0.5, 2, 0, 8, true}, 0.5, PerParticle::Zero(4), v, 1) ==
        0);
  CHECK(v == before);
}

TEST_CASE("two edges bear load where they are nearest inside both, not at an end") {
  const FeaturePair pair{PairKind::edge_edge, {0, 1, 2, 3}};
  const Vector3 a(-1, 0, 0), b(2, 0, 0);
  CHECK(count_repelled({pair}, columns({a, b, {0.5, -1, 0.25}, {0.5, 2, 0.25}}), 0.5) == 1);
  CHECK(count_repelled({pair}, columns({a, b, {0.5, 0.125, 0.25}, {0.5, 2, 0.25}}), 0.5) == 0);
  CHECK(count_repelled({pair}, columns({a, b, {2.125, -1, 0.25}, {2.125, 2, 0.25}}), 0.5) == 0);
}

TEST_CASE("a vertex bears load over a rim only if no triangle is nearer") {
  // two sides of a roof with the ridge 1-2
  const FeaturePair side{PairKind::vertex_triangle, {0, 1, 2, 3}},
      other{PairKind::vertex_triangle, {0, 2, 1, 4}};
  const Vector3 ridge_a(0, 0, 0), ridge_b(2, 0, 0), eaves(1, 1, -1), other_eaves(1, -1, -1);
  const auto roof = [&](const Vector3& vertex) {
    return columns({vertex, ridge_a, ridge_b, eaves, other_eaves});
  };
  // above the ridge: as near to one side as to the other
  CHECK(count_repelled({side, other}, roof({0.5, 0, 0.25}), 0.5) == 2);
  CHECK(count_repelled({side}, roof({0.5, 0, 0.25}), 0.5) == 1);
  // above one side, which is nearer than the other's rim, in either order
  CHECK(count_repelled({side, other}, roof({1, 0.25, 0}), 0.5) == 1);
  CHECK(count_repelled({other, side}, roof({1, 0.25, 0}), 0.5) == 1);
  CHECK(count_repelled({other}, roof({1, 0.25, 0}), 0.5) == 1);
}

TEST_CASE("neither an edge nor another vertex takes away the load that a vertex bears at a rim") {
  // vertex 0 stands beyond the rim of 1-2-3, 0.25 away; its edge 0-4 crosses the edge 5-6 0.125
  // above; vertex 7 is nearer to the triangle
  const PerParticle3 x = columns({{1, -0.25, 0},
                                  {0, 0, 0},
                                  {2, 0, 0},
                                  {1, 2, 0},
                                  {1, -2.25, 0},
                                  {0, -1.25, 0.125},
                                  {2, -1.25, 0.125},
                                  {0.5, -0.0625, 0}});
  const FeaturePair rim{PairKind::vertex_triangle, {0, 1, 2, 3}},
      edges{PairKind::edge_edge, {0, 4, 5, 6}}, nearer{PairKind::vertex_triangle, {7, 1, 2, 3}},
      far{PairKind::vertex_triangle, {4, 1, 2, 3}}, at_an_end{PairKind::edge_edge, {0, 4, 1, 2}};
  CHECK(count_repelled({rim}, x, 0.5) == 1);
  CHECK(count_repelled({edges, rim}, x, 0.5) == 2);
  CHECK(count_repelled({rim, nearer}, x, 0.5) == 2);
  for (const int threads : {1, 2, 3})
    CHECK(count_repelled({far, at_an_end, edges, far, rim, at_an_end, nearer}, x, 0.5, threads) ==
          3);
}

TEST_CASE("pairs are repelled one after the other, also after one that needs no push") {
  PerParticle3 x(3, 8), v = PerParticle3::Zero(3, 8);
  x.leftCols(4) = vertex_and_triangle();
  x.rightCols(4) = vertex_and_triangle().colwise() + Vector3(5, 6, 7);
  v(2, 0) = 9;   // parts fast
  v(2, 4) = -9;  // approaches
  const FeaturePair second{PairKind::vertex_triangle, {4, 5, 6, 7}};
  const SelfCollisionSettings settings{0.01, 1e9, 0, 8, true};
  const PerParticle inverse_mass = PerParticle::Constant(8, 0.3);
  CHECK(repel({vertex_over_triangle, second, second}, x, settings, 0.02, inverse_mass, v, 1) >= 1);
  CHECK(v(2, 0) == 9);
  CHECK((v.rightCols(4) * weights).z() == Approx(0.02));
}
