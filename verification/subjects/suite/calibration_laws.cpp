// What the material's parameters mean: effective moduli in SI, and whether they survive refinement.

#include <optional>

#include "reference/mesh/shapes.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/strips.h"

namespace foldproof {

namespace {

using namespace suite;

// A sheet is strained or bent evenly and let go at rest. Inside, forces balance; so until waves
// come in from the free sides, the momentum of one half grows by the stress across the middle,
// whatever the scheme or the step: Newton's second law for the half. Its angular momentum about the
// middle grows by the bending moment. The mean of opposite strains has no second order.
constexpr double time = 0.006;     // s; waves of 5 m/s come 0.03 m far
constexpr double strain = 0.02;    // 1
constexpr double curvature = 0.5;  // 1/m
constexpr double width = 0.6;      // m
constexpr int usual_columns = 12;

struct Specimen {
  SheetPattern pattern;
  int columns;
};

/// Rows so that cells are squares, or the triangles equilateral.
PortableScene sheet_of(const Specimen& specimen) {
  const bool is_equilateral = specimen.pattern == SheetPattern::equilateral;
  TriangleMesh mesh = make_sheet({.pattern = specimen.pattern,
                                  .width = width,
                                  .height = is_equilateral ? 0 : width,
                                  .columns = specimen.columns,
                                  .rows = specimen.columns});
  mesh.rest.colwise() -= (mesh.rest.rowwise().maxCoeff() / 2).eval();
  return resting(fmt::format("calibration sheet of {} columns", specimen.columns), std::move(mesh),
                 {.young = 5});
}

/// So many that a step is the same share of the largest stable one on each mesh.
long steps_of(const Specimen& specimen) { return specimen.columns / 2; }

Snapshot let_go(Trial& trial, PortableScene scene, const Specimen& specimen) {
  scene.dt = time / double(steps_of(specimen));
  Snapshot end = trial.after(scene, steps_of(specimen));
  end.v = momentum_velocities(scene, end.v, trial.declaration());
  return end;
}

/// Extent along an axis [m].
double extent(const PerParticle3& x, int axis) {
  return x.row(axis).maxCoeff() - x.row(axis).minCoeff();
}

/// Momentum of the half beyond the middle, along `axis`, over minus time and width [N/m].
double stress(const PortableScene& scene, const PerParticle3& v, int axis) {
  double momentum = 0;
  for (Eigen::Index i = 0; i < v.cols(); ++i)
    if (scene.mesh.rest(axis, i) > 0) momentum += scene.mass[i] * v(axis, i);
  const double area = scene.mass.sum() / scene.material.density;
  return -momentum / (time * area / extent(scene.mesh.rest, axis));
}

/// Stresses along x and y over a strain along `axis` [N/m].
Eigen::Vector2d stiffness_row(Trial& trial, const Specimen& specimen, int axis) {
  Eigen::Vector2d row = Eigen::Vector2d::Zero();
  for (const double sign : {1.0, -1.0}) {
    PortableScene scene = sheet_of(specimen);
    scene.x.row(axis) *= 1 + sign * strain;
    const PerParticle3 v = let_go(trial, scene, specimen).v;
    row += sign * Eigen::Vector2d(stress(scene, v, 0), stress(scene, v, 1)) / (2 * strain);
  }
  return row;
}

/// Effective moduli of a sheet in its plane.
struct Moduli {
  double along_x, along_y, poisson;  // Young's [N/m], [N/m]; 1
};

Moduli moduli_of(Trial& trial, const Specimen& specimen) {
  const Eigen::Vector2d x = stiffness_row(trial, specimen, 0),
                        y = stiffness_row(trial, specimen, 1);
  if (!(std::abs(x[0] * y[1]) > 0))
    throw FailedWithoutNumber("a stretched sheet does not pull: no half of it gains momentum",
                              "a stress: lengths beyond those of the rest shape must pull");
  return {x[0] - x[1] * y[0] / y[1], y[1] - x[1] * y[0] / x[0], (x[1] + y[0]) / (2 * y[1])};
}

// The half triangles at both sides are 1/(2 columns) of the area. Springs of k = Y A_e/L0^2 store
// half the sum of Y A (strain of each side)^2: in a half triangle 25/16 of the squared strain along
// y, in an equilateral one 18/16. So they are 39 % stiffer, which is real.
constexpr const char* relaxed =
    "half triangles at the sides are 39 % stiffer, on 1/24 of the area: 1.6 %; the free sides "
    "relax within 0.03 m of the 0.3 m to the middle, a tenth of a ninth: 1.2 %; the square of the "
    "strain, 0.04 %; and what steps of a third of the stable one add (empirical, 2 %)";

Finding modulus_is_the_scene_s(Trial& trial) {
  const Specimen specimen{SheetPattern::equilateral, usual_columns};
  const double young = sheet_of(specimen).material.young;
  const Moduli found = moduli_of(trial, specimen);
  Table measured = table_of(
      "along | Young's modulus [N/m] | Poisson's ratio [1] | "
      "difference from the scene's [of the scene's]");
  for (const auto& [axis, modulus] : {std::pair("x", found.along_x), std::pair("y", found.along_y)})
    measured.row(axis, modulus, found.poisson, std::abs(modulus / young - 1));
  return judge_worst(measured, 0.05, relaxed);
}

/// The larger of both directions' changes [1].
double change_of(const Moduli& fine, const Moduli& coarsest) {
  return std::max(std::abs(fine.along_x / coarsest.along_x - 1),
                  std::abs(fine.along_y / coarsest.along_y - 1));
}

Finding modulus_survives_refinement(Trial& trial) {
  Table measured = table_of(
      "pattern | columns [1] | along x [N/m] | along y [N/m] | Poisson's ratio [1] | "
      "change from the coarsest mesh, x or y [1]");
  for (const auto& [name, pattern] : {std::pair("equilateral", SheetPattern::equilateral),
                                      std::pair("one diagonal", SheetPattern::one_diagonal)}) {
    std::optional<Moduli> coarsest;
    for (const int columns : {4, 8, 12}) {
      const Moduli found = moduli_of(trial, {pattern, columns});
      if (!coarsest) coarsest = found;
      measured.row(name, columns, found.along_x, found.along_y, found.poisson,
                   change_of(found, *coarsest));
    }
  }
  return judge_worst(
      measured, 0.05,
      "an even strain is exact on every mesh, but along y the half triangles at the sides are 39 % "
      "stiffer, on 1/8 of the area of 4 columns and 1/24 of 12: the modulus changes by 3.2 %; "
      "waves and steps, which are much alike on all meshes, add the rest (empirical, 1.8 %)");
}

/// Of a sheet that is stretched along an axis, along it [N/m].
double tension(Trial& trial, const Specimen& specimen, int axis, double stretch) {
  PortableScene scene = sheet_of(specimen);
  scene.x.row(axis) *= 1 + stretch;
  return stress(scene, let_go(trial, scene, specimen).v, axis);
}

Finding tension_grows_with_strain(Trial& trial) {
  const Specimen specimen{SheetPattern::equilateral, usual_columns};
  Table measured = table_of(
      "along | strain [1] | tension [N/m] | "
      "growth since the smaller strain [that up to the first] | short of it by [1]");
  for (const auto& [name, axis] : {std::pair("x", 0), {"y", 1}})
    for (const std::vector<double>& strains :
         {std::vector{0.02, 0.05, 0.1, 0.2, 0.3}, {-0.02, -0.05, -0.1, -0.2}}) {
      double last = 0, before = 0, first_slope = 0;
      for (const double stretch : strains) {
        const double now = tension(trial, specimen, axis, stretch);
        const double slope = (now - before) / (stretch - last);
        if (last == 0) first_slope = slope;
        measured.row(name, stretch, now, slope / first_slope, 1 - slope / first_slope);
        last = stretch, before = now;
      }
    }
  return judge_worst(measured, "short of it by", 0.5,
                     "linear springs grow by as much; a rubber of that Young's modulus, held at "
                     "its width, by 0.57 of it from 20 to 30 %: its tension is Y (l - l^-3)/3; St. "
                     "Venant and Kirchhoff's law by 0.6 from -10 to -20 %");
}

/// Twice as much as St. Venant and Kirchhoff's law adds at 30 %; springs add none.
Finding tension_does_not_jump(Trial& trial) {
  const Specimen specimen{SheetPattern::equilateral, usual_columns};
  Table measured = table_of(
      "along | strain [1] | tension [N/m] | growth since the smaller strain [that up to the "
      "first]");
  for (const auto& [name, axis] : {std::pair("x", 0), {"y", 1}}) {
    double last = 0, before = 0, first_slope = 0;
    for (const double stretch : {0.03, 0.08, drawn("strain beyond 10 %", 0.11, 0.14), 0.33}) {
      const double now = tension(trial, specimen, axis, stretch);
      const double slope = (now - before) / (stretch - last);
      if (last == 0) first_slope = slope;
      measured.row(name, stretch, now, slope / first_slope);
      last = stretch, before = now;
    }
  }
  return judge_worst(measured, 3,
                     "of a sheet held at its width, springs grow by as much, and St. Venant and "
                     "Kirchhoff's law, Y (l^3 - l)/2, by 1.9 times as much at 33 %");
}

/// Cells of criss-cross are those of two diagonals, turned by 45 degrees. Springs of the protocol's
/// stiffness make them 3/4 of Y along their hypotenuses, what is isotropic makes them Y.
Finding modulus_along_hypotenuses(Trial& trial) {
  const Specimen specimen{SheetPattern::criss_cross, usual_columns};
  const double young = sheet_of(specimen).material.young;
  const Moduli found = moduli_of(trial, specimen);
  Table measured = table_of(
      "along | Young's modulus [N/m] | at least [N/m] | at most [N/m] | beyond them [of Y]");
  for (const auto& [axis, modulus] : {std::pair("x", found.along_x), {"y", found.along_y}})
    measured.row(axis, modulus, 0.75 * young, young,
                 std::max({0.0, 0.75 - modulus / young, modulus / young - 1}));
  return judge_worst(measured, 0.05,
                     "3/4 by springs of Y A/L^2, 1 of an isotropic sheet; the free "
                     "sides relax, and waves and steps add the rest, as in the law of the modulus");
}

PortableScene bent(const Specimen& specimen, int axis, double by) {
  PortableScene scene = sheet_of(specimen);
  scene.material.bending_rigidity = 1e-3;
  scene.name += ", bent";
  bend(scene, axis, by);
  return scene;
}

/// Against bending along an axis [N m].
double rigidity_of(Trial& trial, const Specimen& specimen, int axis) {
  return beyond_rounding(trial, "a bent sheet's rigidity [N m]", 0.05, [&](const Vector3& away) {
    double moment = 0;  // N, per width
    for (const double sign : {1.0, -1.0}) {
      PortableScene scene = bent(specimen, axis, sign * curvature);
      scene.x.colwise() += away;
      const PerParticle3 v = let_go(trial, scene, specimen).v;
      moment += sign * angular_momentum(scene, v, axis, 0, away) /
                (2 * time * extent(scene.mesh.rest, 1 - axis));
    }
    return moment / curvature;
  });
}

Finding rigidity_is_the_scene_s(Trial& trial) {
  Table measured = table_of(
      "along | columns [1] | bending rigidity [N m] | "
      "difference from the scene's [of the scene's]");
  for (const auto& [name, axis] : {std::pair("x", 0), {"y", 1}})
    for (const int columns : {8, 12}) {
      const Specimen specimen{SheetPattern::equilateral, columns};
      const double given = bent(specimen, axis, 1).material.bending_rigidity,
                   rigidity = rigidity_of(trial, specimen, axis);
      measured.row(name, columns, rigidity, std::abs(rigidity / given - 1));
    }
  return judge_worst(measured, 0.05,
                     "boundary edges carry no hinges: a ninth of the energy over the rows, 1.4 % "
                     "at 8; and what waves and steps add, as in the law of the modulus");
}

Finding rigidity_survives_refinement(Trial& trial) {
  Table measured = table_of(
      "pattern | along | columns [1] | bending rigidity [N m] | "
      "change from the coarsest mesh [1]");
  for (const auto& [pattern_name, pattern] :
       {std::pair("equilateral", SheetPattern::equilateral),
        std::pair("one diagonal", SheetPattern::one_diagonal)})
    for (const auto& [axis_name, axis] : {std::pair("x", 0), {"y", 1}}) {
      double coarsest = 0;
      for (const int columns : {4, 8, 12}) {
        const double rigidity = rigidity_of(trial, {pattern, columns}, axis);
        if (columns == 4) coarsest = rigidity;
        measured.row(pattern_name, axis_name, columns, rigidity, std::abs(rigidity / coarsest - 1));
      }
    }
  return judge_worst(
      measured, 0.05,
      "an even curvature is exact on every mesh but for edges at its sides, which bear no hinges; "
      "waves and steps, which are much alike on all meshes, add the rest (empirical, 4 %)");
}

}  // namespace

std::vector<Law> calibration_laws() {
  return {
      {"calibration.young-s-modulus-is-the-scene-s",
       "On equilateral meshes the effective Young's modulus is the scene's.",
       "Newton's second law of half a strained sheet", modulus_is_the_scene_s, "",
       "along | Young's modulus"},
      {"calibration.modulus-survives-refinement",
       "The effective Young's modulus, along x and along y, does not depend on the mesh's "
       "resolution.",
       "Newton's second law of half a strained sheet", modulus_survives_refinement},
      {"calibration.tension-grows-with-strain",
       "Up to a strain of 30 %, and down to -20 % in its plane, a sheet's tension goes on growing.",
       "Newton's second law of half a strained sheet", tension_grows_with_strain},
      {"calibration.tension-does-not-jump-with-strain",
       "Up to a strain of 33 %, a sheet stiffens by no more than the elastic laws in use.",
       "Newton's second law of half a strained sheet", tension_does_not_jump, "",
       "along | strain | growth since the smaller strain"},
      {"calibration.modulus-along-hypotenuses",
       "Along the hypotenuses of right-angled triangles, Young's modulus is that of the protocol's "
       "springs, of an isotropic sheet, or between them.",
       "Newton's second law of half a strained sheet", modulus_along_hypotenuses, "",
       "along | Young's modulus"},
      {"calibration.bending-rigidity-is-the-scene-s",
       "On equilateral meshes the effective bending rigidity is the scene's.",
       "Newton's second law of half a bent sheet", rigidity_is_the_scene_s, "bending",
       "bending rigidity"},
      {"calibration.rigidity-survives-refinement",
       "The effective bending rigidity, along x and along y, does not depend on the mesh's "
       "resolution.",
       "Newton's second law of half a bent sheet", rigidity_survives_refinement, "bending"},
  };
}

}  // namespace foldproof
