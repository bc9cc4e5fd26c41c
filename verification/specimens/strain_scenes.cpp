#include "verification/specimens/strain_scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Strains {
  double least = infinity, largest = -infinity;  // of all springs [1]
};

Strains strains_of(const Scene& scene, const PerParticle3& x) {
  Strains strains;
  for (const Edge& edge : scene.mesh.edges) {
    const double rest = scene.stretch->rest_length_scale *
                        (scene.mesh.rest.col(edge.b) - scene.mesh.rest.col(edge.a)).norm();
    const double strain = (x.col(edge.b) - x.col(edge.a)).norm() / rest - 1;
    if (std::isnan(strain)) return {strain, strain};
    strains.least = std::min(strains.least, strain);
    strains.largest = std::max(strains.largest, strain);
  }
  return strains;
}

LimitedCloth limit(const std::string& name, const Specimen& specimen, const PerParticle3& x,
                   const StrainLimits& limits) {
  LimitedCloth cloth{name, specimen.scene, {}, 0.009};
  cloth.scene.stretch = StretchMaterial{37, 0.011, 1};
  cloth.scene.x = x;
  cloth.scene.strain_limits = limits;
  cloth.state = start_state(cloth.scene);
  return cloth;
}

/// The limits just outside the cloth's strains.
void limit_about(LimitedCloth& cloth) {
  const Strains strains = strains_of(cloth.scene, cloth.scene.x);
  cloth.scene.strain_limits->extension = std::max(0.0, strains.largest) + 0.031;
  cloth.scene.strain_limits->compression = std::max(0.0, -strains.least) + 0.017;
}

/// The sheet displaced as the specimen is, or by a fraction of it: on a random mesh no short edge
/// may shrink below half or grow beyond twice its length.
LimitedCloth crumpled_cloth(const Specimen& specimen, const StrainLimits& limits) {
  const PerParticle3& rest = specimen.scene.mesh.rest;
  for (double share = 1;; share *= 0.7) {
    const PerParticle3 x = rest + share * (specimen.scene.x - rest);
    LimitedCloth cloth = limit(specimen.name + ", crumpled", specimen, x, limits);
    const Strains strains = strains_of(cloth.scene, x);
    if (strains.least < -0.5 || strains.largest > 1) continue;
    limit_about(cloth);
    return cloth;
  }
}

/// The sheet stretched by 5 %, with 6 % of its displacements, or less if these would take a spring
/// of a random mesh beyond its limits.
LimitedCloth stretched_cloth(const Specimen& specimen, const StrainLimits& limits) {
  const PerParticle3& rest = specimen.scene.mesh.rest;
  for (double share = 0.06;; share *= 0.7) {
    LimitedCloth cloth = limit(specimen.name + ", stretched", specimen,
                               1.05 * rest + share * (specimen.scene.x - rest), limits);
    const double violation = strain_violation(cloth.scene, cloth.scene.x);
    if (!(violation > -10 * limits.tolerance)) return cloth;
  }
}

/// The ends of the spring with the largest strain separate by a tenth of its length in a step: not
/// every random motion breaks limits.
void pull(LimitedCloth& cloth) {
  const Edge* longest = nullptr;
  double largest = -infinity;
  for (const Edge& edge : cloth.scene.mesh.edges) {
    const double rest =
        (cloth.scene.mesh.rest.col(edge.b) - cloth.scene.mesh.rest.col(edge.a)).norm();
    const double strain = (cloth.state.x.col(edge.b) - cloth.state.x.col(edge.a)).norm() / rest;
    if (strain > largest) largest = strain, longest = &edge;
  }
  const Vector3 d = cloth.state.x.col(longest->b) - cloth.state.x.col(longest->a);
  const Vector3 mean = 0.5 * (cloth.state.v.col(longest->a) + cloth.state.v.col(longest->b));
  cloth.state.v.col(longest->a) = mean - 0.05 / cloth.step * d;
  cloth.state.v.col(longest->b) = mean + 0.05 / cloth.step * d;
}

/// Shortens the step so that the ends of a spring move relative to each other by at most .3 of its
/// length; the motion still breaks limits.
void moderate(LimitedCloth& cloth) {
  cloth.step *= std::min(1.0, 0.3 / relative_motion(cloth, cloth.step));
  if (strain_violation(cloth.scene, cloth.state.x + cloth.step * cloth.state.v) < 0.05) pull(cloth);
}

}  // namespace

double relative_motion(const LimitedCloth& cloth, double h) {
  double largest = 0;
  for (const Edge& edge : cloth.scene.mesh.edges) {
    const double length = (cloth.state.x.col(edge.b) - cloth.state.x.col(edge.a)).norm();
    largest = std::max(largest,
                       h * (cloth.state.v.col(edge.b) - cloth.state.v.col(edge.a)).norm() / length);
  }
  return largest;
}

std::vector<LimitedCloth> limited_cloths(SweepOrder order) {
  StrainLimits limits;
  limits.order = order;
  limits.sweeps = 3000;
  limits.tolerance = 3e-4;
  std::vector<LimitedCloth> cloths;
  for (const Specimen& specimen : crumpled_sheets()) {
    cloths.push_back(crumpled_cloth(specimen, limits));
    cloths.push_back(stretched_cloth(specimen, limits));
  }
  for (LimitedCloth& cloth : cloths) moderate(cloth);
  return cloths;
}

const std::vector<NamedOrder>& sweep_orders() {
  static const std::vector<NamedOrder> orders = {{"gauss_seidel", SweepOrder::gauss_seidel},
                                                 {"alternating", SweepOrder::alternating},
                                                 {"coloured", SweepOrder::coloured},
                                                 {"jacobi", SweepOrder::jacobi}};
  return orders;
}

std::vector<LimitedCloth> cloths_in_all_orders() {
  std::vector<LimitedCloth> all;
  for (const NamedOrder& named : sweep_orders())
    for (LimitedCloth& cloth : limited_cloths(named.order)) {
      cloth.name = named.name + ", " + cloth.name;
      all.push_back(std::move(cloth));
    }
  return all;
}

double strain_violation(const Scene& scene, const PerParticle3& x) {
  const Strains strains = strains_of(scene, x);
  const double over = strains.largest - scene.strain_limits->extension;
  const double under = -strains.least - scene.strain_limits->compression;
  return std::isnan(over) ? over : std::max(over, under);
}

PerParticle3 corrected_by_strain_limits(const Subject& subject, const LimitedCloth& cloth,
                                        const PerParticle3& v) {
  const auto prepared = require_offered(subject.prepare, "prepare")(cloth.scene);
  return require_offered(subject.limit_strain, "limit_strain")(
      *prepared, {0, cloth.step, cloth.step}, cloth.state, v);
}

}  // namespace foldproof
