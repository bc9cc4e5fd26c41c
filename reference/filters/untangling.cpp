#include "reference/filters/untangling.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace foldproof {

namespace {

/// Where an edge pierces a triangle: at a + along (b - a), with the triangle's weights w.
struct Piercing {
  int a, b;
  Triangle triangle;
  double along;
  Vector3 w;
  Vector3 shorter;  // unit: moving the edge this way relative to the triangle shortens their line
};

// Edge e of triangle s pierces triangle t (normal n) at p; their line of intersection runs from p
// along R into s. If the edge moves by d relative to t, p moves by d - (d.n)/(e.n) e. The line
// shortens by R times that: its length falls fastest along
//   G = R - (e.R)/(e.n) n.
void add_piercings(const PerParticle3& x, const Triangle& s, const Triangle& t,
                   std::vector<Piercing>& found) {
  const Vector3 t0 = x.col(t[0]), e1 = x.col(t[1]) - t0, e2 = x.col(t[2]) - t0;
  const Vector3 n = e1.cross(e2),
                line = (x.col(s[1]) - x.col(s[0])).cross(x.col(s[2]) - x.col(s[0])).cross(n);
  for (size_t k = 0; k < 3; ++k) {
    const int a = s[k], b = s[(k + 1) % 3], c = s[(k + 2) % 3];
    const Vector3 from = x.col(a), e = x.col(b) - x.col(a);
    const double along = (t0 - from).dot(n) / e.dot(n);
    if (!(along >= 0 && along <= 1)) continue;
    const Vector3 r = from + along * e - t0;
    const double w1 = r.cross(e2).dot(n) / n.squaredNorm(),
                 w2 = e1.cross(r).dot(n) / n.squaredNorm();
    if (!(w1 >= 0 && w2 >= 0 && w1 + w2 <= 1)) continue;
    const Vector3 inward = x.col(c) - from - (x.col(c) - from).dot(e) / e.squaredNorm() * e;
    const Vector3 R = (line.dot(inward) > 0 ? line : Vector3(-line)).normalized();
    const Vector3 G = R - e.dot(R) / e.dot(n) * n;
    if (G.allFinite() && G.norm() > 0)
      found.push_back({a, b, t, along, {1 - w1 - w2, w1, w2}, G.normalized()});
  }
}

/// Raises their relative speed to `speed` where it is less.
void push(const Piercing& at, double speed, const PerParticle& inverse_mass, PerParticle3& v) {
  const std::array<int, 5> particles = {at.a, at.b, at.triangle[0], at.triangle[1], at.triangle[2]};
  const std::array<double, 5> weights = {1 - at.along, at.along, -at.w[0], -at.w[1], -at.w[2]};
  double pair_compliance = 0, now = 0;  // 1/kg, m/s
  for (size_t k = 0; k < 5; ++k) {
    pair_compliance += weights[k] * weights[k] * inverse_mass[particles[k]];
    now += weights[k] * v.col(particles[k]).dot(at.shorter);
  }
  if (!(pair_compliance > 0) || !(now < speed)) return;
  for (size_t k = 0; k < 5; ++k)
    v.col(particles[k]) +=
        weights[k] * inverse_mass[particles[k]] / pair_compliance * (speed - now) * at.shorter;
}

}  // namespace

std::string list_triangles(const CrossingTriangles& crossing) {
  std::string text = std::to_string(crossing.size()) + " pairs of triangles:";
  for (size_t k = 0; k < std::min<size_t>(5, crossing.size()); ++k)
    text += (k > 0 ? ", " : " ") + std::to_string(crossing[k].first) + " and " +
            std::to_string(crossing[k].second);
  return crossing.size() > 5 ? text + ", ..." : text;
}

std::vector<char> tangled_particles(const CrossingTriangles& crossing,
                                    const std::vector<Triangle>& triangles,
                                    Eigen::Index particles) {
  std::vector<char> tangled(size_t(particles), 0);
  for (const auto& [s, t] : crossing)
    for (const int triangle : {s, t})
      for (const int corner : triangles[size_t(triangle)]) tangled[size_t(corner)] = 1;
  return tangled;
}

void remove_tangled_pairs(const std::vector<char>& tangled, std::vector<FeaturePair>& pairs) {
  std::erase_if(pairs, [&](const FeaturePair& pair) {
    return std::all_of(pair.particles.begin(), pair.particles.end(),
                       [&](int i) { return tangled[size_t(i)]; });
  });
}

void push_out_of_tangle(const CrossingTriangles& crossing, const std::vector<Triangle>& triangles,
                        const PerParticle3& x, double speed, const PerParticle& inverse_mass,
                        PerParticle3& v) {
  std::vector<Piercing> found;
  for (const auto& [s, t] : crossing) {
    add_piercings(x, triangles[size_t(s)], triangles[size_t(t)], found);
    add_piercings(x, triangles[size_t(t)], triangles[size_t(s)], found);
  }
  for (const Piercing& at : found) push(at, speed, inverse_mass, v);
}

}  // namespace foldproof
