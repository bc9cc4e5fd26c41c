// Dampers along the edges: what they do to the motion, and the forces that level 2 states.

#include "reference/mesh/shapes.h"
#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

// Dampers of tau times the stiffness of each edge act on velocities v as the springs on a sheet
// that is displaced by tau v from its rest shape. So a solver is compared with itself: its
// stiffness is the business of other laws.
constexpr long steps = 10;

double tau_of(const PortableScene& scene) {  // s
  return scene.material.stretch_damping / scene.material.young;
}

/// A sheet in its rest shape, with dampers of a third of critical damping for the highest
/// frequency. Each particle has another velocity; the steps are half of tau together.
PortableScene rattled_sheet() {
  PortableScene scene = damped_moving_sheet();
  scene.name = "rattled sheet";
  scene.x = scene.mesh.rest;
  for (Eigen::Index i = 0; i < scene.v.size(); ++i)
    scene.v.data()[i] = 0.3 * std::sin(2.7 * double(i) + 0.1 * double(i % 7));
  scene.dt = tau_of(scene) / 2 / double(steps);
  return scene;
}

constexpr double explained = 0.05;

/// Velocities after the steps, somewhere else [m].
PerParticle3 velocities_at(Trial& trial, PortableScene scene, const Vector3& place) {
  scene.mesh.rest.colwise() += place;
  scene.x.colwise() += place;
  return trial.after(scene, steps).v;
}

/// What dampers did to each particle, over the time [N], and the mean velocities meanwhile.
struct Impulse {
  PerParticle3 force, v;
  double rounding;  // of the force, over its norm [1]
};

/// Particles 0, 8, 16, ... of it are held.
PortableScene rattled_sheet_with_held_particles() {
  PortableScene scene = rattled_sheet();
  for (int i = 0; i < int(scene.x.cols()); i += 8) {
    scene.held.push_back(i);
    scene.v.col(i).setZero();
  }
  return scene;
}

/// The motion with dampers against the one without. Their rounding is measured some metres away,
/// where it is at least four times as coarse. Throws NotOffered where it could explain a failure.
Impulse impulse_of_dampers(Trial& trial, const PortableScene& damped) {
  PortableScene free = damped;
  free.material.stretch_damping = free.material.bending_damping = 0;
  const Vector3 here = Vector3::Zero(), away(2.3, -2.9, 2.7);
  const PerParticle3 with = velocities_at(trial, damped, here),
                     change = with - velocities_at(trial, free, here);
  const PerParticle3 change_away =
      velocities_at(trial, damped, away) - velocities_at(trial, free, away);
  const double rounding = (change_away - change).norm() / change.norm();
  if (!(rounding <= explained))
    throw NotOffered{
        fmt::format("enough digits: rounding may move what dampers do by {:.2g} of it", rounding)};
  const PerParticle3 gained = momentum_velocities(damped, change, trial.declaration());
  return {gained * damped.mass.asDiagonal() / (double(steps) * damped.dt), (damped.v + with) / 2,
          rounding};
}

/// The force of springs on each particle, by the motion of a sheet at rest, displaced so far [N].
PerParticle3 force_of_springs(Trial& trial, PortableScene scene, const PerParticle3& displacement) {
  scene.material.stretch_damping = 0;
  scene.x += displacement;
  scene.v.setZero();
  const PerParticle3 gained =
      momentum_velocities(scene, trial.after(scene, steps).v, trial.declaration());
  return gained * scene.mass.asDiagonal() / (double(steps) * scene.dt);
}

constexpr const char* reason =
    "(omega tau)^2 is 0.4 at most: a first order method errs by a twentieth of half of it over its "
    "10 steps, 1.1 %; the mean velocity by 0.4 %; the shape that velocities have changed, by 1.8 "
    "%; springs are linear to 1 %; and rounding";

Finding edges_damp_as_stiff_as_they_are(Trial& trial, const PortableScene& scene) {
  const Impulse found = impulse_of_dampers(trial, scene);
  const PerParticle3 expected = force_of_springs(trial, scene, tau_of(scene) * found.v);
  Table measured = table_of(
      "force of dampers [N] | of springs, displaced by tau v [N] | "
      "difference [of the force of springs]");
  measured.row(found.force.norm(), expected.norm(),
               (found.force - expected).norm() / expected.norm());
  return judge_worst(measured, explained + 2 * found.rounding, reason);
}

Finding velocities_of_held_do_not_count(Trial& trial) {
  const PortableScene still = rattled_sheet_with_held_particles();
  PortableScene stated = still;
  for (const int i : stated.held) stated.v.col(i) = Vector3(0.4, -0.7, 0.6);
  const PerParticle3 v = trial.after(still, steps).v;
  Table measured = table_of(
      "change of velocities by the motion [m/s] | by what is stated of held ones [m/s] | "
      "difference [of the change]");
  const double change = largest(v - still.v), off = largest(trial.after(stated, steps).v - v);
  measured.row(change, off, off / change);
  return judge_worst(measured, 1e-3, "nothing but rounding may differ");
}

PerParticle3 stated_forces(Trial& trial, const PortableScene& scene, const PerParticle3& v) {
  trial.prepare(scene);
  return trial.solver().damping({scene.x, v}, 0);
}

