#include "verification/subjects/suite/protocol_2/carriers.h"

namespace foldproof::suite {

namespace {

constexpr double large = 20;  // m; of a ball, so that its top is a plane

PortableBody block(double mu) {
  PortableBody body{PerParticle3(3, 8), {}, mu};
  for (int k = 0; k < 8; ++k)
    body.vertices.col(k) << (k & 1 ? 3 : -3), (k & 2 ? 3 : -3), (k & 4 ? 0 : -1);
  body.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return body;
}

/// Ten intervals, in which a turn is nearly straight.
std::vector<double> multiples_of_interval(const PortableMotion& motion) {
  std::vector<double> times;
  for (int k = 0; k <= 10; ++k) times.push_back(motion.keys.back().time * k / 10);
  return times;
}

}  // namespace

const std::array<Carrier, 6>& carriers() {
  static const std::array<Carrier, 6> all{{
      {"planes",
       [](PortableScene& s, double mu, const PortableMotion& motion) {
         s.planes = {{Vector3::Zero(), Vector3::UnitZ(), mu, motion}};
       }},
      {"boxes",
       [](PortableScene& s, double mu, const PortableMotion& motion) {
         s.boxes = {{{0, 0, -0.5}, {3, 3, 0.5}, mu, motion}};
       }},
      {"spheres",
       [](PortableScene& s, double mu, const PortableMotion& motion) {
         s.spheres = {{{0, 0, -large}, large, mu, motion}};
       }},
      {"capsules",
       [](PortableScene& s, double mu, const PortableMotion& motion) {
         s.capsules = {{{-3, 0, -large}, {3, 0, -large}, large, mu, motion}};
       }},
      {"bodies",
       [](PortableScene& s, double mu, const PortableMotion& motion) {
         s.bodies = {block(mu)};
         s.bodies[0].motion = motion;
       }},
      {"deforming_bodies",
       [](PortableScene& s, double mu, const PortableMotion& motion) {
         PortableBody body = block(mu);
         for (const double time : multiples_of_interval(motion)) {
           PerParticle3 x = body.vertices;
           for (Eigen::Index i = 0; i < x.cols(); ++i)
             x.col(i) = to_world(pose_at(motion, time), x.col(i));
           body.times.push_back(time), body.frames.push_back(x);
         }
         s.bodies = {body};
       }},
  }};
  return all;
}

PortableScene sheet_on_top(const char* name) {
  PortableScene scene = small_sheet();
  scene.name = name;
  scene.x.colwise() -= middle_of(scene.x);
  scene.mesh.rest = scene.x;
  scene.gravity = Vector3(0, 0, -weight);
  return scene;
}

PortableMotion straight(const Vector3& velocity, double end) {
  return {{{0, {}}, {end, {Eigen::Quaterniond::Identity(), end * velocity}}}};
}

PortableMotion Carrier::standing() const {
  if (capability != std::string("deforming_bodies")) return {};
  return straight(Vector3::Zero(), 1);
}

}  // namespace foldproof::suite
