// A heavy disc that hangs from its centre, on a mesh that can be a cone without stretching.
#pragma once

#include <vector>

#include "verification/subject.h"

namespace foldproof {

/// A disc as of oracles/sheets/disc_of_sectors.h, with a core of a fifth of its radius,
/// held at its centre.
struct HungDisc {
  int folds = 2;      // of the cone that it starts from
  double weight = 0;  // of the oracle's cone: moment of the weight over bending rigidity [1]
  int sectors = 0;
  double stretch = 0;  // Y of the springs over the weight of a strip as long as the radius [1]
};

struct DiscAtRest {
  double energy = 0;            // of bending, stretch and weight, as the oracle's cone counts [1]
  double depth = 0;             // mean height of the spokes below the centre, as there [1]
  std::vector<double> heights;  // of the spokes' ends, over the radius
  double unbalanced = 0;        // see Equilibrium [1]
  double stretch_share = 0;     // energy of stretch over that of bending [1]
  bool stable = false;
};

/// Lets it settle. Rigidity is the mesh's own: with theta the angle between neighbouring sectors,
/// a spoke's hinges store ke theta^2/4 sum l/(h1 + h2), l a hinge's length and h1, h2 the heights
/// of its triangles.
DiscAtRest disc_at_rest(const Subject& subject, const HungDisc& disc);

/// Highest points of the edge around the disc that stand out by a fiftieth of the radius.
int folds_of(const DiscAtRest& rest);

}  // namespace foldproof
