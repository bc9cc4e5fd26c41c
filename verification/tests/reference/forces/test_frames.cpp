// Places in the frames of triangles: where they are, and how they move with the corners.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/forces/triangle_frame.h"
#include "verification/tests/reference/forces/force_differences.h"

using namespace foldproof;

namespace {

constexpr int n = 6;
using Names = std::vector<std::array<int, 3>>;
const Names triangles{{3, 0, 5}, {1, 5, 2}};
const std::vector<Vector3> places{Vector3(0.23, 0.41, 0.37), Vector3(-0.31, 0.87, -0.59)};

PerParticle3 corners() { return scattered(n, 0.8); }

std::vector<TriangleFrame> frames_at(const PerParticle3& x) {
  return {frame_of(triangles[0], x, places[0], 0.3), frame_of(triangles[1], x, places[1], 0.7)};
}

/// The formula at the head of triangle_frame.h.
Vector3 expected_place(const PerParticle3& x, size_t k) {
  const Vector3 a = x.col(triangles[k][0]), b = x.col(triangles[k][1]), c = x.col(triangles[k][2]);
  const Vector3& p = places[k];
  return (1 - p[0] - p[1]) * a + p[0] * b + p[1] * c + p[2] * (b - a).cross(c - a).normalized();
}

Eigen::MatrixXd jacobian(const PerParticle3& x) {
  return differences(x, 1e-3, [](const PerParticle3& moved) {
    return PerParticle3(0.3 * expected_place(moved, 0) + 0.7 * expected_place(moved, 1));
  });
}

/// (dJ) applied to v, by differences along dx.
Eigen::MatrixXd jacobian_change(const PerParticle3& x, const PerParticle3& dx) {
  const auto at = [&](double t) { return jacobian(x + t * dx); };
  const double step = 1e-3;
  return (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step);
}

}  // namespace

TEST_CASE("a frame has its weights, height, normal and slopes, scaled by its part") {
  const PerParticle3 x = corners();
  const TriangleFrame frame = frame_of(triangles[1], x, places[1], 0.7);
  CHECK(frame.corners == triangles[1]);
  CHECK((frame.weights - 0.7 * Vector3(0.44, -0.31, 0.87)).norm() < 1e-15);
  CHECK(frame.height == Approx(-0.59 * 0.7).epsilon(1e-15));
  const Vector3 a = x.col(1), b = x.col(5), c = x.col(2), N = (b - a).cross(c - a);
  CHECK((frame.normal - N / N.norm()).norm() < 1e-15);
  const std::array<Vector3, 3> opposite{c - b, a - c, b - a};
  for (int i = 0; i < 3; ++i)
    CHECK((frame.slopes.col(i) - N.cross(opposite[size_t(i)]) / N.squaredNorm()).norm() < 1e-14);
}

TEST_CASE("a place is found again from its weights and height") {
  const PerParticle3 x = corners();
  for (size_t k = 0; k < 2; ++k) {
    const std::array<int, 3>& names = triangles[k];
    const Corners3 at{x.col(names[0]), x.col(names[1]), x.col(names[2])};
    CHECK((local_place(at, expected_place(x, k)) - places[k]).norm() < 1e-14);
    CHECK((place_of({frame_of(names, x, places[k], 1)}, x) - expected_place(x, k)).norm() < 1e-15);
  }
  const Vector3 mean = 0.3 * expected_place(x, 0) + 0.7 * expected_place(x, 1);
  CHECK((place_of(frames_at(x), x) - mean).norm() < 1e-15);
  CHECK(place_of({}, x) == Vector3::Zero());
  const Vector3 a(0.25, 0.5, 0.75), along(0.5, -0.25, 0.125);
  CHECK_FALSE(local_place({a, a + along, a + 2 * along}, {0.9, 0.8, 0.7}).allFinite());
}

TEST_CASE("a place moves with its corners, and hands forces on to them, as it depends on them") {
  const PerParticle3 x = corners(), v = scattered(n, 3.3), start = scattered(n, 5.1);
  const std::vector<TriangleFrame> frames = frames_at(x);
  const Eigen::MatrixXd J = jacobian(x);
  CHECK(agree(frame_velocity(frames, v), Vector3(J * v.reshaped()), 1e-10));
  CHECK(frame_velocity({}, v) == Vector3::Zero());
  const Vector3 force(1.3, -0.7, 2.1);
  PerParticle3 f = start;
  add_corner_forces(frames, force, f);
  const Eigen::VectorXd added = J.transpose() * force;
  CHECK(agree(Eigen::VectorXd((f - start).reshaped()), added, 1e-10));
  f = start;
  add_corner_forces({}, force, f);
  CHECK(f == start);
}

TEST_CASE("a place's dependence on its corners changes with them, seen from either side") {
  const PerParticle3 x = corners(), v = scattered(n, 3.3), dx = scattered(n, 4.7),
                     start = scattered(n, 5.1);
  const std::vector<TriangleFrame> frames = frames_at(x);
  const Eigen::MatrixXd dJ = jacobian_change(x, dx);
  CHECK(agree(frame_velocity_change(frames, dx, v), Vector3(dJ * v.reshaped()), 1e-7));
  const Vector3 force(1.3, -0.7, 2.1);
  PerParticle3 f = start;
  add_corner_force_change(frames, force, dx, f);
  const Eigen::VectorXd added = dJ.transpose() * force;
  CHECK(agree(Eigen::VectorXd((f - start).reshaped()), added, 1e-7));
  CHECK(frame_velocity_change({}, dx, v) == Vector3::Zero());
}
