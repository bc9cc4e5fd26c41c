// Level 2: forces and energy.

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr double roundings = 64;  // of a sum over the forces of six springs a particle

/// The scale of elastic forces: of every edge, stiffness times length; summed [N].
double spring_scale(const PortableScene& scene) {
  return edge_stiffness(scene).dot(rest_lengths(scene.mesh));
}

Snapshot start_of(const PortableScene& scene) { return {scene.x, scene.v}; }

PerParticle3 forces_at_start(Trial& trial, const PortableScene& scene) {
  trial.prepare(scene);
  return trial.solver().forces(start_of(scene), 0);
}

PortableScene bent_sheet() {
  PortableScene scene = moving_sheet();
  scene.name = "bent sheet";
  scene.material.bending_rigidity = 0.01;
  return scene;
}

/// It rests at other lengths and angles than it has.
PortableScene sheet_of_other_rest() {
  PortableScene scene = bent_sheet();
  scene.name = "bent sheet of other rest lengths and angles";
  scene.material.rest_length_scale = 0.9;
  for (size_t k = 0; k < scene.mesh.hinges.size(); ++k)
    scene.rest_angles.push_back(0.5 * std::sin(1.7 * double(k) + 0.2));
  return scene;
}

/// The scale of bending forces: rigidity over the shortest edge, for every hinge, whose weight is
/// about three; summed [N].
double bending_scale(const PortableScene& scene) {
  return 3 * double(scene.mesh.hinges.size()) * scene.material.bending_rigidity /
         rest_lengths(scene.mesh).minCoeff();
}

Finding sum_to_zero(Trial& trial, const PortableScene& scene) {
  const PerParticle3 f = forces_at_start(trial, scene);
  Table measured{{"particles", "1"}, {"net force", "of the sum of k L and B/L"}};
  measured.row(f.cols(), f.rowwise().sum().norm() / (spring_scale(scene) + bending_scale(scene)));
  return judge_worst(measured, roundings * trial.declaration().rounding(), "rounding of a sum");
}

Finding torque_is_zero(Trial& trial, const PortableScene& scene) {
  const PerParticle3 f = forces_at_start(trial, scene);
  const Vector3 torque = torque_of(scene.x, f);
  Table measured{{"particles", "1"}, {"net torque", "of the size times the sum of k L and B/L"}};
  measured.row(f.cols(),
               torque.norm() / ((spring_scale(scene) + bending_scale(scene)) * largest(scene.x)));
  return judge_worst(measured, roundings * trial.declaration().rounding(), "rounding of a sum");
}

Finding weight_is_mass_times_g(Trial& trial) {
  const PortableScene scene = falling_sheet();
  const Vector3 weight = scene.mass.sum() * scene.gravity;
  const PerParticle3 f = forces_at_start(trial, scene);
  const Vector3 net = f.rowwise().sum();
  Table measured = table_of(
      "particles [1] | net force [N] | weight [N] | "
      "error of the net force [of the weight + sum of k L]");
  measured.row(f.cols(), net.norm(), weight.norm(),
               (net - weight).norm() / (weight.norm() + spring_scale(scene)));
  return judge_worst(measured, roundings * trial.declaration().rounding(), "rounding of a sum");
}

Finding rest_is_force_free(Trial& trial) {
  const PortableScene scene = sheet_at_rest();
  const PerParticle3 f = forces_at_start(trial, scene);
  Table measured{{"particles", "1"}, {"largest force", "of the largest k times the size"}};
  measured.row(f.cols(), f.colwise().norm().maxCoeff() /
                             (edge_stiffness(scene).maxCoeff() * largest(scene.x)));
  return judge_worst(measured, roundings * trial.declaration().rounding(),
                     "rounding of the springs at a particle");
}

/// Central difference of the energy along the velocities, against minus the forces' power. Gravity,
/// oblique to the axes, is part of both.
Finding are_the_energy_gradient(Trial& trial, const PortableScene& given) {
  PortableScene scene = given;
  scene.gravity = Vector3(2.3, -3.1, -9.0);
  const PerParticle3 f = forces_at_start(trial, scene);
  const double way = std::cbrt(trial.declaration().rounding()) * largest(scene.x);
  const PerParticle3 along = scene.v / scene.v.colwise().norm().maxCoeff();
  const auto energy_at = [&](double distance) {
    return trial.solver().energy({scene.x + distance * along, scene.v}, 0);
  };
  const double slope = (energy_at(way) - energy_at(-way)) / (2 * way);
  const double weight = scene.mass.sum() * scene.gravity.norm();
  const double scale = spring_scale(scene) + bending_scale(scene) + weight;
  Table measured{{"distance", "m"}, {"slope plus power", "of the weight + sum of k L and B/L"}};
  measured.row(way, std::abs(slope + (f.array() * along.array()).sum()) / scale);
  // third derivative: k/L^2 and B/L^3 at most; rounding: of the energy, over the distance
  const double relative = way / rest_lengths(scene.mesh).minCoeff();
  const double bound =
      relative * relative + roundings * trial.declaration().rounding() * largest(scene.x) / way;
  return judge_worst(measured, bound, "third derivative of the energy, and rounding of it");
}

