// Part of the study level-set-resolution: errors of grids.
#pragma once

#include "convergence/study.h"
#include "reference/level_set/fast_marching.h"

namespace foldproof {

// Errors of signed distance on grids about bodies whose distance is known: what
// level-set-resolution measures.

/// A body with its distance in closed form, and how far its medial axis is.
struct KnownBody {
  std::string name;
  std::function<Distance(const Vector3&)> at;
  std::function<bool(const Vector3&)> away;  // from where phi has kinks
  Bounds bounds;                             // that the grid covers [m]
  double layer;                              // m
};

KnownBody known_ball();  // radius 0.7 m, off the lattice's centre; away: outside of half the radius
// radii 0.61 and 0.23 m; away: half the tube's radius from its ring, 0.15 m from its axis
KnownBody known_torus();

/// Initial data of marching: exact values within two and a half cells of the surface; exact values
/// within the body's `layer`, on every grid the same, so that the error is marching's own; which
/// side each node is on.
enum class Start { band, layer, crude };

/// `cells` along the longest side of the body's bounds, three more around it.
Grid march_grid(const KnownBody& body, int cells, Start start, MarchingOrder order);

/// Exact values at all nodes.
Grid sample_grid(const KnownBody& body, int cells);

struct NodeErrors {
  double h;                      // m
  double mean, worst;            // over all nodes [m]
  double mean_away, worst_away;  // away from the medial axis [m]
  double steepness;  // mean of ||grad phi| - 1| away from the medial axis, central differences [1]
};

/// Over the nodes in the body's bounds, which are the same on every grid.
NodeErrors node_errors(const KnownBody& body, const Grid& grid);

constexpr double near_surface = 0.1;  // m

/// Between the nodes, at random points closer to the surface than near_surface.
struct PointErrors {
  double h;               // m
  double value;           // largest [m]
  double cell_gradient;   // largest |error| of the cell's gradient [1]
  double nodal_gradient;  // largest |error| of the blend of the nodes' gradients [1]
};

PointErrors point_errors(const KnownBody& body, const Grid& grid, int points);

/// Of the surface that a grid draws: at its crossings with the lattice's edges.
struct ContourErrors {
  double h;                          // m
  double mean_offset, worst_offset;  // cells
  double mean_angle, worst_angle;    // between N and the body's [degrees]
};

ContourErrors contour_errors(const KnownBody& body, const Grid& grid);

}  // namespace foldproof
