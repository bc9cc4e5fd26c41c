// Solids with a closed form, and the nearest of several objects, worked out by hand.
#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

#include "reference/level_set/object.h"

using namespace foldproof;

namespace {

void check_distance(const Distance& found, double phi, const Vector3& normal) {
  CHECK(found.phi == Approx(phi).margin(1e-15));
  CHECK((found.normal - normal).norm() < 1e-15);
}

ObjectPoint answer(double phi, int part) {
  ObjectPoint point;
  point.phi = phi;
  point.part = part;
  return point;
}

}  // namespace

TEST_CASE("solids have the distances of their closed forms, with a normal at every kink") {
  struct Row {
    Solid solid;
    Vector3 p;
    double phi;
    Vector3 normal;
  };
  const Sphere sphere{0.45};
  const Box box{{0.3, 0.5, 0.9}}, even{{0.25, 0.5, 0.75}};
  const Capsule capsule{0.2, 0.5};
  const Torus torus{0.9, 0.25};
  const std::vector<Row> rows = {{HalfSpace{}, {0.3, -0.8, -1.7}, -1.7, {0, 0, 1}},
                                 {sphere, {0.2, 0.3, -0.6}, 0.25, Vector3(2, 3, -6) / 7},
                                 {sphere, {0.02, 0.03, -0.06}, -0.38, Vector3(2, 3, -6) / 7},
                                 {sphere, {0, 0, 0}, -0.45, {0, 0, 1}},
                                 // inside of a box, the nearest face
                                 {box, {0.25, 0.1, -0.4}, -0.05, {1, 0, 0}},
                                 {box, {-0.25, 0.1, -0.4}, -0.05, {-1, 0, 0}},
                                 {box, {-0.1, 0.45, 0.2}, -0.05, {0, 1, 0}},
                                 {box, {-0.1, -0.45, 0.2}, -0.05, {0, -1, 0}},
                                 {box, {0.1, 0.2, 0.8}, -0.1, {0, 0, 1}},
                                 {box, {0.1, 0.2, -0.8}, -0.1, {0, 0, -1}},
                                 // on its faces
                                 {even, {-0.25, 0.1, 0.3}, 0, {-1, 0, 0}},
                                 {even, {0.1, 0.5, 0.3}, 0, {0, 1, 0}},
                                 {even, {0.1, -0.2, -0.75}, 0, {0, 0, -1}},
                                 // off a face, an edge and a corner
                                 {box, {0.2, -1.7, 0.4}, 1.2, {0, -1, 0}},
                                 {box, {0.6, -0.9, 0.1}, 0.5, {0.6, -0.8, 0}},
                                 {box, {-0.5, 0.8, -1.5}, 0.7, Vector3(-2, 3, -6) / 7},
                                 {capsule, {0.3, -0.4, 0.1}, 0.3, {0.6, -0.8, 0}},
                                 {capsule, {0.3, 0, 0.9}, 0.3, {0.6, 0, 0.8}},
                                 {capsule, {0, -0.3, -0.9}, 0.3, {0, -0.6, -0.8}},
                                 {capsule, {0, 0, -0.4}, -0.2, {1, 0, 0}},
                                 {torus, {0.72, 0.96, 0.4}, 0.25, {0.36, 0.48, 0.8}},
                                 {torus, {0, 0, 1.2}, 1.25, {-0.6, 0, 0.8}},
                                 {torus, {-0.54, 0.72, 0}, -0.25, {-0.6, 0.8, 0}}};
  for (const Row& row : rows) check_distance(distance_to(row.solid, row.p), row.phi, row.normal);
}

TEST_CASE("the two nearest answers are found in any order, and containing objects are counted") {
  const std::vector<double> phi{-0.2, 0.3, -0.5, 0.1};
  std::vector<int> order{0, 1, 2, 3};
  do {
    std::vector<ObjectPoint> points;
    for (const int k : order) points.push_back(answer(phi[k], k));
    const Nearest nearest = nearest_of(points);
    CHECK(nearest.first.part == 2);
    CHECK(nearest.second.part == 0);
    CHECK(nearest.inside == 2);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("of objects equally near the earlier are nearest, and two that contain a point pinch") {
  const Nearest nearest = nearest_of(std::vector{answer(0.4, 7), answer(0.4, 3), answer(0.4, 5)});
  CHECK(nearest.first.part == 7);
  CHECK(nearest.second.part == 3);
  CHECK_FALSE(nearest_of(std::vector{answer(0.2, 0), answer(-0.3, 1)}).pinched());
  CHECK_FALSE(nearest_of(std::vector{answer(0, 0), answer(-0.3, 1)}).pinched());
  CHECK(nearest_of(std::vector{answer(-0.1, 0), answer(-0.3, 1)}).pinched());
  const Nearest none = nearest_of({});
  CHECK(none.first.part == -1);
  CHECK(std::isinf(none.first.phi));
  CHECK(none.inside == 0);
}
