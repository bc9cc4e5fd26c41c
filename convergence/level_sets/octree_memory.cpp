// octree-memory: what an octree saves against a regular grid of the same error.
#include <memory>
#include <random>

#include "convergence/study.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/level_set/octree.h"
#include "reference/level_set/octree_nodes.h"
#include "reference/mesh/shapes.h"
#include "verification/processor_time.h"
#include "verification/seeds.h"

namespace foldproof {

namespace {

constexpr double band_cells = 3;  // of the grid, to each side of the surface

struct Body {
  std::string name;
  DistanceFunction distance;
  int coarsest, quick, full;  // levels: the first, and the finest in each tier
};

Body statue() {
  const TriangleMesh mesh = make_statue(1, 3);
  const Vector3 low = mesh.rest.rowwise().minCoeff(), high = mesh.rest.rowwise().maxCoeff();
  const PerParticle3 x =
      0.82 / (high - low).maxCoeff() * (mesh.rest.colwise() - 0.5 * (low + high));
  const auto distance = std::make_shared<MeshDistance>(make_mesh_distance(x, mesh.triangles));
  return {"statue", [distance](const Vector3& p) { return distance->at(p); }, 7, 8, 9};
}

std::vector<Body> bodies() {
  return {{"sphere", [](const Vector3& p) { return Sphere{0.37}.at(p); }, 5, 7, 9},
          {"torus",
           [](const Vector3& p) {
             return Torus{0.29, 0.11}.at(p);
           },
           5, 7, 9},
          {"box",
           [](const Vector3& p) {
             return Box{{0.31, 0.27, 0.23}}.at(p);
           },
           6, 8, 9},
          statue()};
}

/// Points within the band: from random ones down to the surface and out again along N.
std::vector<Vector3> points_in_band(const Body& body, double band) {
  std::mt19937 random(shifted_seed(60013));
  std::uniform_real_distribution<double> along(-0.5, 0.5), height(-band, band);
  std::vector<Vector3> points;
  while (points.size() < 8000) {
    const double x = along(random), y = along(random), z = along(random), up = height(random);
    const Distance at = body.distance({x, y, z});
    const Vector3 p = Vector3(x, y, z) - (at.phi - up) * at.normal;
    if (p.cwiseAbs().maxCoeff() < 0.5 && std::abs(body.distance(p).phi) <= band)
      points.push_back(p);
  }
  return points;
}

/// Largest miss [m] of the trilinear interpolant on a regular grid of 2^level cells along each axis
/// of the cube; only the cells about the points are made.
double grid_miss(const Body& body, const std::vector<Vector3>& points, int level) {
  const double cells = std::ldexp(1, level);
  Worst worst;
  for (const Vector3& p : points) {
    const Vector3 q = (p + Vector3::Constant(0.5)) * cells;
    const Vector3 cell = q.array().floor();
    BranchNodes<double> nodes{};
    for (int k = 0; k < 8; ++k) {
      const Vector3 node = cell + Vector3(k & 1, k >> 1 & 1, k >> 2);
      nodes[corner_steps[k]] = body.distance(node / cells - Vector3::Constant(0.5)).phi;
    }
    worst.observe(std::abs(trilinear(nodes, 0, q - cell).value - body.distance(p).phi));
  }
  return worst.value();
}

double tree_miss(const Body& body, const std::vector<Vector3>& points, const Octree& tree) {
  Worst worst;
  for (const Vector3& p : points) worst.observe(std::abs(tree.at(p).phi - body.distance(p).phi));
  return worst.value();
}

struct Balance {
  std::string body;
  int level;
  double grid_bytes, tree_bytes, grid_miss, tree_miss, tolerance, evaluations, seconds;
};

/// The first of a row of ever smaller tolerances with which the tree misses by no more than the
/// grid. The band is wider by the diagonal of a cell, so that what hangs from coarser cells
/// lies outside of it.
Balance balance_of(const Body& body, int level) {
  const double h = std::ldexp(1, -level), band = band_cells * h;
  const std::vector<Vector3> points = points_in_band(body, band);
  Balance balance{
      body.name, level, 8 * std::pow(1 / h + 1, 3), 0, grid_miss(body, points, level), nan, 0,
      0,         0};
  for (const double share : {1.05, 0.85, 0.6, 0.42, 0.3}) {
    const double start = processor_seconds();
    const Octree tree = make_octree(
        {body.distance}, {Vector3::Constant(-0.5), 1, level + 1, 3, share * balance.grid_miss,
                          band + std::sqrt(3.0) * h, 0.25, 0, HangingNodes::constrained});
    balance.seconds = processor_seconds() - start;
    balance.tree_bytes = double(bytes(tree));
    balance.tree_miss = tree_miss(body, points, tree);
    balance.tolerance = share * balance.grid_miss;
    balance.evaluations = double(tree.evaluations);
    if (balance.tree_miss <= balance.grid_miss) return balance;
  }
  balance.tree_bytes = nan;  // none of them
  return balance;
}

double share_of_grid(const Balance& balance) { return balance.tree_bytes / balance.grid_bytes; }

Table evidence_of(const std::vector<Balance>& all, const std::string& body) {
  Table table(
      "cells of the grid along each axis [1]; memory over the grid's [1]; miss of the grid [m]; "
      "miss of the octree [m]");
  for (const Balance& b : all)
    if (b.body == body)
      table.row(std::ldexp(1, b.level), share_of_grid(b), b.grid_miss, b.tree_miss);
  return table;
}

NamedFinding takes_a_tenth(const std::vector<Balance>& all) {
  constexpr int from_here_on = 8;  // level
  Worst worst;
  for (const Balance& b : all)
    if (b.body == "statue" && b.level >= from_here_on) worst.observe(share_of_grid(b));
  return {"octree-memory.bumpy-body-takes-a-tenth",
          "On a bumpy body the octree takes a tenth of the memory of the grid with the same error, "
          "or less, from 256 cells along each axis on.",
          {{worst.value(), 0.1, 0, "1",
            "a tenth: what is asked of it at 512 cells along each axis, where the full tier "
            "measures; the quick tier stops at 256, where less is saved"},
           evidence_of(all, "statue"),
           "errors are the largest within three cells of the surface, at the same points for both; "
           "on coarser grids more than a tenth may be left"}};
}

NamedFinding even_curve_takes_more(const std::vector<Balance>& all) {
  Worst worst;
  for (const Balance& b : all)
    if (b.body == "sphere") worst.observe(0.1 / share_of_grid(b));
  return {"octree-memory.sphere-takes-more-than-a-tenth",
          "On a sphere, which is equally curved everywhere, the octree takes more than a tenth of "
          "the grid's memory, on every grid tried.",
          {{worst.value(), 1, 0, "1",
            "measured is a tenth over the share: below 1 the share is larger. The band's cells "
            "must all be as small as the grid's, and a leaf takes the memory of four nodes"},
           evidence_of(all, "sphere")}};
}

NamedFinding uneven_bodies_save(const std::vector<Balance>& all) {
  Table shares("body; cells of the grid along each axis [1]; octree over grid [1]");
  for (const Balance& b : all)
    if (b.body == "box" || b.body == "statue")
      shares.row(b.body, std::ldexp(1, b.level), share_of_grid(b));
  return {"octree-memory.saves-on-boxes-and-bumpy-bodies",
          "On a box and on a bumpy body the octree takes less memory than the grid, on every grid "
          "tried.",
          judge_worst(shares, 1, "the grid's memory: beyond it nothing is saved")};
}

/// A sphere and a torus: less memory from 128 cells on, more at 64. (The torus saves at 32, too,
/// where the grid misses by a large part of its tube.)
NamedFinding even_bodies_save_on_fine_grids(const std::vector<Balance>& all) {
  constexpr int from_here_on = 7, not_yet = 6;  // levels
  Table shares(
      "body; cells of the grid along each axis [1]; octree over grid [1]; that, or its inverse at "
      "64 cells [1]");
  for (const Balance& b : all)
    if ((b.body == "sphere" || b.body == "torus") && b.level >= not_yet) {
      const double share = share_of_grid(b);
      shares.row(b.body, std::ldexp(1, b.level), share,
                 b.level >= from_here_on ? share : 1 / share);
    }
  return {"octree-memory.even-bodies-save-from-128-cells-on",
          "On a sphere and on a torus the octree takes less memory than the grid from 128 cells "
          "along each axis on, and more at 64.",
          judge_worst(shares, 1, "the grid's memory, from both sides")};
}

Table table_of(const std::vector<Balance>& all) {
  Table table(
      "body; cells of the grid along each axis [1]; miss of the grid [m]; miss of the octree [m]; "
      "memory of the grid [MB]; memory of the octree [MB]; octree over grid [1]; distances asked "
      "for [1]; processor time to build [s]");
  for (const Balance& b : all)
    table.row(b.body, std::ldexp(1, b.level), b.grid_miss, b.tree_miss, b.grid_bytes / 1e6,
              b.tree_bytes / 1e6, share_of_grid(b), b.evaluations, b.seconds);
  return {"balance",
          "Octree and regular grid of the same largest error within three cells of the surface",
          table};
}

Figure figure_of(const std::vector<Balance>& all) {
  Figure figure{"memory",
                "Memory against error",
                {"largest miss within three cells", "m", Scale::log},
                {"memory", "MB", Scale::log},
                "The cube is 1 m wide. A grid of n cells along each axis has (n + 1)^3 values; "
                "each octree's error is at most that of the grid beside it."};
  for (const char* const body : {"sphere", "torus", "box", "statue"}) {
    Curve grid{std::string(body) + ", grid"}, tree{std::string(body) + ", octree"};
    for (const Balance& b : all) {
      if (b.body != body) continue;
      grid.point(b.grid_miss, b.grid_bytes / 1e6);
      tree.point(b.tree_miss, b.tree_bytes / 1e6);
    }
    figure.curves.push_back(std::move(grid));
    figure.curves.push_back(std::move(tree));
  }
  return figure;
}

/// The leaves that a plane through the statue cuts.
Map slice_of(const Body& body) {
  const Octree tree = make_octree({body.distance}, {Vector3::Constant(-0.5), 1, 7, 3, 1e-3, 0.05,
                                                    0.25, 0, HangingNodes::constrained});
  Map map{"leaves",
          "Leaves of an octree, cut by a plane",
          {"x", "m"},
          {"y", "m"},
          {},
          {},
          {},
          "width of the leaf",
          "m",
          Scale::log,
          "The statue, cut through its middle; 128 cells along each axis at most, to 1 mm within 5 "
          "cm of the surface.",
          {}};
  constexpr int points = 192;
  for (int i = 0; i < points; ++i) map.x_values.push_back((i + 0.5) / points - 0.5);
  map.y_values = map.x_values;
  for (double y : map.y_values)
    for (double x : map.x_values)
      map.values.push_back(std::ldexp(1, -leaf_at(tree, {x, y, 0.013}).level));
  return map;
}

StudyResult run_octree_memory(const Subject&, Tier tier, const Progress& progress) {
  std::vector<Balance> all;
  const std::vector<Body> measured = bodies();
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const int last = tier == Tier::quick ? measured[i].quick : measured[i].full;
    for (int level = measured[i].coarsest; level <= last; ++level)
      all.push_back(balance_of(measured[i], level));
    progress(double(i + 1) / double(measured.size()));
  }
  StudyResult result;
  result.findings = {takes_a_tenth(all), even_curve_takes_more(all), uneven_bodies_save(all),
                     even_bodies_save_on_fine_grids(all)};
  result.figures = {figure_of(all)};
  result.maps = {slice_of(measured.back())};
  result.tables = {table_of(all)};
  return result;
}

}  // namespace

Study octree_memory_study() {
  return {
      "octree-memory",
      "An octree takes less memory than a regular grid of the same error on a box and on a bumpy "
      "body; on a sphere and on a torus more at 64 cells along each axis, and less from 128 on.",
      {"saves-on-boxes-and-bumpy-bodies", "even-bodies-save-from-128-cells-on"},
      "BMF03 section 5.1",
      "How much does adaptive sampling save? For bodies with even curvature, sharp edges and "
      "bumps, a regular grid and the coarsest octree with no larger error, both in double "
      "precision. The octree may use cells of half the grid's width where it needs them.",
      run_octree_memory};
}

}  // namespace foldproof
