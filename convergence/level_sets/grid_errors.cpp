#include "convergence/level_sets/level_set_resolution.h"
#include "verification/specimens/random.h"
#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

constexpr int margin = 3;

Lattice lattice_of(const KnownBody& body, int cells) {
  return lattice_about(body.bounds, cells, margin);
}

Bounds cube(const Vector3& centre, const Vector3& half) { return {centre - half, centre + half}; }

bool is_inner(const Lattice& lattice, const Node& node) {
  for (int axis = 0; axis < 3; ++axis)
    if (node[axis] < 1 || node[axis] > lattice.nodes[axis] - 2) return false;
  return true;
}

/// ||grad phi| - 1| by central differences at an inner node.
double steepness_error(const Grid& grid, long index) {
  double squares = 0;
  for (const long stride : grid.lattice.strides())
    squares += std::pow(
        (grid.phi[index + stride] - grid.phi[index - stride]) / (2 * grid.lattice.spacing), 2);
  return std::abs(std::sqrt(squares) - 1);
}

/// A mean that is NaN where nothing was seen.
struct Mean {
  double sum = 0;
  long count = 0;
  void observe(double value) { sum += value, ++count; }
  double value() const { return sum / double(count); }
};

}  // namespace

KnownBody known_ball() {
  const Vector3 centre(0.013, -0.007, 0.021);
  const Sphere ball{0.7};
  return {"ball", [=](const Vector3& p) { return ball.at(p - centre); },
          [=](const Vector3& p) { return (p - centre).norm() > 0.35; },
          cube(Vector3::Zero(), Vector3::Constant(1)), 0.16};
}

KnownBody known_torus() {
  const Torus torus{0.61, 0.23};
  return {"torus", [=](const Vector3& p) { return torus.at(p); },
          [=](const Vector3& p) {
            const double from_axis = std::hypot(p.x(), p.y());
            return from_axis > 0.15 && std::hypot(from_axis - 0.61, p.z()) > 0.115;
          },
          cube(Vector3(0.011, 0.017, -0.005), {1.05, 1.05, 0.5}), 0.14};
}

Grid sample_grid(const KnownBody& body, int cells) {
  Grid grid{lattice_of(body, cells), {}};
  grid.phi.resize(grid.lattice.size());
  for (long i = 0; i < grid.lattice.size(); ++i)
    grid.phi[i] = body.at(grid.lattice.position(grid.lattice.node(i))).phi;
  return grid;
}

Grid march_grid(const KnownBody& body, int cells, Start start, MarchingOrder order) {
  const Grid exact = sample_grid(body, cells);
  Seeds seeds;
  if (start == Start::crude) {
    std::vector<float> side;
    for (const double phi : exact.phi) side.push_back(phi < 0 ? -1.f : 1.f);
    seeds = seeds_from_sides(exact.lattice, side);
  } else {
    const double width = start == Start::layer ? body.layer : 2.5 * exact.lattice.spacing;
    for (long i = 0; i < exact.lattice.size(); ++i) {
      if (!(std::abs(exact.phi[i]) < width)) continue;
      seeds.nodes.push_back(i);
      seeds.phi.push_back(exact.phi[i]);
    }
  }
  return march(exact.lattice, seeds, order);
}

NodeErrors node_errors(const KnownBody& body, const Grid& grid) {
  Mean all, away, steepness;
  Worst worst, worst_away;
  for (long i = 0; i < grid.lattice.size(); ++i) {
    const Node node = grid.lattice.node(i);
    const Vector3 p = grid.lattice.position(node);
    if (!body.bounds.contains(p)) continue;
    const double error = std::abs(grid.phi[i] - body.at(p).phi);
    all.observe(error);
    worst.observe(error);
    if (!body.away(p)) continue;
    away.observe(error);
    worst_away.observe(error);
    if (is_inner(grid.lattice, node)) steepness.observe(steepness_error(grid, i));
  }
  return {grid.lattice.spacing, all.value(),        worst.value(),
          away.value(),         worst_away.value(), steepness.value()};
}

PointErrors point_errors(const KnownBody& body, const Grid& grid, int points) {
  Random random(107);
  Worst value, cell, nodal;
  const Vector3 low = body.bounds.min(), sizes = body.bounds.sizes();
  for (int seen = 0; seen < points;) {
    Vector3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = low[axis] + sizes[axis] * random.uniform(0, 1);
    const Distance exact = body.at(p);
    if (!(std::abs(exact.phi) < near_surface)) continue;
    ++seen;
    const Distance in_cell = grid.in_cell(p);
    value.observe(std::abs(in_cell.phi - exact.phi));
    cell.observe((in_cell.normal - exact.normal).norm());
    nodal.observe((grid.at(p).normal - exact.normal).norm());
  }
  return {grid.lattice.spacing, value.value(), cell.value(), nodal.value()};
}

ContourErrors contour_errors(const KnownBody& body, const Grid& grid) {
  const Lattice& lattice = grid.lattice;
  Mean offset, angle;
  Worst worst_offset, worst_angle;
  for (long i = 0; i < lattice.size(); ++i) {
    const Node node = lattice.node(i);
    for (int axis = 0; axis < 3; ++axis) {
      if (node[axis] + 1 >= lattice.nodes[axis]) continue;
      const double here = grid.phi[i], there = grid.phi[i + lattice.strides()[axis]];
      if ((here < 0) == (there < 0)) continue;
      const Vector3 p =
          lattice.position(node) + here / (here - there) * lattice.spacing * Vector3::Unit(axis);
      const Distance exact = body.at(p);
      const double degrees =
          std::acos(std::clamp(grid.at(p).normal.dot(exact.normal), -1.0, 1.0)) * 180 / pi;
      offset.observe(std::abs(exact.phi) / lattice.spacing);
      worst_offset.observe(std::abs(exact.phi) / lattice.spacing);
      angle.observe(degrees);
      worst_angle.observe(degrees);
    }
  }
  return {lattice.spacing, offset.value(), worst_offset.value(), angle.value(),
          worst_angle.value()};
}

}  // namespace foldproof
