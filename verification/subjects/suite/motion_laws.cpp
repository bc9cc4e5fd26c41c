// Smoke, rest, inertia, gravity, momentum, held particles.

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr long few = 20, many = 50;  // steps

Finding stays_roughly(Trial& trial) {
  const PortableScene scene = sheet_at_rest();
  const double edge = rest_lengths(scene.mesh).mean();
  Table measured{{"steps", "1"}, {"largest displacement", "of the mean edge"}};
  measured.row(few, largest(trial.after(scene, few).x - scene.x) / edge);
  return judge_worst(measured, 0.01,
                     "a hundredth of an edge: any correctly driven solver stays below it");
}

Finding falls_roughly(Trial& trial) {
  const PortableScene scene = falling_sheet();
  const double time = many * scene.dt;
  const Vector3 fall = scene.gravity * time * time / 2;
  const PerParticle3 moved = trial.after(scene, many).x - scene.x;
  Table measured{{"steps", "1"}, {"error of the fall", "of g t^2/2"}};
  measured.row(many, largest(moved.colwise() - fall) / fall.norm());
  return judge_worst(measured, 0.05, "a first order method errs by 2 %; two and a half times that");
}

Finding stays_exactly(Trial& trial) {
  const PortableScene scene = sheet_at_rest();
  const PerParticle3 moved = trial.after(scene, few).x - scene.x;
  Table measured{{"steps", "1"}, {"largest displacement", "of the largest position"}};
  measured.row(few, largest(moved) / largest(scene.x));
  return judge_worst(measured, narrow_rounding(trial, scene, few),
                     "rounding of rest lengths, enlarged by elastic forces");
}

Finding stays_on_every_pattern(Trial& trial) {
  Table measured("pattern; largest displacement [m]; over rounding [1]");
  for (const PortableScene& scene : sheets_at_rest()) {
    const double moved = largest(trial.after(scene, few).x - scene.x);
    measured.row(scene.name, moved, moved / largest(scene.x) / narrow_rounding(trial, scene, few));
  }
  return judge_worst(measured, 1, "rounding of rest lengths, enlarged by elastic forces");
}

/// In the plane, at the lengths that the scene's scale gives.
Finding scaled_lengths_are_at_rest(Trial& trial) {
  Table measured("rest_length_scale [1]; largest displacement [m]; over rounding [1]");
  for (const double scale : {drawn("shorter", 0.8, 0.93), 1.15}) {
    PortableScene scene = sheet_at_rest();
    scene.name = "sheet of scaled rest lengths";
    scene.material.rest_length_scale = scale;
    scene.x *= scale;
    const double moved = largest(trial.after(scene, few).x - scene.x);
    measured.row(scale, moved, moved / largest(scene.x) / (2 * narrow_rounding(trial, scene, few)));
  }
  return judge_worst(measured, 1, "rounding of rest lengths, enlarged by elastic forces");
}

/// Slightly deformed about scaled rest lengths: springs of the stiffness that the scene gives.
Finding scaled_lengths_keep_their_stiffness(Trial& trial) {
  const auto gained = [&](double scale) {
    PortableScene scene = sheet_at_rest();
    scene.name = "deformed sheet of scaled rest lengths";
    scene.material.rest_length_scale = scale;
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
      scene.x.col(i) = scale * scene.mesh.rest.col(i) +
                       1e-3 * Vector3(std::sin(2.3 * double(i)), std::cos(1.7 * double(i)), 0);
    return trial.after(scene, few).v;
  };
  const PerParticle3 right = gained(1);
  Table measured = table_of("rest_length_scale [1] | velocity gained [m/s] | difference [of it]");
  for (const double scale : {drawn("much shorter", 0.7, 0.8), 1.3}) {
    const PerParticle3 v = gained(scale);
    measured.row(scale, largest(v), (v - right).norm() / right.norm());
  }
  return judge_worst(measured, 0.05, "displacements turn edges by a hundredth");
}

/// The angle of a hinge as the protocol defines it [rad].
double angle(const PerParticle3& x, const std::array<int, 4>& hinge) {
  const Vector3 x1 = x.col(hinge[0]), x2 = x.col(hinge[1]), x3 = x.col(hinge[2]),
                x4 = x.col(hinge[3]);
  const Vector3 n1 = (x1 - x3).cross(x1 - x4), n2 = (x2 - x4).cross(x2 - x3);
  return std::atan2(n1.cross(n2).dot((x4 - x3).normalized()), n1.dot(n2));
}

