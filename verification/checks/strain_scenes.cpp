#include "verification/checks/strain_scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verification/checks/specimens.h"

namespace foldproof {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Strains {
  double least = infinity, largest = -infinity;  // of all springs [1]
};

Strains strains_of(const Scene& scene, const PerParticle3& x) {
  Strains strains;
  for (const Edge& edge : scene.mesh.edges) {
    const double rest =
        scene.stretch->rest_length_scale * (scene.mesh.rest.col(edge.b) - scene.mesh.rest.col(edge.a)).norm();
    const double strain = (x.col(edge.b) - x.col(edge.a)).norm() / rest - 1;
    if (std::isnan(strain)) return {strain, strain};
    strains.least = std::min(strains.least, strain);
    strains.largest = std::max(strains.largest, strain);
  }
  return strains;
}

LimitedCloth limited(const std::string& name, const Specimen& specimen, const PerParticle3& x,
                     const StrainLimits& limits) {
  LimitedCloth cloth{name, specimen.scene, {}, 0.009};
  cloth.scene.stretch = StretchMaterial{37, 0.011, 1};
  cloth.scene.x = x;
  cloth.scene.strain_limits = limits;
  cloth.state = start_state(cloth.scene);
  return cloth;
}

/// The sheet stretched by 5 %, with a share of its displacements that leaves all springs within their limits: of 6 %,
/// unless that shortens a short edge of a random mesh by more than it is stretched.
LimitedCloth stretched(const Specimen& specimen, const StrainLimits& limits) {
  const PerParticle3& rest = specimen.scene.mesh.rest;
  for (double share = 0.06;; share *= 0.7) {
    LimitedCloth cloth = limited(specimen.name + ", stretched", specimen,
                                 1.05 * rest + share * (specimen.scene.x - rest), limits);
    const double violation = strain_violation(cloth.scene, cloth.scene.x);
    if (!(violation > -10 * limits.tolerance)) return cloth;
  }
}

}  // namespace

std::vector<LimitedCloth> limited_cloths(SweepOrder order) {
  StrainLimits limits;
  limits.order = order;
  limits.sweeps = 3000;
  limits.tolerance = 3e-4;
  std::vector<LimitedCloth> cloths;
  for (const Specimen& specimen : crumpled_sheets()) {
    LimitedCloth crumpled = limited(specimen.name + ", crumpled", specimen, specimen.scene.x, limits);
    const Strains strains = strains_of(crumpled.scene, crumpled.scene.x);
    crumpled.scene.strain_limits->extension = std::max(0.0, strains.largest) + 0.031;
    crumpled.scene.strain_limits->compression = std::max(0.0, -strains.least) + 0.017;
    cloths.push_back(std::move(crumpled));
    cloths.push_back(stretched(specimen, limits));
  }
  return cloths;
}

const std::vector<NamedOrder>& sweep_orders() {
  static const std::vector<NamedOrder> orders = {{"gauss_seidel", SweepOrder::gauss_seidel},
                                                 {"alternating", SweepOrder::alternating},
                                                 {"coloured", SweepOrder::coloured},
                                                 {"jacobi", SweepOrder::jacobi}};
  return orders;
}

double strain_violation(const Scene& scene, const PerParticle3& x) {
  const Strains strains = strains_of(scene, x);
  const double over = strains.largest - scene.strain_limits->extension;
  const double under = -strains.least - scene.strain_limits->compression;
  return std::isnan(over) ? over : std::max(over, under);
}

PerParticle3 strain_limited(const Subject& subject, const LimitedCloth& cloth, const PerParticle3& v) {
  const auto prepared = offered(subject.prepare, "prepare")(cloth.scene);
  return offered(subject.limit_strain, "limit_strain")(*prepared, {0, cloth.step, cloth.step}, cloth.state,
                                                       v);
}

}  // namespace foldproof
