// Cloth against itself (BMF03 section 5, after Bridson, Fedkiw and Anderson 2002): repulsion within
// the thickness, then impulses against crossings, then rigid zones, until the step is shown to be
// free of crossings.
#pragma once

#include "reference/filters/cloth_pairs.h"
#include "reference/filters/repulsion.h"
#include "reference/filters/untangling.h"
#include "reference/level_set/object.h"
#include "reference/types.h"

namespace foldproof {

/// The filter. It comes last: objects first, then cloth against itself. It returns a velocity that
/// is proven safe: for every pair of features whose boxes meet on the way, planes separate the two
/// throughout (approach.h), or they move rigidly together (impact_zones.h). So cloth free of
/// crossings stays free of them, and pairs farther apart than a tenth of the thickness stay so. The
/// velocity that ends a step moves nothing; there, layers within the thickness are only kept from
/// approaching. Cloth that starts crossing itself is held apart only where it is not tangled, and
/// pushed apart where it is; until it is untangled there is no proof.
struct SelfCollision {
  SelfCollisionSettings settings;
  ClothTree cloth;
  PerParticle mass, inverse_mass;   // N [kg], [1/kg]; the latter 0 for prescribed particles
  CrossingTriangles at_start = {};  // pairs that cross before the first step
  LayerProperties layers = {};

  /// Searches and queries run on it; impulses are given one after the other.
  void set_team(const Team& team, Eigen::Index) { cloth.team = team; }

  /// In a run that keeps values, searches for the pairs that may meet in the next steps, unless the
  /// kept pairs still suffice. That saves most searches without changing a bit: correct() searches
  /// where it must.
  void look_ahead(const State& s, const Work& work) const;

  /// Throws DegenerateElement where prescribed particles force the cloth through itself, and where
  /// the corners of a triangle part by more than ten mean edges and a tenth of the cloth's size.
  void correct(const Span& span, const State& s, PerParticle3& v, Work& work) const;
};

}  // namespace foldproof
