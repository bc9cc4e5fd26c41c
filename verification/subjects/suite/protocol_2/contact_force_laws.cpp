// Forces of obstacles that are read back from the solver, against the motion of the cloth.
#include <cmath>

#include "verification/subjects/suite/protocol_2/carriers.h"

namespace foldproof {

namespace {

using namespace suite;

/// Of an `advance`: the state at its end, and the mean forces of the obstacles during it.
struct Reading {
  Snapshot end;
  PerParticle3 forces;
  Vector3 total() const { return forces.rowwise().sum(); }
};

/// The scene goes on by so many steps.
Reading read_after(Trial& trial, const PortableScene& scene, long steps) {
  Reading reading{trial.solver().advance(scene.dt, steps), {}};
  reading.forces = trial.solver().contact_forces();
  return reading;
}

/// It falls onto a slope and slides down.
Finding balance_the_momentum(Trial& trial) {
  PortableScene scene = sheet_on_a_plane({0.6, drawn("way down", 0, 6)}, 0.3);
  scene.name = "sheet thrown onto a slope";
  const Vector3 normal = scene.planes[0].normal, side = normal.unitOrthogonal();
  scene.x.colwise() += 0.003 * normal;
  scene.v.colwise() = 0.4 * side - drawn("speed of landing", 0.25, 0.35) * normal;
  trial.prepare(scene);
  constexpr long steps = 25;
  const double mass = scene.mass.sum(), time = steps * scene.dt;
  Vector3 before = momentum_of(scene, scene.v);
  Table measured = table_of(
      "step [1] | change of momentum [kg m/s] | of it by the forces read [kg m/s] | difference "
      "[of the weight's]");
  for (long k = 1; k <= 6; ++k) {
    const Reading now = read_after(trial, scene, steps);
    const Vector3 after = momentum_of(scene, now.end.v), by_contact = time * now.total();
    const Vector3 rest = after - before - time * mass * scene.gravity - by_contact;
    measured.row(k * steps, (after - before).norm(), by_contact.norm(),
                 rest.norm() / (time * mass * weight));
    before = after;
  }
  return judge_worst(measured, 0.05,
                     "springs and hinges keep the momentum, so that weight and contact alone "
                     "change it; a scheme that states contact a step late errs by a step in 25");
}

/// A flat sheet that falls by 2 mm onto a level plane and lies there; no two masses are alike.
Finding carry_each_particle(Trial& trial) {
  PortableScene scene = sheet_on_a_plane({0, 0}, 0.3);
  scene.x.colwise() += 0.002 * scene.planes[0].normal;
  trial.prepare(scene);
  read_after(trial, scene, 50);
  const Reading now = read_after(trial, scene, 50);
  Table measured =
      table_of("particle [1] | its weight [N] | force read [N] | difference [of the mean weight]");
  const double mean = scene.mass.mean() * weight;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 due = -scene.mass[i] * scene.gravity, read = now.forces.col(i);
    measured.row(int(i), due.norm(), read.norm(), (read - due).norm() / mean);
  }
  return judge_worst(
      measured, 0.05,
      "what rests flat on a plane is carried where it lies: each particle by its own "
      "weight; a twentieth is for jitter and a limp sheet's waves");
}

/// The sheet on each kind of obstacle, on slopes on which it sticks and slides.
Finding keep_to_coulomb_s_law(Trial& trial) {
  Table measured = table_of(
      "obstacle | slope [1] | mu [1] | along the slope [of the weight] | by Coulomb's law [of the "
      "weight] | difference of the force [of the weight]");
  const double heading = drawn("heading of a slope", 0.3, 1.2);
  const Vector3 down(std::cos(heading), std::sin(heading), 0);
  for_each_carrier(trial, [&](const Carrier& carrier) {
    for (const auto& [slope, mu] : {std::pair(0.2, 0.55), {0.5, 0.23}}) {
      PortableScene scene = sheet_on_top("sheet on a slope");
      const double angle = std::atan(slope), across = std::cos(angle), along = std::sin(angle);
      scene.gravity = weight * Vector3(along * down - across * Vector3::UnitZ());
      carrier.put(scene, mu, carrier.standing());
      trial.prepare(scene);
      read_after(trial, scene, 15);
      const Vector3 force =
          read_after(trial, scene, 50).total() / (scene.mass.sum() * scene.gravity.norm());
      const double friction = std::min(along, mu * across);
      measured.row(carrier.capability, slope, mu, -force.dot(down), friction,
                   (force - across * Vector3::UnitZ() + friction * down).norm());
    }
  });
  return judge_worst(measured, 0.05,
                     "the normal force carries the weight's part, and friction takes mu of it or "
                     "what rests needs; the sheet's waves and the ball's curvature leave 2 %");
}

/// A sheet that lies, one that leaves the plane, and one that has not reached it yet.
Finding vanish_apart(Trial& trial) {
  PortableScene lies = sheet_on_a_plane({0, 0}, 0.3), leaves = lies, falls = lies;
  const Vector3 normal = lies.planes[0].normal;
  leaves.name = "sheet thrown off a plane", falls.name = "sheet above a plane";
  leaves.v.colwise() = drawn("speed off the plane", 0.8, 1.2) * normal;
  falls.x.colwise() += 0.2 * normal;
  Table measured = table_of(
      "sheet | when | force read [of the weight] | due [of the weight] | difference [of the "
      "weight]");
  for (const auto& [scene, due] : {std::pair(&lies, 1.0), {&leaves, 0.0}, {&falls, 0.0}}) {
    const auto add = [&, of = scene](const char* when, const PerParticle3& forces, double is_due) {
      const double sum = forces.colwise().norm().sum() / (of->mass.sum() * weight);
      measured.row(of->name, when, sum, is_due, std::abs(sum - is_due));
    };
    trial.prepare(*scene);
    add("before its first step", trial.solver().contact_forces(), 0);
    read_after(trial, *scene, 20);
    add("later", read_after(trial, *scene, 20).forces, due);
  }
  return judge_worst(measured, 0.05,
                     "cloth that is far from every obstacle is pushed by none; the sheet that lies "
                     "shows that forces are read");
}

}  // namespace

std::vector<Law> contact_force_laws() {
  return {
      {"contact-forces.balance-the-momentum",
       "Weight and the forces read from the solver change the momentum of cloth as it changes.",
       "momentum balance", balance_the_momentum, "L1 planes contact_forces",
       "change of momentum | of it by the forces read"},
      {"contact-forces.carry-each-particle",
       "On a level plane the force read at each particle is its weight.", "statics",
       carry_each_particle, "L1 planes contact_forces", "its weight | force read"},
      {"contact-forces.keep-to-coulomb-s-law",
       "On a slope of each obstacle the forces read carry the weight, and have Coulomb's friction.",
       "Coulomb", keep_to_coulomb_s_law, "L1 contact_forces",
       "mu | along the slope | by Coulomb's law"},
      {"contact-forces.vanish-apart",
       "Cloth that has left an obstacle, not reached it, or not moved yet has no force of contact.",
       "protocol", vanish_apart, "L1 planes contact_forces", "force read | due"},
  };
}

}  // namespace foldproof
