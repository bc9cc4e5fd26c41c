// Newton's method of the implicit methods: steps, halvings, fallbacks and what they
// count. Where only counts show what happens, a false derivative makes each step too long
// or too short by a known factor.
#include <catch2/catch.hpp>

#include "reference/dynamics/implicit.h"
#include "reference/forces/degenerate.h"

using namespace foldproof;

namespace {

constexpr double h = 0.5, mass = 0.25, k = 7;  // M + h^2 k = 2 kg

/// A particle on a spring of three equal rates from `rest`. All numbers are exact in binary.
struct Oscillator {
  // of a Newton step over that to the solution; the derivative says (M + h^2 k)/length
  double length = 1;
  double sideways = 0;         // force across the displacement, over h^2 k + M
  double farthest = 1e300;     // from the start: beyond it the force is degenerate [m]
  Vector3 uneven = {0, 0, 0};  // increase of M + h^2 k along each axis, over itself
  Vector3 rest = Vector3(3, 4, 12) / 16;
  System system = make_system((PerParticle(1) << mass).finished());
  State start{0.75, PerParticle3::Zero(3, 1), PerParticle3::Zero(3, 1)};
  std::vector<Force> more = {};

  State step(double tolerance, Work& work) {
    system.solver.tolerance = tolerance;
    CustomForce force;
    force.elastic = [this](const State& s, PerParticle3& f) {
      if (s.x.norm() > farthest) throw DegenerateElement("too far", {0});
      const Vector3 d = rest - s.x.col(0);
      f.col(0) += k * d + sideways * 2 / (h * h) * Vector3(4, -3, 0).normalized().cross(d) -
                  2 / (h * h) * uneven.cwiseProduct(s.x.col(0));
    };
    force.differential = [this](const State&, const PerParticle3& dx, PerParticle3& df) {
      df -= (2 / length - mass) / (h * h) * dx + 2 / (h * h) * uneven.asDiagonal() * dx;
    };
    system.forces.assign(1, std::move(force));
    system.forces.insert(system.forces.end(), more.begin(), more.end());
    return backward_euler(system, {&start, 1}, h, work);
  }
  Work work_of(double tolerance) {
    Work work;
    step(tolerance, work);
    return work;
  }
  /// The solution from rest at the origin: h k rest/(M + h^2 k).
  Vector3 solution() const { return h * k / 2 * rest; }
};

}  // namespace

TEST_CASE("steps that overshoot are halved, and the iteration ends at the tolerance") {
  Oscillator of{.length = 3};  // halved to 1.5: each step leaves -1/2 of the residual
  for (const auto& [tolerance, iterations] : {std::pair{0.25, 2}, {0.2499, 3}, {0.3, 2}}) {
    Work work;
    const State end = of.step(tolerance, work);
    const double left = std::pow(-0.5, iterations);
    CHECK((end.v.col(0) - (1 - left) * of.solution()).norm() < 1e-14);
    CHECK(work.newton_iterations == iterations);
    CHECK(work.elastic_evaluations == 1 + 2 * iterations);
    CHECK(work.worst_residual == Approx(std::abs(left)).epsilon(1e-12));
    CHECK(work.unfinished_solves == 0);
  }
}

TEST_CASE("a step is taken if the residual falls by a ten-thousandth of the part taken") {
  const auto tried = [](double length) {
    return Oscillator{.length = length}.work_of(0.99995).elastic_evaluations - 1;
  };
  CHECK(tried(1.99989) == 1);
  CHECK(tried(1.99991) == 2);
  CHECK(tried(2 * (2 - 0.52e-4)) == 2);  // of half a step half as much
  CHECK(tried(2 * (2 - 0.48e-4)) == 3);
}

TEST_CASE("a step is also taken if it leads downhill, though the residual rises") {
  // steps of length b leave 1 - b of the residual's part along the step, and more across it
  for (const auto& [length, trials] :
       {std::pair{1.5, 1}, {1.99989, 1}, {1.99991, 2}, {2.5, 2}, {3.9, 2}, {4.1, 3}}) {
    Oscillator of{.length = length, .sideways = 8};
    of.rest = Vector3(0.3, 0.4, 1.2);  // across the axis of the sideways force
    INFO(length);
    // sixty iterations from the start, as many from the linearised step
    CHECK(of.work_of(1e-6).elastic_evaluations == 1 + 60 * trials + 2 + 60 * trials);
  }
}

