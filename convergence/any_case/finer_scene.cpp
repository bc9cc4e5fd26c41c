#include "convergence/any_case/finer_scene.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>

#include "reference/scene/refine_cloth.h"

namespace foldproof {

namespace {

bool moves_alike(const Motion& one, const Motion& other) {
  return one.velocity == other.velocity && one.amplitude == other.amplitude &&
         one.frequency == other.frequency && one.phase == other.phase &&
         one.center == other.center && one.angular_velocity == other.angular_velocity &&
         one.from == other.from && one.until == other.until;
}

/// `chosen`, and the middles of those edges whose ends are both in it.
std::vector<int> with_middles(const TriangleMesh& mesh, std::vector<int> chosen) {
  const std::set<int> ends(chosen.begin(), chosen.end());
  for (size_t e = 0; e < mesh.edges.size(); ++e)
    if (ends.contains(mesh.edges[e].a) && ends.contains(mesh.edges[e].b))
      chosen.push_back(mesh.particles() + int(e));
  return chosen;
}

std::vector<PrescribedParticle> prescribed_with_midpoints(const Scene& scene) {
  std::vector<const PrescribedParticle*> of_particle(size_t(scene.mesh.particles()), nullptr);
  for (const PrescribedParticle& p : scene.prescribed) of_particle[size_t(p.particle)] = &p;
  std::vector<PrescribedParticle> prescribed = scene.prescribed;
  for (size_t e = 0; e < scene.mesh.edges.size(); ++e) {
    const PrescribedParticle* a = of_particle[size_t(scene.mesh.edges[e].a)];
    const PrescribedParticle* b = of_particle[size_t(scene.mesh.edges[e].b)];
    if (a && b && moves_alike(a->motion, b->motion))
      prescribed.push_back(
          {scene.mesh.particles() + int(e), 0.5 * (a->start + b->start), a->motion});
  }
  return prescribed;
}

StickyPatch finer_patch(const TriangleMesh& mesh, const std::vector<Triangle>& quarters,
                        StickyPatch patch) {
  patch.particles = with_middles(mesh, patch.particles);
  if (patch.place) return patch;
  std::map<Triangle, std::ptrdiff_t> number_of;
  for (const Triangle& triangle : mesh.triangles)
    number_of.emplace(triangle, std::ptrdiff_t(number_of.size()));
  std::vector<Triangle> triangles;
  for (const Triangle& old : patch.triangles) {
    const std::ptrdiff_t t = number_of.at(old);
    triangles.insert(triangles.end(), quarters.begin() + 4 * t, quarters.begin() + 4 * t + 4);
  }
  patch.triangles = triangles;
  return patch;
}

}  // namespace

Scene with_half_steps(const Scene& scene) {
  Scene half = scene;
  StepRule& rule = half.schedule.step;
  rule.fixed = std::min(rule.fixed, scene.schedule.frame_interval) / 2;  // 0, automatic, stays 0
  rule.safety /= 2;
  rule.strain_per_step /= 2;
  return half;
}

Scene with_finer_mesh(const Scene& scene) {
  Scene finer = scene;
  refine_cloth(finer);
  finer.prescribed = prescribed_with_midpoints(scene);
  for (StickyPatch& patch : finer.sticky)
    patch = finer_patch(scene.mesh, finer.mesh.triangles, patch);
  if (scene.self_collision)
    finer.self_collision->thickness =
        std::min(finer.self_collision->thickness,
                 0.49 * smallest_height(finer.mesh.triangles, finer.mesh.rest));
  return finer;
}

}  // namespace foldproof
