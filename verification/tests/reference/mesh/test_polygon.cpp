// Polygons of files: whatever their shape, triangles that cover them exactly once.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "reference/mesh/polygon.h"

using namespace foldproof;

namespace {

struct Areas {
  double sum, of_outline;   // of the triangles' areas; of the polygon, by its outline [m^2]
  double least = INFINITY;  // of a triangle
};

/// In a plane that lies askew in space.
PerParticle3 in_space(const std::vector<Eigen::Vector2d>& outline) {
  const Eigen::AngleAxisd turn(1.1, Vector3(1, 2, -3).normalized());
  PerParticle3 x(3, Eigen::Index(outline.size()));
  for (size_t k = 0; k < outline.size(); ++k)
    x.col(Eigen::Index(k)) = turn * Vector3(outline[k].x(), outline[k].y(), 0) + Vector3(3, -5, 7);
  return x;
}

std::vector<Triangle> cut(const PerParticle3& x) {
  std::vector<int> corners(size_t(x.cols()));
  std::iota(corners.begin(), corners.end(), 0);
  return triangles_of_polygon(corners, x);
}

Areas areas_of(const PerParticle3& x) {
  Vector3 outline = Vector3::Zero();
  for (Eigen::Index k = 0; k < x.cols(); ++k)
    outline += x.col(k).cross(x.col((k + 1) % x.cols())) / 2;
  Areas areas{0, outline.norm()};
  for (const Triangle& t : cut(x)) {
    const Vector3 area = (x.col(t[1]) - x.col(t[0])).cross(x.col(t[2]) - x.col(t[0])) / 2;
    areas.sum += area.norm();
    areas.least = std::min(areas.least, area.dot(outline) / outline.norm());
  }
  return areas;
}

}  // namespace

TEST_CASE("concave polygons are cut into triangles that cover them once, from every corner") {
  for (auto [area, outline] : std::vector<std::pair<double, std::vector<Eigen::Vector2d>>>{
           {3, {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},                  // L
           {7, {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}},  // U
           {0.75, {{0, 0}, {2, -1}, {0.5, 0}, {2, 2}}},                            // dart
           {2.5, {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 2}}},  // a corner on a side
           {4, {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}},
           {5,
            {{0, 0},
             {3, 0},
             {3, 2},
             {0, 2},
             {0, 0},
             {1, 0.5},
             {1, 1.5},
             {2, 1.5},
             {2, 0.5},
             {1, 0.5}}}})  // a hole, by a slit
    for (size_t k = 0; k < outline.size(); ++k) {
      const PerParticle3 x = in_space(outline);
      const Areas areas = areas_of(x);
      CHECK(areas.of_outline == Approx(area));
      CHECK(areas.sum == Approx(area));
      CHECK(areas.least > 1e-3);
      CHECK(cut(x).size() == outline.size() - 2);
      std::rotate(outline.begin(), outline.begin() + 1, outline.end());
    }
}

TEST_CASE("stars of up to 1000 corners are cut; longer and crossing ones are not") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.2, 2);
  for (const int corners : {5, 12, 60, 1000}) {
    std::vector<Eigen::Vector2d> star;
    for (int k = 0; k < corners; ++k)
      star.push_back(radius(random) * Eigen::Vector2d(std::cos(2 * pi * k / corners),
                                                      std::sin(2 * pi * k / corners)));
    const Areas areas = areas_of(in_space(star));
    CHECK(areas.sum == Approx(areas.of_outline));
    CHECK(areas.least > 0);
    star.insert(star.begin(), Eigen::Vector2d(0, 0));
    if (corners == 1000) CHECK(cut(in_space(star)).empty());
  }
  CHECK(cut(in_space({{0, 0}, {1, 1}, {1, 0}, {0, 2}})).empty());
  CHECK(cut(in_space({{0, 1}, {-0.6, -0.8}, {1, 0.3}, {-1, 0.3}, {0.6, -0.8}})).empty());
}

TEST_CASE("a convex polygon is a fan about its first corner; repeated corners count once") {
  const PerParticle3 x = in_space({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}});
  const std::vector<Triangle> fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  CHECK(cut(x) == fan);
  CHECK(triangles_of_polygon(std::vector<int>{0, 0, 1, 2, 3, 3, 4, 0}, x) == fan);
  CHECK(triangles_of_polygon(std::vector<int>{0, 1, 0, 1}, x).size() == 2);  // without area
  PerParticle3 bent = x;
  bent.col(2) += Vector3(0.1, 0.2, 0.3);
  CHECK(cut(bent) == fan);
}