TEST_CASE("twelve lengths of a step are tried, then Newton's method starts again, once") {
  // the twelfth part is of 4000/2048
  const Work found = Oscillator{.length = 4000}.work_of(0.96);
  CHECK(found.newton_iterations == 1);
  CHECK(found.elastic_evaluations == 13);
  CHECK(found.unfinished_solves == 0);

  Oscillator far{.length = 4200};
  far.start.v.col(0) = Vector3(0.5, -0.25, 0.125);
  Work lost;
  CHECK(far.step(0.125, lost).v == far.start.v);
  CHECK(lost.newton_iterations == 2);
  CHECK(lost.elastic_evaluations == 1 + 12 + 2 + 12);
  CHECK(lost.unfinished_solves == 1);
  // the residual h F over itself and the momentum, in the mass-weighted norm
  const Vector3 residual = h * k * (far.rest - h * far.start.v.col(0));
  const double norm = residual.norm() / std::sqrt(mass),
               momentum = std::sqrt(mass) * far.start.v.norm();
  CHECK(lost.worst_residual == Approx(norm / (norm + momentum)).epsilon(1e-13));
  const Work exact = far.work_of(0);
  CHECK(exact.worst_residual == Approx(norm).epsilon(1e-13));
  CHECK(exact.unfinished_solves == 1);
}

TEST_CASE("Newton's method ends after sixty iterations, and after sixty more from another start") {
  Oscillator of{.length = 0.01};
  Work work;
  const State end = of.step(1e-3, work);
  const double left = std::pow(0.99, 61);
  CHECK((end.v.col(0) - (1 - left) * of.solution()).norm() < 1e-12);
  CHECK(work.newton_iterations == 120);
  CHECK(work.unfinished_solves == 1);
  CHECK(work.worst_residual == Approx(left).epsilon(1e-12));
  CHECK(work.solves == 121);
  CHECK(work.elastic_evaluations == 123);
}

TEST_CASE(
    "the other start of Newton's method solves the equation linearised about the step's start") {
  Oscillator of{.length = 0.01};
  Work work = of.work_of(1e-3);  // gives it its force
  // BDF2 after a step as long: s = 2/3 of the step, X and V a third beyond
  State before = of.start, now = of.start;
  before.time -= 0.75;
  before.v.col(0) = Vector3(0.3, -0.2, 0.4);
  now.x.col(0) = Vector3(0.1, 0.2, -0.3);
  now.v.col(0) = Vector3(-0.4, 0.9, -1.7);
  const State end = bdf2(of.system, std::vector{before, now}, 0.75, work);
  const Vector3 x = now.x, v = now.v, X = 4 * x / 3, V = (4 * v - Vector3(before.v)) / 3;
  const Vector3 exact = (mass * V + h * k * (of.rest - X)) / 2;
  const double rate = (2 / of.length - mass) / (h * h);  // of the false derivative
  const Vector3 linear = (mass * V + h * k * (of.rest - x) - h * rate * (X - x)) / 200;
  REQUIRE((linear - exact).norm() < 0.95 * (v - exact).norm());
  CHECK((Vector3(end.v) - exact - std::pow(0.99, 60) * (linear - exact)).norm() < 1e-11);
}

TEST_CASE("steps into degenerate places are halved, and no start is taken there") {
  Oscillator of{.length = 1.5};
  of.farthest = 1.01 * h * of.solution().norm();  // the full step leads half as far again
  const Work work = of.work_of(0.3);
  CHECK(work.newton_iterations == 1);
  CHECK(work.worst_residual == Approx(0.25));
  CHECK(work.unfinished_solves == 0);

  of.farthest = 1e-9;
  Work lost;
  CHECK(of.step(0.3, lost).v.norm() == 0);
  CHECK(lost.newton_iterations == 1);
  CHECK(lost.unfinished_solves == 1);
  CHECK(lost.worst_residual == Approx(1));
}

TEST_CASE("a derivative that is indefinite, even made semidefinite, gives no step") {
  Oscillator of{.length = -1};
  Work work;
  CHECK(of.step(0.3, work).v.norm() == 0);
  CHECK(work.newton_iterations == 2);
  CHECK(work.elastic_evaluations == 1 + 12 + 2 + 12);
  // of each iteration the exact one, and the symmetric one twice
  CHECK(work.stiffness_preparations == 3 + 1 + 3);
  CHECK(work.solves == 5);
  CHECK(work.cg_iterations == 0);
}

TEST_CASE("a Newton step is solved to a thousandth of its residual") {
  // A = 2 (1 +- d) along two axes: one iteration leaves d of a residual between them
  for (const auto& [d, iterations] : {std::pair{0.95e-3, 1}, {1.05e-3, 2}}) {
    Oscillator of{.uneven = {d, -d, 1}};
    of.rest = Vector3(0.3, 0.3, 0);
    const Work work = of.work_of(0.5);
    CHECK(work.newton_iterations == 1);
    CHECK(work.cg_iterations == iterations);
  }
}

