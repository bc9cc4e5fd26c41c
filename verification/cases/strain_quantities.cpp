// Quantities of cloth that is stretched or compressed: springs against their limits, length, area.
#include <string>

#include "verification/cases/quantities.h"

namespace foldproof {

namespace {

double violation(const Scene& scene, const State& s) {
  Worst worst;
  const std::vector<double> strains = strains_of(scene, s.x);
  std::vector<StrainRange> ranges = strain_ranges_of(scene);
  if (ranges.empty()) ranges.assign(strains.size(), *scene.strain_limits);
  for (size_t e = 0; e < strains.size(); ++e) {
    worst.observe(strains[e] - ranges[e].extension);
    worst.observe(-strains[e] - ranges[e].compression);
  }
  return worst.value();
}

double largest_extension(const Scene& scene, const State& s) {
  Worst worst;
  for (const double strain : strains_of(scene, s.x)) worst.observe(strain);
  return worst.value();
}

double lengthening(const Scene& scene, const State& s) {
  const auto extents = [](const PerParticle3& x) -> Vector3 {
    return x.rowwise().maxCoeff() - x.rowwise().minCoeff();
  };
  Eigen::Index axis = 0;
  const double at_rest = extents(scene.mesh.rest).maxCoeff(&axis);
  return extents(s.x)[axis] / at_rest - 1;
}

double area_lost(const Scene& scene, const State& s) {
  const double at_rest = triangle_areas(scene.mesh.triangles, scene.mesh.rest).sum();
  return 1 - triangle_areas(scene.mesh.triangles, s.x).sum() / at_rest;
}

std::string without_limits(const Scene& scene) {
  return scene.strain_limits ? "" : "the case has no [strain_limits]";
}

}  // namespace

std::vector<double> strains_of(const Scene& scene, const PerParticle3& x) {
  const double scale = scene.stretch ? scene.stretch->rest_length_scale : 1;
  const Eigen::VectorXd lengths = scale * rest_lengths(scene.mesh);
  std::vector<double> values;
  for (size_t e = 0; e < scene.mesh.edges.size(); ++e) {
    const Edge& edge = scene.mesh.edges[e];
    values.push_back((x.col(edge.b) - x.col(edge.a)).norm() / lengths[Eigen::Index(e)] - 1);
  }
  return values;
}

std::vector<Quantity> strain_quantities() {
  return {
      {"stays_within_strain_limits", "1",
       "No spring is beyond a strain limit by more than this share of its rest length.",
       Sense::at_most, Scope::any_cloth, violation, nullptr, without_limits},
      {"stretches_to", "1", "Some spring is stretched by this share of its rest length.",
       Sense::at_least, Scope::this_shape, largest_extension, nullptr, without_springs},
      {"lengthens_by", "1", "The cloth's longest extent grows by this share of its extent at rest.",
       Sense::at_least, Scope::this_shape, lengthening, nullptr, nullptr},
      {"keeps_its_area", "1", "The cloth loses no more than this share of its area.",
       Sense::at_most, Scope::this_shape, area_lost, nullptr, nullptr},
  };
}

}  // namespace foldproof
