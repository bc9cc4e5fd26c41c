// Diagnostics against independent sums, and the balance of energy.
#include "reference/dynamics/simulate.h"
#include "verification/oracles/definitions.h"
#include "verification/specimens/check.h"
#include "verification/specimens/followed_runs.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

double rest_area(const Scene& scene, int triangle) {
  const auto [a, b, c] = scene.mesh.triangles[size_t(triangle)];
  const Vector3 p = scene.mesh.rest.col(b) - scene.mesh.rest.col(a),
                q = scene.mesh.rest.col(c) - scene.mesh.rest.col(a);
  return p.cross(q).norm() / 2;
}

oracles::SpringInput spring_input(const Scene& scene, const Edge& edge, const State& s) {
  double area = 0;
  for (int triangle : edge.triangles)
    if (triangle >= 0) area += rest_area(scene, triangle);
  const double rest = (scene.mesh.rest.col(edge.b) - scene.mesh.rest.col(edge.a)).norm(),
               scale = scene.stretch->rest_length_scale;
  // The stiffness is Y A_e/L0^2 of the rest shape at any scale: the area in the formula grows with
  // its length.
  return {{s.x.col(edge.a), s.x.col(edge.b)},
          {s.v.col(edge.a), s.v.col(edge.b)},
          {scene.stretch->stiffness, scene.stretch->damping, area * scale * scale, scale * rest}};
}

oracles::HingeInput hinge_input(const Scene& scene, size_t h, const State& s) {
  const Hinge& hinge = scene.mesh.hinges[h];
  oracles::HingeInput input;
  input.x = corners_of(hinge, s.x);
  input.v = corners_of(hinge, s.v);
  input.rest = corners_of(hinge, scene.mesh.rest);
  input.ke = scene.bending->stiffness;
  input.kd = scene.bending->damping;
  input.theta0 = scene.rest_angles[h];
  return input;
}

/// The numbers of a row of diagnostics, from the definitions; damping_power in W.
struct Sums {
  double kinetic = 0, stretch = 0, bending = 0, gravity = 0, damping_power = 0;
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};

Sums sums_of(const Scene& scene, const State& s) {
  Sums sums;
  for (size_t t = 0; t < scene.mesh.triangles.size(); ++t)
    for (int i : scene.mesh.triangles[t]) {
      const double m = scene.density * rest_area(scene, int(t)) / 3;
      const Vector3 x = s.x.col(i), v = s.v.col(i);
      sums.kinetic += m / 2 * v.squaredNorm();
      sums.gravity -= m * scene.gravity->dot(x);
      sums.linear += m * v;
      sums.angular += m * x.cross(v);
    }
  for (const Edge& edge : scene.mesh.edges) {
    const oracles::SpringInput input = spring_input(scene, edge, s);
    sums.stretch += oracles::spring_energy_50(input).value;
    const auto force = oracles::spring_damping_50(input).value;
    sums.damping_power += force[0].dot(input.v[0]) + force[1].dot(input.v[1]);
  }
  for (size_t h = 0; h < scene.mesh.hinges.size(); ++h) {
    const oracles::HingeInput input = hinge_input(scene, h, s);
    sums.bending += oracles::bending_energy_50(input).value;
    const auto force = oracles::bending_damping_50(input).value;
    for (size_t k = 0; k < 4; ++k) sums.damping_power += force[k].dot(input.v[k]);
  }
  return sums;
}

Followed record_run(const Scene& scene, const std::string& integrator, double h, int steps) {
  return followed_run(build_system(scene), integrator_named(integrator), start_state(scene),
                      {steps * h, h, {h, 0.5, 0.1}, 1000000});
}

/// The largest error of a row, each quantity in epsilon of its own magnitude.
double row_error(const Diagnostics& row, const Sums& sums, double damping_work,
                 double size_of_work) {
  Worst worst;
  const auto observe = [&](double error, double size) {
    worst.observe(std::abs(error) / (epsilon * size));
  };
  observe(row.energy.kinetic - sums.kinetic, sums.kinetic);
  observe(row.energy.stretch - sums.stretch, sums.stretch);
  observe(row.energy.bending - sums.bending, sums.bending);
  observe(row.energy.gravity - sums.gravity, std::abs(sums.gravity) + sums.kinetic);
  observe(row.energy.custom, sums.kinetic);
  observe(row.energy.total() - (sums.kinetic + sums.stretch + sums.bending + sums.gravity),
          sums.kinetic + sums.stretch + sums.bending + std::abs(sums.gravity));
  observe((row.linear_momentum - sums.linear).norm(), sums.linear.norm());
  observe((row.angular_momentum - sums.angular).norm(), sums.angular.norm());
  observe(row.damping_work - damping_work, size_of_work);
  return worst.value();
}

