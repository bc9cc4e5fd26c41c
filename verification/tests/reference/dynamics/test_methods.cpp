// One step of every method, compared with its formula in dense matrices.
#include <catch2/catch.hpp>

#include "reference/dynamics/explicit.h"
#include "reference/dynamics/finish_step.h"
#include "reference/dynamics/implicit.h"
#include "reference/dynamics/integrator.h"
#include "verification/tests/reference/dynamics/dynamics_specimen.h"

using namespace foldproof;
using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double h = 0.13;

double difference(const PerParticle3& a, const VectorXd& b) {
  return (flat(a) - b).cwiseAbs().maxCoeff();
}

/// What the filters make of v.
VectorXd modified(const DynamicsSpecimen& of, const Span& span, double t, const VectorXd& x,
                  const VectorXd& v_of_state, const VectorXd& v) {
  PerParticle3 changed = columns(v);
  Work work;
  const State s{t, columns(x), columns(v_of_state)};
  correct(of.system.filters, span, s, changed, work);
  return flat(changed);
}

/// Steps of the theory page, at the state (t, x) with its own forces.
struct HalfSteps {
  const DynamicsSpecimen& of;

  VectorXd explicit_one(double t, const VectorXd& x, const VectorXd& v, const VectorXd& v_damped,
                        const Vector3& known) const {
    const VectorXd force = of.elastic(t, x) + of.damping(t, x) * v_damped;
    return of.with(v + h / 2 * force.cwiseQuotient(of.mass()), known);
  }
  VectorXd implicit_one(double t, const VectorXd& x, const VectorXd& v,
                        const Vector3& known) const {
    const VectorXd m = of.mass();
    const MatrixXd A = MatrixXd(m.asDiagonal()) - h / 2 * of.damping(t, x);
    return of.solve(A, m.cwiseProduct(v) + h / 2 * of.elastic(t, x), known);
  }
};

struct Expected {
  VectorXd x, v;
};

Expected scheme(char name, const DynamicsSpecimen& of) {
  const HalfSteps half{of};
  const double t = of.now.time, end = t + h;
  const VectorXd x = flat(of.now.x), v = flat(of.now.v);
  const Vector3 mean = (of.path(end) - of.now.x.col(of.prescribed)) / h,
                last = of.path_velocity(end);
  const VectorXd v_half = half.explicit_one(t, x, v, v, of.now.v.col(of.prescribed));
  const VectorXd start = name == 'A' ? of.with(v_half, mean) : half.implicit_one(t, x, v, mean);
  const VectorXd moving = modified(of, {t, end, h}, t, x, v, start);
  const VectorXd there = x + h * moving;
  if (name == 'B') return {there, half.explicit_one(end, there, moving, moving, last)};
  const VectorXd w = half.implicit_one(end, there, v_half, last);
  return {there, modified(of, {end, end, h}, end, there, w, w)};
}

void expect_same(const State& step, const Expected& expected, double tolerance) {
  CHECK(difference(step.x, expected.x) < tolerance);
  CHECK(difference(step.v, expected.v) < tolerance);
}

/// Positions and velocities, with rates at a time.
struct Point {
  VectorXd x, v;
};

Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.v + b.v}; }
Point operator*(double factor, const Point& a) { return {factor * a.x, factor * a.v}; }

Point rate(const DynamicsSpecimen& of, double t, const Point& raw) {
  const Point p{of.with(raw.x, of.path(t)), of.with(raw.v, of.path_velocity(t))};
  const VectorXd force = of.elastic(t, p.x) + of.damping(t, p.x) * p.v;
  return {p.v, force.cwiseQuotient(of.mass())};
}

/// Without filters, textbook forms: Heun's and Shu and Osher's combinations of Euler steps.
Point runge_kutta(int stages, const DynamicsSpecimen& of) {
  const Point u{flat(of.now.x), flat(of.now.v)};
  const double t = of.now.time;
  const auto euler = [&](double at, const Point& p) { return p + h * rate(of, at, p); };
  if (stages == 1) return euler(t, u);
  if (stages == 2) return u + h * rate(of, t + h / 2, u + (h / 2) * rate(of, t, u));
  if (stages == 3) {
    const Point second = 0.75 * u + 0.25 * euler(t + h, euler(t, u));
    return (1. / 3) * u + (2. / 3) * euler(t + h / 2, second);
  }
  const Point k1 = rate(of, t, u), k2 = rate(of, t + h / 2, u + (h / 2) * k1),
              k3 = rate(of, t + h / 2, u + (h / 2) * k2), k4 = rate(of, t + h, u + h * k3);
  return u + (h / 6) * (k1 + 2 * k2 + 2 * k3 + k4);
}

