// A mass-spring solver as an example: springs along the edges, velocity Verlet.
//
//   build/foldproof judge --solver build/toy_solver
#include <cmath>

#include "verification/subjects/adapters/foldproof_solver.h"

namespace {

using foldproof_solver::Mapping;
using foldproof_solver::Numbers;
using foldproof_solver::Scene;

struct ToySolver : foldproof_solver::Solver {
  std::vector<std::int32_t> edges, held;
  Numbers stiffness, lengths, mass;
  double gravity[3] = {0, 0, 0};  // m/s^2

  ToySolver() {
    declared.name = "toy springs (C++)";
    declared.version = "1.0";
    declared.level = "L2";
    declared.scheme = "velocity Verlet";
    declared.order = 2;
    declared.capabilities = {"set_state", "held", "masses"};
  }

  Mapping prepare(const Scene& scene) override {
    const foldproof_solver::Json& constants = scene.header["scene"];
    if (constants["material"]["bending_rigidity"] > 0) throw foldproof_solver::Declined("bending");
    edges = scene.integers.at("edges");
    held = scene.integers.at("held");
    stiffness = scene.numbers.at("edge_stiffness");
    lengths = scene.numbers.at("rest_lengths");
    mass = scene.numbers.at("mass");
    for (int k = 0; k < 3; ++k) gravity[k] = constants["gravity"][k];
    set_state(scene.numbers.at("x"), scene.numbers.at("v"), 0);
    return {{"stretch", "a spring per edge, of the edge's own stiffness [N/m]"},
            {"damping", "none"}};
  }

  /// The elongation [m] of edge e, and its unit direction.
  double elongation(std::size_t e, double (&direction)[3]) const {
    const double* const a = &x[3 * std::size_t(edges[2 * e])];
    const double* const b = &x[3 * std::size_t(edges[2 * e + 1])];
    for (int k = 0; k < 3; ++k) direction[k] = b[k] - a[k];
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    for (double& component : direction) component /= length;
    return length - lengths[e];
  }

  Numbers forces() override {
    Numbers f(x.size());
    for (std::size_t i = 0; i < f.size(); ++i) f[i] = mass[i / 3] * gravity[i % 3];
    for (std::size_t e = 0; e < lengths.size(); ++e) {
      double direction[3];
      const double pull = stiffness[e] * elongation(e, direction);
      for (std::size_t k = 0; k < 3; ++k) {
        f[3 * std::size_t(edges[2 * e]) + k] += pull * direction[k];
        f[3 * std::size_t(edges[2 * e + 1]) + k] -= pull * direction[k];
      }
    }
    return f;
  }

  Numbers damping() override { return Numbers(x.size(), 0.0); }

  double energy() override {
    double sum = 0;
    for (std::size_t e = 0; e < lengths.size(); ++e) {
      double direction[3];
      const double longer = elongation(e, direction);
      sum += stiffness[e] * longer * longer / 2;
    }
    for (std::size_t i = 0; i < x.size(); ++i) sum -= mass[i / 3] * gravity[i % 3] * x[i];
    return sum;
  }

  void kick(double dt) {
    const Numbers f = forces();
    for (std::size_t i = 0; i < v.size(); ++i) v[i] += dt * f[i] / mass[i / 3];
    for (const std::int32_t particle : held)
      for (std::size_t k = 0; k < 3; ++k) v[3 * std::size_t(particle) + k] = 0;
  }

  void advance(double dt, long steps) override {
    for (long step = 0; step < steps; ++step) {
      kick(dt / 2);
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += dt * v[i];
      kick(dt / 2);
      time += dt;
    }
  }
};

}  // namespace

int main() {
  ToySolver solver;
  return foldproof_solver::serve(solver);
}
