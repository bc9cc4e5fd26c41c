#include "verification/specimens/layered_cloth.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "reference/mesh/shapes.h"
#include "verification/specimens/random.h"
#include "verification/specimens/ugly_solids.h"

namespace foldproof {

Scene layered_scene(const LayeredSheets& wanted) {
  Random random(wanted.seed);
  const TriangleMesh one = make_sheet({SheetPattern::jittered, 0.1, 0.12, 5, 6, 0.2});
  TriangleSoup stack{PerParticle3(3, 0), {}, {}};
  for (int k = 0; k < wanted.sheets; ++k)
    stack = join(stack, soup_of(one), Vector3(0.003 * k, -0.002 * k, wanted.gap * k));
  Scene scene = scene_at_rest(make_triangle_mesh(stack.rest, stack.triangles), 0.17);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.x(2, i) += random.uniform(-wanted.height, wanted.height);
  scene.v = random.vectors(scene.x.cols(), wanted.speed);
  scene.self_collision = wanted.settings;
  return scene;
}

PerParticle3 corrected_by_self_collision(const Subject& subject, const Scene& scene,
                                         const StepRequest& request) {
  const auto prepared = require_offered(subject.prepare, "prepare")(scene);
  const State s = start_state(scene);
  const Span span{0, request.moves ? request.step : 0, request.step};
  return require_offered(subject.avoid_itself, "avoid_itself")(*prepared, span, s, s.v);
}

std::vector<FeaturePair> all_pairs(const TriangleMesh& mesh) {
  std::vector<FeaturePair> all;
  for (int i = 0; i < mesh.particles(); ++i)
    for (const Triangle& t : mesh.triangles)
      if (std::find(t.begin(), t.end(), i) == t.end())
        all.push_back({PairKind::vertex_triangle, {i, t[0], t[1], t[2]}});
  for (size_t e = 0; e < mesh.edges.size(); ++e)
    for (size_t f = e + 1; f < mesh.edges.size(); ++f) {
      const Edge &a = mesh.edges[e], &b = mesh.edges[f];
      if (a.a != b.a && a.a != b.b && a.b != b.a && a.b != b.b)
        all.push_back({PairKind::edge_edge, {a.a, a.b, b.a, b.b}});
    }
  return all;
}

Vector3 linear_momentum_of(const PerParticle& mass, const PerParticle3& v) { return v * mass; }

Vector3 angular_momentum_of(const PerParticle& mass, const PerParticle3& x, const PerParticle3& v) {
  const Vector3 middle = x.rowwise().mean();
  Vector3 sum = Vector3::Zero();
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    sum += mass[i] * Vector3(x.col(i) - middle).cross(Vector3(v.col(i)));
  return sum;
}

double kinetic_energy_of(const PerParticle& mass, const PerParticle3& v) {
  return 0.5 * v.colwise().squaredNorm().dot(mass.transpose());
}

}  // namespace foldproof
