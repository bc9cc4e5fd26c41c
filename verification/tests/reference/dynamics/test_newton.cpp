// Newton's method of the implicit methods: steps, halvings, fallbacks and what they
// count. Where only counts show what happens, a false derivative makes each step too long
// or too short by a known factor.
#include <catch2/catch.hpp>

#include "reference/dynamics/implicit.h"
#include "reference/dynamics/integrator.h"
#include "reference/forces/degenerate.h"

using namespace foldproof;

namespace {

constexpr double h = 0.5, mass = 0.25, k = 7;  // M + h^2 k = 2 kg

/// A particle on a spring of three equal rates from `rest`. All numbers are exact in binary.
struct Oscillator {
  Vector3 rest = Vector3(3, 4, 12) / 16;
  // of a Newton step over that to the solution; the derivative says (M + h^2 k)/length
  double length = 1;
  double sideways = 0;      // force across the displacement, over h^2 k + M
  double farthest = 1e300;  // from the start: beyond it the force is degenerate [m]
  System system = make_system((PerParticle(1) << mass).finished());
  State start{0.75, PerParticle3::Zero(3, 1), PerParticle3::Zero(3, 1)};

  State step(double tolerance, Work& work) {
    system.solver.tolerance = tolerance;
    CustomForce force;
    force.elastic = [this](const State& s, PerParticle3& f) {
      if (s.x.norm() > farthest) throw DegenerateElement("too far", {0});
      const Vector3 d = rest - s.x.col(0);
      f.col(0) += k * d + sideways * 2 / (h * h) * Vector3(4, -3, 0).normalized().cross(d);
    };
    force.differential = [this](const State&, const PerParticle3& dx, PerParticle3& df) {
      df -= (2 / length - mass) / (h * h) * dx;
    };
    system.forces.assign(1, std::move(force));
    system.forces.insert(system.forces.end(), more.begin(), more.end());
    return backward_euler(system, {&start, 1}, h, work);
  }
  std::vector<Force> more;
  /// The solution from rest at the origin: h k rest/(M + h^2 k).
  Vector3 solution() const { return h * k / 2 * rest; }
};

}  // namespace

TEST_CASE("a linear force takes one Newton iteration, whose work is counted") {
  Oscillator of;
  Work work;
  const State end = of.step(0, work);
  CHECK(end.v.col(0) == of.solution());
  CHECK(end.x.col(0) == h * of.solution());
  CHECK(work.newton_iterations == 1);
  CHECK(work.elastic_evaluations == 2);
  CHECK(work.damping_preparations == 3);
  CHECK(work.damping_products == 3);
  CHECK(work.stiffness_preparations == 2);
  CHECK(work.stiffness_products == 1);
  CHECK(work.solves == 1);
  CHECK(work.cg_iterations == 1);
  CHECK(work.unfinished_solves == 0);
  CHECK(work.worst_residual == 0);
}

TEST_CASE("steps that overshoot are halved, and the iteration ends at the tolerance") {
  Oscillator of;
  of.length = 3;  // halved to 1.5: each step leaves -1/2 of the residual
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
    Oscillator of;
    of.length = length;
    Work work;
    of.step(0.99995, work);
    return work.elastic_evaluations - 1;
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
    Oscillator of;
    of.length = length;
    of.sideways = 8;
    of.rest = Vector3(0.3, 0.4, 1.2);  // across the axis of the sideways force
    Work work;
    of.step(1e-6, work);
    INFO(length);
    // sixty iterations from the start, as many from the linearised step
    CHECK(work.newton_iterations == 120);
    CHECK(work.elastic_evaluations == 1 + 60 * trials + 2 + 60 * trials);
  }
}

