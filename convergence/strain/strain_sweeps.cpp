// strain-sweeps: how fast the orders of strain limiting find velocities within the limits, on finer
// and finer meshes.

#include "convergence/study.h"
#include "reference/dynamics/system.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/strain_scenes.h"

namespace foldproof {

namespace {

// violation over the rest length at which sweeps are counted [1]
constexpr double tolerance = 1e-3;
constexpr double fall = 0.08;  // of the sheet's height, in one step [1]

/// A square sheet of n x n cells, at rest, held along its upper edge, when all below has been given
/// the velocity that takes it down by 8 % of its height in a step: within limits of 10 % it can
/// come down nearly so far, but every row has to learn it. Mirror-symmetric in x.
struct JerkedSheet {
  int cells;
  Scene scene;
  System system;
  PerParticle3 v;
  double step = 0.01;  // s

  StrainLimiter limiter(SweepOrder order, int sweeps) const {
    StrainLimits limits;
    limits.order = order;
    limits.sweeps = sweeps;
    limits.tolerance = tolerance;
    return make_strain_limiter(limits, std::get<StretchSprings>(system.forces.front()).springs,
                               system.inverse_mass);
  }
};

JerkedSheet jerked_sheet(int cells) {
  JerkedSheet sheet{cells,
                    scene_at_rest(make_sheet({SheetPattern::union_jack, 1, 1, cells, cells}), 0.2),
                    {},
                    {}};
  sheet.scene.stretch = StretchMaterial{10, 0, 1};
  for (int i = 0; i <= cells; ++i) {
    const int top = cells * (cells + 1) + i;
    sheet.scene.prescribed.push_back({top, sheet.scene.x.col(top), Motion{}});
  }
  sheet.system = build_system(sheet.scene);
  sheet.v = PerParticle3::Zero(3, sheet.scene.x.cols());
  for (Eigen::Index i = 0; i < sheet.v.cols(); ++i)
    if (sheet.system.inverse_mass[i] > 0) sheet.v(1, i) = -fall / sheet.step;
  return sheet;
}

/// The sheet's velocities after at most `sweeps` sweeps.
struct Swept {
  PerParticle3 v;
  StrainSweeps done;
};

Swept swept(const JerkedSheet& sheet, SweepOrder order, int sweeps) {
  Swept result{sheet.v, {}};
  result.done = limit_strain(sheet.limiter(order, sweeps), sheet.step, sheet.scene.x, result.v);
  return result;
}

/// How much less is left in x than its mirror image has, at most, over the largest correction [1].
double asymmetry(const JerkedSheet& sheet, const PerParticle3& v) {
  const int row = sheet.cells + 1;
  Worst worst;
  for (Eigen::Index i = 0; i < v.cols(); ++i) {
    const Eigen::Index mirror_finding = i / row * row + sheet.cells - i % row;
    worst.observe(
        (v.col(i) - Vector3(-v(0, mirror_finding), v(1, mirror_finding), v(2, mirror_finding)))
            .norm());
  }
  return worst.value() / largest_difference(v, sheet.v);
}

double kinetic(const JerkedSheet& sheet, const PerParticle3& v) {
  return energies(sheet.system, {0, sheet.scene.x, v}).kinetic;
}

/// One order of sweeps on all meshes, coarse to fine.
Table refined(const NamedOrder& order, const std::vector<int>& meshes) {
  return refine({{"cells along a side", "1"},
                 {"sweeps", "1"},
                 {"kinetic energy left", "of what there was"},
                 {"asymmetry", "of the largest correction"}},
                meshes, [&](int cells) {
                  const JerkedSheet sheet = jerked_sheet(cells);
                  const Swept all = swept(sheet, order.order, 1'000'000);
                  return std::tuple{cells, all.done.sweeps,
                                    kinetic(sheet, all.v) / kinetic(sheet, sheet.v),
                                    asymmetry(sheet, all.v)};
                });
}

NamedFinding growth(const std::string& order, const Table& row) {
  std::vector<double> widths;
  for (const double cells : row.numbers("cells along a side")) widths.push_back(1 / cells);
  const double exponent = -pair_orders({widths, row.numbers("sweeps"), 0}).back();
  return {"strain-sweeps.grow-quadratically." + order,
          "In the order '" + order +
              "' the number of sweeps that find velocities within the limits grows as the square "
              "of the number of cells along a side.",
          {{std::abs(exponent - 2), 0.1, 0, "1",
            "near the limits a sweep is one iteration for a Poisson equation, in which a "
            "correction spreads like heat, over n cells in n^2 sweeps; another power is off by 1, "
            "and a tenth is what an order is allowed elsewhere"},
           row,
           "measured is |exponent - 2| between the two finest meshes"}};
}

NamedFinding mirror_finding(const Table& row) {
  return {"strain-sweeps.jacobi-is-mirror-symmetric",
          "Sweeps that correct all springs from the same velocities turn a mirror-symmetric motion "
          "into a mirror-symmetric one.",
          {{row.worst("asymmetry") / epsilon, 64, 0, "epsilon of the largest correction",
            "the two sides differ only in the order in which a particle's impulses are added, and "
            "the limits damp its rounding errors from sweep to sweep"},
           row}};
}

/// One order and its sweeps on all meshes.
struct Row {
  std::string order;
  Table sweeps;
};

NamedFinding bias_finding(const std::vector<Row>& rows) {
  Worst worst;
  Table coarsest{{"order", ""}, {"asymmetry", "of the largest correction"}};
  for (const Row& row : rows) {
    if (row.order == "jacobi") continue;
    coarsest.row(row.order, row.sweeps.numbers("asymmetry").front());
    worst.observe(0.01 / row.sweeps.numbers("asymmetry").front());
  }
  return {"strain-sweeps.sequential-sweeps-break-mirror-symmetry",
          "Sweeps that correct springs one after the other break mirror symmetry, even if their "
          "direction alternates.",
          {{worst.value(), 1, 0, "1",
            "measured is a hundredth of the largest correction over the asymmetry, on the coarsest "
            "mesh: the asymmetry exceeds a hundredth"},
           coarsest,
           "Many velocities satisfy the limits; the order of the springs decides which is found."}};
}

Table of_all_orders(const std::vector<Row>& rows) {
  std::vector<std::pair<std::string, Table>> groups;
  for (const Row& row : rows) groups.emplace_back(row.order, row.sweeps);
  return stacked({"order", ""}, groups);
}

NamedFinding energy(const std::vector<Row>& rows) {
  Worst worst;
  for (const Row& row : rows) worst.observe(row.sweeps.worst("kinetic energy left"));
  return {"strain-sweeps.kinetic-energy-decreases",
          "Limiting the strain of a sheet that moves away from rest removes kinetic energy, in "
          "every order.",
          {{worst.value(), 1, 0, "of what there was",
            "springs start within their limits, and each impulse only removes relative motion "
            "beyond them"},
           of_all_orders(rows)}};
}

/// What mirror symmetry costs: the fewest sweeps of all springs at once over the most of another
/// order, mesh by mesh.
NamedFinding jacobi_is_dearer(const std::vector<Row>& rows) {
  const std::vector<double>& cells = rows.front().sweeps.numbers("cells along a side");
  Table ratios(
      "cells along a side [1]; sweeps of all springs at once [1]; most of another order [1]; three "
      "over their ratio [1]");
  for (size_t k = 0; k < cells.size(); ++k) {
    double at_once = nan, most = 0;
    for (const Row& row : rows) {
      const double sweeps = row.sweeps.numbers("sweeps")[k];
      if (row.order == "jacobi")
        at_once = sweeps;
      else
        most = std::max(most, sweeps);
    }
    ratios.row(cells[k], at_once, most, 3 * most / at_once);
  }
  return {"strain-sweeps.jacobi-needs-more-than-three-times-as-many",
          "Correcting all springs at once takes more than three times as many sweeps as any other "
          "order.",
          judge_worst(ratios, 1, "three: the factor that the study's headline names")};
}

Curve residuals(const NamedOrder& order, int cells) {
  const JerkedSheet sheet = jerked_sheet(cells);
  Curve curve{order.name};
  for (int sweeps = 1;; sweeps *= 2) {
    const StrainSweeps done = swept(sheet, order.order, sweeps).done;
    curve.point(done.sweeps, done.remaining_violation);
    if (!(done.remaining_violation > tolerance)) return curve;
  }
}

Table table_of(const std::vector<Row>& rows) {
  return {"orders", "Sweeps until no violation exceeds a thousandth", of_all_orders(rows)};
}

/// Springs that are beyond their limits at the start are brought back in one step, however many
/// sweeps that takes.
Table recovery_table() {
  Table table(
      "length over rest length [1]; kinetic energy given [J]; elastic energy of the stretch [J]; "
      "sweeps [1]");
  const JerkedSheet sheet = jerked_sheet(12);
  StrainLimiter free = sheet.limiter(SweepOrder::gauss_seidel, 10'000);
  free.inverse_mass = sheet.system.mass.cwiseInverse();
  for (const double stretch : {1.05, 1.12, 1.2, 1.4}) {
    const State stretched{0, stretch * sheet.scene.x, PerParticle3::Zero(3, sheet.v.cols())};
    PerParticle3 v = stretched.v;
    const int sweeps = limit_strain(free, sheet.step, stretched.x, v).sweeps;
    table.row(stretch, energies(sheet.system, {0, stretched.x, v}).kinetic,
              energies(sheet.system, stretched).stretch, sweeps);
  }
  return {"brought-back",
          "Kinetic energy that limits of +10 % give to a free sheet at rest, stretched in all "
          "directions",
          table};
}

StudyResult run_strain_sweeps(const Subject&, Tier tier, const Progress& progress) {
  std::vector<int> meshes = {6, 12, 24};
  if (tier == Tier::full) meshes.push_back(48);
  StudyResult result;
  Figure figure{"residual",
                "Largest violation of a limit against sweeps",
                {"sweeps", "1", Scale::log},
                {"violation left, over the rest length", "1", Scale::log},
                "A sheet of 12 x 12 cells, held along its upper edge, falls by 8 % of its height "
                "in a step; limits are +10 % and 0 %."};
  std::vector<Row> rows;
  for (const NamedOrder& order : sweep_orders()) {
    rows.push_back({order.name, refined(order, meshes)});
    const Table& row = rows.back().sweeps;
    result.findings.push_back(growth(order.name, row));
    if (order.order == SweepOrder::jacobi) result.findings.push_back(mirror_finding(row));
    figure.curves.push_back(residuals(order, 12));
    progress(double(rows.size()) / double(sweep_orders().size()));
  }
  result.add({bias_finding(rows), jacobi_is_dearer(rows), energy(rows)});
  result.figures.push_back(std::move(figure));
  result.tables = {table_of(rows), recovery_table()};
  return result;
}

}  // namespace

Study strain_sweeps_study() {
  return {"strain-sweeps",
          "The number of strain-limiting sweeps grows nearly as the square of the number of cells "
          "along a side, in every order; only sweeps that correct all springs at once keep mirror "
          "symmetry, and more than three times as many of them are needed.",
          {"grow-quadratically", "jacobi-is-mirror-symmetric",
           "sequential-sweeps-break-mirror-symmetry", "jacobi-needs-more-than-three-times-as-many"},
          "BMF03 section 3, after Provot 1995",
          "A square sheet at rest is held along its upper edge. All particles below it get the "
          "velocity that lowers them by 8 % of the sheet's height in a step. Limits of 10 % allow "
          "nearly that much, but only if every row takes its share: corrections must travel from "
          "the edge to the hem and back, at best one cell a sweep. Springs are corrected in the "
          "order of the particles, alternately forwards and backwards, colour by colour, or all at "
          "once; sweeps are counted until no violation exceeds a thousandth of a rest length. The "
          "sweeps are the reference's own.",
          run_strain_sweeps};
}

}  // namespace foldproof
