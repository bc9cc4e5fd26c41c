// The lines of the schemes, one by one: which velocities are filtered and which continue,
// prescribed motion, counted work.
#include "reference/dynamics/integrator.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

/// sqrt(sum m_i |v_i|^2) [kg^(1/2) m/s].
double mass_norm(const PerParticle3& v, const PerParticle& mass) {
  return std::sqrt(v.colwise().squaredNorm().dot(mass.transpose()));
}

Finding trapezoidal_finding(const Subject& subject, const std::string& integrator) {
  const double tolerance = 1e-12;
  Scene scene = free_sheet();
  scene.gravity = Vector3(0.7, -9.1, 1.9);
  scene.solver.tolerance = tolerance;
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  Stepper stepper(subject, scene, integrator);
  State now = stepper.start();
  Table errors{{"step", "s"}, {"defect of the trapezoidal rule over that velocity", "1"}};
  for (double h : {2.1e-3, 3.7e-4, 1.3e-3, 4.9e-3}) {
    const State next = stepper.step(now, h);
    const PerParticle3 here = stepper.elastic_forces(now) + stepper.damping_forces(now, now.v);
    const PerParticle3 there = stepper.elastic_forces(next) + stepper.damping_forces(next, next.v);
    const PerParticle3 defect =
        next.v - now.v - h / 2 * (here + there) * mass.cwiseInverse().asDiagonal();
    const PerParticle3 undamped =
        next.v - h / 2 * stepper.damping_forces(next, next.v) * mass.cwiseInverse().asDiagonal();
    errors.row(h, mass_norm(defect, mass) / mass_norm(undamped, mass));
    now = next;
  }
  return judge_worst(
      errors, 2 * tolerance,
      "the solve's tolerance, 1e-12 of the velocity before damping; as much again for rounding");
}

/// Arguments and result of a filter call.
struct Call {
  Span span;
  PerParticle3 given, left;
};

/// A free damped sheet with a filter that changes every velocity and records its calls.
struct FilteredStep {
  State now, next;
  std::vector<Call> calls;
};

FilteredStep filtered_step(const std::string& integrator, double h) {
  FilteredStep result;
  const Scene scene = free_sheet();
  System system = build_system(scene);
  CustomFilter filter;
  filter.modify = [&result](const Span& span, const State&, PerParticle3& v) {
    const PerParticle3 given = v;
    v *= 0.83;
    v.colwise() += Vector3(0.07, -0.11, 0.05);
    result.calls.push_back({span, given, v});
  };
  system.filters.emplace_back(filter);
  result.now = start_state(scene);
  result.now.time = 0.37;
  result.next = step_once(integrator, system, result.now, h);
  return result;
}

Finding filter_finding(const std::string& integrator) {
  const double h = 1.7e-3;
  const FilteredStep step = filtered_step(integrator, h);
  const bool ends = integrator != "B";
  if (step.calls.size() != (ends ? 2 : 1))
    return {{NAN, 0, 0, "numbers that differ",
             "the filter is called once for each velocity that is used"},
            {},
            "a wrong number of calls"};
  const Call& move = step.calls.front();
  const PerParticle3 moved = step.now.x + h * move.left;
  double differing = count_differing_entries(step.next.x, moved);
  differing += (move.span.start != step.now.time) + (move.span.end != step.now.time + h);
  if (ends) {
    differing += count_differing_entries(step.next.v, step.calls[1].left);
    differing +=
        (step.calls[1].span.start != step.next.time) + (step.calls[1].span.end != step.next.time);
  }
  return {{differing, 0, 0, "numbers that differ",
           "x + h v of the filtered velocity and the filtered end velocity are used as they are, "
           "bit for bit"},
          {},
          ends ? "The filter is called for the motion and for the end velocity."
               : "The filter is called for the motion only."};
}

/// Velocity after one step of a particle with x'' = g - c x'; a filter adds d to the velocity that
/// moves it.
double end_velocity(const std::string& integrator, double h, double c, double g, double v,
                    double d) {
  const double m = 0.25;
  System system = make_system(PerParticle::Constant(1, m));
  CustomForce force;
  force.elastic = [=](const State&, PerParticle3& f) { f.row(0).array() += m * g; };
  force.damping = [=](const State&) -> DampingOperator::Custom {
    return {[=](const PerParticle3& w, PerParticle3& f) { f -= m * c * w; }, {}};
  };
  system.forces.push_back(force);
  CustomFilter filter;
  filter.modify = [=](const Span& span, const State&, PerParticle3& w) {
    if (span.end > span.start) w(0, 0) += d;
  };
  system.filters.emplace_back(filter);
  system.solver.tolerance = 1e-15;
  const State s{0, PerParticle3::Zero(3, 1), PerParticle3(Vector3(v, 0, 0))};
  return step_once(integrator, system, s, h).v(0, 0);
}

