// Small sheets that lie on an obstacle, on any of its sides, and what they do there.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "verification/subjects/suite/laws.h"

namespace foldproof::suite {

/// How far from an obstacle cloth may rest, into it and off it [m]; every law of this page that
/// judges a distance takes it from here.
struct Allowance {
  double depth, height;
};
Allowance allowance(const Declaration& declared, const PortableScene& scene);

/// Where a sheet is laid, and a direction in which gravity may pull it along the obstacle.
struct Side {
  std::string name;
  Vector3 point;         // of the surface [m]
  Vector3 normal, down;  // of length 1, outward and along the surface
};

/// A kind of obstacle: many of them, three planes, each with its sides and, but for planes, its
/// size, so that none reaches another's.
struct ObstacleKind {
  std::string group, capability;
  std::string name;  // "the face of a box"
  void (*add)(PortableScene& scene, int which, double friction);
  std::vector<Side> (*sides)(int which);
};

const std::array<ObstacleKind, 4>& obstacle_kinds();

/// Distance of a point to the nearest obstacle of the scene, negative inside [m].
double clearance(const PortableScene& scene, const Vector3& p);

/// A free jittered sheet of n x n cells of that edge [m], limp enough for steps of 2 ms.
PortableScene limp_sheet(int cells, double edge);

/// Lays the sheet on that side of the scene's obstacles, its rest shape in the tangential plane,
/// under a gravity that pulls `down` with this tangent of the slope.
void lay(PortableScene& scene, const Side& side, double slope);

/// A sheet of 2 x 2 cells of 3 cm on this side of the obstacle.
PortableScene sheet_on(const ObstacleKind& kind, const Side& side, double slope, double friction);

/// Of laws that compare how sheets slide with Coulomb's law.
constexpr const char* slides_headline = "side | mu | acceleration | by Coulomb's law";

class Slides {
 public:
  /// A row: the sheet's mean acceleration along the side in 24 steps, over that without friction.
  /// From places at three times: a late start and a scheme of first order hardly change it.
  void measure(Trial& trial, const PortableScene& scene, const Side& side, double friction);

  Finding judged() const;

 private:
  Table rows_ = table_of(
      "side | slope [1] | mu [1] | acceleration [of that without friction] | by Coulomb's law [1] "
      "| difference [of that without friction]");
};

}  // namespace foldproof::suite
