// Adapter of Bullet's deformable bodies with mass-spring forces; `scripts/engines bullet` builds
// it. Settings: implicit = 1 (Euler backward, one Newton iteration, the default) or 0 (symplectic);
// bending = stiffness of its springs two edges apart, in place of a declined rigidity [N/m].
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "verification/subjects/adapters/bullet/bullet_body.h"

using namespace foldproof_solver;

struct Deformable : BulletBody {
  std::unique_ptr<btDeformableBodySolver> deformable;
  std::unique_ptr<btDeformableMassSpringForce> springs;
  std::unique_ptr<btDeformableGravityForce> weight;

  Deformable() : BulletBody("Bullet deformable") {
    declared.capabilities.push_back("damping");
    declared.level = "L2", declared.scheme = "Euler, backward or symplectic", declared.order = 1;
    // its conjugate gradients end at a squared residual of one rounding
    declared.solve_tolerance = std::sqrt(SIMD_EPSILON);
  }
  ~Deformable() override { clear(); }  // the world before what it refers to

  Mapping prepare(const Scene& scene) override {
    const Json& material = scene.header["scene"]["material"];
    const double bending = setting(scene, "bending", 0);
    prepare_body(scene, bending > 0);
    if (bending > 0 && material["bending_rigidity"] > 0) add_long_springs(scene.numbers.at("rest"));
    const bool implicit = setting(scene, "implicit", 1) != 0;
    const Numbers& stiffness = scene.numbers.at("edge_stiffness");
    const double sum = std::accumulate(stiffness.begin(), stiffness.end(), 0.0);
    deformable = std::make_unique<btDeformableBodySolver>();
    auto solver = std::make_unique<btDeformableMultiBodyConstraintSolver>();
    solver->setDeformableSolver(deformable.get());
    auto made = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
        &dispatcher, broadphase.get(), solver.get(), &configuration, deformable.get());
    const double mean = sum / double(stiffness.size()), young = material["young"];
    const double damper = young > 0 ? mean * double(material["stretch_damping"]) / young : 0;
    springs = std::make_unique<btDeformableMassSpringForce>(mean, damper, true, bending);
    weight = std::make_unique<btDeformableGravityForce>(gravity);
    made->setGravity(gravity);
    made->setImplicit(implicit);
    made->setLineSearch(false);
    made->setUseProjection(true);  // without it, implicit cloth does not move
    made->addSoftBody(body);
    body->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
    body->m_cfg.kKHR = 1;  // of fixed obstacles, too, nodes are pushed out fully
    made->addForce(body, springs.get());
    made->addForce(body, weight.get());
    constraints = std::move(solver), world = std::move(made);
    place_obstacles(scene);
    return {{"stretch", "one stiffness [N/m] for all edges, the mean of the scene's"},
            {"bending", "springs two edges apart, if the setting says so"},
            {"damping", "one damper [N s/m] for all edges, along them"},
            {"step", implicit ? "backward Euler, one Newton iteration" : "symplectic Euler"}};
  }

  void add_long_springs(const Numbers& rest) {
    body->generateBendingConstraints(2);
    body->m_bUpdateRtCst = false;  // again
    for (int k = 0; k < body->m_links.size(); ++k) {
      btSoftBody::Link& link = body->m_links[k];
      if (!link.m_bbending) continue;
      const double *a = &rest[3 * size_t(link.m_n[0]->index)],
                   *b = &rest[3 * size_t(link.m_n[1]->index)];
      link.m_rl = (btVector3(a[0], a[1], a[2]) - btVector3(b[0], b[1], b[2])).length();
      link.m_c1 = link.m_rl * link.m_rl;
    }
  }

  Numbers summed(const std::function<void(btDeformableLagrangianForce::TVStack&)>& add) {
    btDeformableLagrangianForce::TVStack sum;
    sum.resize(body->m_nodes.size(), btVector3(0, 0, 0));
    add(sum);
    Numbers all;
    for (int i = 0; i < sum.size(); ++i) all.insert(all.end(), {sum[i][0], sum[i][1], sum[i][2]});
    return all;
  }
  Numbers forces() override {
    return summed(
        [this](auto& f) { springs->addScaledElasticForce(1, f), weight->addScaledForces(1, f); });
  }
  Numbers damping() override {
    return summed([this](auto& f) { springs->addScaledDampingForce(1, f); });
  }
  double energy() override {
    double potential = springs->totalElasticEnergy(1);
    for (int i = 0; i < body->m_nodes.size(); ++i)
      if (body->m_nodes[i].m_im > 0)
        potential -= gravity.dot(body->m_nodes[i].m_x) / body->m_nodes[i].m_im;
    return potential;
  }
};

int main() {
  Deformable solver;
  return serve(solver);
}