Finding stays_curved(Trial& trial) {
  PortableScene scene = sheets_at_rest().back();
  scene.name = "curved sheet with rest angles";
  scene.material.bending_rigidity = 0.005;
  for (const Hinge& hinge : scene.mesh.hinges)
    scene.rest_angles.push_back(angle(scene.x, hinge.particles));
  Table measured("steps [1]; largest displacement [m]; over rounding [1]");
  const double moved = largest(trial.after(scene, few).x - scene.x);
  measured.row(few, moved, moved / largest(scene.x) / narrow_rounding(trial, scene, few));
  return judge_worst(measured, 1, "rounding of rest lengths and angles, enlarged by forces");
}

Finding keeps_its_velocity(Trial& trial) {
  const PortableScene scene = drifting_sheet();
  const double time = few * scene.dt;
  const Snapshot end = trial.after(scene, few);
  const double path = scene.v.col(0).norm() * time;
  const double rounding = narrow_rounding(trial, scene, few);
  Table measured("of; error; over rounding [1]");
  const auto row = [&](const char* of, const char* unit, double error, double scale) {
    measured.row(of, fmt::format("{:.3g} {}", error, unit), error / (rounding * scale));
  };
  row("positions", "m", largest(end.x - scene.x - time * scene.v), largest(scene.x) + path);
  // a position error of rounding, made within one step, is a velocity error of it over the step
  row("velocities", "m/s", largest(end.v - scene.v),
      largest(scene.x) / scene.dt + largest(scene.v));
  const PerParticle3 lost = (end.v - scene.v) * scene.mass.asDiagonal();
  row("mean velocity", "m/s", lost.rowwise().sum().norm() / scene.mass.sum(),
      scene.v.col(0).norm());
  return judge_worst(measured, 1, "rounding alone: no force acts");
}

// Inner forces cancel in the mean velocity, so only rounding of its own enters: n steps round
// the velocity, at most g t, four times each, and where velocities come from positions, the
// height as often. It is at most g t^2/2, and half a unit of it over dt is epsilon g t n/4.
// Together, over g t:
//   n (4 epsilon) + n (4 epsilon n/4) = epsilon n (4 + n)
// Across gravity a position of the sheet's size takes the place of the height.
double speed_rounding(long steps, const Declaration& declared) {
  const double n = double(steps);
  return narrow(n * ((4 + n) * declared.rounding() + declared.solve_tolerance), declared);
}

double sideways_rounding(const PortableScene& scene, long steps, const Declaration& declared) {
  const double time = double(steps) * scene.dt;
  const double per_step = largest(scene.x) / scene.dt / (scene.gravity.norm() * time);
  return narrow(
      double(steps) * (4 * (1 + per_step) * declared.rounding() + declared.solve_tolerance),
      declared);
}

/// Mean velocity after the fall, against g t.
Finding gains_speed(Trial& trial) {
  const PortableScene scene = falling_sheet();
  const Vector3 expected = scene.gravity * (many * scene.dt);
  const PerParticle3 momenta = trial.after(scene, many).v * scene.mass.asDiagonal();
  const Vector3 mean = momenta.rowwise().sum() / scene.mass.sum();
  const Vector3 down = expected.normalized(), error = (mean - expected) / expected.norm();
  Table measured("of the mean velocity; error [g t]; error over rounding [1]");
  const double along = std::abs(error.dot(down)), across = (error - error.dot(down) * down).norm();
  measured.row("along gravity", along, along / speed_rounding(many, trial.declaration()));
  measured.row("across", across, across / sideways_rounding(scene, many, trial.declaration()));
  return judge_worst(measured, 1,
                     "a step that adds dt g to the velocity is exact for constant g; rounding of n "
                     "steps is left, epsilon n (4 + n) along gravity");
}

