// Dynamic sticking constraints (BMF03 section 6): cloth that sticks to patches of an object or of cloth, is carried,
// and breaks off.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reference/forces/damping.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

/// Triangles that particles may stick to: of the cloth itself, or of a surface that moves by itself.
struct StickyPatch {
  std::string name;
  std::vector<Triangle> triangles;  // corners: particles of the cloth, or columns of `place`
  std::function<PerParticle3(double t)> place,
      velocity;                // of a surface's corners at t [m], [m/s]; empty: cloth
  std::vector<int> particles;  // that may stick to it
  double stiffness = 0;        // k [N/m]
  double forecast_time = 0;    // tau_s [s]
  double near = 0;             // a bond forms within this distance [m]
  double far = 0;              // a bond breaks beyond this distance from its target [m]
  double from = 0, until = 0;  // active in between [s]
};

struct Sticking {
  std::vector<StickyPatch> patches;

  void add_elastic(const State& s, PerParticle3& f) const;
  double energy(const State& s) const;
};

}  // namespace foldproof