State step_of(const char* name, const DynamicsSpecimen& of, Work& work) {
  return integrator_named(name).step(of.system, {&of.now, 1}, h, work);
}

/// M (w - V) - s (F + D w) at (t, X + s w), in which the prescribed particle is on its path.
double stage_error(const DynamicsSpecimen& of, double t, const VectorXd& X, const VectorXd& V,
                   double s, VectorXd w) {
  w = of.with(w, of.path_velocity(t));
  const VectorXd x = of.with(X + s * w, of.path(t));
  const VectorXd rest =
      of.mass().cwiseProduct(w - V) - s * (of.elastic(t, x) + of.damping(t, x) * w);
  return of.with(rest, Vector3::Zero()).cwiseAbs().maxCoeff();
}

const char* const explicit_names[] = {"", "forward-euler", "RK2", "SSP-RK3", "RK4"};

}  // namespace

TEST_CASE("schemes A, B and C take the steps of their formulas, with and without filters") {
  for (const bool filtered : {false, true}) {
    DynamicsSpecimen of;
    if (filtered) of.system.filters.emplace_back(uneven_filter(of.prescribed));
    for (const char* name : {"A", "B", "C"}) {
      Work work;
      const State step = step_of(name, of, work);
      INFO(name);
      CHECK(step.time == of.now.time + h);
      CHECK(step.bonds.size() == 1);
      expect_same(step, scheme(name[0], of), 1e-11);
      CHECK(work.solves == (name[0] == 'C' ? 2 : 1));
      CHECK(work.elastic_evaluations == 2);
      CHECK(work.damping_preparations == 2);
      // one product for each explicit half step, one for each solve's first residual
      CHECK(work.damping_products == work.cg_iterations + work.solves + 1);
    }
  }
}

TEST_CASE("explicit methods take the steps of their textbooks") {
  DynamicsSpecimen of;
  for (int stages = 1; stages <= 4; ++stages) {
    Work work;
    const State step = step_of(explicit_names[stages], of, work);
    const Point expected = runge_kutta(stages, of);
    const double end = of.now.time + h;
    INFO(stages);
    expect_same(step,
                {of.with(expected.x, of.path(end)), of.with(expected.v, of.path_velocity(end))},
                1e-13);
    CHECK(step.time == end);
    CHECK(step.bonds.size() == 1);
    CHECK(work.damping_products == stages);
    CHECK(work.elastic_evaluations == stages);
    CHECK(work.damping_preparations == stages);
    CHECK(work.solves == 0);
  }
}

TEST_CASE("stages of an explicit method have the bonds of its step's start") {
  DynamicsSpecimen of;
  size_t calls = 0;
  CustomForce force;
  force.elastic = [&](const State& s, PerParticle3&) { calls += s.bonds.size(); };
  of.system.forces.emplace_back(force);
  Work work;
  step_of("RK4", of, work);
  CHECK(calls == 4);
}

TEST_CASE("at the end of a step filters see the move first, then the velocity that it left") {
  DynamicsSpecimen of;
  of.system.filters.emplace_back(uneven_filter(of.prescribed));
  const double t = of.now.time, end = t + h;
  const VectorXd move = uneven_matrix(12, 1.1, 0.3).col(2),
                 last = uneven_matrix(12, 0.8, 4.3).col(5);
  const VectorXd start = of.with(move, (of.path(end) - of.now.x.col(of.prescribed)) / h);
  const VectorXd moved = modified(of, {t, end, h}, t, flat(of.now.x), flat(of.now.v), start);
  const VectorXd there = flat(of.now.x) + h * moved;
  const VectorXd left = of.with(last + moved - start, of.path_velocity(end));
  Work work;
  const State step = finish_step(of.system, of.now, h, {columns(move), columns(last)}, work);
  CHECK(step.time == end);
  CHECK(step.bonds.size() == 1);
  expect_same(step, {there, modified(of, {end, end, h}, end, there, left, left)}, 1e-14);
}