/// Largest difference of forces from those of the same state in a scene that starts with it [N].
double staleness(Trial& trial, PortableScene scene, const Snapshot& state) {
  const PerParticle3 asked = trial.solver().forces(state, 0);
  scene.x = state.x, scene.v = state.v;
  trial.prepare(scene);
  return (asked - trial.solver().forces(state, 0)).colwise().norm().maxCoeff();
}

Finding are_of_the_present_state(Trial& trial) {
  const PortableScene scene = moving_sheet();
  const double scale = edge_stiffness(scene).maxCoeff() * largest(scene.x);
  Table measured{{"state", ""}, {"difference of forces", "of the largest k times the size"}};
  constexpr long steps = 20;
  trial.prepare(scene);
  const Snapshot moved = trial.solver().advance(scene.dt, steps);
  measured.row("after 20 steps", staleness(trial, scene, moved) / scale);
  if (trial.declaration().offers("set_state")) {
    trial.prepare(scene);
    trial.solver().advance(scene.dt, steps);
    const PerParticle3 half = (scene.x + moved.x) / 2;
    measured.row("set after them", staleness(trial, scene, {half, scene.v}) / scale);
  }
  return judge_worst(measured, roundings * trial.declaration().rounding(),
                     "forces of the same positions; rounding of the springs at a particle");
}

/// One after the other, at one time.
Finding two_states_have_their_forces(Trial& trial) {
  const PortableScene scene = moving_sheet();
  PerParticle3 other = scene.x;
  for (Eigen::Index i = 0; i < other.size(); ++i)
    other.data()[i] += 2e-3 * std::sin(2.9 * double(i));
  PortableScene alone = scene;
  alone.x = other;
  trial.prepare(alone);
  const PerParticle3 right = trial.solver().forces({other, scene.v}, 0);
  trial.prepare(scene);
  const PerParticle3 first = trial.solver().forces({scene.x, scene.v}, 0),
                     second = trial.solver().forces({other, scene.v}, 0);
  Table measured = table_of(
      "forces of the first state [N] | of the second [N] | error of the second [of the largest k "
      "times the size]");
  measured.row(largest(first), largest(right),
               largest(second - right) / (edge_stiffness(scene).maxCoeff() * largest(scene.x)));
  return judge_worst(measured, roundings * trial.declaration().rounding(),
                     "forces of the same positions; rounding of the springs at a particle");
}

/// So bent that hinges turn by up to two thirds of a straight angle.
PortableScene sharply_bent_sheet() {
  PortableScene scene = bent_sheet();
  scene.name = "sharply bent sheet";
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.x(2, i) += 0.06 * std::sin(2.6 * double(i));
  return scene;
}

/// Those that are held aside, whose force a solver may leave out.
Finding held_particles_change_no_force(Trial& trial) {
  PortableScene scene = moving_sheet();
  scene.gravity = Vector3(2.3, -3.1, -9.0);
  const PerParticle3 free = forces_at_start(trial, scene);
  scene.name = "moving sheet that is held";
  scene.held = {8, 0, 25, 51};
  PerParticle3 apart = forces_at_start(trial, scene) - free;
  for (const int i : scene.held) apart.col(i).setZero();
  Table measured{{"held", "1"}, {"difference of the others' forces", "of the largest k, the size"}};
  measured.row(scene.held.size(),
               largest(apart) / (edge_stiffness(scene).maxCoeff() * largest(scene.x)));
  return judge_worst(measured, roundings * trial.declaration().rounding(),
                     "forces of the same positions; rounding of the springs at a particle");
}

/// The energy of free particles on their way back to rest. Energy between held particles alone may
/// be left out.
Finding held_particles_change_no_energy(Trial& trial) {
  const PortableScene free = moving_sheet();
  PortableScene held = free;
  held.name = "moving sheet that is held, for its energy";
  held.held = {8, 0, 25, 51};
  PerParticle3 other = free.mesh.rest;
  for (const int i : held.held) other.col(i) = free.x.col(i);
  const auto gained = [&](const PortableScene& scene) {
    trial.prepare(scene);
    return trial.solver().energy({scene.x, scene.v}, 0) -
           trial.solver().energy({other, scene.v}, 0);
  };
  const double alone = gained(free), beside = gained(held);
  Table measured = table_of("energy gained [J] | beside held ones [J] | difference [of it]");
  measured.row(alone, beside, std::abs(beside - alone) / std::abs(alone));
  return judge_worst(measured, 1e-3 + 1e4 * trial.declaration().rounding(),
                     "the same springs in the same places; strains lose some digits");
}

