// The drag of the air: its law, its momenta, closed forms of falling, spinning and drifting sheets.
#include "reference/beyond/air.h"

#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/trial_cases.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

const Air windy{1.3, {2.1, -0.7, 1.4}, 1.1, 0.3};

/// The specimens with air instead of any other force.
std::vector<Specimen> sheets_in(const Air& air) {
  std::vector<Specimen> sheets = small_crumpled_sheets();
  for (Specimen& sheet : sheets) sheet.scene.air = air;
  return sheets;
}

/// The whole force of the air at s, 3 x N [N].
PerParticle3 drag_at(const Scene& scene, const State& s) {
  const System system = build_system(scene);
  Work work;
  const Forces at = forces_at(system.forces, s, work);
  PerParticle3 force = *at.elastic;
  at.damping->add_product(s.v, force);
  return force;
}

/// The drag on a triangle by the header's line, from its angle to the flow rather than from
/// projections.
Vector3 drag_by_angle(const Air& air, const std::array<Vector3, 3>& x, const Vector3& v) {
  const Vector3 sum = (x[1] - x[0]).cross(x[2] - x[1]), u = air.wind - v;
  const double area = sum.norm() / 2, angle = std::acos(u.dot(sum) / (u.norm() * sum.norm()));
  const Vector3 n = sum.normalized(), t = n.cross(u).cross(n).normalized();
  const double across = u.norm() * std::cos(angle), along = u.norm() * std::sin(angle);
  return air.density * area / 2 *
         (air.normal_drag * across * std::abs(across) * n +
          air.tangential_drag * along * along * t);
}

Finding law_finding() {
  Table errors{{"sheet", "1"}, {"force", "epsilon of the largest"}, {"torque", "epsilon"}};
  for (const Specimen& sheet : sheets_in(windy)) {
    const PerParticle3& x = sheet.state.x;
    PerParticle3 by_angle = PerParticle3::Zero(3, x.cols());
    Vector3 torque = Vector3::Zero();
    for (const Triangle& t : sheet.scene.mesh.triangles) {
      const std::array<Vector3, 3> corners{x.col(t[0]), x.col(t[1]), x.col(t[2])};
      const Vector3 v =
          (sheet.state.v.col(t[0]) + sheet.state.v.col(t[1]) + sheet.state.v.col(t[2])) / 3;
      const Vector3 drag = drag_by_angle(windy, corners, v);
      for (const int i : t) by_angle.col(i) += drag / 3;
      torque += (corners[0] + corners[1] + corners[2]).cross(drag) / 3;
    }
    const PerParticle3 force = drag_at(sheet.scene, sheet.state);
    Vector3 sum = Vector3::Zero();
    double size = 0;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      sum += Vector3(x.col(i)).cross(Vector3(force.col(i)));
      size += x.col(i).norm() * force.col(i).norm();
    }
    errors.row(
        sheet.name,
        (force - by_angle).cwiseAbs().maxCoeff() / (epsilon * by_angle.cwiseAbs().maxCoeff()),
        (sum - torque).norm() / (epsilon * size));
  }
  Finding finding =
      judge_worst(errors, "force", 64,
                  "an angle and its sine and cosine cost about ten roundings, and six "
                  "triangles meet in a particle");
  return finding;
}

Finding torque_finding() {
  Finding finding = law_finding();
  return judge_worst(finding.evidence, "torque", 16,
                     "a drag is divided among three corners, each to a rounding");
}

Finding symmetric_finding() {
  Table worst{{"sheet", "1"},
              {"gain", "of the largest rate"},
              {"rate over its bound", "1"},
              {"asymmetry", "epsilon of the largest entry"}};
  for (const Specimen& sheet : sheets_in(windy)) {
    const System system = build_system(sheet.scene);
    Work work;
    const auto damping = damping_at(system.forces, sheet.state, work);
    const Eigen::MatrixXd D = matrix_of(sheet.state.x.cols(), [&](const PerParticle3& v) {
      PerParticle3 f = PerParticle3::Zero(3, v.cols());
      damping->add_product(v, f);
      return f;
    });
    const Eigen::VectorXd masses = system.mass.replicate(1, 3).transpose().reshaped();
    const Eigen::VectorXd rates = oracles::symmetric_modes(-D, masses).values;  // 1/s
    const double gain = -rates.minCoeff() / rates.maxCoeff(),
                 rate = rates.maxCoeff() / damping_rate_bound(*damping, system.inverse_mass);
    const double asymmetry = largest_entry(D - D.transpose()) / (epsilon * largest_entry(D));
    worst.row(sheet.name, gain, rate, gain <= 1e-12 && rate <= 1 + 1e-12 ? asymmetry : nan);
  }
  return judge_worst(
      worst, 8,
      "a triangle's matrix is J^T C J with a symmetric C, and six are added; a "
      "motion that gains energy, or is damped faster than the bound, fails outright");
}

