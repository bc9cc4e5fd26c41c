// All that a scene may have at once: each part does what it does alone.

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr long steps = 4;

/// A strained, curved sheet that moves, with everything that a scene without obstacles may have.
/// (omega t)^2 is 0.005 after the steps, and dampers take 0.02 of what they act on.
PortableScene whole_sheet() {
  PortableScene scene = moving_sheet();
  scene.name = "sheet with everything at once";
  scene.dt = 5e-5;
  constexpr double tau = 5e-4;  // s
  scene.material.bending_rigidity = drawn("rigidity among all", 0.002, 0.003);
  scene.material.stretch_damping = tau * scene.material.young;
  scene.material.bending_damping = 3 * tau * scene.material.bending_rigidity / 0.1;
  scene.gravity = Vector3(2.3, -3.1, -9.0);
  return scene;
}

struct Part {
  const char* name;
  void (*remove)(PortableScene& scene);
};

constexpr Part parts[] = {
    {"bending", [](PortableScene& scene) { scene.material.bending_rigidity = 0; }},
    {"dampers of edges", [](PortableScene& scene) { scene.material.stretch_damping = 0; }},
    {"dampers of hinges", [](PortableScene& scene) { scene.material.bending_damping = 0; }},
    {"weight", [](PortableScene& scene) { scene.gravity.setZero(); }},
};

/// From 0.8 to 2.4 times as heavy, and some held, where the solver can have that.
PortableScene with_own_particles(PortableScene scene, const Declaration& declared) {
  if (declared.offers("masses")) {
    scene.own_masses = true;
    for (Eigen::Index i = 0; i < scene.mass.size(); ++i)
      scene.mass[i] *= 1.6 + 0.8 * std::sin(1.9 * double(i) + 0.3);
  }
  if (declared.offers("held") && !declared.has_consistent_mass) {
    scene.held = {30, 0, 17, 44};
    for (const int i : scene.held) scene.v.col(i).setZero();
  }
  return scene;
}

/// What the part adds to the momentum of each particle, over the time [N].
PerParticle3 force_of(Trial& trial, const PortableScene& scene, const Part& part) {
  PortableScene without = scene;
  part.remove(without);
  const PerParticle3 gained = momentum_velocities(
      scene, trial.after(scene, steps).v - trial.after(without, steps).v, trial.declaration());
  return gained * scene.mass.asDiagonal() / (double(steps) * scene.dt);
}

Finding each_part_acts_as_alone(Trial& trial) {
  const PortableScene whole = with_own_particles(whole_sheet(), trial.declaration());
  Table measured = table_of(
      "part | its force among all [N] | alone [N] | largest difference on a particle [of the "
      "largest force]");
  for (const Part& part : parts) {
    PortableScene alone = whole_sheet();
    alone.v = whole.v;
    for (const Part& other : parts)
      if (&other != &part) other.remove(alone);
    PerParticle3 among = force_of(trial, whole, part), single = force_of(trial, alone, part);
    if (&part == &parts[3])  // weight: of the mass that the particle has
      single = single * (whole.mass.array() / alone.mass.array()).matrix().asDiagonal();
    for (const int i : whole.held) among.col(i).setZero(), single.col(i).setZero();
    const double most = largest(single);
    // velocities may come from positions of single precision, and from unfinished solves
    const Declaration& declared = trial.declaration();
    const double speed = largest(whole.x) / whole.dt * declared.rounding() +
                         double(steps) * declared.solve_tolerance * largest(whole.v);  // m/s
    const double rounding = speed * whole.mass.maxCoeff() / (double(steps) * whole.dt) / most;
    if (!(rounding < widest_bound)) continue;  // or it does nothing alone: another law's business
    measured.row(part.name, among.norm(), single.norm(),
                 std::max(0.0, largest(among - single) / most - 2 * rounding));
  }
  if (measured.rows() == 0)
    throw CannotTell("what the solver declares allows errors as large as what each part does");
  return judge_worst(
      measured, 0.1,
      "(omega t)^2 is 0.005, and dampers change velocities that others act on by 0.02; "
      "what rounding explains is taken off");
}

/// By `step`, each from the state that the one before gave, against `advance`. One part at a time,
/// and springs that hardly act, so that none hides another.
Finding steps_of_a_state_go_as_advance(Trial& trial) {
  Table measured = table_of(
      "part | change of velocities by advance [m/s] | by steps of a state [m/s] | largest "
      "difference [of the change]");
  for (const Part& part : parts) {
    PortableScene scene = whole_sheet();
    scene.name = fmt::format("sheet with {} alone, by single steps", part.name);
    for (const Part& other : parts)
      if (&other != &part) other.remove(scene);
    scene.material.young = 1e-3;
    for (size_t k = 0; k < scene.mesh.hinges.size(); ++k)
      scene.rest_angles.push_back(0.5 * std::sin(1.3 * double(k)));
    for (Eigen::Index i = 0; i < scene.v.size(); ++i)
      scene.v.data()[i] += 0.3 * std::sin(2.7 * double(i));
    const PerParticle3 advanced = trial.after(scene, steps).v - scene.v;
    trial.prepare(scene);
    Snapshot now{scene.x, scene.v};
    for (long k = 0; k < steps; ++k)
      now = trial.solver().step({now}, {double(k) * scene.dt}, scene.dt);
    const PerParticle3 stepped = now.v - scene.v;
    measured.row(part.name, largest(advanced), largest(stepped),
                 largest(stepped - advanced) / largest(advanced));
  }
  return judge_worst(
      measured, 0.25,
      "a scheme that looks back on several states begins anew in each step, of four");
}

}  // namespace

std::vector<Law> together_laws() {
  return {
      {"together.steps-of-a-state-go-as-advance",
       "Bending, dampers and weight act in steps from given states as they do in `advance`.",
       "protocol: 'step'", steps_of_a_state_go_as_advance, "L1 set_state damping bending",
       "part | change of velocities by advance | by steps of a state"},
      {"together.each-part-acts-as-it-does-alone",
       "Bending, dampers of edges and of hinges, and weight give each particle the same impulse "
       "together, beside held particles and with any masses, as alone.",
       "sum of forces", each_part_acts_as_alone, "f8 damping bending",
       "part | its force among all | alone"},
  };
}

}  // namespace foldproof
