// sharp-edges: what a sampled distance makes of the normals next to a body's edges.
#include <memory>
#include <random>

#include "convergence/study.h"
#include "reference/level_set/grid.h"
#include "reference/level_set/octree.h"
#include "verification/seeds.h"

namespace foldproof {

namespace {

constexpr double told_apart = 1;       // degrees
constexpr double cells_looked_at = 6;  // from the edge

/// A box that stands askew in the cube of the samples, which has a width of 1 m about the origin.
struct Askew {
  Box box{{0.31, 0.27, 0.23}};
  Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.7, Vector3::UnitX()) * Eigen::AngleAxisd(0.4, Vector3::UnitY()) *
       Eigen::AngleAxisd(0.9, Vector3::UnitZ()))
          .toRotationMatrix();

  Distance at(const Vector3& p) const {
    const Distance here = box.at(turn.transpose() * p);
    return {here.phi, turn * here.normal};
  }
};

/// A point of a face next to the edge that it shares with another, all faces and edges alike.
struct EdgePoint {
  Vector3 p, normal;  // the face's, outward
  double from_edge;   // m
};

std::vector<EdgePoint> edge_points(const Askew& body, double h) {
  std::mt19937_64 random(shifted_seed(97));
  const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
  std::vector<EdgePoint> points;
  for (int i = 0; i < 6000; ++i) {
    const int face = int(random() % 3), along = (face + 1 + int(random() % 2)) % 3,
              across = 3 - face - along;
    EdgePoint point;
    point.from_edge = cells_looked_at * h * unit();
    Vector3 p, n = Vector3::Zero();
    const auto side = [&] { return random() % 2 ? 1.0 : -1.0; };
    n[face] = side();
    p[face] = n[face] * body.box.half_extents[face];
    p[across] = side() * (body.box.half_extents[across] - point.from_edge);
    p[along] = (2 * unit() - 1) * 0.5 * body.box.half_extents[along];  // away from the corners
    point.p = body.turn * p;
    point.normal = body.turn * n;
    points.push_back(point);
  }
  return points;
}

/// How a sampled distance errs next to edges.
struct EdgeErrors {
  double h;            // m
  double reach;        // the farthest from the edge that N errs by more than a degree [cells]
  double worst_angle;  // degrees
  double worst_phi;    // m
};

template <class Solid>
EdgeErrors edge_errors(const Askew& body, const Solid& solid, double h) {
  EdgeErrors errors{h, 0, 0, 0};
  for (const EdgePoint& point : edge_points(body, h)) {
    const Distance at = solid.at(point.p);
    const double angle =
        180 / pi * std::atan2(at.normal.cross(point.normal).norm(), at.normal.dot(point.normal));
    if (!(angle <= told_apart)) errors.reach = std::max(errors.reach, point.from_edge / h);
    update_worst(errors.worst_angle, angle);
    update_worst(errors.worst_phi, std::abs(at.phi));
  }
  return errors;
}

Grid grid_of(const Askew& body, int cells) {
  Grid grid{{Vector3::Constant(-0.5), 1.0 / cells, {cells + 1, cells + 1, cells + 1}}, {}};
  for (long i = 0; i < grid.lattice.size(); ++i)
    grid.phi.push_back(body.at(grid.lattice.position(grid.lattice.node(i))).phi);
  return grid;
}

Octree octree_of(const Askew& body, int depth) {
  const double h = std::ldexp(1, -depth);
  return make_octree(
      {[&](const Vector3& p) { return body.at(p); }},
      {Vector3::Constant(-0.5), 1, depth, 3, 1e-3 * h, 3 * h, 0.25, 0, HangingNodes::constrained});
}

/// One kind of samples over a row of spacings, and how far from an edge its stencil looks.
struct Sampling {
  std::string name, words;
  Table errors;  // spacing by spacing
  double looks;  // cells
  std::string why_looks;
};

Table edge_table() {
  return {{"spacing", "m"},
          {"reach", "cells"},
          {"largest angle", "degrees"},
          {"largest miss of phi", "m"}};
}

void add_row(const EdgeErrors& errors, Table& table) {
  table.row(errors.h, errors.reach, errors.worst_angle, errors.worst_phi);
}

