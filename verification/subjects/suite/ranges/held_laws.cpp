// Held particles: which they are, that they stay for seconds, and what is beside them.

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

/// A third of its particles is held, in no order.
PortableScene sheet_held_all_over() {
  PortableScene scene = falling_sheet();
  scene.name = "sheet held all over";
  for (int i = int(scene.x.cols()) - 1; i > 0; i -= 3) scene.held.push_back(i);
  std::swap(scene.held.front(), scene.held.back());
  return scene;
}

bool is_held(const PortableScene& scene, int i) {
  return std::ranges::find(scene.held, i) != scene.held.end();
}

/// At rest in its rest shape all but the weight begins at zero. (omega t)^2 is 0.03. Inertia that
/// neighbours share, as of linear elements, makes those beside held ones faster, by less than half.
Finding neighbours_fall_at_once(Trial& trial) {
  constexpr long steps = 4;
  PortableScene scene = sheet_held_all_over();
  scene.dt = 2e-4;
  if (trial.declaration().offers("masses")) {
    scene.own_masses = true;
    for (Eigen::Index i = 0; i < scene.mass.size(); ++i)
      scene.mass[i] *= 1 + 0.3 * std::sin(2.3 * double(i));
  }
  const PerParticle3 v = trial.after(scene, steps).v;
  const double gained = scene.gravity.norm() * double(steps) * scene.dt;
  Worst slowest, fastest, held;
  for (int i = 0; i < int(v.cols()); ++i) {
    const double speed = -v(2, i) / gained;
    if (is_held(scene, i))
      held.observe(v.col(i).norm() / gained);
    else
      slowest.observe(1 - speed), fastest.observe(speed - 1);
  }
  Table measured = table_of("particles | farthest from g t [g t] | allowed [g t] | over it [1]");
  const double slower = trial.declaration().has_consistent_mass ? 0.35 : 0.2;
  measured.row("slowest free", slowest.value(), slower, slowest.value() / slower);
  measured.row("fastest free", fastest.value(), 0.5, fastest.value() / 0.5);
  measured.row("held", held.value(), 1e-3, held.value() / 1e-3);
  return judge_worst(measured, 1,
                     "in the rest shape no force but weight begins; (omega t)^2 is 0.03; where "
                     "neighbours share inertia, those beside held ones fall up to 1.3 times as "
                     "fast, and the next ones slower, by a quarter where the matrix is consistent");
}

/// Soft, so that steps may be long, with more weight than its springs bear at small strains. All
/// particles, held ones too, have a velocity at the start.
PortableScene sheet_held_for_seconds() {
  PortableScene scene = sheet_of_cells(3);
  scene.name = "sheet held for seconds";
  scene.material.young = 0.6;
  scene.gravity = Vector3(0.3, -0.2, -1.6);
  scene.v.colwise() = Vector3(0.05, 0.08, -0.06);
  scene.held = {13, 0, 3, 8};
  scene.dt = drawn("long held", 0.005, 0.006);
  return scene;
}

/// The same motion in 0.4 of the time, of cloth of 4 kg/m^2 under 6.25 times the gravity: 3.7 N
/// hang from four particles.
PortableScene heavy_sheet_held() {
  PortableScene scene = sheet_held_for_seconds();
  scene.name = "heavy sheet that is held";
  const double heavier = 20, faster = 2.5;
  scene.material.density *= heavier, scene.mass *= heavier;
  scene.material.young *= heavier * faster * faster;
  scene.gravity *= faster * faster;
  scene.v *= faster, scene.dt /= faster;
  return scene;
}

/// Two of the four are inside a box each, one deep and one by a tenth of its size.
PortableScene sheet_held_in_boxes() {
  PortableScene scene = heavy_sheet_held();
  scene.name = "heavy sheet that is held in boxes";
  const Vector3 half(0.02, 0.015, 0.03);
  scene.boxes = {{scene.x.col(scene.held[0]) + 0.1 * half, half, 0.4},
                 {scene.x.col(scene.held[1]) - 0.9 * half.z() * Vector3::UnitZ(), half, 0.4}};
  return scene;
}

Finding all_stay(Trial& trial, const std::vector<PortableScene>& scenes) {
  Table measured = table_of("sheet | time [s] | the others moved by [m] | held ones [roundings]");
  for (const PortableScene& scene : scenes) {
    const std::vector<long> at = multiples(112, 4);
    const std::vector<Snapshot> states = trial.motion(scene, at);
    for (size_t k = 0; k < at.size(); ++k) {
      double most = 0;
      for (const int i : scene.held)
        update_worst(most, (states[k].x.col(i) - scene.x.col(i)).norm());
      const double moved = largest(states[k].x - scene.x);
      if (!(moved > 0.01))
        throw FailedWithoutNumber("the sheet stands still", "a sheet that hangs from what is held");
      measured.row(scene.name, double(at[k]) * scene.dt, moved,
                   most / largest(scene.x) / trial.declaration().rounding());
    }
  }
  return judge_worst(measured, 8, "a few roundings of a position");
}

Finding stay_for_seconds(Trial& trial) {
  return all_stay(trial, {sheet_held_for_seconds(), heavy_sheet_held()});
}

Finding stay_in_boxes(Trial& trial) { return all_stay(trial, {sheet_held_in_boxes()}); }

/// By `step`, each from the state that the one before gave.
Finding stay_in_steps_of_a_state(Trial& trial) {
  PortableScene scene = sheet_held_all_over();
  scene.name = "sheet held all over, by single steps";
  constexpr long steps = 6;
  const PerParticle3 advanced = trial.after(scene, steps).x;
  trial.prepare(scene);
  Snapshot now{scene.x, scene.v};
  for (long k = 0; k < steps; ++k)
    now = trial.solver().step({now}, {double(k) * scene.dt}, scene.dt);
  const double fall = largest(advanced - scene.x);
  Table measured = table_of("particles | farthest from where `advance` takes them [of the fall]");
  Worst held, free;
  for (int i = 0; i < int(now.x.cols()); ++i)
    (is_held(scene, i) ? held : free).observe((now.x - advanced).col(i).norm() / fall);
  measured.row("held", held.value());
  measured.row("free", free.value());
  return judge_worst(measured, 0.2,
                     "a scheme that looks back on several states begins anew in each step, of six");
}

}  // namespace

std::vector<Law> held_laws() {
  return {
      {"held.many-in-any-order-and-no-other",
       "A third of the particles, named in any order, is held; all others begin to fall with g.",
       "protocol: array 'held'; Newton's second law", neighbours_fall_at_once, "held",
       "particles | farthest from g t"},
      {"held.particles-stay-for-seconds",
       "Held particles stay for 2.5 s, and under 3.7 N, even if the scene gives them a velocity.",
       "protocol: array 'held'", stay_for_seconds, "held", "sheet | time | held ones"},
      {"held.particles-stay-inside-boxes",
       "Held particles that are inside a box stay there, and the cloth hangs from them.",
       "protocol: array 'held'", stay_in_boxes, "held boxes", "sheet | time | held ones"},
      {"held.particles-stay-in-steps-of-a-state",
       "Held particles stay, and others fall, in steps from states that are set.",
       "protocol: 'step'", stay_in_steps_of_a_state, "L1 set_state held",
       "particles | farthest from where `advance` takes them"},
  };
}

}  // namespace foldproof
