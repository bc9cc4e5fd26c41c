#include "reference/forces/triangle_frame.h"

#include <Eigen/Geometry>

namespace foldproof {

Vector3 local_place(const Corners3& corners, const Vector3& p) {
  const auto& [a, b, c] = corners;
  const Vector3 along_b = b - a, along_c = c - a, from_a = p - a, N = along_b.cross(along_c);
  const double squared = N.squaredNorm();
  return {from_a.cross(along_c).dot(N) / squared, along_b.cross(from_a).dot(N) / squared,
          from_a.dot(N) / std::sqrt(squared)};
}

TriangleFrame frame_of(const std::array<int, 3>& particles, const PerParticle3& x,
                       const Vector3& place, double part) {
  const Vector3 a = x.col(particles[0]), b = x.col(particles[1]), c = x.col(particles[2]);
  const Vector3 N = (b - a).cross(c - a);
  const double twice_area = N.norm();
  TriangleFrame frame{particles,
                      part * Vector3(1 - place[0] - place[1], place[0], place[1]),
                      part * place[2],
                      N / twice_area,
                      {}};
  frame.slopes.col(0) = frame.normal.cross(c - b) / twice_area;
  frame.slopes.col(1) = frame.normal.cross(a - c) / twice_area;
  frame.slopes.col(2) = frame.normal.cross(b - a) / twice_area;
  return frame;
}

Vector3 place_of(const std::vector<TriangleFrame>& frames, const PerParticle3& x) {
  Vector3 sum = Vector3::Zero();
  for (const TriangleFrame& frame : frames) {
    for (int i = 0; i < 3; ++i) sum += frame.weights[i] * x.col(frame.corners[size_t(i)]);
    sum += frame.height * frame.normal;
  }
  return sum;
}

Vector3 frame_velocity(const std::vector<TriangleFrame>& frames, const PerParticle3& v) {
  Vector3 sum = Vector3::Zero();
  for (const TriangleFrame& frame : frames)
    for (int i = 0; i < 3; ++i) {
      const Vector3 of_corner = v.col(frame.corners[size_t(i)]);
      sum += frame.weights[i] * of_corner -
             frame.height * frame.normal.dot(of_corner) * frame.slopes.col(i);
    }
  return sum;
}

void add_corner_forces(const std::vector<TriangleFrame>& frames, const Vector3& force,
                       PerParticle3& f) {
  for (const TriangleFrame& frame : frames)
    for (int i = 0; i < 3; ++i)
      f.col(frame.corners[size_t(i)]) +=
          frame.weights[i] * force - frame.height * frame.slopes.col(i).dot(force) * frame.normal;
}

namespace {

/// The rotation of a frame with its corners' displacements.
struct Turning {
  Vector3 normal;          // dn
  Eigen::Matrix3d slopes;  // dg
};

Turning turning_of(const TriangleFrame& frame, const PerParticle3& dx) {
  Eigen::Matrix3d moved;  // of the corners
  for (int i = 0; i < 3; ++i) moved.col(i) = dx.col(frame.corners[size_t(i)]);
  const Vector3 heights = moved.transpose() * frame.normal;  // n . dx_j
  const Eigen::Matrix3d& g = frame.slopes;
  return {-g * heights, -g * (g.transpose() * moved).transpose() +
                            frame.normal * (g.transpose() * g * heights).transpose()};
}

}  // namespace

void add_corner_force_change(const std::vector<TriangleFrame>& frames, const Vector3& force,
                             const PerParticle3& dx, PerParticle3& f) {
  for (const TriangleFrame& frame : frames) {
    const Turning turning = turning_of(frame, dx);
    for (int i = 0; i < 3; ++i)
      f.col(frame.corners[size_t(i)]) -=
          frame.height * (turning.slopes.col(i).dot(force) * frame.normal +
                          frame.slopes.col(i).dot(force) * turning.normal);
  }
}

Vector3 frame_velocity_change(const std::vector<TriangleFrame>& frames, const PerParticle3& dx,
                              const PerParticle3& v) {
  Vector3 sum = Vector3::Zero();
  for (const TriangleFrame& frame : frames) {
    const Turning turning = turning_of(frame, dx);
    for (int i = 0; i < 3; ++i) {
      const Vector3 of_corner = v.col(frame.corners[size_t(i)]);
      sum -= frame.height * (frame.normal.dot(of_corner) * turning.slopes.col(i) +
                             turning.normal.dot(of_corner) * frame.slopes.col(i));
    }
  }
  return sum;
}

}  // namespace foldproof
