// What the laws find in Bullet, without foldproof: each line is one observation. With the word
// `friction`, how far a position based sheet slides on a slope.
//
//   g++ -std=c++17 -O2 -DBT_USE_DOUBLE_PRECISION -isystem /usr/include/bullet \
//     verification/subjects/adapters/bullet/reproductions/laws.cpp -o laws \
//     -lBulletSoftBody-float64 -lBulletDynamics-float64 -lBulletCollision-float64 \
//     -lLinearMath-float64
//   ./laws && ./laws friction
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>
#include <vector>

using Points = std::vector<btVector3>;

constexpr double dt = 0.002, weight = 9.81;  // s, m/s^2
constexpr int side = 4;                      // particles along each side of a sheet

btSoftBodyRigidBodyCollisionConfiguration configuration;
btCollisionDispatcher dispatcher(&configuration);

/// A square sheet of springs, in one of two orders of its particles; where it is stretched, it
/// is uneven, too.
struct Sheet {
  btDbvtBroadphase broadphase;
  btSoftBodyWorldInfo info;
  btSoftBody* body = nullptr;
  std::vector<int> number;  // of each particle

  Sheet(bool reversed, double stretch, const btVector3& gravity, const btVector3& v) {
    info.m_broadphase = &broadphase, info.m_dispatcher = &dispatcher;
    info.m_gravity = gravity, info.air_density = 0, info.water_density = 0;
    info.m_maxDisplacement = 1e9;
    const int n = side * side;
    for (int i = 0; i < n; ++i) number.push_back(reversed ? n - 1 - i : i);
    body = new btSoftBody(&info, n, nullptr, nullptr);
    for (int i = 0; i < n; ++i) {
      btSoftBody::Node& node = body->m_nodes[number[i]];
      const double height = stretch > 1 ? 0.02 * std::sin(2.0 * i) : 0;  // m
      node.m_x = btVector3(0.1 * stretch * (i % side), 0.1 * stretch * (i / side), height);
      node.m_q = node.m_x;
      node.m_v = node.m_vn = v;
      node.index = number[i];
      body->setMass(number[i], 1e-3);
    }
    body->appendMaterial()->m_kLST = 1;
    add_links(reversed);
    for (int j = 0; j + 1 < side; ++j)
      for (int i = 0; i + 1 < side; ++i) {
        const int a = j * side + i;
        body->appendFace(number[a], number[a + 1], number[a + side + 1]);
        body->appendFace(number[a], number[a + side + 1], number[a + side]);
      }
    body->m_cfg.kDP = body->m_cfg.kDF = body->m_cfg.kDG = body->m_cfg.kLF = 0;
    body->m_cfg.piterations = 10;
    body->m_sleepingThreshold = 0;
    body->setActivationState(DISABLE_DEACTIVATION);
    body->m_bUpdateRtCst = false;  // else the first step takes the start for the rest shape
    body->updateLinkConstants();
  }

  void add_links(bool reversed) {
    std::vector<std::pair<int, int>> pairs;
    for (int a = 0; a < side * side; ++a) {
      if (a % side + 1 < side) pairs.push_back({a, a + 1});
      if (a / side + 1 < side) pairs.push_back({a, a + side});
      if (a % side + 1 < side && a / side + 1 < side) pairs.push_back({a, a + side + 1});
    }
    if (reversed) pairs = {pairs.rbegin(), pairs.rend()};
    for (const auto& [a, b] : pairs) {
      body->appendLink(number[a], number[b]);
      btSoftBody::Link& link = body->m_links[body->m_links.size() - 1];
      link.m_rl = (b - a == side + 1 ? std::sqrt(2.0) : 1.0) * 0.1;
      link.m_c1 = link.m_rl * link.m_rl;
    }
  }

  /// By the particles' own order.
  Points positions() const {
    Points all;
    for (const int i : number) all.push_back(body->m_nodes[i].m_x);
    return all;
  }
};

double largest_difference(const Points& a, const Points& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).length());
  return largest;
}

/// obstacle: may be none
Points move_position_based(Sheet& sheet, const btVector3& gravity, int steps,
                           btRigidBody* obstacle = nullptr) {
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world(&dispatcher, &sheet.broadphase, &constraints, &configuration);
  world.setGravity(gravity);
  world.addSoftBody(sheet.body);
  if (obstacle) world.addCollisionObject(obstacle);
  for (int k = 0; k < steps; ++k) world.stepSimulation(dt, 0);
  const Points end = sheet.positions();
  if (obstacle) world.removeCollisionObject(obstacle);
  world.removeSoftBody(sheet.body);
  return end;
}

void numbering() {
  const btVector3 none(0, 0, 0);
  Sheet first(false, 1.05, none, none), second(true, 1.05, none, none);
  const double apart = largest_difference(move_position_based(first, none, 20),
                                          move_position_based(second, none, 20));
  std::printf("position based, other numbers: positions differ by %.3g m after 20 steps\n", apart);
}

