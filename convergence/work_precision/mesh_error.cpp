// mesh-error: what the mesh leaves of the error, beside what the step leaves.

#include "convergence/order.h"
#include "convergence/tables.h"
#include "convergence/work_precision/precision_problem.h"
#include "convergence/study.h"
#include "reference/mesh/shapes.h"

namespace foldproof {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double width = 0.83, height = 0.71;  // m
constexpr double end = 0.15;                   // s
constexpr int coarsest = 4;                    // cells along each side

/// Held along its upper edge, swung by a smooth velocity. Every constant is a property of the
/// cloth, none of the mesh.
Scene swung_sheet(int cells) {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::one_diagonal, width, height, cells, cells}), 0.19);
  scene.integrator = "C";
  scene.gravity = Vector3(0, -9.81, 0);
  scene.stretch = StretchMaterial{47, 0.047, 1};
  scene.bending =
      BendingMaterial{3e-3, 1.5e-6, Weighting::rest, DampingFactor::edge_squared_over_area, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  scene.solver.tolerance = 1e-10;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double a = scene.mesh.rest(0, i) / width, below = 1 - scene.mesh.rest(1, i) / height;
    scene.v.col(i) = Vector3(0.2, 0, 1.1 + 0.5 * std::cos(2.9 * a)) * below * below;
  }
  for (int i = cells * (cells + 1); i < scene.mesh.particles(); ++i)
    scene.prescribed.push_back({i, scene.mesh.rest.col(i), {}});
  return scene;
}

/// One mesh: where the particles of the coarsest mesh end, with a small step and with larger ones.
struct MeshRun {
  int cells;
  double limit;         // the elastic limit, the solver's bound [s]
  PerParticle3 x;       // extrapolated in the step, 3 x N of the coarsest mesh [m]
  double uncertainty;   // of x, by the step: all of the extrapolation's correction [m]
  double time_error;    // at the automatic rule's share of the elastic limit [m]
  double applications;  // of force operators, in that run
  double farthest;      // that any particle got [m]
};

/// The share of the elastic limit that automatic steps take.
double usual_share() { return StepRule{}.safety; }

/// Of the particles of a finer mesh, those of the coarsest.
PerParticle3 shared_particles(const PerParticle3& x, int cells) {
  const int every = cells / coarsest;
  PerParticle3 picked(3, (coarsest + 1) * (coarsest + 1));
  for (int row = 0, k = 0; row <= coarsest; ++row)
    for (int column = 0; column <= coarsest; ++column, ++k)
      picked.col(k) = x.col(every * (row * (cells + 1) + column));
  return picked;
}

MeshRun run_mesh(const Subject& subject, int cells) {
  const Scene scene = swung_sheet(cells);
  MeshRun mesh{cells, elastic_limit(build_system(scene), start_state(scene)), {}, 0, 0, 0, 0};
  const int usual = int(std::ceil(end / (usual_share() * mesh.limit)));
  const PlannedRun coarse = run_planned(subject, scene, {end, usual, infinite, infinite});
  const PlannedRun fine = run_planned(subject, scene, {end, 2 * usual, infinite, infinite});
  const PerParticle3 correction = (fine.last.x - coarse.last.x) / 3;
  mesh.x = shared_particles(fine.last.x + correction, cells);
  mesh.uncertainty = largest_distance(mesh.x, shared_particles(fine.last.x, cells));
  mesh.time_error = largest_distance(mesh.x, shared_particles(coarse.last.x, cells));
  mesh.applications = operator_applications(coarse.work);
  mesh.farthest = fine.farthest;
  return mesh;
}

const std::string difference_column = "difference to half the width";

/// Differences of neighbouring meshes against the coarser one's cells.
Table differences(const std::vector<MeshRun>& meshes) {
  Table table{{"width of a cell", "m"}, {difference_column, "m"}};
  for (size_t i = 0; i + 1 < meshes.size(); ++i)
    table.row(width / meshes[i].cells, largest_distance(meshes[i].x, meshes[i + 1].x));
  return table;
}

Convergence errors_of(const std::vector<MeshRun>& meshes) {
  Convergence result = convergence_of(differences(meshes), difference_column);
  for (size_t i = 0; i + 1 < meshes.size(); ++i)
    result.floor = std::max(result.floor, meshes[i].uncertainty + meshes[i + 1].uncertainty);
  return result;
}

/// Errors of meshes and steps. The error of a mesh follows from its difference to the next finer
/// one and the observed order:
///   e(dx) - e(dx/2) = e(dx) (1 - 2^-order)
Table errors_table(const std::vector<MeshRun>& meshes, const Convergence& differences) {
  const double order = pair_orders(differences).back();
  Table table("cells along a side [1]; error of the mesh [m]; error of the step [m]");
  for (size_t i = 0; i < differences.errors.size(); ++i)
    table.row(meshes[i].cells, differences.errors[i] / (1 - std::pow(2, -order)),
              meshes[i].time_error);
  return table;
}

