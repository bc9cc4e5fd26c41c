#include "reference/scene/object_surface.h"

#include <cmath>

#include "reference/mesh/shapes.h"

namespace foldproof {

namespace {

constexpr int vertices_around = 64;  // vertices on each circle around the axis
constexpr int along_arc = 16;        // edges of a quarter of a circle in the profile
constexpr int subdivisions = 4;      // of the sphere: 5120 triangles

struct ProfilePoint {
  double r, z;  // m
};

/// The profile turned about the z axis; it runs upwards (counter-clockwise if it closes), so that
/// triangles point away from the axis. It must have no points on the axis.
ObjectSurface revolve(const std::vector<ProfilePoint>& profile, bool closes) {
  const int rings = int(profile.size());
  ObjectSurface surface;
  surface.vertices.resize(3, rings * vertices_around);
  for (int k = 0; k < rings; ++k)
    for (int i = 0; i < vertices_around; ++i) {
      const double angle = 2 * pi * i / vertices_around;
      surface.vertices.col(k * vertices_around + i) << profile[size_t(k)].r * std::cos(angle),
          profile[size_t(k)].r * std::sin(angle), profile[size_t(k)].z;
    }
  for (int k = 0; k + (closes ? 0 : 1) < rings; ++k)
    for (int i = 0; i < vertices_around; ++i) {
      const int a = k * vertices_around + i, b = k * vertices_around + (i + 1) % vertices_around;
      const int c = (k + 1) % rings * vertices_around + i,
                d = (k + 1) % rings * vertices_around + (i + 1) % vertices_around;
      surface.triangles.push_back({a, b, d});
      surface.triangles.push_back({a, d, c});
    }
  return surface;
}

}  // namespace

ObjectSurface square_surface(double side) {
  ObjectSurface surface;
  surface.vertices.resize(3, 4);
  surface.vertices << -1, 1, 1, -1, -1, -1, 1, 1, 0, 0, 0, 0;
  surface.vertices *= side / 2;
  surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  return surface;
}

//   6 --- 7
//  /|    /|    corner k has the sign of x in bit 0, of y in bit 1, of z in bit 2
// 4 --- 5 |
// | 2 --|-3
// |/    |/
// 0 --- 1
ObjectSurface box_surface(const Vector3& half_extents) {
  ObjectSurface surface;
  surface.vertices.resize(3, 8);
  for (int k = 0; k < 8; ++k)
    surface.vertices.col(k) =
        half_extents.cwiseProduct(Vector3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
  surface.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return surface;
}

ObjectSurface sphere_surface(double radius) {
  static const TriangleMesh unit = make_icosphere(1, subdivisions);
  return {radius * unit.rest, unit.triangles};
}

ObjectSurface capsule_surface(double radius, double half_length) {
  std::vector<ProfilePoint> profile;
  for (const double end : {-half_length, half_length})
    for (int k = 0; k <= along_arc; ++k) {
      const double latitude =
          pi / 2 * (end < 0 ? double(k) / along_arc - 1 : double(k) / along_arc);
      const double r = radius * std::max(std::cos(latitude), 1e-3);  // a pinhole at the poles
      profile.push_back({r, end + radius * std::sin(latitude)});
    }
  return revolve(profile, false);
}

ObjectSurface torus_surface(double ring_radius, double tube_radius) {
  std::vector<ProfilePoint> profile;
  for (int k = 0; k < 4 * along_arc; ++k) {
    const double angle = pi / 2 * k / along_arc;
    profile.push_back({ring_radius + tube_radius * std::cos(angle), tube_radius * std::sin(angle)});
  }
  return revolve(profile, true);
}

}  // namespace foldproof