void speed_of_a_fall() {
  const btVector3 gravity(0, 0, -9.81);
  Sheet sheet(false, 1, gravity, btVector3(0, 0, 0));
  move_position_based(sheet, gravity, 50);
  double mean = 0;
  for (const int i : sheet.number) mean += sheet.body->m_nodes[i].m_v.z() / sheet.number.size();
  std::printf("position based, falling sheet: speed differs from g t by %.3g g t\n",
              std::abs(mean / (-9.81 * 50 * dt) - 1));
}

void drift() {
  const btVector3 none(0, 0, 0), v(0.31, -0.23, 0.47);
  Sheet sheet(false, 1, none, v);
  move_position_based(sheet, none, 20);
  double worst = 0;
  for (const int i : sheet.number)
    worst = std::max(worst, double((sheet.body->m_nodes[i].m_v - v).length()));
  std::printf("position based, drifting sheet: velocity changes by %.3g of it\n",
              worst / v.length());
}

/// A step from a state, and the same again after others.
void explicit_steps() {
  const btVector3 none(0, 0, 0);
  Sheet sheet(false, 1.05, none, none);
  btDeformableBodySolver deformable;
  btDeformableMultiBodyConstraintSolver constraints;
  constraints.setDeformableSolver(&deformable);
  btDeformableMultiBodyDynamicsWorld world(&dispatcher, &sheet.broadphase, &constraints,
                                           &configuration, &deformable);
  btDeformableMassSpringForce springs(5, 0);
  world.setGravity(none);
  world.setImplicit(false);
  world.setLineSearch(false);
  world.setUseProjection(true);
  world.addSoftBody(sheet.body);
  world.addForce(sheet.body, &springs);
  const Points start = sheet.positions();
  std::vector<Points> ends;
  for (int round = 0; round < 2; ++round) {
    for (size_t i = 0; i < start.size(); ++i) {
      btSoftBody::Node& node = sheet.body->m_nodes[sheet.number[i]];
      node.m_x = node.m_q = start[i];
      node.m_v = node.m_vn = node.m_f = node.m_splitv = none;
    }
    world.stepSimulation(dt, 0);
    ends.push_back(sheet.positions());
    for (int k = 0; k < 20; ++k) world.stepSimulation(dt, 0);
  }
  std::printf("deformable, explicit, same state twice: positions differ by %.3g m\n",
              largest_difference(ends[0], ends[1]));
  world.removeSoftBody(sheet.body);
}

// Bullet 3.24 takes the share mu of a sliding particle's speed in each step, whatever presses it
// on. So the speed ends at (1 - mu)/mu times what gravity adds in a step, and the way of n steps is
// 2 (1 - mu)/(n mu) of that without friction, on every slope on which it slides at all:
//
//      mu   slope/mu        Coulomb          200 steps of 2 ms   2 (1 - mu)/(200 mu)
//     0.23  0.5             0                0
//     0.23  0.7, 1.3, 4.0   0, 0.23, 0.75    0.033               0.0335
//     0.61  0.5             0                0
//     0.61  0.7, 1.3, 4.0   0, 0.23, 0.75    0.0063, 0.0064      0.0064

/// On the upper side of a box; gravity is tilted instead of it. Mean way down over the way without
/// friction [1].
double share_of_way(double slope, double friction, int iterations, int steps) {
  const double angle = std::atan(slope), time = steps * dt;
  const btVector3 gravity(weight * std::sin(angle), 0, -weight * std::cos(angle));
  Sheet sheet(false, 1, gravity, btVector3(0, 0, 0));
  sheet.info.m_sparsesdf.Initialize();
  sheet.body->m_cfg.kDF = 1;  // times the box's friction
  sheet.body->m_cfg.piterations = iterations;
  sheet.body->getCollisionShape()->setMargin(1e-4);
  btBoxShape shape(btVector3(5, 5, 5));
  shape.setMargin(0);
  btRigidBody box(0, nullptr, &shape);
  box.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, -5)));
  box.setFriction(friction);
  const Points start = sheet.positions(), end = move_position_based(sheet, gravity, steps, &box);
  double sum = 0;
  for (size_t i = 0; i < end.size(); ++i) sum += end[i].x() - start[i].x();
  return sum / double(end.size()) / (weight * std::sin(angle) * time * time / 2);
}

void friction() {
  std::printf("%11s %5s %9s %9s %10s %10s\n", "iterations", "mu", "slope/mu", "Coulomb",
              "200 steps", "400 steps");
  for (const int iterations : {1, 10})
    for (const double mu : {0.23, 0.61})
      for (const double over : {0.5, 0.7, 0.9, 1.1, 1.3, 2.0, 4.0})
        std::printf("%11d %5.2f %9.1f %9.4f %10.4f %10.4f\n", iterations, mu, over,
                    std::fmax(0, 1 - 1 / over), share_of_way(over * mu, mu, iterations, 200),
                    share_of_way(over * mu, mu, iterations, 400));
}

int main(int count, char** words) {
  if (count == 2 && std::string_view(words[1]) == "friction") {
    std::printf("Bullet %d, position based: way down a slope over that without friction\n",
                btGetVersion());
    friction();
    return 0;
  }
  std::printf("Bullet %d\n", btGetVersion());
  numbering();
  speed_of_a_fall();
  drift();
  explicit_steps();
}