NamedFinding second_order(const std::vector<MeshRun>& meshes) {
  const Convergence errors = errors_of(meshes);
  const Estimate deviation = order_deviation(errors, 2, 1);
  Table evidence = differences(meshes);
  evidence.add({"order of the pair", "1", row_orders(errors)});
  const Verdict verdict{deviation.value, 0.5, deviation.uncertainty, "1",
                        "midway between the orders one and two; the border, whose springs and "
                        "hinges lack a neighbour, leaves no more on meshes this coarse"};
  return {"mesh-error.order-is-nearer-two-than-one",
          "On the finest meshes tried, positions of a smooth motion converge with an order in the "
          "cells' width that is nearer two than one.",
          {verdict, std::move(evidence),
           "measured is |order - 2| of the last pair, at the particles of the coarsest mesh"}};
}

/// The usual step: the share of the elastic limit that automatic steps take.
NamedFinding step_errs_less(const std::vector<MeshRun>& meshes, const Table& errors) {
  Worst uncertainty;
  for (size_t i = 0; i < errors.rows(); ++i)
    uncertainty.observe(meshes[i].uncertainty / errors.numbers("error of the mesh")[i]);
  const Verdict verdict{
      largest_ratio(errors, "error of the step", "error of the mesh"), 0.1, uncertainty.value(),
      "1", "a tenth: then a shorter step would lessen the whole error by no more than that"};
  return {"mesh-error.usual-step-error-is-below-a-tenth-of-it",
          "With automatic steps, the step's error is less than a tenth of the mesh's.",
          {verdict, errors, "measured is the largest ratio of the two"}};
}

Table balance(const std::vector<MeshRun>& meshes, const Table& errors) {
  Table table(
      "cells along a side [1]; width of a cell [m]; elastic limit [s]; error of the mesh [%]; "
      "error of the step [%]; step's error over the mesh's [1]; step over elastic limit at which "
      "both are equal [1]; operator applications [1]");
  for (size_t i = 0; i < errors.rows(); ++i) {
    const MeshRun& mesh = meshes[i];
    const double space = errors.numbers("error of the mesh")[i];
    table.row(mesh.cells, width / mesh.cells, mesh.limit, 100 * space / mesh.farthest,
              100 * mesh.time_error / mesh.farthest, mesh.time_error / space,
              usual_share() * std::sqrt(space / mesh.time_error), mesh.applications);
  }
  return {"balance",
          "Error of the mesh and of the step (scheme C at half the elastic limit), over the motion",
          table};
}

Figure figure_of(const std::vector<MeshRun>& meshes, const Table& space) {
  const Convergence errors = errors_of(meshes);
  Figure figure{
      "errors",
      "Errors of the mesh and of the step",
      {"width of a cell", "m", Scale::log},
      {"position error", "m", Scale::log},
      2,
      "Largest component at the particles of the coarsest mesh, at the end of the motion. The step "
      "is half the elastic limit of its mesh, so that it shrinks with the cells.",
      {}};
  figure.curves.push_back(
      {"mesh", errors.steps, space.numbers("error of the mesh"), nan, pair_orders(errors)});
  Curve step{"step, half the elastic limit", {}, {}, nan, {}};
  for (const MeshRun& mesh : meshes) step.point(width / mesh.cells, mesh.time_error);
  figure.curves.push_back(std::move(step));
  return figure;
}

StudyResult run_mesh_error(const Subject& subject, Tier tier, const Progress& progress) {
  const int levels = tier == Tier::quick ? 4 : 5;
  std::vector<MeshRun> meshes;
  for (int level = 0; level < levels; ++level) {
    meshes.push_back(run_mesh(subject, coarsest << level));
    progress(std::pow(8, level + 1 - levels));
  }
  const Table errors = errors_table(meshes, errors_of(meshes));
  StudyResult result;
  result.findings = {second_order(meshes), step_errs_less(meshes, errors)};
  result.figures = {figure_of(meshes, errors)};
  result.tables = {balance(meshes, errors)};
  return result;
}

}  // namespace

Study mesh_error_study() {
  return {"mesh-error",
          "On a smoothly swinging sheet a step of C of half the elastic limit errs less than a "
          "tenth as much as the mesh does.",
          {"usual-step-error-is-below-a-tenth-of-it"},
          "ours",
          "How fine should the step be for my mesh? A sheet held along its upper edge swings by a "
          "smooth velocity, on meshes that each halve the cells of the one before. Errors of the "
          "mesh come from neighbouring meshes at the particles that they share, with the step's "
          "error extrapolated away; errors of the step from two steps on one mesh. Where springs "
          "decide the elastic limit it is proportional to the cells' width, so that with second "
          "order in both, the ratio of the two errors is the same on every mesh.",
          run_mesh_error};
}

}  // namespace foldproof
