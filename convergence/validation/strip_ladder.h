// One test of a strip on finer and finer meshes, beside the elastica.
#pragma once

#include <array>

#include <vector>

#include "convergence/any_case/error_bar.h"
#include "convergence/bending/row_strip.h"
#include "convergence/order.h"
#include "verification/oracles/elastica.h"

namespace foldproof {

/// A strip that is held and hangs as the oracle's does. Its measured length is how high the point
/// at `measured_at` (arc length over L) is above or below the first end, over L.
struct StripTest {
  std::string name, words;
  std::string kind;  // tests of a kind share a figure
  oracles::HeavyStrip strip;
  double measured_at;  // 1: the last end
};

/// A test on meshes of so many panels.
struct StripLadder {
  Table levels;  // spacing of the rows over L, height, reach, largest distance from the elastica
  oracles::StripShape elastica;             // 201 points at equal arc lengths
  std::vector<oracles::StripPoint> points;  // rows of the finest mesh, from the first end over L
  oracles::Estimate height, reach;          // of the elastica's measured point
  double floor = 0;  // of all of them: stretch, unfinished solves, the oracle's uncertainty [1]
};

constexpr const char *height_column = "height over L", *reach_column = "reach over L",
                     *distance_column = "largest distance from the elastica over L";

/// A column of its numbers, with the floor.
Ladder ladder_of(const StripLadder& levels, const char* column);

/// No row of the finest mesh is farther from the elastica than the bound, over L.
Finding shape_verdict(const StripLadder& levels, double bound, std::string why, std::string note);

/// Adds the elastica, and every fourth of the first `rows` rows of the finest mesh.
void show(const StripLadder& levels, std::size_t rows, const std::array<std::string, 2>& labels,
          Figure& figure);

/// How high the highest row is, by the parabola through it and its neighbours.
double highest_row(const std::vector<oracles::StripPoint>& points);

/// One mesh of a strip at rest.
struct StripOnMesh {
  StripAtRest rest;
  std::vector<oracles::StripPoint> points;  // rows from row 1 on, from the first end over L
  double spacing = 0;                       // of the rows over L [1]
  double force_on_row_1 = 0;                // of the strip, upward, over B/L^2 times the width [1]
  double unit_of_force = 0;                 // B/L^2 times the width [N]
};
StripOnMesh strip_on_mesh(const Subject& subject, const StripTest& test, int panels);

/// panels: ascending. The strip has the rigidity of its mesh, held cylindrical. Newton's method
/// starts from the elastica's slopes, which choose the branch.
StripLadder strip_ladder(const Subject& subject, const StripTest& test,
                         const std::vector<int>& panels);

}  // namespace foldproof
