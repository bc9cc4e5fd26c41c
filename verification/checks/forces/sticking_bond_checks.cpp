// Forming and breaking of bonds, and their storage in the state.
#include <fmt/format.h>
#include <numeric>
#include <set>

#include "reference/dynamics/simulate.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/triangle_distance.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"
#include "verification/specimens/sticking_scenes.h"

namespace foldproof {

namespace {

/// The state with the bonds formed at the start of a step; dt is too short to matter.
State begun(const Subject& subject, const Scene& scene, const State& s) {
  return Stepper(subject, scene, "C").step(s, 1e-12);
}

/// A crumpled lower layer and particles all around it, all of which may stick to it; so may its own
/// corners.
Scene crumpled_layers() {
  Scene scene = scene_at_rest(two_sheets(4, 0.3, 0.02), 0.2);
  Random random(101);
  scene.x += random.vectors(scene.x.cols(), 0.03);
  StickyPatch patch = layer_patch(scene.mesh);
  patch.particles.resize(size_t(scene.x.cols()));
  std::iota(patch.particles.begin(), patch.particles.end(), 0);
  patch.stiffness = 11;
  patch.near = 0.033;
  patch.far = 0.07;
  scene.sticky = {patch};
  return scene;
}

Finding forms_finding(const Subject& subject) {
  const Scene scene = crumpled_layers();
  const StickyPatch& patch = scene.sticky[0];
  const State s = begun(subject, scene, start_state(scene));
  std::set<std::pair<int, int>> found;  // particle and triangle
  Worst off;
  for (const Bond& bond : s.bonds) {
    found.insert({bond.particle, bond.triangle});
    const auto [a, b, c] = patch.triangles[size_t(bond.triangle)];
    const oracles::StuckParticle stuck{scene.x.col(bond.particle),
                                       {{scene.x.col(a), scene.x.col(b), scene.x.col(c)}},
                                       {bond.place},
                                       1,
                                       1};
    off.observe((oracles::sticking_answer(stuck).target - stuck.x).norm() /
                (epsilon * extent(scene.x)));
  }
  double wrong = double(s.bonds.size() - found.size()), several = 0;
  for (int i = 0; i < int(scene.x.cols()); ++i) {
    int count = 0;
    for (int t = 0; t < int(patch.triangles.size()); ++t) {
      const Triangle& corners = patch.triangles[size_t(t)];
      const bool own = std::ranges::find(corners, i) != corners.end();
      const bool near =
          oracles::distance_to_triangles(scene.x, {corners}, scene.x.col(i)).value <= patch.near;
      wrong += (near && !own) != found.contains({i, t});
      count += near && !own;
    }
    several += count > 1;
  }
  Table measured{{"case", ""}, {"wrong pairs, and places in roundings over 1000", "1"}};
  measured.row("pairs of particle and triangle that should stick and do not, or the reverse",
               wrong);
  measured.row("place at formation, in 1000 epsilon of the extent", off.value() / 1000);
  measured.row("few particles with several triangles", several >= 8 ? 0 : NAN);
  return judge_worst(measured, 0.9,
                     "counts are exact; a foot's weights are magnified by the triangles' thinness",
                     fmt::format("{} bonds, {} particles of {} with several.", found.size(),
                                 several, scene.x.cols()));
}

Finding renewal_finding(const Subject& subject) {
  const Scene scene = crumpled_layers();
  Random random(7);
  State s = start_state(scene), twice = s;
  double differ = 0, changes = 0;
  for (int n = 0; n < 12; ++n) {
    const size_t before = s.bonds.size();
    s = begun(subject, scene, s);
    twice = begun(subject, scene, s);
    changes += s.bonds.size() != before;
    differ += std::abs(double(s.bonds.size()) - double(twice.bonds.size()));
    for (size_t k = 0; k < std::min(s.bonds.size(), twice.bonds.size()); ++k)
      differ += s.bonds[k].place != twice.bonds[k].place;
    s.x += random.vectors(s.x.cols(), 0.03);
  }
  Finding finding{{changes >= 6 ? differ : NAN, 0, 0, "bonds that differ",
                   "what has been renewed is as it should be"},
                  {},
                  fmt::format("{} of 12 renewals changed the number of bonds.", changes)};
  return finding;
}

/// A held particle above a palm that moves up and down past it.
Finding again_finding(const Subject& subject) {
  Motion motion;
  motion.amplitude = {0, 0, 0.09};
  motion.frequency = 1.7;
  Scene scene = scene_at_rest(make_hinge(0.1, 0.3), 0.2);
  scene.x.colwise() += Vector3(0, 0, 0.017);
  for (int i = 0; i < 4; ++i) scene.prescribed.push_back({i, scene.x.col(i), Motion{}});
  StickyPatch patch = palm(scene, 1, motion);
  patch.stiffness = 30;
  patch.near = 0.011;
  patch.far = 0.041;
  scene.sticky = {patch};

  Stepper stepper(subject, scene, "B");
  State s = stepper.start();
  // of each particle from its target; NaN while it does not stick
  std::vector<double> offset(4, NAN);
  std::vector<double> made(4, 0);
  double wrong = 0;
  for (int n = 0; n < 3000; ++n) {
    const double level = 0.09 * std::sin(2 * pi * 1.7 * s.time);
    std::vector<char> sticks(4, 0);
    for (size_t i = 0; i < 4; ++i) {
      const double height = scene.x(2, Eigen::Index(i)) - level;
      if (std::abs(height - offset[i]) > patch.far) offset[i] = NAN;
      if (std::isnan(offset[i]) && std::abs(height) <= patch.near) {
        offset[i] = height;
        ++made[i];
      }
      sticks[i] = !std::isnan(offset[i]);
    }
    s = stepper.step(s, 0.0013);
    std::vector<char> found(4, 0);
    for (const Bond& bond : s.bonds) found[size_t(bond.particle)] = 1;
    wrong += found != sticks;
  }
  Table bonds{{"particle", "1"}, {"bonds made in 3.9 s", "1"}};
  for (size_t i = 0; i < 4; ++i) bonds.row(i, made[i]);
  return {{*std::ranges::min_element(made) >= 12 ? wrong : NAN, 0, 0,
           "steps with other bonds than predicted",
           "bonds form within 11 mm and break beyond 41 mm of their target, as the palm's known "
           "height says"},
          bonds};
}

Scene timed_palm() {
  Scene scene = scene_at_rest(make_hinge(0.1, 0.4), 0.2);
  scene.gravity = Vector3(0, 0, -0.3);
  StickyPatch patch = palm(scene, 1, Motion{});
  patch.stiffness = 30;
  patch.forecast_time = 0.01;
  patch.near = 0.2;
  patch.far = 0.3;
  patch.from = 0.07;
  patch.until = 0.23;
  patch.release = 0.06;
  scene.sticky = {patch};
  return scene;
}

Finding timed_finding(const Subject& subject) {
  const Scene scene = timed_palm();
  Table measured{{"case", ""}, {"steps with wrong bonds, or error of the stiffness", "1"}};
  Stepper stepper(subject, scene, "C");
  State s = stepper.start();
  double wrong = 0;
  for (int n = 0; n < 300; ++n) {
    const bool active = s.time >= 0.07 && s.time < 0.23;
    s = stepper.step(s, 0.001);
    wrong += (s.bonds.size() > 0) != active;
  }
  measured.row("bonds exactly from `from` until `until`", wrong);

  const Probe probe(subject, scene);
  State held = start_state(scene);
  held.time = 0.1;
  held = begun(subject, scene, held);
  held.x.col(2) += Vector3(0.02, -0.03, 0.05);
  const auto pull = [&](double t) -> Vector3 {
    held.time = t;
    return probe.elastic(held).col(2) - probe.elastic(start_state(scene)).col(2);
  };
  const double full = pull(0.1).norm();
  for (const double part : {-0.2, 0.0, 0.3, 0.7, 1.0}) {
    const double share = part > 0 ? std::pow(1 - part * part, 2) : 1;
    measured.row(fmt::format("force after {} of the release", part),
                 std::abs(pull(0.17 + 0.06 * part).norm() / full - share) / 1e-12);
  }
  return judge_worst(measured, 0.9,
                     "counts are exact; the force is that of k0 (1 - q^2)^2 to a thousand "
                     "roundings, where q is the elapsed share of `release`");
}

Finding events_finding() {
  Scene scene = timed_palm();
  scene.schedule.end = 0.31;
  scene.schedule.frame_interval = 0.31;
  scene.schedule.step.fixed = 0.0047;
  const System system = build_system(scene);
  std::vector<double> times;
  Observer observer;
  observer.step = [&](const Diagnostics& row) { times.push_back(row.time); };
  simulate(system, integrator_named("C"), start_state(scene), scene.schedule, observer);
  double missed = 0;
  for (const double time : {0.07, 0.17, 0.23}) missed += std::ranges::count(times, time) != 1;
  missed += std::abs(std::ranges::count_if(times, [](double t) { return t > 0.31; }));
  return {{missed, 0, 0, "events that no step ends at",
           "steps end where a patch begins, begins to let go, and ends"},
          {}};
}

Scene sheet_on_a_palm() {
  Scene scene = free_sheet();
  const StickyPatch hand = swinging_palm(scene);
  StickyPatch cloth = hand;
  cloth.place = {};
  cloth.velocity = {};
  cloth.triangles = {scene.mesh.triangles.front(), scene.mesh.triangles.back()};
  cloth.near = 0.2;
  cloth.far = 0.3;
  cloth.stiffness = 7;
  scene.sticky = {hand, cloth};
  return scene;
}

/// Numbers that differ at the end of two runs, one of them stopped after `half` steps and continued
/// from its states alone.
Finding memory_finding(const Subject& subject) {
  constexpr int half = 9;
  constexpr double h = 4e-4;
  Table measured{{"case", ""}, {"numbers that differ", "1"}};
  for (const Integrator& integrator : integrators()) {
    const std::string name(integrator.name);
    const auto continued = [&](std::vector<State> past) {
      Stepper stepper(subject, sheet_on_a_palm(), name);
      for (int n = 0; n < half; ++n) past = {past.back(), stepper.step_after(past, h)};
      return past;
    };
    const std::vector<State> cut = continued({start_state(sheet_on_a_palm())});
    Stepper whole(subject, sheet_on_a_palm(), name);
    std::vector<State> past = {whole.start()};
    for (int n = 0; n < 2 * half; ++n) past = {past.back(), whole.step_after(past, h)};
    const State a = continued(cut).back(), b = past.back();
    measured.row(name + ", cut in two", count_differing_entries(a.x, b.x) +
                                            count_differing_entries(a.v, b.v) +
                                            double(a.bonds.size() != b.bonds.size()));
    std::vector<State> forgetful = cut;
    for (State& s : forgetful) s.bonds = {};
    const State c = continued(forgetful).back();
    measured.row(name + ", forgetting makes a difference",
                 count_differing_entries(c.x, b.x) > 0 ? 0 : 1);
  }
  return judge_worst(measured, 0,
                     "a step is a function of its states: bonds are in them and nowhere else");
}

/// A triangle that rests alone, with particles around it, `distance` away on all six sides.
struct SurroundedParticle {
  StickyPatch patch;
  State state;
};

SurroundedParticle surround(double near, double distance) {
  SurroundedParticle made;
  made.patch.name = "triangle";
  made.patch.triangles = {{0, 1, 2}};
  made.patch.place = [](double) -> PerParticle3 {
    return PerParticle3{{0.13, 0.93, 0.13}, {0.21, 0.21, 1.11}, {0.37, 0.37, 0.37}};
  };
  made.patch.particles = {0, 1, 2, 3, 4, 5};
  made.patch.stiffness = 3.7;
  made.patch.near = near;
  made.patch.far = 0.3 * near;  // a new target is at the particle: distance 0
  made.state =
      resting_state(PerParticle3{{0.13 - distance, 0.93 + distance, 0.35, 0.13, 0.35, 0.35},
                                 {0.41, 0.21, 0.21 - distance, 1.11 + distance, 0.41, 0.41},
                                 {0.37, 0.37, 0.37, 0.37, 0.37 - distance, 0.37 + distance}});
  return made;
}

Finding sides_finding() {
  Table measured{{"case", ""}, {"particles of six that stick wrongly", "1"}};
  for (const double near : {0.051, 0.43})
    for (const double part : {0.4, 0.99, 1.01}) {
      SurroundedParticle made = surround(near, part * near);
      Sticking{{made.patch}}.update_bonds(made.state);
      const double expected = part < 1 ? 6 : 0;
      measured.row(fmt::format("{} of near = {} m", part, near),
                   std::abs(double(made.state.bonds.size()) - expected));
    }
  return judge_worst(measured, 0,
                     "a particle sticks exactly where its distance is at most `near`, on either "
                     "side, however soon bonds break");
}

}  // namespace

std::vector<Check> sticking_bond_checks() {
  const std::string source = "BMF03 section 6";
  return {
      {"sticking.bonds-form-with-every-near-triangle",
       "A particle starts to stick, where it is, to every triangle of a patch within `near`, "
       "except triangles of which it is a corner.",
       source, forms_finding},
      {"sticking.bonds-form-on-every-side",
       "Particles stick to a surface that moves by itself within `near` of it on each of six "
       "sides, and not beyond.",
       source, sides_finding},
      {"sticking.renewing-bonds-twice-changes-nothing",
       "Bonds that were renewed stay as they are when renewed again.",
       "our reading of BMF03 section 6", renewal_finding},
      {"sticking.bonds-break-and-form-again",
       "Bonds form and break as a palm comes and goes, many times, exactly when their distances "
       "say so.",
       source, again_finding},
      {"sticking.patches-follow-their-schedule",
       "A patch is sticky from one time until another, and releases smoothly before the second.",
       source, timed_finding},
      {"sticking.steps-end-at-the-times-of-patches",
       "The reference's steps end where a patch becomes sticky, begins to release, and stops being "
       "sticky.",
       "our reading of BMF03 section 6", events_finding},
      {"sticking.bonds-are-part-of-the-state",
       "For every method: a run resumed from its states ends with the same bits, but not if its "
       "bonds are forgotten.",
       "our reading of BMF03 section 6", memory_finding}};
}

}  // namespace foldproof