/// A flat free sheet without forces of its own, in the plane z = 0, of 0.15 kg/m^2. Nothing holds
/// it flat: solves go to rounding, or what they leave tilts it.
Scene loose_sheet(const Air& air) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::one_diagonal, 0.4, 0.3, 3, 2}), 0.15);
  scene.air = air;
  scene.solver.tolerance = 1e-14;
  return scene;
}

struct Fall {
  std::string way;
  Vector3 g;
  double drag;  // of this way [1]
};

const std::array<Fall, 2> falls() {
  const Air air;
  return {{{"face-on", {0, 0, -9.81}, air.normal_drag},
           {"edge-on", {0, -9.81, 0}, air.tangential_drag}}};
}

double terminal_speed(const Fall& fall) {
  return std::sqrt(2 * 0.15 * fall.g.norm() / (Air{}.density * fall.drag));
}

Finding terminal_finding(const Subject& subject, const std::string& integrator) {
  Table errors{{"way", "1"}, {"speed", "m/s"}, {"closed form", "m/s"}, {"error", "1"}};
  for (const Fall& fall : falls()) {
    Scene scene = loose_sheet({});
    scene.gravity = fall.g;
    const double u = terminal_speed(fall), time = u / fall.g.norm();
    scene.v.colwise() += 0.9 * u * fall.g.normalized();
    Stepper stepper(subject, scene, integrator);
    const State end = stepper.run(stepper.start(), time / 20, 80);
    const double speed = end.v.colwise().norm().minCoeff();
    errors.row(fall.way, speed, u, std::abs(speed / u - 1));
  }
  return judge_worst(
      errors, "error", 1e-3,
      "from nine tenths of it the closed form has 4e-5 to go after four times u/g. Much later an "
      "edge-on sheet without stiffness tilts, from roundings: so it does in air");
}

Finding tanh_finding(const Subject& subject, const std::string& integrator) {
  Table orders{{"way", "1"}, {"steps", "1"}, {"error", "m/s"}, {"order", "1"}, {"distance", "1"}};
  for (const Fall& fall : falls()) {
    Scene scene = loose_sheet({});
    scene.gravity = fall.g;
    const double u = terminal_speed(fall), time = 1.5 * u / fall.g.norm(),
                 exact = u * std::tanh(1.5);
    double last = nan;
    for (const int steps : {80, 160, 320}) {
      Stepper stepper(subject, scene, integrator);
      const State end = stepper.run(stepper.start(), time / steps, steps);
      const double error = std::abs(end.v.colwise().norm().maxCoeff() - exact);
      const double order = std::log2(last / error);
      orders.row(fall.way, steps, error, order, std::isnan(last) ? 0 : std::abs(order - 2));
      last = error;
    }
  }
  return judge_worst(
      orders, "distance", 0.1,
      "the next term of the error is smaller by a few steps over u/g, of a 53rd and less");
}

Finding drift_finding() {
  const Air air{1.2, {3.1, -0.4, 1.7}, 1.17, 0.3}, still{1.2, Vector3::Zero(), 1.17, 0.3};
  Table forces{{"sheet", "1"}, {"with the wind", "N"}, {"difference", "epsilon of the largest"}};
  for (Specimen& sheet : sheets_in(air)) {
    State with = sheet.state, relative = sheet.state;
    with.v.colwise() = air.wind;
    relative.v.colwise() -= air.wind;
    const double none = drag_at(sheet.scene, with).cwiseAbs().maxCoeff();
    const PerParticle3 force = drag_at(sheet.scene, sheet.state);
    sheet.scene.air = still;
    const double difference = largest_difference(force, drag_at(sheet.scene, relative)) /
                              (epsilon * force.cwiseAbs().maxCoeff());
    forces.row(sheet.name, none, none <= 1e-15 ? difference : nan);
  }
  return judge_worst(forces, 256,
                     "a velocity and the wind are up to thrice their difference, which enters "
                     "squared, and six triangles meet in a particle; a sheet that moves with the "
                     "wind and feels more than 1e-15 N fails outright");
}

Finding spin_finding() {
  // torque on a disc of radius R that turns with omega: about its axis rho C_t omega^2 pi R^5/5,
  // about a diameter rho C_n omega^2 4 R^5/15
  const Air air{1.2, Vector3::Zero(), 1.17, 0.4};
  const double R = 0.3, omega = 7;
  Table errors{{"about", "1"},         {"rings", "1"}, {"torque", "N m"},
               {"closed form", "N m"}, {"error", "1"}, {"judged", "1"}};
  for (const bool flips : {false, true})
    for (const int rings : {12, 24, 48}) {
      Scene scene = scene_at_rest(make_disc(R, rings), 0.2);
      scene.air = air;
      State s = start_state(scene);
      const Vector3 axis = flips ? Vector3(1, 0, 0) : Vector3(0, 0, 1);
      s.v = s.x.colwise().cross(-omega * axis);
      const PerParticle3 force = drag_at(scene, s);
      double torque = 0;
      for (Eigen::Index i = 0; i < s.x.cols(); ++i)
        torque -= axis.dot(Vector3(s.x.col(i)).cross(Vector3(force.col(i))));
      const double exact = air.density * omega * omega * std::pow(R, 5) *
                           (flips ? 4 * air.normal_drag / 15 : pi * air.tangential_drag / 5);
      const double error = std::abs(torque / exact - 1);
      errors.row(flips ? "a diameter" : "its axis", rings, torque, exact, error,
                 rings == 48 ? error : 0);
    }
  return judge_worst(errors, "judged", 2e-3,
                     "drag at a triangle's centre is second order in its size over the radius: "
                     "a few times 1/48^2");
}

