#include "verification/specimens/sticking_scenes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <numeric>

#include "reference/mesh/shapes.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/random.h"
#include "verification/specimens/ugly_solids.h"

namespace foldproof {

namespace {

constexpr int cells = 2;

void give_trial_values(StickyPatch& patch) {
  patch.name = "trial";
  patch.stiffness = 37;
  patch.forecast_time = 0.019;
  patch.near = 0.021;
  patch.far = 0.053;
}

/// Sticks the particle to triangles of the patch at random places; their corners are at y (3 x
/// ...). Displaces it from the mean of these places by `part` of `far`.
void stick(StuckSpecimen& specimen, int particle, const std::vector<int>& triangles,
           const PerParticle3& y, double part, Random& random) {
  const StickyPatch& patch = specimen.patch();
  oracles::StuckParticle stuck{Vector3::Zero(), {}, {}, patch.stiffness, patch.far};
  std::vector<int> particles = {particle};
  for (const int t : triangles) {
    const auto [a, b, c] = patch.triangles[size_t(t)];
    const Vector3 place(random.uniform(-0.1, 0.7), random.uniform(-0.1, 0.6),
                        random.uniform(-0.02, 0.03));
    stuck.corners.push_back({y.col(a), y.col(b), y.col(c)});
    stuck.places.push_back(place);
    if (!patch.place) particles.insert(particles.end(), {a, b, c});
    specimen.state.bonds.push_back({0, t, particle, place});
  }
  const Vector3 away = random.vectors(1, 1).col(0).normalized();
  stuck.x = oracles::sticking_answer(stuck).target + part * patch.far * away;
  specimen.state.x.col(particle) = stuck.x;
  specimen.stuck.push_back(stuck);
  specimen.particles.push_back(particles);
}

}  // namespace

TriangleMesh two_sheets(int n, double side, double gap) {
  const TriangleSoup one =
      soup_of(make_sheet({SheetPattern::jittered, side, side, n, n, 0.23, 29}));
  const TriangleSoup both = join(one, one, {0, 0, gap});
  return make_triangle_mesh(both.rest, both.triangles);
}

std::vector<StuckSpecimen> stuck_layers() {
  std::vector<StuckSpecimen> all;
  Random random(83);
  for (const double part : {0.07, 0.44, 0.83, 0.99})
    for (const size_t each : {size_t(1), size_t(2)}) {
      StuckSpecimen specimen;
      specimen.name = fmt::format("{} of far, {} triangles", part, each);
      specimen.scene = scene_at_rest(two_sheets(cells, 0.17, 0.013), 0.23);
      const Eigen::Index n = specimen.scene.x.cols() / 2;
      StickyPatch patch = layer_patch(specimen.scene.mesh);
      give_trial_values(patch);
      specimen.scene.sticky = {patch};
      specimen.state = {0.37, specimen.scene.x + random.vectors(2 * n, 0.011),
                        random.vectors(2 * n, 1.3)};
      for (int i = int(n); i < 2 * int(n); ++i) {
        std::vector<int> to = {i % int(patch.triangles.size())};
        if (each == 2) to.push_back(to[0] == 5 ? 7 : 5);
        std::ranges::sort(to);
        stick(specimen, i, to, specimen.state.x, part, random);
      }
      all.push_back(std::move(specimen));
    }
  return all;
}

StuckSpecimen stuck_to_turning_surface() {
  StuckSpecimen specimen;
  specimen.name = "a surface that turns and drifts";
  specimen.scene =
      scene_at_rest(make_sheet({SheetPattern::jittered, 0.2, 0.2, cells, cells, 0.2, 3}), 0.31);
  StickyPatch patch;
  give_trial_values(patch);
  patch.triangles = specimen.scene.mesh.triangles;
  patch.particles.resize(size_t(specimen.scene.x.cols()));
  std::iota(patch.particles.begin(), patch.particles.end(), 0);
  const PerParticle3 X = specimen.scene.mesh.rest;
  const Vector3 spin(0.7, -1.9, 1.1), drift(0.4, 0.2, -0.9);
  patch.place = [=](double t) {
    PerParticle3 x(3, X.cols());
    for (Eigen::Index i = 0; i < X.cols(); ++i) x.col(i) = rotate(X.col(i), t * spin) + t * drift;
    return x;
  };
  patch.velocity = [=](double t) {
    PerParticle3 v(3, X.cols());
    for (Eigen::Index i = 0; i < X.cols(); ++i)
      v.col(i) = spin.cross(rotate(X.col(i), t * spin)) + drift;
    return v;
  };
  specimen.scene.sticky = {patch};
  Random random(89);
  specimen.state = {0.41, specimen.scene.x, random.vectors(X.cols(), 1.1)};
  const PerParticle3 y = patch.place(specimen.state.time);
  for (int i = 0; i < int(X.cols()); ++i)
    stick(specimen, i, {i % 3, 5}, y, 0.09 * i + 0.05, random);
  return specimen;
}

PerParticle3 expected_elastic(const StuckSpecimen& specimen) {
  PerParticle3 force = PerParticle3::Zero(3, specimen.state.x.cols());
  for (size_t k = 0; k < specimen.stuck.size(); ++k) {
    const oracles::StickingAnswer answer = oracles::sticking_answer(specimen.stuck[k]);
    for (size_t j = 0; j < specimen.particles[k].size(); ++j)
      force.col(specimen.particles[k][j]) += answer.force.segment<3>(Eigen::Index(3 * j));
  }
  return force;
}

double expected_energy(const StuckSpecimen& specimen) {
  double sum = 0;
  for (const oracles::StuckParticle& stuck : specimen.stuck)
    sum += oracles::sticking_answer(stuck).energy;
  return sum;
}

Eigen::MatrixXd expected_damping(const StuckSpecimen& specimen) {
  const Eigen::Index n = specimen.state.x.size();
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
  for (size_t k = 0; k < specimen.stuck.size(); ++k) {
    const oracles::StickingAnswer answer = oracles::sticking_answer(specimen.stuck[k]);
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(3, n);
    const std::vector<int>& particles = specimen.particles[k];
    G.block<3, 3>(0, 3 * particles[0]) = -Eigen::Matrix3d::Identity();
    for (size_t j = 1; j < particles.size(); ++j)
      G.block<3, 3>(0, 3 * particles[j]) +=
          answer.derivative.block<3, 3>(0, Eigen::Index(3 * (j - 1)));
    D -= answer.stiffness * specimen.patch().forecast_time * G.transpose() * G;
  }
  return D;
}

StickyPatch layer_patch(const TriangleMesh& mesh) {
  StickyPatch patch;
  patch.name = "layer";
  patch.triangles.assign(mesh.triangles.begin(),
                         mesh.triangles.begin() + std::ptrdiff_t(mesh.triangles.size() / 2));
  patch.particles.resize(size_t(mesh.particles() / 2));
  std::iota(patch.particles.begin(), patch.particles.end(), mesh.particles() / 2);
  return patch;
}

StickyPatch swinging_palm(const Scene& scene) {
  Motion swing;
  swing.amplitude = {0.05, 0.02, 0.1};
  swing.frequency = 3.1;
  StickyPatch hand = palm(scene, 0.8, swing);
  hand.stiffness = 40;
  hand.forecast_time = 0.011;
  hand.near = 0.02;
  hand.far = 0.031;
  return hand;
}

StickyPatch palm(const Scene& scene, double side, const RigidMotion& motion) {
  SceneObject part;
  part.object.body = RigidObject{{}, {}, motion};
  part.vertices.resize(3, 4);
  part.vertices << -1, 1, 1, -1, -1, -1, 1, 1, 0, 0, 0, 0;
  part.vertices *= side / 2;
  part.triangles = {{0, 1, 2}, {0, 2, 3}};
  StickyPatch patch;
  patch.name = "palm";
  patch.triangles = part.triangles;
  patch.place = [part](double t) { return surface_at(part, t); };
  patch.velocity = [part](double t) { return surface_velocity_at(part, t); };
  patch.particles.resize(size_t(scene.x.cols()));
  std::iota(patch.particles.begin(), patch.particles.end(), 0);
  return patch;
}

}  // namespace foldproof