TEST_CASE("backward Euler and the midpoint rule solve their stage equations") {
  DynamicsSpecimen of;
  const double t = of.now.time;
  const VectorXd x = flat(of.now.x), v = flat(of.now.v);
  for (const auto& [name, s] : {std::pair{"backward-euler", h}, {"implicit-midpoint", h / 2}}) {
    Work work;
    const State step = step_of(name, of, work);
    INFO(name);
    const VectorXd w = (flat(step.x) - x) / h;
    CHECK(stage_error(of, t + s, x, v, s, w) < 1e-11);
    const VectorXd last = s == h ? w : VectorXd(2 * w - v);
    expect_same(step,
                {of.with(flat(step.x), of.path(t + h)), of.with(last, of.path_velocity(t + h))},
                1e-13);
    CHECK(step.bonds.size() == 1);
    CHECK(step.time == t + h);
    CHECK(work.unfinished_solves == 0);
    CHECK(work.worst_residual <= of.system.solver.tolerance);
    CHECK(work.worst_residual > 0);
  }
}

TEST_CASE("BDF2 solves its stage equation with the coefficients of uneven steps") {
  DynamicsSpecimen of;
  State before = of.now;
  before.time -= 0.09;
  before.x = columns(flat(of.now.x) - 0.09 * uneven_matrix(12, 1.2, 0.9).col(1));
  before.v = columns(uneven_matrix(12, 1.2, 2.9).col(6));
  State earlier = before;
  earlier.time -= 0.03;
  earlier.x.array() += 5, earlier.v.array() += 5;
  Work work;
  const std::vector<State> past{earlier, before, of.now};
  const State step = bdf2(of.system, past, h, work);
  // (1 + 2 r) y_{n+1} = (1 + r)^2 y_n - r^2 y_{n-1} + h (1 + r) f_{n+1}
  const double r = h / 0.09, p = r * r / (1 + 2 * r), s = h * (1 + r) / (1 + 2 * r);
  const double end = of.now.time + h;
  const VectorXd X = (1 + p) * flat(of.now.x) - p * flat(before.x),
                 V = (1 + p) * flat(of.now.v) - p * flat(before.v);
  const VectorXd w = (flat(step.x) - X) / s;
  CHECK(stage_error(of, end, X, V, s, w) < 1e-11);
  expect_same(step, {of.with(flat(step.x), of.path(end)), of.with(w, of.path_velocity(end))},
              1e-12);
  CHECK(step.time == end);
  CHECK(step.bonds.size() == 1);
  // of more states than two the latest count
  Work same;
  CHECK(bdf2(of.system, std::span(past).last(2), h, same).x == step.x);
  // alone it starts as the midpoint rule does
  Work first, midpoint;
  const State one = bdf2(of.system, {&of.now, 1}, h, first);
  CHECK(one.x == step_of("implicit-midpoint", of, midpoint).x);
}

TEST_CASE("linearised backward Euler solves one linear system about the step's start") {
  DynamicsSpecimen of;
  const double t = of.now.time, end = t + h;
  const VectorXd x = flat(of.now.x), v = flat(of.now.v), m = of.mass();
  const Vector3 mean = (of.path(end) - of.now.x.col(of.prescribed)) / h;
  const MatrixXd D = of.damping(t, x), K = of.stiffness(x);
  const MatrixXd A = MatrixXd(m.asDiagonal()) - h * D - h * h * K;
  const VectorXd w = of.solve(A, m.cwiseProduct(v) + h * of.elastic(t, x), mean);
  Work work;
  const State step = step_of("linear-backward-euler", of, work);
  expect_same(step, {x + h * w, of.with(w, of.path_velocity(end))}, 1e-11);
  CHECK(step.bonds.size() == 1);
  CHECK(work.solves == 1);
  CHECK(work.unfinished_solves == 0);
  CHECK(work.elastic_evaluations == 1);
  CHECK(work.damping_preparations == 1);
  CHECK(work.stiffness_preparations == 1);
  CHECK(work.damping_products == work.cg_iterations + 1);
  CHECK(work.stiffness_products == work.cg_iterations + 1);
  CHECK(work.newton_iterations == 0);

  of.system.solver.max_iterations = 2;
  Work cut;
  step_of("linear-backward-euler", of, cut);
  CHECK(cut.unfinished_solves == 1);
  CHECK(cut.cg_iterations == 2);
  CHECK(cut.worst_residual > 1e-6);
}