/// Dampers, where there are some, are no part of either.
Finding are_of_positions_alone(Trial& trial) {
  const PortableScene scene =
      trial.declaration().offers("damping") ? damped_moving_sheet() : moving_sheet();
  trial.prepare(scene);
  const auto moving = [&](double times) { return Snapshot{scene.x, times * scene.v}; };
  const double kinetic = 9 * kinetic_energy(scene, scene.v),
               energy = trial.solver().energy(moving(0), 0);
  const PerParticle3 f = trial.solver().forces(moving(0), 0);
  Table measured = table_of("of a strained sheet | at rest | in motion | change [1]");
  const double energy_moving = trial.solver().energy(moving(3), 0);
  measured.row("energy, change over that of the motion", energy, energy_moving,
               std::abs(energy_moving - energy) / kinetic);
  const PerParticle3 f_moving = trial.solver().forces(moving(3), 0);
  measured.row("largest force", largest(f), largest(f_moving), largest(f_moving - f) / largest(f));
  return judge_worst(measured, 0.01, "elastic and potential energy, and its forces, alone");
}

}  // namespace

std::vector<Law> force_laws() {
  return {
      {"forces.sum-to-zero", "Elastic forces of a free sheet sum to zero.", "Newton's third law",
       in_scene(sum_to_zero, moving_sheet), "L2"},
      {"forces.torques-sum-to-zero", "Elastic forces of a free sheet exert no torque.",
       "Newton's third law", in_scene(torque_is_zero, moving_sheet), "L2"},
      {"forces.weight-is-mass-times-g", "The net force on a free sheet is its weight.",
       "Newton's second law", weight_is_mass_times_g, "L2", "net force | weight"},
      {"forces.rest-is-force-free", "The rest shape is free of forces.", "equilibrium",
       rest_is_force_free, "L2 still"},
      {"forces.are-minus-the-energy-gradient",
       "Forces, weight among them, are minus the energy's gradient.", "conservative forces",
       in_scene(are_the_energy_gradient, moving_sheet), "L2 set_state"},
      {"forces.are-those-of-the-present-state",
       "Forces after a motion, or of a state that is set, are those of a scene that starts there.",
       "forces depend on positions alone", are_of_the_present_state, "L2"},
      {"forces.of-two-states-at-one-time-differ",
       "Forces are those of the state that is given, not of another one of the same time.",
       "forces depend on positions alone", two_states_have_their_forces, "L2 set_state"},
      {"forces.of-a-bent-sheet-sum-to-zero",
       "Forces of a free sheet that resists bending sum to zero.", "Newton's third law",
       in_scene(sum_to_zero, bent_sheet), "L2 bending"},
      {"forces.of-a-bent-sheet-exert-no-torque",
       "Forces of a free sheet that resists bending exert no torque.", "Newton's third law",
       in_scene(torque_is_zero, bent_sheet), "L2 bending"},
      {"forces.of-a-bent-sheet-are-minus-the-energy-gradient",
       "Forces of a sheet that resists bending are minus its energy's gradient.",
       "conservative forces", in_scene(are_the_energy_gradient, bent_sheet),
       "L2 set_state bending"},
      {"forces.of-a-sharply-bent-sheet-are-minus-the-energy-gradient",
       "Forces of hinges that are bent by up to 120 degrees are minus their energy's gradient.",
       "conservative forces", in_scene(are_the_energy_gradient, sharply_bent_sheet),
       "L2 set_state bending"},
      {"forces.of-a-sheet-of-other-rest-are-minus-the-energy-gradient",
       "Forces of a sheet that rests at other lengths and angles are minus its energy's gradient.",
       "conservative forces", in_scene(are_the_energy_gradient, sheet_of_other_rest),
       "L2 set_state bending"},
      {"forces.of-a-held-sheet-are-those-of-a-free-one",
       "Held particles change no force that is stated for others.", "locality of forces",
       held_particles_change_no_force, "L2 held"},
      {"forces.energy-of-a-held-sheet-is-that-of-a-free-one",
       "Held particles change no energy that others gain.", "locality of forces",
       held_particles_change_no_energy, "L2 set_state held", "energy gained | beside held ones"},
      {"forces.and-energy-are-those-of-positions",
       "The forces and the energy that are stated do not depend on velocities.",
       "protocol: 'forces', 'energy'", are_of_positions_alone, "L2 set_state"},
  };
}

}  // namespace foldproof
