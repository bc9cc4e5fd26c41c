// Friction of Bullet's position based cloth, without foldproof: how far a sheet slides on a slope.
//
//   g++ -std=c++17 -O2 -DBT_USE_DOUBLE_PRECISION -isystem /usr/include/bullet \
//     verification/subjects/adapters/bullet/repro/friction.cpp -o friction \
//     -lBulletSoftBody-float64 -lBulletDynamics-float64 -lBulletCollision-float64 \
//     -lLinearMath-float64 && ./friction
//
// Bullet 3.24 takes the share mu of a sliding particle's speed in each step, whatever presses it
// on. So the speed ends at (1 - mu)/mu times what gravity adds in a step, and the way of n steps is
// 2 (1 - mu)/(n mu) of that without friction, on every slope on which it slides at all:
//
//      mu   slope/mu        Coulomb          200 steps of 2 ms   2 (1 - mu)/(200 mu)
//     0.23  0.5             0                0
//     0.23  0.7, 1.3, 4.0   0, 0.23, 0.75    0.033               0.0335
//     0.61  0.5             0                0
//     0.61  0.7, 1.3, 4.0   0, 0.23, 0.75    0.0063, 0.0064      0.0064
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <cstdio>

constexpr double dt = 0.002, weight = 9.81;  // s, m/s^2
constexpr int side = 4;                      // particles along each side of the sheet
constexpr double cell = 0.1;                 // m

/// A sheet of springs that lies on the upper side of a box; gravity is tilted instead of the box.
struct Slide {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &constraints, &configuration};
  btBoxShape shape{btVector3(5, 5, 5)};
  btRigidBody box{0, nullptr, &shape};
  btSoftBodyWorldInfo info;
  btSoftBody body{&info, side* side, nullptr, nullptr};

  Slide(double slope, double friction, int iterations) {
    const double angle = std::atan(slope);
    const btVector3 gravity(weight * std::sin(angle), 0, -weight * std::cos(angle));
    info.m_broadphase = &broadphase, info.m_dispatcher = &dispatcher;
    info.m_gravity = gravity, info.air_density = 0, info.water_density = 0;
    info.m_maxDisplacement = 1e9;
    info.m_sparsesdf.Initialize();
    add_sheet(iterations);
    world.setGravity(gravity);
    world.addSoftBody(&body);
    shape.setMargin(0);
    box.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, -5)));
    box.setFriction(friction);
    world.addCollisionObject(&box);
  }

  ~Slide() {
    world.removeCollisionObject(&box);
    world.removeSoftBody(&body);
  }

  void add_sheet(int iterations) {
    for (int i = 0; i < side * side; ++i) {
      btSoftBody::Node& node = body.m_nodes[i];
      node.m_x = node.m_q = btVector3(cell * (i % side), cell * (i / side), 0);
      node.index = i;
      body.setMass(i, 1e-3);
    }
    body.appendMaterial()->m_kLST = 1;
    for (int a = 0; a < side * side; ++a) {
      const bool right = a % side + 1 < side, up = a / side + 1 < side;
      if (right) body.appendLink(a, a + 1);
      if (up) body.appendLink(a, a + side);
      if (!right || !up) continue;
      body.appendLink(a, a + side + 1);
      body.appendFace(a, a + 1, a + side + 1);
      body.appendFace(a, a + side + 1, a + side);
    }
    body.m_cfg.kDP = body.m_cfg.kDG = body.m_cfg.kLF = 0;
    body.m_cfg.kDF = 1;  // times the box's friction
    body.m_cfg.piterations = iterations;
    body.getCollisionShape()->setMargin(1e-4);
    body.m_sleepingThreshold = 0;
    body.setActivationState(DISABLE_DEACTIVATION);
    body.updateLinkConstants();
  }

  /// Mean way down after so many steps [m].
  double way(int steps) {
    for (int k = 0; k < steps; ++k) world.stepSimulation(dt, 0);
    double sum = 0;
    for (int i = 0; i < side * side; ++i) sum += body.m_nodes[i].m_x.x() - cell * (i % side);
    return sum / (side * side);
  }
};

/// Over the way without friction [1].
double share_of_way(double slope, double friction, int iterations, int steps) {
  const double time = steps * dt, acceleration = weight * std::sin(std::atan(slope));
  return Slide(slope, friction, iterations).way(steps) / (acceleration * time * time / 2);
}

int main() {
  std::printf("Bullet %d, position based: way down a slope over that without friction\n",
              btGetVersion());
  std::printf("%11s %5s %9s %9s %10s %10s\n", "iterations", "mu", "slope/mu", "Coulomb",
              "200 steps", "400 steps");
  for (const int iterations : {1, 10})
    for (const double mu : {0.23, 0.61})
      for (const double over : {0.5, 0.7, 0.9, 1.1, 1.3, 2.0, 4.0})
        std::printf("%11d %5.2f %9.1f %9.4f %10.4f %10.4f\n", iterations, mu, over,
                    std::fmax(0, 1 - 1 / over), share_of_way(over * mu, mu, iterations, 200),
                    share_of_way(over * mu, mu, iterations, 400));
}