Finding diagnostics_finding() {
  const double h = 1.7e-3;
  const Scene scene = partly_prescribed_sheet();
  const Followed run = record_run(scene, "C", h, 9);
  const System system = build_system(scene);
  Worst worst;
  Table errors{{"time", "s"}, {"error", "epsilon of the quantity"}};
  double damping_work = 0, power_before = 0;
  if (run.rows.size() != run.frames.size() || run.rows.size() != 10) worst.observe(NAN);
  for (size_t n = 0; n < std::min(run.rows.size(), run.frames.size()); ++n) {
    const Diagnostics& row = run.rows[n];
    const Sums sums = sums_of(scene, run.frames[n]);
    damping_work += row.step / 2 * (sums.damping_power + power_before);
    power_before = sums.damping_power;
    const double size_of_work = std::abs(damping_work) + h * std::abs(sums.damping_power);
    const double error = row_error(row, sums, damping_work, size_of_work);
    errors.row(row.time, error);
    worst.observe(error);
    worst.observe(std::abs(row.time - run.frames[n].time) / epsilon);
    const State& begun_at = run.frames[n - (n > 0)];
    worst.observe(
        std::abs(row.step_over_elastic_limit - row.step / elastic_limit(system, begun_at)) /
        epsilon);
    worst.observe(std::abs(row.step - (n == 0 ? 0 : h)) / (epsilon * 9 * h));
    const bool is_solved =
        row.work.cg_iterations > 0 && row.work.worst_residual <= scene.solver.tolerance;
    if (n > 0 && !(is_solved && row.seconds >= 0)) worst.observe(NAN);
  }
  return {{worst.value(), 512, 0, "epsilon of the quantity",
           "up to a hundred terms of ten roundings each, which add up like a random walk to a "
           "hundred and cancel to a fifth of their size in the momenta: 500; energies of springs "
           "near their rest length lose a factor of 1/strain, about ten"},
          errors,
          "springs, hinges and dampers in 50 digits, masses and areas by an independent loop"};
}

/// Largest change of energy minus the work of damping since the start, over the first kinetic
/// energy [1].
double imbalance(const std::string& integrator, double h, int steps) {
  Scene scene = partly_prescribed_sheet();
  for (PrescribedParticle& p : scene.prescribed) p.motion = Motion{};  // held particles do no work
  const Followed run = record_run(scene, integrator, h, steps);
  Worst worst;
  for (const Diagnostics& row : run.rows)
    worst.observe(
        std::abs(row.energy.total() - row.damping_work - run.rows.front().energy.total()) /
        run.rows.front().energy.kinetic);
  return worst.value();
}

Finding balance_finding(const std::string& integrator) {
  Table errors("step [s]; imbalance over kinetic energy [1]; observed order [1]");
  double last = NAN, order = NAN;
  // s; later on a hinge may have folded through pi, where its energy jumps
  constexpr double time = 0.04;
  for (int n = 100; n <= 800; n *= 2) {
    const double error = imbalance(integrator, time / n, n);
    order = std::log2(last / error);
    errors.row(time / n, error, order);
    last = error;
  }
  return {{std::abs(order - 2), 0.1, 0, "1",
           "second order, two-sided: the schemes' and the trapezoidal rule's for the work, in the "
           "last pair"},
          errors};
}

}  // namespace

std::vector<Check> energy_checks() {
  std::vector<Check> list = {{"dynamics.diagnostics-are-as-defined",
                              "Energies, momenta and the work of damping that the reference "
                              "reports are the sums that define them.",
                              "BMF03 sections 3 and 4", diagnostics_finding}};
  add_for_each_scheme(list,
                      {{"dynamics.energy-balance-closes",
                        "on a damped sheet of the reference, energy minus the work of damping is "
                        "conserved to second order.",
                        "BMF03 section 3", balance_finding}});
  return list;
}

}  // namespace foldproof
