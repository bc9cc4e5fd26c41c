#include "reference/level_set/winding.h"

#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

constexpr double full_angle = 4 * pi;

/// The solid angle of a triangle seen from the origin [rad], positive when its back is seen: twice
/// the arc tangent of a b c over |a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b| (van Oosterom and
/// Strackee 1983).
double solid_angle(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double u = a.norm(), v = b.norm(), w = c.norm();
  const double below = u * v * w + a.dot(b) * w + b.dot(c) * u + c.dot(a) * v;
  return 2 * std::atan2(a.dot(b.cross(c)), below);
}

double solid_angle(const Corners3& corners, const Vector3& p) {
  return solid_angle(corners[0] - p, corners[1] - p, corners[2] - p);
}

Vector3 area_of(const Corners3& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]); }

Vector3 centre_of(const Corners3& t) { return (t[0] + t[1] + t[2]) / 3; }

Dipole dipole_of(const MeshDistance& mesh, const BoxNode& node) {
  Dipole dipole{Vector3::Zero(), Vector3::Zero(), Eigen::Matrix3d::Zero(), 0};
  double sum = 0;
  for (int i = node.first; i < node.first + node.count; ++i) {
    const Vector3 area = area_of(mesh.corners[i]);
    dipole.area += area;
    dipole.centre += area.norm() * centre_of(mesh.corners[i]);
    sum += area.norm();
  }
  dipole.centre /= sum;
  for (int i = node.first; i < node.first + node.count; ++i) {
    dipole.slope +=
        area_of(mesh.corners[i]) * (centre_of(mesh.corners[i]) - dipole.centre).transpose();
    for (const Vector3& corner : mesh.corners[i])
      dipole.radius = std::max(dipole.radius, (corner - dipole.centre).norm());
  }
  return dipole;
}

// The solid angle of a small patch of area n at r from p is n.r/|r|^3; for a patch spread about its
// centre the next term is its derivative: slope : (I/|r|^3 - 3 r r^T/|r|^5).
double far_angle(const Dipole& dipole, const Vector3& r, double distance) {
  const double cube = distance * distance * distance;
  return dipole.area.dot(r) / cube + dipole.slope.trace() / cube -
         3 * r.dot(dipole.slope * r) / (cube * distance * distance);
}

}  // namespace

double winding_number(const PerParticle3& x, const std::vector<Triangle>& triangles,
                      const Vector3& p) {
  double sum = 0;
  for (const Triangle& t : triangles)
    sum += solid_angle(x.col(t[0]) - p, x.col(t[1]) - p, x.col(t[2]) - p);
  return sum / full_angle;
}

std::vector<Dipole> make_dipoles(const MeshDistance& mesh) {
  std::vector<Dipole> dipoles;
  dipoles.reserve(mesh.tree.nodes.size());
  for (const BoxNode& node : mesh.tree.nodes) dipoles.push_back(dipole_of(mesh, node));
  return dipoles;
}

double winding_number(const MeshDistance& mesh, const std::vector<Dipole>& dipoles,
                      const Vector3& p, double far) {
  double sum = 0;
  std::vector<int> waiting{0};
  while (!waiting.empty()) {
    const int at = waiting.back();
    waiting.pop_back();
    const BoxNode& node = mesh.tree.nodes[at];
    const Vector3 r = dipoles[at].centre - p;
    const double distance = r.norm();
    if (distance > far * dipoles[at].radius) {
      sum += far_angle(dipoles[at], r, distance);
    } else if (node.right >= 0) {
      waiting.push_back(node.right);
      waiting.push_back(at + 1);
    } else {
      for (int i = node.first; i < node.first + node.count; ++i)
        sum += solid_angle(mesh.corners[i], p);
    }
  }
  return sum / full_angle;
}

}  // namespace foldproof
