// A sheet as a soft body of Bullet, for both of its adapters.
#pragma once

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include <memory>

#include "verification/subjects/adapters/foldproof_solver.h"

namespace foldproof_solver {

struct BulletBody : Solver {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  std::unique_ptr<btDbvtBroadphase> broadphase;
  std::unique_ptr<btSequentialImpulseConstraintSolver> constraints;
  std::unique_ptr<btDiscreteDynamicsWorld> world;  // made by the adapter's prepare
  btSoftBodyWorldInfo info;
  btSoftBody* body = nullptr;
  btVector3 gravity;
  std::vector<std::unique_ptr<btCollisionShape>> shapes;  // of the obstacles
  std::vector<std::unique_ptr<btRigidBody>> obstacles;

  explicit BulletBody(const char* name) {
    const int version = btGetVersion();
    declared.name = name;
    declared.version = std::to_string(version / 100) + "." + std::to_string(version % 100);
    declared.capabilities = {"set_state", "held",    "masses",  "planes",
                             "boxes",     "spheres", "capsules"};
  }
  ~BulletBody() override { clear(); }

  void clear() {
    if (body) world->removeCollisionObject(body);
    for (const auto& obstacle : obstacles) world->removeCollisionObject(obstacle.get());
    obstacles.clear(), shapes.clear();
    delete body;
    body = nullptr;
    world.reset(), constraints.reset();
  }

  static double setting(const Scene& scene, const char* key, int otherwise) {
    return std::stod(scene.header["scene"]["settings"].value(key, std::to_string(otherwise)));
  }

  /// The body and what its world needs; springs, edges and masses are the scene's.
  void prepare_body(const Scene& scene, bool bends = false) {
    if (!bends && scene.header["scene"]["material"]["bending_rigidity"] > 0)
      throw Declined("a bending rigidity in N m: Bullet bends by springs two edges apart");
    clear();
    x = scene.numbers.at("x"), v = scene.numbers.at("v");
    gravity = vector(scene.header["scene"]["gravity"]);
    broadphase = std::make_unique<btDbvtBroadphase>();
    info.m_broadphase = broadphase.get(), info.m_dispatcher = &dispatcher;
    info.m_gravity = gravity, info.air_density = 0, info.water_density = 0;
    info.m_sparsesdf.Initialize();
    info.m_sparsesdf.setDefaultVoxelsz(0.02);  // m; with the default, 0.25, balls are polyhedra
    info.m_sparsesdf.Reset();
    info.m_maxDisplacement = 1e9;  // m; a step's velocity is cut to it over dt
    add_body(scene);
  }

  void add_body(const Scene& scene) {
    const auto &edges = scene.integers.at("edges"), &triangles = scene.integers.at("triangles");
    body = new btSoftBody(&info, int(x.size() / 3), nullptr, nullptr);
    for (int i = 0; i < body->m_nodes.size(); ++i) {
      body->m_nodes[i].index = i;
      body->setMass(i, scene.numbers.at("mass")[size_t(i)]);
    }
    for (const int i : scene.integers.at("held")) body->setMass(i, 0);
    body->appendMaterial()->m_kLST = 1;
    set_state(x, v, 0);
    for (size_t e = 0; e + 1 < edges.size(); e += 2) {
      body->appendLink(edges[e], edges[e + 1]);
      btSoftBody::Link& link = body->m_links[body->m_links.size() - 1];
      link.m_rl = scene.numbers.at("rest_lengths")[e / 2];
      link.m_c1 = link.m_rl * link.m_rl;
    }
    for (size_t t = 0; t + 2 < triangles.size(); t += 3)
      body->appendFace(triangles[t], triangles[t + 1], triangles[t + 2]);
    body->m_bUpdateRtCst = false;  // else the first step takes the start for the rest lengths
    body->m_cfg.kDP = body->m_cfg.kDG = body->m_cfg.kLF = 0;
    body->m_cfg.kDF = 1;  // times the obstacle's friction
    body->getCollisionShape()->setMargin(1e-4);
    body->m_sleepingThreshold = 0;
    body->setActivationState(DISABLE_DEACTIVATION);
  }

  static btVector3 vector(const Json& list) { return {list[0], list[1], list[2]}; }
  static btTransform at(const Json& p) { return btTransform(btQuaternion(0, 0, 0, 1), vector(p)); }

  void place_box(const btVector3& half_extents, const btTransform& pose, double friction) {
    auto box = std::make_unique<btBoxShape>(half_extents);
    box->setMargin(0);
    place(std::move(box), pose, friction);
  }

  void place(std::unique_ptr<btCollisionShape> shape, const btTransform& pose, double friction) {
    shapes.push_back(std::move(shape));
    obstacles.push_back(std::make_unique<btRigidBody>(0, nullptr, shapes.back().get()));
    obstacles.back()->setCenterOfMassTransform(pose);  // now, and in the prediction
    obstacles.back()->setFriction(friction);
    world->addCollisionObject(obstacles.back().get());
  }

  /// Soft bodies of Bullet meet convex shapes alone: a plane is the side of a box of `far`. The
  /// world must be made, and the body in it.
  void place_obstacles(const Scene& scene) {
    constexpr double far = 5;  // m
    const Json& constants = scene.header["scene"];
    for (const Json& plane : constants.value("planes", Json::array())) {
      const btVector3 normal = vector(plane["normal"]);
      const btTransform pose(shortestArcQuat(btVector3(0, 0, 1), normal),
                             vector(plane["point"]) - far * normal);
      place_box({far, far, far}, pose, plane["friction"]);
    }
    for (const Json& box : constants.value("boxes", Json::array()))
      place_box(vector(box["half_extents"]), at(box["centre"]), box["friction"]);
    for (const Json& s : constants.value("spheres", Json::array()))
      place(std::make_unique<btSphereShape>(s["radius"]), at(s["centre"]), s["friction"]);
    for (const Json& c : constants.value("capsules", Json::array())) {
      const btVector3 a = vector(c["a"]), axis = vector(c["b"]) - a;
      const btTransform pose(shortestArcQuat(btVector3(0, 1, 0), axis.normalized()), a + axis / 2);
      place(std::make_unique<btCapsuleShape>(c["radius"], axis.length()), pose, c["friction"]);
    }
  }

  void set_state(Numbers new_x, Numbers new_v, double new_time) override {
    Solver::set_state(std::move(new_x), std::move(new_v), new_time);
    for (int i = 0; i < body->m_nodes.size(); ++i) {
      btSoftBody::Node& node = body->m_nodes[i];
      const double *p = &x[3 * size_t(i)], *u = &v[3 * size_t(i)];
      node.m_x = node.m_q = {p[0], p[1], p[2]};
      node.m_v = node.m_vn = {u[0], u[1], u[2]};
      node.m_f = node.m_splitv = {0, 0, 0};
    }
  }

  void advance(double dt, long steps) override {
    for (long k = 0; k < steps; ++k) world->stepSimulation(dt, 0);
    for (int i = 0; i < body->m_nodes.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        x[3 * size_t(i) + size_t(c)] = body->m_nodes[i].m_x[c];
        v[3 * size_t(i) + size_t(c)] = body->m_nodes[i].m_v[c];
      }
  }
};

}  // namespace foldproof_solver