NamedFinding reach_finding(const Sampling& sampling) {
  return {"sharp-edges.normals-blend-near-edges-only." + sampling.name,
          "On " + sampling.words + " N is the face's normal except within a few cells of an edge.",
          judge_worst(sampling.errors, "reach", sampling.looks, sampling.why_looks,
                      "measured is the largest distance from the edge at which N is off by more "
                      "than a degree")};
}

NamedFinding angle_finding(const Sampling& sampling) {
  const std::vector<double>& angles = sampling.errors.numbers("largest angle");
  const double first = angles.front(), last = angles.back();
  return {"sharp-edges.normal-error-persists-under-refinement." + sampling.name,
          "On " + sampling.words +
              " refinement narrows the strip of blended normals, but not their error.",
          {{std::abs(last / first - 1), 0.2, 0, "1",
            "next to an edge the samples look alike at every spacing, except for where the edge "
            "lies among them; 6000 places are tried, and a fifth is left for chance"},
           sampling.errors,
           "measured is the change of the largest angle from the coarsest to the finest"}};
}

NamedFinding phi_finding(const Sampling& sampling) {
  return {
      "sharp-edges.phi-is-first-order." + sampling.name,
      "On " + sampling.words + " the surface misses an edge by a part of a cell.",
      {order_verdict(
           convergence_of(sampling.errors, "largest miss of phi"), 1, 2, 0.2,
           "a kink of phi is cut off over a cell: order 1; the largest of 6000 random places is "
           "known to a tenth or so, a fifth of an order between a spacing and its half"),
       sampling.errors, "measured is |order - 1| of the last two pairs"}};
}

Figure figure_of(const std::vector<Sampling>& samplings) {
  Figure figure{"reach",
                "How far from an edge normals are off",
                {"spacing", "m", Scale::log},
                {"distance from the edge", "m", Scale::log},
                1,
                "A box at an angle to the grid: the points of its faces farthest from an edge at "
                "which N is off by more than a degree."};
  for (const Sampling& sampling : samplings) {
    const std::vector<double>&spacings = sampling.errors.numbers("spacing"),
          &reaches = sampling.errors.numbers("reach");
    Curve curve{sampling.words};
    for (size_t k = 0; k < spacings.size(); ++k) curve.point(spacings[k], reaches[k] * spacings[k]);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

StudyResult run_sharp_edges(const Subject&, Tier tier, const Progress& progress) {
  const Askew body;
  const int finest = tier == Tier::full ? 8 : 7;
  Sampling grids{"grid", "a grid", edge_table(), 2 * std::sqrt(6.0),
                 "differences at a cell's corners look two cells along each axis, 2 sqrt(3) cells "
                 "away; the kink inside the box is s/sqrt(2) from a point at s from the edge, so "
                 "that beyond 2 sqrt(6) cells all that is looked at is one plane"};
  Sampling trees{
      "octree", "an octree", edge_table(), std::sqrt(6.0),
      "a cell's own gradient looks one cell along each axis: sqrt(6) cells, by the same reckoning"};
  for (int level = 5; level <= finest; ++level) {
    const double h = std::ldexp(1, -level);
    add_row(edge_errors(body, grid_of(body, 1 << level), h), grids.errors);
    add_row(edge_errors(body, octree_of(body, level), h), trees.errors);
    progress(double(level - 4) / (finest - 4));
  }
  StudyResult result;
  for (const Sampling& sampling : {grids, trees}) {
    result.add({reach_finding(sampling), phi_finding(sampling)});
  }
  result.findings.push_back(angle_finding(grids));
  result.figures.push_back(figure_of({grids, trees}));
  return result;
}

}  // namespace

Study sharp_edges_study() {
  return {"sharp-edges",
          "Sampled distances round off edges and blend the normals next to them.",
          {"phi-is-first-order", "normals-blend-near-edges-only",
           "normal-error-persists-under-refinement"},
          "BMF03 section 5.1",
          "How far from an edge does N differ from the face's normal, and how much does refinement "
          "help? A box at an angle to the grid, with exact values at the nodes.",
          run_sharp_edges};
}

}  // namespace foldproof
