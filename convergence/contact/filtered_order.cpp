// filtered-order: what is left of the order of schemes A, B and C while contact or strain limits
// correct their velocities.

#include "convergence/contact/contact_runs.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr int sheet_cells = 4;
constexpr double sheet_side = 0.3;  // m
/// So short steps that the schemes' own error, of second order, is less than the filters'.
constexpr int coarsest_steps = 256;

/// Scenes that differ a little in how they start: when in a step a filter begins to act is chance.
struct FilteredMotion {
  std::string name, leaves, in_words;
  double end;  // s
  Scene (*scene)(int start);
};

/// The same motion with nothing that corrects its velocities.
Scene unfiltered(Scene scene) {
  scene.objects.clear();
  scene.strain_limits.reset();
  return scene;
}

/// The sheet flutters, falls on a ball, and slides on it.
Scene sheet_on_ball(int start) {
  constexpr double radius = 0.1;
  Scene scene =
      level_sheet(sheet_cells, sheet_side, Vector3(0.013, radius + 0.011 + 0.0017 * start, -0.009));
  scene.solver.tolerance = 1e-11;
  scene.objects = {solid_object("ball", Sphere{radius}, 0.3)};
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double a = scene.mesh.rest(0, i) / sheet_side, b = scene.mesh.rest(1, i) / sheet_side;
    scene.v.col(i) = Vector3(0.1 * std::cos(2.9 * b), 0.5 * std::cos(4.1 * a - 2.2 * b),
                             0.2 * std::sin(3.7 * a));
  }
  return scene;
}

/// The sheet hangs by one edge, on springs so weak that most of them reach their limits.
Scene sheet_at_limits(int start) {
  Scene scene = level_sheet(sheet_cells, sheet_side, Vector3::Zero());
  scene.solver.tolerance = 1e-11;
  scene.x = scene.mesh.rest;
  scene.stretch = StretchMaterial{2 + 0.13 * start, 0.01, 1};
  StrainLimits limits;
  limits.extension = 0.1;
  limits.compression = 0;
  limits.sweeps = 5000;
  limits.tolerance = 1e-9;
  scene.strain_limits = limits;
  for (int i = 0; i < scene.mesh.particles(); ++i)
    if (scene.mesh.rest(1, i) > sheet_side - 1e-9)
      scene.prescribed.push_back({i, scene.mesh.rest.col(i), {}});
  return scene;
}

double root_mean_square(const PerParticle3& u) {
  return std::sqrt(u.colwise().squaredNorm().mean());
}

PerParticle3 end_of(const Subject& subject, const Scene& scene, const std::string& scheme,
                    double end, int steps) {
  Stepper stepper(subject, scene, scheme);
  return stepper.run(stepper.start(), end / steps, steps).x;
}

/// By level, how far the ends of runs with h and h/2 are apart: the geometric mean over the scenes.
Table differences_of(const Subject& subject, const std::vector<Scene>& scenes,
                     const std::string& scheme, double end, int levels) {
  std::vector<double> logarithms(static_cast<size_t>(levels), 0);
  for (const Scene& scene : scenes) {
    PerParticle3 before = end_of(subject, scene, scheme, end, coarsest_steps);
    for (int k = 0; k < levels; ++k) {
      const PerParticle3 next = end_of(subject, scene, scheme, end, coarsest_steps << (k + 1));
      logarithms[size_t(k)] += std::log(root_mean_square(next - before)) / double(scenes.size());
      before = next;
    }
  }
  size_t level = 0;
  return refine({{"step", "s"}, {"difference from half of it", "m"}},
                doubling_range(coarsest_steps, coarsest_steps << (levels - 1)), [&](int steps) {
                  return std::tuple{end / steps, std::exp(logarithms[level++])};
                });
}

NamedFinding order_left(const FilteredMotion& motion, const std::string& scheme,
                        const Table& differences) {
  const double order = fitted_order(convergence_of(differences, "difference from half of it"));
  return {"filtered-order." + motion.leaves + "-no-second-order." + scheme,
          "Scheme " + scheme + " is not of second order while " + motion.in_words + ".",
          {{order, 1.5, 0, "1",
            "halfway between first and second order; a run is shifted by a part of a step that "
            "depends on when in the step a filter begins to act"},
           differences,
           "measured is the order of the line through all levels"}};
}

/// Without its filter the same motion keeps the schemes' order: the filter takes it.
NamedFinding order_without(const Subject& subject, const FilteredMotion& motion, int levels) {
  const std::vector<Scene> scenes = {unfiltered(motion.scene(0))};
  Table orders("scheme [1]; order [1]; |order - 2| [1]");
  for (const Integrator& method : paper_schemes()) {
    const std::string scheme(method.name);
    const Table differences = differences_of(subject, scenes, scheme, motion.end, levels);
    const double order = fitted_order(convergence_of(differences, "difference from half of it"));
    orders.row(scheme, order, std::abs(order - 2));
  }
  return {"filtered-order.second-order-without." + motion.name,
          "Without " + motion.name + " A, B and C are of second order in the same motion.",
          judge_worst(std::move(orders), 0.1, "another order is off by 1",
                      "measured is the largest |order - 2| of the lines through all levels")};
}

StudyResult run_filtered_order(const Subject& subject, Tier tier, const Progress& progress) {
  const std::vector<FilteredMotion> motions = {
      {"contact", "contact-leaves", "the sheet meets a ball", 0.25, sheet_on_ball},
      {"strain-limits", "strain-limits-leave", "strain limits hold the sheet", 0.3,
       sheet_at_limits}};
  const int levels = tier == Tier::quick ? 3 : 5, starts = tier == Tier::quick ? 3 : 8;
  StudyResult result;
  double done = 0;
  for (const FilteredMotion& motion : motions) {
    std::vector<Scene> scenes;
    for (int start = 0; start < starts; ++start) scenes.push_back(motion.scene(start));
    Figure figure{motion.name,
                  "Difference between a run and one of half the step, while " + motion.in_words,
                  {"step", "s", Scale::log},
                  {"root mean square difference at the end", "m", Scale::log},
                  1,
                  "Geometric mean over several starts. Without filters each halving takes three "
                  "quarters of the difference away."};
    for (const Integrator& method : paper_schemes()) {
      const std::string scheme(method.name);
      const Table differences = differences_of(subject, scenes, scheme, motion.end, levels);
      result.findings.push_back(order_left(motion, scheme, differences));
      figure.curves.push_back(curve_of(scheme, differences, "step", "difference from half of it"));
      progress(++done / (3.0 * double(motions.size())));
    }
    result.findings.push_back(order_without(subject, motion, levels));
    result.figures.push_back(std::move(figure));
  }
  return result;
}

}  // namespace

Study filtered_order_study() {
  return {"filtered-order",
          "No scheme of the paper is of second order on a sheet that meets a ball, or on one that "
          "strain limits hold; without ball and limits each is, in the same motions.",
          {"contact-leaves-no-second-order", "strain-limits-leave-no-second-order",
           "second-order-without"},
          "BMF03 section 3",
          "A sheet falls on a ball and slides on it; another hangs on springs that reach their "
          "limits. A contact begins somewhere within a step, but acts from the step's start or "
          "end: that shifts the motion by part of a step, and all that follows errs by first "
          "order. Strain limits, too, stop springs at one end of the step; in the shortest steps "
          "of the full tier their differences no longer fall. By how much is chance, so the "
          "differences are averaged over starts that differ a little.",
          run_filtered_order};
}

}  // namespace foldproof