/// The same by the printed lines: B continues from the filtered velocity, A and C do not.
double printed_end_velocity(const std::string& integrator, double h, double c, double g, double v,
                            double d) {
  const double a = h * c / 2, kick = h / 2 * g;
  if (integrator == "B") return (1 - a) * ((v + kick) / (1 + a) + d) + kick;
  return ((1 - a) * v + 2 * kick) / (1 + a);
}

Finding continues_finding(const std::string& integrator) {
  Table errors{{"h c/2", "1"}, {"error", "epsilon of the terms"}};
  for (double c : {0.7, 11.0, 170.0}) {
    const double h = 0.037, g = -9.3, v = 1.3, d = 0.59, a = h * c / 2;
    const double size = (1 + a) * (v + d) + h * std::abs(g);
    const double error =
        end_velocity(integrator, h, c, g, v, d) - printed_end_velocity(integrator, h, c, g, v, d);
    errors.row(a, std::abs(error) / (epsilon * size));
  }
  return judge_worst(
      errors, 16,
      "some twenty roundings of half an epsilon each; the filter's change is 0.3 of the terms");
}

Scene held_scene() {
  Scene scene = partly_prescribed_sheet();
  for (PrescribedParticle& p : scene.prescribed) p.motion = Motion{};
  return scene;
}

Finding held_finding(const Subject& subject) {
  Table counts{{"integrator", "1"}, {"numbers that differ", "1"}};
  for (const Integrator& integrator : paper_schemes()) {
    Stepper stepper(subject, held_scene(), std::string(integrator.name));
    State s = stepper.start();
    double here = 0;
    for (int n = 0; n < 50; ++n) {
      s = stepper.step(s, n % 2 == 0 ? 1.9e-3 : 0.6e-3);
      for (const PrescribedParticle& p : stepper.scene().prescribed) {
        here += count_differing_entries(s.x.col(p.particle), p.start);
        here += count_differing_entries(s.v.col(p.particle), Vector3(Vector3::Zero()));
      }
    }
    counts.row(integrator.name, here);
  }
  return {{counts.worst("numbers that differ"), 0, 0, "numbers that differ",
           "held particles have velocity 0 and keep every bit of their position"},
          counts};
}

/// Position of a prescribed particle, from the definition of Motion, with the rotation by
/// Rodrigues' formula.
State led_point(const PrescribedParticle& p, double t) {
  const Motion& m = p.motion;
  const double rate = m.angular_velocity.norm(), omega = 2 * pi * m.frequency;
  const Vector3 arm = p.start - m.center,
                axis = rate > 0 ? Vector3(m.angular_velocity / rate) : Vector3(0, 0, 1);
  const Vector3 along = axis.dot(arm) * axis, turned = along + std::cos(rate * t) * (arm - along) +
                                                       std::sin(rate * t) * axis.cross(arm);
  const double swing = std::sin(omega * t + m.phase) - std::sin(m.phase);
  State point;
  point.x = m.center + turned + t * m.velocity + swing * m.amplitude;
  point.v =
      rate * axis.cross(turned) + m.velocity + omega * std::cos(omega * t + m.phase) * m.amplitude;
  return point;
}

Finding led_finding(const Subject& subject, const std::string& integrator) {
  Stepper stepper(subject, partly_prescribed_sheet(), integrator);
  State s = stepper.start();
  Worst worst;
  for (int n = 0; n < 200; ++n) {
    s = stepper.step(s, n % 3 == 0 ? 2.1e-3 : 0.8e-3);
    for (const PrescribedParticle& p : stepper.scene().prescribed) {
      const State point = led_point(p, s.time);
      const double fastest = p.motion.velocity.norm() +
                             p.motion.angular_velocity.norm() * (p.start - p.motion.center).norm() +
                             2 * pi * p.motion.frequency * p.motion.amplitude.norm();
      worst.observe((s.x.col(p.particle) - point.x).norm() / epsilon);
      if (fastest > 0) worst.observe((s.v.col(p.particle) - point.v).norm() / (epsilon * fastest));
    }
  }
  return {{worst.value(), 16, 0, "epsilon of the size",
           "two formulas of ten roundings each, for points within 1 m of the origin and phases up "
           "to 6 rad"},
          {},
          "Compared after each of 200 uneven steps; the size is 1 m, or the point's top speed."};
}