TEST_CASE("twelve lengths of a step are tried, then Newton's method starts again, once") {
  Oscillator near;
  near.length = 4000;  // the twelfth part is of 4000/2048
  Work found;
  near.step(0.96, found);
  CHECK(found.newton_iterations == 1);
  CHECK(found.elastic_evaluations == 13);
  CHECK(found.unfinished_solves == 0);

  Oscillator far;
  far.length = 4200;
  far.start.v.col(0) = Vector3(0.5, -0.25, 0.125);
  Work lost;
  const State end = far.step(0.125, lost);
  CHECK(end.v == far.start.v);
  CHECK(lost.newton_iterations == 2);
  CHECK(lost.elastic_evaluations == 1 + 12 + 2 + 12);
  CHECK(lost.unfinished_solves == 1);
  // the residual h F over itself and the momentum, in the mass-weighted norm
  const Vector3 residual = h * k * (far.rest - h * far.start.v.col(0));
  const double norm = residual.norm() / std::sqrt(mass),
               momentum = std::sqrt(mass) * far.start.v.norm();
  CHECK(lost.worst_residual == Approx(norm / (norm + momentum)).epsilon(1e-13));
  Work exact;
  far.step(0, exact);
  CHECK(exact.worst_residual == Approx(norm).epsilon(1e-13));
  CHECK(exact.unfinished_solves == 1);
}

TEST_CASE("Newton's method ends after sixty iterations, and after sixty more from another start") {
  Oscillator of;
  of.length = 0.01;
  Work work;
  const State end = of.step(1e-3, work);
  const double left = std::pow(0.99, 61);
  CHECK((end.v.col(0) - (1 - left) * of.solution()).norm() < 1e-12);
  CHECK(work.newton_iterations == 120);
  CHECK(work.unfinished_solves == 1);
  CHECK(work.worst_residual == Approx(left).epsilon(1e-12));
  CHECK(work.solves == 121);
  CHECK(work.elastic_evaluations == 123);
  CHECK(work.stiffness_preparations == 241);
  CHECK(work.damping_preparations == 243);
  CHECK(work.damping_products == 244);
  CHECK(work.stiffness_products == 122);
}

TEST_CASE(
    "the other start of Newton's method solves the equation linearised about the step's start") {
  Oscillator of;
  of.length = 0.01;
  Work work;
  of.step(1e-3, work);  // gives it its force
  // BDF2 after a step as long: s = 2/3 of the step, X and V a third beyond
  State before = of.start, now = of.start;
  before.time -= 0.75;
  before.v.col(0) = Vector3(0.3, -0.2, 0.4);
  now.x.col(0) = Vector3(0.1, 0.2, -0.3);
  now.v.col(0) = Vector3(-0.4, 0.9, -1.7);
  const std::vector<State> past{before, now};
  const State end = bdf2(of.system, past, 0.75, work);
  const Vector3 x = now.x, v = now.v, X = 4 * x / 3, V = (4 * v - Vector3(before.v)) / 3;
  const Vector3 exact = (mass * V + h * k * (of.rest - X)) / 2;
  const double rate = (2 / of.length - mass) / (h * h);  // of the false derivative
  const Vector3 linear = (mass * V + h * k * (of.rest - x) - h * rate * (X - x)) / 200;
  REQUIRE((linear - exact).norm() < 0.95 * (v - exact).norm());
  CHECK((Vector3(end.v) - exact - std::pow(0.99, 60) * (linear - exact)).norm() < 1e-11);
}

TEST_CASE("steps into degenerate places are halved, and no start is taken there") {
  Oscillator of;
  of.length = 1.5;
  of.farthest = 1.01 * h * of.solution().norm();  // the full step leads half as far again
  Work work;
  of.step(0.3, work);
  CHECK(work.newton_iterations == 1);
  CHECK(work.worst_residual == Approx(0.25));
  CHECK(work.unfinished_solves == 0);

  of.farthest = 1e-9;
  Work lost;
  const State end = of.step(0.3, lost);
  CHECK(end.v.norm() == 0);
  CHECK(lost.newton_iterations == 1);
  CHECK(lost.unfinished_solves == 1);
  CHECK(lost.worst_residual == Approx(1));
}

TEST_CASE("a derivative that is indefinite, even made semidefinite, gives no step") {
  Oscillator of;
  of.length = -1;
  Work work;
  const State end = of.step(0.3, work);
  CHECK(end.v.norm() == 0);
  CHECK(work.newton_iterations == 2);
  CHECK(work.elastic_evaluations == 1 + 12 + 2 + 12);
  // of each iteration the exact one, and the symmetric one twice
  CHECK(work.stiffness_preparations == 3 + 1 + 3);
  CHECK(work.solves == 5);
  CHECK(work.cg_iterations == 0);
}