TEST_CASE("a damped spring makes the derivative unsymmetric: that step is tried first") {
  // two more particles on a damped spring at rest, which changes nothing else
  const auto work_with_damper = [](double length) {
    Oscillator of{.length = length};
    of.system = make_system((PerParticle(3) << mass, 0.3, 0.6).finished());
    of.start.x = of.start.v = PerParticle3::Zero(3, 3);
    of.start.x.col(2).x() = 0.5;
    of.more.emplace_back(StretchSprings{{{1, 2, 0.5, 3, 0.2}}});
    return of.work_of(1e-9);
  };
  const Work one = work_with_damper(1);
  CHECK(one.solves == 1);
  CHECK(one.cg_iterations == 2);
  CHECK(one.stiffness_preparations == 1);
  CHECK(one.elastic_evaluations == 2);

  const Work too_long = work_with_damper(4200);  // both steps are tried at twelve lengths
  CHECK(too_long.elastic_evaluations == 1 + 24 + 2 + 24);
  CHECK(too_long.solves == 2 + 1 + 2);

  const Work uphill = work_with_damper(-1);  // not tried at all
  CHECK(uphill.elastic_evaluations == 1 + 12 + 2 + 12);
  CHECK(uphill.solves == 3 + 1 + 3);
}

namespace {

/// A spring from a held particle to a free one that the load keeps in balance, pushed aside.
struct PushedSpring {
  Vector3 along = Vector3(2, -1, 2) / 3;
  Spring spring{0, 1, 1.3, 20, 0};
  System system = make_system((PerParticle(2) << 0.7, 0.4).finished());
  State start{0.3, PerParticle3::Zero(3, 2), PerParticle3::Zero(3, 2)};
  Work work;

  PushedSpring(double length, double damping, const Vector3& velocity) {
    const Vector3 held(0.2, 0.5, -0.1);
    spring.damping = damping;
    start.x.col(0) = held;
    start.x.col(1) = held + length * along;
    start.v.col(1) = velocity;
    prescribe(system, {0, held, {}});
    system.forces.emplace_back(StretchSprings{{spring}});
    CustomForce load;
    load.elastic = [force = Vector3(spring.stiffness * (length - spring.rest_length) * along)](
                       const State&, PerParticle3& f) { f.col(1) += force; };
    system.forces.emplace_back(load);
    system.solver.tolerance = 1e-10;
  }
  State step(double length) { return backward_euler(system, {&start, 1}, length, work); }
  /// M (w - V) - s F(X + s w) of the free particle, without its damping.
  double error(const State& end, double step) const {
    State there = start;
    there.x += step * end.v;
    Work uncounted;
    const Vector3 f = elastic_forces(system.forces, there, uncounted).col(1);
    return (system.mass[1] * (end.v.col(1) - start.v.col(1)) - step * f).norm();
  }
};

/// The rate across is -20 (1.3 - 0.65)/0.65 = -20 N/m: of M, 1 - part is left after `step_over`.
PushedSpring compressed_spring() { return {0.65, 0, 1e-3 * Vector3(1, 2, 0).normalized()}; }
double step_over(double part) { return std::sqrt(part * 0.4 / 20); }

}  // namespace

TEST_CASE("the derivative of a compressed spring is taken as it is where the step allows") {
  PushedSpring of = compressed_spring();
  CHECK(of.error(of.step(step_over(0.9)), step_over(0.9)) < 1e-12);
  CHECK(of.work.unfinished_solves == 0);
  CHECK(of.work.newton_iterations <= 4);
  CHECK(of.work.stiffness_preparations == 2 * of.work.newton_iterations);
}

TEST_CASE("the derivative of a compressed spring is made semidefinite where the step is too long") {
  PushedSpring of = compressed_spring();
  CHECK(of.error(of.step(step_over(1.5)), step_over(1.5)) < 1e-9);
  CHECK(of.work.unfinished_solves == 0);
  CHECK(of.work.stiffness_preparations > 2 * of.work.newton_iterations);
  // in a linearised step nothing moves along the spring; across it the derivative, left out,
  // would have tripled the speed
  const State end = linearised_backward_euler(of.system, {&of.start, 1}, step_over(1.5), of.work);
  CHECK((end.v - of.start.v).norm() < 1e-15);
}

TEST_CASE("an unsymmetric step that its solver did not finish is not taken") {
  PushedSpring of(1.4, 9, {2.1, 3.4, -1.7});
  of.system.solver.max_iterations = 1;
  of.system.solver.tolerance = 1e-3;
  of.step(0.11);
  CHECK(of.work.newton_iterations > 0);
  CHECK(of.work.solves == 2 * of.work.newton_iterations + of.work.unfinished_solves);
}