Finding stated_forces_are_inner_ones(Trial& trial) {
  const PortableScene scene = rattled_sheet();
  const PerParticle3 f = stated_forces(trial, scene, scene.v);
  const Vector3 torque = torque_of(scene.x, f);
  const double scale =
      tau_of(scene) * edge_stiffness(scene).sum() * scene.v.colwise().norm().maxCoeff();
  Table measured{{"of", ""}, {"sum", "of the sum of c |v|, times the size"}};
  measured.row("forces", f.rowwise().sum().norm() / scale);
  measured.row("torques", torque.norm() / (scale * largest(scene.x)));
  constexpr double roundings = 64;  // of a sum over the dampers of six edges a particle
  return judge_worst(measured, roundings * trial.declaration().rounding(), "rounding of a sum");
}

/// Hinges damp as edges do above, in about the same time.
PortableScene rattled_sheet_with_damped_hinges() {
  PortableScene scene = rattled_sheet();
  scene.name = "rattled sheet with damped hinges";
  scene.material.stretch_damping = 0;
  scene.material.bending_damping = drawn("damping of rattled hinges", 4e-4, 5e-4);
  return scene;
}

Finding stated_forces_are_those_of_the_motion(Trial& trial, const PortableScene& scene) {
  const Impulse found = impulse_of_dampers(trial, scene);
  const PerParticle3 f = stated_forces(trial, scene, found.v);
  const auto power = [&](const PerParticle3& force) {
    return (force.array() * found.v.array()).sum();
  };
  Table measured = table_of(
      "power of the stated forces [W] | power in the motion [W] | "
      "difference [of the force in the motion]");
  measured.row(power(f), power(found.force), (found.force - f).norm() / found.force.norm());
  return judge_worst(measured, explained + found.rounding, reason);
}

/// Twelve cells in a row of 1.2 m: half a wave along it takes 0.24 s, the shortest step that keeps
/// an explicit method stable 6 ms.
PortableScene ringing_strip(double step, double tau) {
  PortableScene scene = resting("strip that rings along itself",
                                make_sheet({.pattern = SheetPattern::union_jack,
                                            .width = 1.2,
                                            .height = 0.1,
                                            .columns = 12,
                                            .rows = 1}),
                                {.young = 5});
  scene.material.stretch_damping = tau * scene.material.young;
  scene.dt = step;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.v.col(i) << 0.3 * std::cos(pi * scene.x(0, i) / 1.2), 0, 0;
  return scene;
}

/// What dampers leave of the wave's momentum: with dampers, over that without.
double left_by_dampers(Trial& trial, double step, double tau, double time) {
  const auto wave = [&](double damped) {
    const PortableScene scene = ringing_strip(step, damped);
    const PerParticle3 v = trial.after(scene, std::lround(time / step)).v;
    const double start = kinetic_energy(scene, scene.v);
    if (!(kinetic_energy(scene, v) < 1.02 * start))
      throw NotOffered{fmt::format("steps of {:.2g} s: a strip gains energy in them", step)};
    return (v.cwiseProduct(scene.v) * scene.mass).sum() / 2 / start;
  };
  return wave(tau) / wave(0);
}

/// Steps beyond an explicit method's limit, which solvers may divide: dampers act in every part.
Finding damp_alike_in_long_steps(Trial& trial) {
  Table measured = table_of(
      "tau [s] | left by dampers in steps of 20 ms [1] | in steps of 1 ms [1] | difference [of "
      "what they take]");
  for (const double tau : {0.03, drawn("dampers in long steps", 0.045, 0.055)}) {
    const double lasting = left_by_dampers(trial, 0.02, tau, 0.06),
                 brief = left_by_dampers(trial, 0.001, tau, 0.06);
    measured.row(tau, lasting, brief, std::abs(lasting - brief) / std::abs(1 - brief));
  }
  return judge_worst(measured, 0.25,
                     "a first order method errs by half of what a step of three takes, 10 %, and "
                     "by the phase of the wave");
}

}  // namespace

std::vector<Law> damping_laws() {
  return {
      {"damping.edges-damp-in-proportion-to-their-stiffness",
       "Dampers act on velocities as the springs on displacements: each edge has its share.",
       "protocol: 'stretch_damping'", in_scene(edges_damp_as_stiff_as_they_are, rattled_sheet),
       "damping"},
      {"damping.edges-of-held-particles-damp-as-the-others",
       "Dampers between held particles and free ones act on velocities as the springs there.",
       "protocol: 'stretch_damping', 'held'",
       in_scene(edges_damp_as_stiff_as_they_are, rattled_sheet_with_held_particles),
       "damping held"},
      {"damping.long-steps-damp-as-short-ones",
       "Dampers take as much of a slow wave in steps of 20 ms as in steps of 1 ms.",
       "protocol: 'stretch_damping', 'dt'", damp_alike_in_long_steps, "damping",
       "tau | left by dampers in steps of 20 ms | in steps of 1 ms"},
      {"damping.stated-forces-sum-to-zero",
       "Damping forces of a free sheet sum to zero and exert no torque.", "Newton's third law",
       stated_forces_are_inner_ones, "L2 damping set_state"},
      {"damping.stated-forces-are-those-of-the-motion",
       "The damping forces that level 2 states change the motion by their impulse.",
       "Newton's second law", in_scene(stated_forces_are_those_of_the_motion, rattled_sheet),
       "L2 damping set_state"},
      {"damping.stated-forces-of-hinges-are-those-of-the-motion",
       "The damping forces of hinges that level 2 states change the motion by their impulse.",
       "Newton's second law",
       in_scene(stated_forces_are_those_of_the_motion, rattled_sheet_with_damped_hinges),
       "L2 damping set_state bending"},
      {"damping.stated-velocities-of-held-particles-do-not-count",
       "Dampers see held particles at rest, even if the scene gives them a velocity.",
       "protocol: array 'held'", velocities_of_held_do_not_count, "damping held"},
  };
}

}  // namespace foldproof