TEST_CASE("a Newton step is solved to a thousandth of its residual") {
  // A = 1 +- d along two axes: one iteration leaves d of a residual between them
  for (const auto& [d, iterations] : {std::pair{0.95e-3, 1}, {1.05e-3, 2}}) {
    System system = make_system((PerParticle(1) << 0.5).finished());
    system.solver.tolerance = 0.5;
    const Vector3 rates = Vector3(0.5 + d, 0.5 - d, 3) / (h * h);
    CustomForce force;
    force.elastic = [&](const State& s, PerParticle3& f) {
      f.col(0) += Vector3(0.3, 0.3, 0) - rates.cwiseProduct(s.x.col(0));
    };
    force.differential = [&](const State&, const PerParticle3& dx, PerParticle3& df) {
      df.col(0) -= rates.cwiseProduct(dx.col(0));
    };
    system.forces.emplace_back(force);
    const State start{0.2, PerParticle3::Zero(3, 1), PerParticle3::Zero(3, 1)};
    Work work;
    backward_euler(system, {&start, 1}, h, work);
    CHECK(work.newton_iterations == 1);
    CHECK(work.cg_iterations == iterations);
  }
}

namespace {

/// A spring from a held particle to a free one that the load keeps in balance, pushed aside.
struct PushedSpring {
  Vector3 along = Vector3(2, -1, 2) / 3, across = Vector3(1, 2, 0).normalized();
  Spring spring{0, 1, 1.3, 20, 0};
  System system = make_system((PerParticle(2) << 0.7, 0.4).finished());
  State start{0.3, PerParticle3::Zero(3, 2), PerParticle3::Zero(3, 2)};

  PushedSpring(double length, double damping) {
    spring.damping = damping;
    start.x.col(0) = Vector3(0.2, 0.5, -0.1);
    start.x.col(1) = start.x.col(0) + length * along;
    prescribe(system, {0, start.x.col(0), {}});
    system.forces.emplace_back(StretchSprings{{spring}});
    CustomForce load;
    load.elastic = [force = Vector3(spring.stiffness * (length - spring.rest_length) * along)](
                       const State&, PerParticle3& f) { f.col(1) += force; };
    system.forces.emplace_back(load);
    system.solver.tolerance = 1e-10;
  }
  /// M (w - V) - s F(X + s w) of the free particle.
  double error(const State& end, double step) const {
    const Vector3 w = end.v.col(1), x = start.x.col(1) + step * w;
    State there = start;
    there.x.col(1) = x;
    PerParticle3 f = PerParticle3::Zero(3, 2);
    Work uncounted;
    f += elastic_forces(system.forces, there, uncounted);
    const Vector3 d = (x - start.x.col(0)).normalized();
    f.col(1) -= spring.damping * d.dot(w) * d;
    return (system.mass[1] * (w - start.v.col(1)) - step * f.col(1)).norm();
  }
};

}  // namespace

TEST_CASE("the derivative of a compressed spring is taken as it is where the step allows") {
  // the rate across is -20 (1.3 - 0.65)/0.65 = -20 N/m: of M, -0.9 M is left
  PushedSpring of(0.65, 0);
  of.start.v.col(1) = 1e-3 * of.across;
  const double step = std::sqrt(0.9 * 0.4 / 20);
  Work work;
  const State end = backward_euler(of.system, {&of.start, 1}, step, work);
  CHECK(of.error(end, step) < 1e-12);
  CHECK(work.unfinished_solves == 0);
  CHECK(work.newton_iterations <= 4);
  CHECK(work.stiffness_preparations == 2 * work.newton_iterations);
}

TEST_CASE("the derivative of a compressed spring is made semidefinite where the step is too long") {
  PushedSpring of(0.65, 0);
  of.start.v.col(1) = 1e-3 * of.across;
  const double step = std::sqrt(1.5 * 0.4 / 20);
  Work work;
  const State end = backward_euler(of.system, {&of.start, 1}, step, work);
  CHECK(of.error(end, step) < 1e-9);
  CHECK(work.unfinished_solves == 0);
  CHECK(work.stiffness_preparations > 2 * work.newton_iterations);
}

