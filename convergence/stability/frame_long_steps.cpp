// frame-long-steps: implicit methods in steps of a frame, on cloth that crumples.

#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/random.h"
#include "verification/specimens/stepper.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double frame = 1.0 / 30;  // s
constexpr double side = 0.4;        // of the sheet [m]

struct Cloth {
  std::string words;
  double stiffness;  // Y [N/m]
  double damping;    // kd_s [N s/m]
};
constexpr double bending_over_stretch = 1e-6;  // ke over Y [m]

/// A sheet held at two corners; it falls and swings.
Scene falling_sheet(int cells, const Cloth& cloth, double noise) {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::alternating, side, side, cells, cells}), 0.2);
  scene.gravity = Vector3(0, 0, -9.80665);
  scene.stretch = StretchMaterial{cloth.stiffness, cloth.damping, 1};
  add_flat_hinges(scene, bending_over_stretch * cloth.stiffness, 0);
  scene.solver.tolerance = 1e-6;
  Random random(71);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    scene.x(2, i) += noise * random.uniform(-1, 1);
    if (scene.mesh.rest(1, i) < 1e-9 &&
        (scene.mesh.rest(0, i) < 1e-9 || scene.mesh.rest(0, i) > side - 1e-9))
      scene.prescribed.push_back({int(i), scene.x.col(i), Motion{}});
  }
  return scene;
}

double energy_of(const Subject& subject, const Scene& scene, const State& s) {
  const PerParticle3 v = s.v;
  const double kinetic =
      (build_system(scene).mass.transpose().array() * v.colwise().squaredNorm().array()).sum() / 2;
  return kinetic + Probe(subject, scene).energy(s);
}

/// The most that kinetic, elastic and gravitational energy together rise above their start, over
/// what a fall by the sheet's side frees.
double largest_gain(const Subject& subject, const Scene& scene, const char* method, int steps) {
  Stepper stepper(subject, scene, method);
  State s = stepper.start();
  const double start = energy_of(subject, scene, s);
  const double scale = build_system(scene).mass.sum() * 9.80665 * side;
  Worst gain;
  for (int k = 0; k < steps; ++k) {
    s = stepper.step(s, frame);
    gain.observe((energy_of(subject, scene, s) - start) / scale);
  }
  return gain.value();
}

std::vector<Cloth> cloths() {
  return {{"soft", 30, 0},          {"stiff", 3000, 0},          {"very stiff", 3e5, 0},
          {"soft, damped", 30, .1}, {"stiff, damped", 3000, 10}, {"very stiff, damped", 3e5, 1e3}};
}

std::vector<NamedFinding> gains_of_one_solve(const Subject& subject, Tier tier) {
  const int cells = tier == Tier::full ? 20 : 10;
  Table table(
      "cloth; Y [N/m]; kd [N s/m]; step over elastic limit [1]; largest gain of energy [1]");
  for (const Cloth& cloth : cloths()) {
    const Scene scene = falling_sheet(cells, cloth, 1e-3);
    const double limit = elastic_limit(build_system(scene), start_state(scene));
    table.row(cloth.words, cloth.stiffness, cloth.damping, frame / limit,
              largest_gain(subject, scene, "linear-backward-euler", 60));
  }
  double largest = 0;
  for (const double gain : table.numbers("largest gain of energy")) update_worst(largest, gain);
  return {{"frame-long-steps.one-solve-stays-bounded",
           "In steps of a thirtieth of a second, one linear solve a step keeps the energy of a "
           "falling sheet bounded, from soft to nearly inextensible cloth, damped or not.",
           judge_worst(table, "largest gain of energy", 1,
                       "the energy that a fall by the sheet's side sets free: an unstable method "
                       "gains it many times over within sixty steps",
                       "linearised backward Euler with semidefinite elements")},
          {"frame-long-steps.one-solve-adds-energy",
           "In such steps one linear solve a step does add energy to at least one of these sheets, "
           "more than a hundredth of the energy that the fall sets free.",
           {{0.01 / largest, 1, 0, "1",
             "a hundredth is visible; backward Euler solved to convergence only takes energy away"},
            table}}};
}

/// Where the sheet is after a quarter of a second, and what that took.
struct Swing {
  PerParticle3 x;
  Work work;
};

Swing swing(const Subject& subject, const Scene& scene, const char* method, double h,
            double until) {
  Stepper stepper(subject, scene, method);
  const State end = stepper.run(stepper.start(), h, int(std::lround(until / h)));
  return {end.x, stepper.work()};
}

double distance_of(const PerParticle3& a, const PerParticle3& b) {
  return (a - b).norm() / std::sqrt(double(a.cols()));  // root of the mean square [m]
}