constexpr int counted_steps = 7;

Work work_of_steps(const Subject& subject, const Integrator& integrator) {
  Stepper stepper(subject, partly_prescribed_sheet(), std::string(integrator.name));
  stepper.run(stepper.start(), 1.3e-3, counted_steps);
  return stepper.work();
}

Finding counts_finding(const Subject& subject) {
  Worst worst;
  Table solves{{"integrator", "1"}, {"solves a step", "1"}};
  for (const Integrator& integrator : paper_schemes()) {
    const double counted = double(work_of_steps(subject, integrator).solves) / counted_steps;
    solves.row(integrator.name, counted);
    worst.observe(std::abs(counted - (integrator.name == "C" ? 2 : 1)));
  }
  return {{worst.value(), 0, 0, "solves a step",
           "counts are exact: the paper's lists have one implicit line in A and B, two in C"},
          solves};
}

Finding once_finding(const Subject& subject) {
  Worst worst;
  Table counts{{"integrator", "1"},
               {"preparations a step", "1"},
               {"products a step", "1"},
               {"iterations a step", "1"}};
  constexpr int steps = counted_steps;
  for (const Integrator& integrator : paper_schemes()) {
    const Work work = work_of_steps(subject, integrator);
    counts.row(integrator.name, double(work.damping_preparations) / steps,
               double(work.damping_products) / steps, double(work.cg_iterations) / steps);
    worst.observe(std::abs(double(work.damping_preparations - 2 * steps)));
    worst.observe(std::abs(double(work.elastic_evaluations - 2 * steps)));
    // a product for each iteration, one for each solve's first residual, one for the
    // explicit half step
    worst.observe(
        std::abs(double(work.damping_products - work.cg_iterations - work.solves - steps)));
    if (work.cg_iterations < steps) worst.observe(NAN);
  }
  return {{worst.value(), 0, 0, "evaluations",
           "counts are exact: a step has two sets of positions, and every product uses the terms "
           "prepared there"},
          counts};
}

}  // namespace

std::vector<Check> step_checks() {
  const std::string source = "BMF03 section 3";
  std::vector<Check> list = {
      {"dynamics.lines-one-and-four-are-the-trapezoidal-rule.A",
       "Scheme A: unmodified, the velocity follows the trapezoidal rule between the two ends of a "
       "step.",
       source, [](const Subject& subject) { return trapezoidal_finding(subject, "A"); }},
      {"dynamics.A-continues-from-the-unmodified-velocity",
       "The reference's end velocity in A continues from v*, not from the filtered velocity.",
       source, []() { return continues_finding("A"); }},
      {"dynamics.B-continues-from-the-modified-velocity",
       "The reference's end velocity in B continues from the filtered velocity.", source,
       []() { return continues_finding("B"); }},
      {"dynamics.C-continues-from-the-start-velocity",
       "The reference's end velocity in C continues from v_n, whatever a filter did.", source,
       []() { return continues_finding("C"); }},
      {"dynamics.held-particles-do-not-move",
       "Held particles do not move, whatever forces act on them.", "our reading of BMF03 section 3",
       held_finding},
      {"dynamics.solves-are-counted", "A and B solve once a step, C twice.", source,
       counts_finding},
      {"dynamics.position-terms-are-computed-once-per-position",
       "Forces and the position-dependent terms of damping are evaluated twice a step, however "
       "many products a solve needs.",
       source, once_finding}};
  add_for_each_scheme(
      list, {{"dynamics.cloth-moves-with-the-filtered-velocity",
              "the reference moves the cloth with exactly the filtered velocity, and "
              "filters the end velocity where the paper does.",
              source, filter_finding},
             {"dynamics.prescribed-particles-follow-their-path",
              "prescribed particles are on their path, with its velocity, after every step.",
              "our reading of BMF03 section 3", led_finding}});
  return list;
}

}  // namespace foldproof