/// A method of order 1 errs by dt/2 g t, others not at all.
Finding falls_as_its_order_says(Trial& trial) {
  const Declaration declared = trial.declaration();
  Table measured("steps [1]; of; error over what the order allows [1]");
  for (const long steps : {many, 2 * many}) {
    PortableScene scene = falling_sheet();
    const double time = many * scene.dt;
    scene.dt = time / double(steps);
    const Vector3 fall = scene.gravity * time * time / 2;
    const PerParticle3 moved = trial.after(scene, steps).x - scene.x;
    const double rounding =
        rounding_error(scene, steps, declared) * (1 + largest(scene.x) / fall.norm());
    const double of_order = declared.order < 2 ? 1 / double(steps) : 0;
    measured.row(steps, "each particle",
                 largest(moved.colwise() - fall) / fall.norm() / (of_order + rounding));
    // the mean along gravity, in which inner forces cancel: twice the error of the speed
    const Vector3 mean = moved * scene.mass / scene.mass.sum();
    measured.row(steps, "mean along gravity",
                 std::abs(mean.dot(fall) / fall.squaredNorm() - 1) /
                     (of_order + 2 * speed_rounding(steps, declared)));
  }
  return judge_worst(measured, 1, "order 1: g t dt/2; order 2 and more: exact, rounding is left");
}

Finding keeps_momentum(Trial& trial, const PortableScene& scene) {
  const Snapshot end = trial.after(scene, few);
  const double scale =
      (scene.v.colwise().norm() * scene.mass.asDiagonal()).sum() +
      scene.mass.sum() * largest(scene.x) * std::sqrt(squared_phase(scene, 1)) / scene.dt;
  Table measured =
      table_of("steps [1] | change of linear momentum [of the sum of m (|v| + omega size)]");
  measured.row(few, (momentum_of(scene, end.v) - momentum_of(scene, scene.v)).norm() / scale);
  const Declaration& declared = trial.declaration();
  const double bound = 8 * few * declared.rounding() + few * declared.solve_tolerance;
  narrow(bound * scale / (scene.v.colwise().norm() * scene.mass)[0], declared);
  return judge_worst(measured, bound,
                     "inner forces cancel to a few roundings a step, or to the solver's tolerance");
}

Vector3 angular_momentum_of(const PortableScene& scene, const Snapshot& state,
                            const Declaration& declared) {
  return torque_of(state.x,
                   momentum_velocities(scene, state.v, declared) * scene.mass.asDiagonal());
}

