#include "reference/mesh/split_fans.h"

#include <utility>

namespace foldproof {

namespace {

/// Gives each corner the particle of its fan. fans: as returned by fans_of. Returns copy_of.
std::vector<int> number_fans(const std::vector<int>& fans, TriangleSoup& soup) {
  std::vector<int> copy_of, particle_of(fans.size(), -1);  // of a fan's first corner
  for (int v = 0; v < int(soup.rest.cols()); ++v) copy_of.push_back(v);
  std::vector<char> is_taken(copy_of.size(), 0);
  for (size_t corner = 0; corner < fans.size(); ++corner) {
    int& v = soup.triangles[corner / 3][corner % 3];
    int& particle = particle_of[size_t(fans[corner])];
    if (particle < 0 && !is_taken[size_t(v)]) {
      particle = v;
      is_taken[size_t(v)] = 1;
    } else if (particle < 0) {
      particle = int(copy_of.size());
      copy_of.push_back(v);
    }
    v = particle;
  }
  return copy_of;
}

//       a --- b      A triangle of the fan of v: the midpoint of its side opposite v is
//        \   /      (a + b)/2.
//          v
/// Positions of the particles of the split mesh, 3 x N' [m].
PerParticle3 pulled_apart(const std::vector<Triangle>& split, const PerParticle3& x,
                          const std::vector<int>& copy_of) {
  const Eigen::Index count = Eigen::Index(copy_of.size());
  PerParticle3 sum = PerParticle3::Zero(3, count), place = x(Eigen::all, copy_of);
  PerParticle sides = PerParticle::Zero(count);
  for (const Triangle& t : split)
    for (size_t k = 0; k < 3; ++k) {
      const int a = copy_of[size_t(t[(k + 1) % 3])], b = copy_of[size_t(t[(k + 2) % 3])];
      sum.col(t[k]) += (x.col(a) + x.col(b)) / 2;
      sides[t[k]] += 1;
    }
  std::vector<int> particles_of(size_t(x.cols()), 0);  // of a vertex
  for (const int v : copy_of) ++particles_of[size_t(v)];
  for (Eigen::Index i = 0; i < count; ++i) {
    if (particles_of[size_t(copy_of[size_t(i)])] == 1) continue;
    const Vector3 middle = sum.col(i) / sides[i];
    place.col(i) += split_share * (middle - place.col(i));
  }
  return place;
}

}  // namespace

SplitMesh split_fans(TriangleSoup soup) {
  const std::vector<int> fans = fans_of(make_mesh_of_fans(soup.rest, soup.triangles, soup.origin));
  std::vector<int> copy_of = number_fans(fans, soup);
  const PerParticle3 place = pulled_apart(soup.triangles, soup.rest, copy_of);
  MeshOrigin& origin = soup.origin;
  if (!origin.vertex_lines.empty())
    for (size_t i = origin.vertex_lines.size(); i < copy_of.size(); ++i)
      origin.vertex_lines.push_back(origin.vertex_lines[size_t(copy_of[i])]);
  return {make_triangle_mesh(place, std::move(soup.triangles), origin), std::move(copy_of)};
}

}  // namespace foldproof