/// A stiff square that turns about its middle line in air: omega' = -k omega^2 with the torque of
/// its triangles and the inertia of its particles, so omega = omega_0/(1 + k omega_0 t).
Finding slowing_finding(const Subject& subject, const std::string& integrator) {
  const double omega = 6, sigma = 0.2;
  Table errors{{"time", "s"}, {"omega", "rad/s"}, {"closed form", "rad/s"}, {"error", "1"}};
  Scene scene = scene_at_rest(make_sheet({SheetPattern::union_jack, 0.1, 0.1, 2, 2}), sigma);
  scene.x.colwise() -= scene.x.rowwise().mean().eval();
  scene.mesh.rest = scene.x;
  scene.air = Air{40, Vector3::Zero(), 1.17, 0.02};
  scene.stretch = StretchMaterial{2e3, 0, 1};
  scene.bending = BendingMaterial{.stiffness = 1};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0.0);
  const System system = build_system(scene);
  double inertia = 0, slope = 0;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    inertia += system.mass[i] * scene.x(1, i) * scene.x(1, i);
  const Eigen::VectorXd areas = rest_areas(scene.mesh);
  for (size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    double y = 0;
    for (const int i : scene.mesh.triangles[t]) y += scene.x(1, i) / 3;
    slope += scene.air->density * areas[Eigen::Index(t)] / 2 * scene.air->normal_drag *
             std::pow(std::abs(y), 3) / inertia;
  }
  scene.v = scene.x.colwise().cross(Vector3(-omega, 0, 0));
  Stepper stepper(subject, scene, integrator);
  State s = stepper.start();
  const double half = 1 / (slope * omega), h = 2e-4;  // s: until it turns half as fast
  for (const double time : {0.25, 0.5, 1.0}) {
    while (s.time < time * half) s = stepper.step(s, h);
    const double measured = angular_momentum(system, s).x() / inertia,
                 exact = omega / (1 + slope * omega * s.time);
    errors.row(s.time, measured, exact, std::abs(measured / exact - 1));
  }
  return judge_worst(errors, 1e-4,
                     "steps are a few hundredths of the time, and of second order; the square "
                     "bends by less");
}

Finding rejected_finding() {
  Differences differences;
  const auto refuses = [](const Air& air) {
    return is_rejected([&] { make_air({{0, 1, 2}}, air); }, "air: ");
  };
  differences.is("a negative density is refused", refuses({-1, Vector3::Zero(), 1, 1}));
  differences.is("a drag that is NaN is refused", refuses({1, Vector3::Zero(), nan, 1}));
  differences.is("an infinite wind is refused",
                 refuses({1, {std::numeric_limits<double>::infinity(), 0, 0}, 1, 1}));
  return differences.judged(0, "each is tried");
}

}  // namespace

std::vector<Check> air_checks() {
  const std::string source = "reference/beyond/air.h";
  std::vector<Check> list = {
      {"air.drag-is-quadratic",
       "The drag on a triangle is rho A/2 (C_n |u_n| u_n + C_t |u_t| u_t), a third at each corner.",
       source, law_finding},
      {"air.torque-is-that-at-the-centres",
       "Forces of the air turn the cloth as if they acted at the centres of its triangles.", source,
       torque_finding},
      {"air.damping-is-symmetric",
       "The drag enters a step as a symmetric matrix that takes energy away, within its bound.",
       source, symmetric_finding},
      {"air.moves-with-the-wind",
       "Drag is that of still air at the relative velocity; a sheet that moves with the wind feels "
       "none.",
       source, drift_finding},
      {"air.spinning-discs-are-slowed",
       "The torque on a spinning disc, about its axis and about a diameter, is the closed form's.",
       source, spin_finding},
      {"air.bad-numbers-are-refused", "Air of negative, infinite or NaN numbers is refused.",
       source, rejected_finding},
  };
  add_for_each_scheme(
      list, {{"air.terminal-speed",
              "A falling sheet reaches sqrt(2 sigma g/(rho C)), face-on and "
              "edge-on.",
              source, terminal_finding},
             {"air.spinning-sheet-slows",
              "A stiff square that turns in air slows as omega/(1 + k omega t).", source,
              slowing_finding},
             {"air.fall-is-tanh",
              "The speed of a falling sheet is u tanh(g t/u), to the second order of the scheme.",
              source, tanh_finding}});
  return list;
}

}  // namespace foldproof
