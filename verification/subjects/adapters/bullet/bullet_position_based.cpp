// Adapter of Bullet's older, position based cloth; `scripts/engines bullet` builds it.
// Setting: iterations = of the constraints, each step.
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include "verification/subjects/adapters/bullet/bullet_body.h"

using namespace foldproof_solver;

struct PositionBased : BulletBody {
  PositionBased() : BulletBody("Bullet soft body") {
    declared.scheme = "position based";
    declared.tunables["iterations"] = {
        {"kind", "iterations"}, {"range", {1, 10000}}, {"value", 10}, {"proportional", true}};
  }

  Mapping prepare(const Scene& scene) override {
    prepare_body(scene);
    constraints = std::make_unique<btSequentialImpulseConstraintSolver>();
    auto made = std::make_unique<btSoftRigidDynamicsWorld>(&dispatcher, broadphase.get(),
                                                           constraints.get(), &configuration);
    made->setGravity(gravity);
    body->m_cfg.piterations = (int)setting(scene, "iterations", (int)tuned(scene, "iterations"));
    body->updateLinkConstants();
    made->addSoftBody(body);
    world = std::move(made);
    place_obstacles(scene);
    return {{"stretch", "kLST = 1: as stiff as the iterations make it; Young's modulus is ignored"},
            {"damping", "none but that of the method"}};
  }
};

int main() {
  PositionBased solver;
  return serve(solver);
}