/// Errors of one solve and of Newton's method to the end, at equal steps.
NamedFinding one_solve_is_coarser(const Subject& subject) {
  const Scene scene = falling_sheet(10, {"stiff", 300, 0.3}, 1e-3);
  const double until = 8 * frame;
  const PerParticle3 exact = swing(subject, scene, "BDF2", frame / 48, until).x;
  Table table(
      "step [s]; error, one solve [m]; error, iterated [m]; one over the other [1]; iterations, "
      "one solve [1]; iterations, iterated [1]");
  for (const int parts : {1, 2, 4, 8}) {
    const double h = frame / parts;
    const Swing one = swing(subject, scene, "linear-backward-euler", h, until),
                full = swing(subject, scene, "backward-euler", h, until);
    table.row(h, distance_of(one.x, exact), distance_of(full.x, exact),
              distance_of(one.x, exact) / distance_of(full.x, exact), one.work.cg_iterations,
              full.work.cg_iterations);
  }
  const double at_a_frame = table.numbers("one over the other").front();
  return {"frame-long-steps.one-solve-is-less-accurate",
          "In steps of a frame, one linear solve a step has more than twice the error of Newton's "
          "method run to convergence.",
          {{2 / at_a_frame, 1, 0, "1",
            "both are of first order: a factor of two is what halving the step would give"},
           table,
           "a falling sheet of 121 particles, after eight frames, against BDF2 in steps of 1/48 of "
           "a frame"}};
}

/// Work of a solve: iterations times particles, at the same frame rate on finer meshes.
NamedFinding work_grows(const Subject& subject, Tier tier) {
  std::vector<int> cells{8, 16, 32};
  if (tier == Tier::full) cells.push_back(64);
  Table table(
      "particles [1]; iterations a step [1]; iterations times particles [1]; exponent of the pair "
      "[1]");
  double before_work = 0, before_particles = 0, last = nan;
  for (const int n : cells) {
    const Scene scene = falling_sheet(n, {"stiff", 300, 0}, 1e-4);
    const double particles = double(scene.x.cols());
    const Swing done = swing(subject, scene, "linear-backward-euler", frame, 6 * frame);
    const double a_step = double(done.work.cg_iterations) / 6, work = a_step * particles;
    if (before_work > 0)
      last = std::log(work / before_work) / std::log(particles / before_particles);
    table.row(particles, a_step, work, before_work > 0 ? last : nan);
    before_work = work;
    before_particles = particles;
  }
  return {"frame-long-steps.work-grows-with-the-power-of-three-halves",
          "At a fixed frame rate, between the finest two meshes, iterations times particles grow "
          "with the power 3/2 of the number of particles.",
          {{std::abs(last - 1.5), 0.2, 0, "1",
            "iterations grow with the root of the condition number, and that root with the number "
            "of cells along a side, the root of the number of particles: 1 + 1/2; two tenths are "
            "allowed, since these meshes are only at the start of the range in which that holds"},
           table,
           "counted, not timed: a product costs the same for each particle"}};
}

/// Between the coarsest meshes the power is another.
NamedFinding coarse_meshes_differ(const Table& meshes) {
  const double first = meshes.numbers("exponent of the pair").at(1);
  return {
      "frame-long-steps.work-grows-faster-between-coarse-meshes",
      "Between the two coarsest meshes, iterations times particles grow with a power above 3/2.",
      {{1.5 / first, 1, 0, "1", "at 1 the power is 3/2 there, too"},
       meshes,
       "measured is 3/2 over that power; counted, not timed"}};
}

/// Of the motion of a sheet that swings: what is left of its energy, and the price.
NamedFinding bdf2_costs(const Subject& subject) {
  const Scene scene = falling_sheet(10, {"stiff", 300, 0}, 1e-3);
  Table table(
      "step [s]; iterations, backward Euler [1]; iterations, BDF2 [1]; one over the other [1]");
  for (const int parts : {1, 2, 4, 8}) {
    const double h = frame / parts;
    const double euler =
        double(swing(subject, scene, "backward-euler", h, 8 * frame).work.cg_iterations);
    // a two-step method, started by its own first step
    Stepper stepper(subject, scene, "BDF2");
    std::vector<State> past{stepper.start()};
    for (int k = 0; k < 8 * parts; ++k) {
      past.push_back(stepper.step_after(past, h));
      if (past.size() > 2) past.erase(past.begin());
    }
    const double bdf2 = double(stepper.work().cg_iterations);
    table.row(h, euler, bdf2, bdf2 / euler);
  }
  return {"frame-long-steps.bdf2-takes-fewer-iterations",
          "BDF2 takes fewer iterations than backward Euler, at equal steps of a frame or less.",
          judge_worst(table, "one over the other", 1,
                      "its matrix has the step times 2/3 in it and is better conditioned; at 1 "
                      "both cost as much",
                      "all linear iterations of Newton's method, over eight frames")};
}

StudyResult run_frame_long_steps(const Subject& subject, Tier tier, const Progress& progress) {
  StudyResult result;
  result.findings = gains_of_one_solve(subject, tier);
  progress(0.4);
  result.findings.push_back(one_solve_is_coarser(subject));
  progress(0.6);
  const NamedFinding growth = work_grows(subject, tier);
  result.add({growth, coarse_meshes_differ(growth.finding.evidence)});
  progress(0.8);
  result.findings.push_back(bdf2_costs(subject));
  return result;
}

}  // namespace

Study frame_long_steps_study() {
  return {"frame-long-steps",
          "In steps of a frame one linear solve keeps backward Euler bounded, though it may add "
          "energy and errs more than twice as much as Newton's method; the cost grows faster than "
          "the number of particles.",
          {"one-solve-stays-bounded", "one-solve-adds-energy", "one-solve-is-less-accurate",
           "work-grows-with-the-power-of-three-halves"},
          "Baraff and Witkin (1998); Choi and Ko (2002)",
          "A sheet held at two corners falls and swings. Steps are a thirtieth of a second, up to "
          "more than a thousand times the elastic limit.",
          run_frame_long_steps};
}

}  // namespace foldproof