/// The damped sheet turned by a radian from its rest shape, spinning by 9 rad/s more.
PortableScene damped_sheet_turned_from_rest() {
  PortableScene scene = damped_moving_sheet();
  scene.name = "damped sheet turned from its rest shape";
  scene.dt /= 2;
  const double c = std::cos(1.0), s = std::sin(1.0);
  const Eigen::Matrix3d turn{{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
  scene.x = turn * scene.x, scene.v = turn * scene.v;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.v.col(i) += Vector3(2, -3, 8).cross(Vector3(scene.x.col(i)));
  return scene;
}

/// Bent at all hinges, which are damped for 2 ms of their stiffness.
PortableScene sheet_of_damped_hinges() {
  PortableScene scene = moving_sheet();
  scene.name = "moving sheet of damped hinges";
  scene.material.bending_rigidity = 0.005;
  scene.material.bending_damping = drawn("damping of hinges", 1e-4, 2e-4);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.x(2, i) += 0.02 * std::sin(2.1 * double(i));
  return scene;
}

double angular_drift(Trial& trial, PortableScene scene, long steps) {
  const double time = few * scene.dt;
  scene.dt = time / double(steps);
  const Snapshot end = trial.after(scene, steps);
  const Declaration& declared = trial.declaration();
  const Vector3 start = angular_momentum_of(scene, {scene.x, scene.v}, declared);
  return (angular_momentum_of(scene, end, declared) - start).norm() / start.norm();
}

Finding angular_momentum_converges(Trial& trial, const PortableScene& scene) {
  const Declaration declared = trial.declaration();
  PortableScene finest = scene;
  const long count = 4 * few * parts_of_step(finest.dt / 2, declared);
  finest.dt *= double(few) / double(count);
  const double floor = narrow(10 * rounding_error(finest, count, declared), declared);
  const double coarse = angular_drift(trial, scene, count / 2),
               fine = angular_drift(trial, scene, count);
  Table measured("drift at dt/2 [L]; drift at dt/4 [L]; fine over coarse [1]");
  measured.row(coarse, fine, fine <= floor ? 0 : fine / coarse);
  const double expected = std::pow(0.5, std::max(1, declared.order));
  return judge_worst(measured, "fine over coarse", 1.35 * expected,
                     "2^-order, and a third for the next term of the series; 0 below rounding");
}

Finding held_particles_stay(Trial& trial) {
  const PortableScene scene = hanging_sheet();
  const Snapshot end = trial.after(scene, many);
  Table measured{{"particle", "1"}, {"displacement", "of the largest position"}};
  for (const int i : scene.held)
    measured.row(i, (end.x.col(i) - scene.x.col(i)).norm() / largest(scene.x));
  return judge_worst(measured, 8 * trial.declaration().rounding(), "a few roundings of a position");
}

}  // namespace

std::vector<Law> motion_laws() {
  return {
      {"smoke.sheet-at-rest-stays",
       "A sheet in its rest shape, with no forces on it, does not move.", "equilibrium",
       stays_roughly, "still"},
      {"smoke.free-fall-within-5-percent", "A free sheet falls by g t^2/2, within 5 %.", "Galilei",
       falls_roughly},
      {"rest.no-force-no-motion", "A sheet in its rest shape stays, to rounding.", "equilibrium",
       stays_exactly, "still"},
      {"rest.no-force-no-motion-on-any-pattern",
       "Sheets of seven meshes, one of them curved, stay in their rest shape.", "equilibrium",
       stays_on_every_pattern, "still", "pattern | largest displacement"},
      {"rest.scaled-lengths-are-at-rest", "A sheet scaled as its `rest_length_scale` says stays.",
       "protocol: 'rest_length_scale'", scaled_lengths_are_at_rest, "still",
       "rest_length_scale | largest displacement"},
      {"rest.scaled-lengths-keep-their-stiffness",
       "Springs of scaled rest lengths have the stiffness of the others.",
       "protocol: 'rest_length_scale', 'edge_stiffness'", scaled_lengths_keep_their_stiffness, "",
       "rest_length_scale | velocity gained"},
      {"rest.curved-sheet-keeps-its-rest-angles",
       "A curved sheet that resists bending stays in its rest shape.", "equilibrium", stays_curved,
       "bending still", "largest displacement"},
      {"inertia.free-sheet-keeps-its-velocity",
       "A sheet that drifts without forces keeps its velocity.", "Newton's first law",
       keeps_its_velocity, "", "of | error"},
      {"gravity.speed-grows-by-g-t", "A falling sheet gains the velocity g t.",
       "Newton's second law", gains_speed, "", "of the mean velocity | error"},
      {"gravity.fall-is-as-exact-as-the-order-claims",
       "The error of a free fall is what the claimed order allows.", "Taylor's series of the fall",
       falls_as_its_order_says},
      {"momentum.linear-is-conserved", "A free sheet keeps its linear momentum.",
       "Newton's third law", in_scene(keeps_momentum, moving_sheet)},
      {"momentum.linear-of-unequal-masses-is-conserved",
       "A free sheet of given, unequal masses keeps its linear momentum.", "Newton's third law",
       in_scene(keeps_momentum, moving_sheet_of_unequal_masses), "masses"},
      {"momentum.linear-under-damping-is-conserved",
       "A free sheet with damped springs keeps its linear momentum.", "Newton's third law",
       in_scene(keeps_momentum, damped_moving_sheet), "damping"},
      {"momentum.angular-drift-falls-with-the-step",
       "The change of a free sheet's angular momentum falls as the order claims.",
       "Newton's third law along the line of force",
       in_scene(angular_momentum_converges, moving_sheet), "", "drift at dt/2 | drift at dt/4"},
      {"momentum.angular-under-damping-drifts-less-in-shorter-steps",
       "Damped edges, turned from their rest shape, change the angular momentum by the step's "
       "error alone: dampers act along the edges.",
       "Newton's third law along the line of force",
       in_scene(angular_momentum_converges, damped_sheet_turned_from_rest), "damping",
       "drift at dt/2 | drift at dt/4"},
      {"momentum.linear-under-damping-of-hinges-is-conserved",
       "A free sheet with damped hinges keeps its linear momentum.", "Newton's third law",
       in_scene(keeps_momentum, sheet_of_damped_hinges), "damping bending"},
      {"momentum.angular-under-damping-of-hinges-drifts-less-in-shorter-steps",
       "Damped hinges change the angular momentum by the step's error alone.",
       "Newton's third law for moments",
       in_scene(angular_momentum_converges, sheet_of_damped_hinges), "damping bending",
       "drift at dt/2 | drift at dt/4"},
      {"held.particles-stay", "Held particles stay where they are.", "protocol: array 'held'",
       held_particles_stay, "held"},
  };
}

}  // namespace foldproof