TEST_CASE("a linearised step is semidefinite where a compressed spring would push aside") {
  // along the spring nothing moves; across it the derivative, left out, would have
  // tripled the speed
  PushedSpring of(0.65, 0);
  of.start.v.col(1) = 1e-3 * of.across;
  Work work;
  const State end =
      linearised_backward_euler(of.system, {&of.start, 1}, std::sqrt(1.5 * 0.4 / 20), work);
  CHECK((end.v - of.start.v).norm() < 1e-15);
  CHECK(work.unfinished_solves == 0);
}

TEST_CASE("with dampers that turn Newton's method converges as fast as with springs alone") {
  PushedSpring of(1.4, 9);
  of.start.v.col(1) = Vector3(2.1, 3.4, -1.7);
  Work work;
  const State end = backward_euler(of.system, {&of.start, 1}, 0.11, work);
  CHECK(of.error(end, 0.11) < 1e-9);
  CHECK(work.unfinished_solves == 0);
  CHECK(work.newton_iterations <= 8);
  CHECK(work.solves == work.newton_iterations);
}

TEST_CASE("a damped spring makes the derivative unsymmetric: that step is tried first") {
  // two more particles on a damped spring at rest, which changes nothing else
  const auto with_damper = [](double length) {
    Oscillator of;
    of.length = length;
    of.system = make_system((PerParticle(3) << mass, 0.3, 0.6).finished());
    of.start.x = of.start.v = PerParticle3::Zero(3, 3);
    of.start.x.col(2).x() = 0.5;
    of.more.emplace_back(StretchSprings{{{1, 2, 0.5, 3, 0.2}}});
    return of;
  };
  Oscillator right = with_damper(1);
  Work one;
  right.step(1e-9, one);
  CHECK(one.newton_iterations == 1);
  CHECK(one.solves == 1);
  CHECK(one.cg_iterations == 2);
  CHECK(one.stiffness_preparations == 1);
  CHECK(one.elastic_evaluations == 2);

  // too long: both steps are tried at twelve lengths
  Oscillator long_one = with_damper(4200);
  Work both;
  long_one.step(0.3, both);
  CHECK(both.newton_iterations == 2);
  CHECK(both.elastic_evaluations == 1 + 24 + 2 + 24);
  CHECK(both.solves == 2 + 1 + 2);

  // uphill: not tried at all
  Oscillator wrong = with_damper(-1);
  Work uphill;
  wrong.step(0.3, uphill);
  CHECK(uphill.newton_iterations == 2);
  CHECK(uphill.elastic_evaluations == 1 + 12 + 2 + 12);
  CHECK(uphill.solves == 3 + 1 + 3);
}

TEST_CASE("an unsymmetric step that its solver did not finish is not taken") {
  PushedSpring of(1.4, 9);
  of.start.v.col(1) = Vector3(2.1, 3.4, -1.7);
  of.system.solver.max_iterations = 1;
  of.system.solver.tolerance = 1e-3;
  Work work;
  backward_euler(of.system, {&of.start, 1}, 0.11, work);
  CHECK(work.newton_iterations > 0);
  CHECK(work.solves == 2 * work.newton_iterations + work.unfinished_solves);
}

TEST_CASE("no residual need be smaller than positions round") {
  // without iterations the start's residual stays, h F, and is compared with that of rounding
  PushedSpring of(1.4, 0);
  of.start.v.col(1) = Vector3(2.1, 3.4, -1.7);
  of.start.x.colwise() += Vector3(-50, 10, 3);
  of.system.prescribed[0].start = of.start.x.col(0);
  of.system.solver.tolerance = 1e-30;
  of.system.solver.max_iterations = 0;
  Work work;
  const State end = backward_euler(of.system, {&of.start, 1}, 0.11, work);
  CHECK((end.v - of.start.v).norm() == 0);
  const double largest = std::max(50 - 0.2, std::abs(of.start.x(0, 1) + 0.11 * 2.1));
  const double target = 0.11 * 2.220446049250313e-16 * largest * 2 * 20 / std::sqrt(0.4);
  CHECK(work.worst_residual ==
        Approx(1e-30 * of.error(end, 0.11) / std::sqrt(0.4) / target).epsilon(1e-10));
  CHECK(work.unfinished_solves == 1);
}
