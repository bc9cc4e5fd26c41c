// A limp strip between two points, against the catenary.

#include "reference/mesh/shapes.h"
#include "verification/oracles/chains_and_ribbons.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/relaxation.h"

namespace foldproof {

namespace {

using namespace suite;

// Both end rows of a strip are held. It starts at rest as an arc of a circle, unstrained, and sags
// to the catenary of the length that it then has: so its Young's modulus hardly matters.
constexpr int cells = 16;
constexpr double length = 0.6;  // m
constexpr double angle = 1.13;  // half of the arc's [rad]; its ends are 0.8 of the length apart

int row_of(const PortableScene& scene, Eigen::Index i) {
  return int(std::lround(scene.mesh.rest(0, i) / length * cells));
}

PortableScene limp_strip() {
  PortableScene scene =
      resting("limp strip between two points",
              make_sheet({SheetPattern::alternating, length, length / cells, cells, 1}));
  const double radius = length / cells / (2 * std::sin(angle / cells));  // of its corners
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const int row = row_of(scene, i);
    const double turn = angle * (2.0 * row / cells - 1);
    scene.x(0, i) = radius * std::sin(turn);
    scene.x(2, i) = -radius * std::cos(turn);
    if (row == 0 || row == cells) scene.held.push_back(int(i));
  }
  scene.gravity = Vector3(0, 0, -9.81);
  scene.dt = 1e-3;  // explicit methods need a quarter of it
  return scene;
}

/// Mean places of the rows [m].
Eigen::Matrix3Xd rows_of(const PortableScene& scene, const PerParticle3& x) {
  Eigen::Matrix3Xd rows = Eigen::Matrix3Xd::Zero(3, cells + 1);
  for (Eigen::Index i = 0; i < x.cols(); ++i) rows.col(row_of(scene, i)) += x.col(i) / 2;
  return rows;
}

/// Distances of the rows from the first one, along the strip [m].
std::vector<double> ways_along(const Eigen::Matrix3Xd& rows) {
  std::vector<double> ways{0};
  for (Eigen::Index k = 1; k < rows.cols(); ++k)
    ways.push_back(ways.back() + (rows.col(k) - rows.col(k - 1)).norm());
  return ways;
}

Finding sags_as_a_catenary(Trial& trial) {
  const PortableScene scene = limp_strip();
  const Relaxed end = relaxed(trial, scene, {scene.x, length, 3e-4, 0.02});
  const Eigen::Matrix3Xd rows = rows_of(scene, end.x);
  std::vector<double> ways = ways_along(rows);
  const double hung = ways.back(), moved = end.last_move / hung;
  for (double& way : ways) way = std::min(1.0, way / hung);
  const double span = (rows.col(cells) - rows.col(0)).norm() / hung;
  const oracles::Catenary catenary = oracles::catenary({span, 0}, ways);
  Worst off;
  double lowest = 0;
  for (int k = 0; k <= cells; ++k) {
    const oracles::CatenaryPoint& point = catenary.points[size_t(k)];
    const Eigen::Vector3d from_end = (rows.col(k) - rows.col(0)) / hung;
    off.observe((from_end - Eigen::Vector3d(point.across, 0, point.up)).norm());
    lowest = std::min(lowest, point.up);
  }
  const double sag = (rows(2, 0) - rows.row(2).minCoeff()) / hung;
  Table measured = table_of(
      "length over that at rest [1] | sag [L] | of the catenary [L] | farthest row from it [L] | "
      "last move [L] | of both [L]");
  measured.row(hung / length, sag, -lowest, off.value(), moved, off.value() + moved);
  return judge_worst(
      measured, 0.005,
      "links of 1/16 of the length instead of a curve of at most 2.4 radians a length: "
      "(2.4/16)^2/24 of it, 0.1 %; strain is uneven by a third of itself, up to 1 %: 0.3 %");
}

}  // namespace

std::vector<Law> chain_laws() {
  return {
      {"chain.limp-strip-sags-as-a-catenary",
       "A strip without bending that is held at both ends sags as the catenary of its length does.",
       "catenary", sags_as_a_catenary, "L1 held"},
  };
}

}  // namespace foldproof
