#include "convergence/contact/contact_runs.h"

#include <algorithm>

#include "reference/mesh/shapes.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

SceneObject solid_object(const std::string& name, const Solid& solid, double friction) {
  SceneObject part;
  part.object.name = part.shape = name;
  part.object.friction = friction;
  part.object.body = RigidObject{solid, Pose{}, Motion{}};
  return part;
}

Scene level_sheet(int n, double side, const Vector3& middle) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::alternating, side, side, n, n}), 0.2);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 X = scene.mesh.rest.col(i);
    scene.x.col(i) = middle + Vector3(X.x() - side / 2, 0, side / 2 - X.y());
  }
  scene.gravity = Vector3(0, -9.80665, 0);
  scene.stretch = StretchMaterial{40, 0.05, 1};
  add_flat_hinges(scene, 1e-4, 3e-6);
  scene.solver.tolerance = 1e-8;
  return scene;
}

State run_to_end(const Subject& subject, const Scene& scene, double h, double end,
                 const std::function<void(const State&)>& watch) {
  Stepper stepper(subject, scene, scene.integrator);
  State s = stepper.start();
  watch(s);
  while (s.time < end - h / 2) {
    s = stepper.step(s, h);
    watch(s);
  }
  return s;
}

double usual_step(const Scene& scene) {
  return elastic_limit(build_system(scene), start_state(scene)) / 2;
}

double distance_at(const Scene& scene, const Vector3& p, double time) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const SceneObject& part : scene.objects) {
    const Span now{time, time, 0};
    nearest = std::min(nearest, std::visit([&](const auto& body) { return body.at(p, now).phi; },
                                           part.object.body));
  }
  return nearest;
}

Depths depths_of(const Scene& scene, const State& s) {
  Worst particles, edges, faces;
  const auto depth = [&](const Vector3& p) { return -distance_at(scene, p, s.time); };
  for (Eigen::Index i = 0; i < s.x.cols(); ++i) particles.observe(depth(s.x.col(i)));
  for (const Edge& edge : scene.mesh.edges)
    edges.observe(depth((s.x.col(edge.a) + s.x.col(edge.b)) / 2));
  for (const Triangle& t : scene.mesh.triangles)
    faces.observe(depth((s.x.col(t[0]) + s.x.col(t[1]) + s.x.col(t[2])) / 3));
  return {particles.value(), edges.value(), faces.value()};
}

}  // namespace foldproof
