// What the laws find in Bullet, without foldproof: each line is one observation.
//
//   g++ -std=c++17 -O2 -DBT_USE_DOUBLE_PRECISION -isystem /usr/include/bullet \
//     verification/subjects/adapters/bullet/repro/laws.cpp -o laws -lBulletSoftBody-float64 \
//     -lBulletDynamics-float64 -lBulletCollision-float64 -lLinearMath-float64 && ./laws
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
#include <utility>
#include <vector>

using Points = std::vector<btVector3>;

constexpr double dt = 0.002;
constexpr int side = 4;  // particles along each side of a sheet

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

Points move_position_based(Sheet& sheet, const btVector3& gravity, int steps) {
  btSequentialImpulseConstraintSolver constraints;
  btSoftRigidDynamicsWorld world(&dispatcher, &sheet.broadphase, &constraints, &configuration);
  world.setGravity(gravity);
  world.addSoftBody(sheet.body);
  for (int k = 0; k < steps; ++k) world.stepSimulation(dt, 0);
  const Points end = sheet.positions();
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

int main() {
  std::printf("Bullet %d\n", btGetVersion());
  numbering();
  speed_of_a_fall();
  drift();
  explicit_steps();
}
