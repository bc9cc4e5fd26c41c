#include "verification/specimens/differences.h"
#include "verification/specimens/check.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

using Measurement = double (*)(const PerParticle3& x, const PerParticle3& f);

double net_force_of(const PerParticle3&, const PerParticle3& f) { return net_force(f); }

const char* const why_sums =
    "each hinge's forces cancel to a few roundings and about 20 hinge forces are added to a "
    "particle, a rounding each";

/// A momentum law on all crumpled sheets and some hinges, for the given materials.
Table over_specimens(const Subject& subject, const std::vector<BendingMaterial>& materials,
                     const std::string& scale, Measurement measure) {
  std::vector<Specimen> specimens = crumpled_sheets();
  for (const double angle : {0.7, -2.4, 3.1})
    specimens.push_back(random_hinge(unsigned(60 + 10 * angle), angle));
  Table measured = roundings_of(scale);
  for (Specimen& specimen : specimens) {
    for (const BendingMaterial& material : materials) {
      specimen.scene.bending = material;
      const PerParticle3 f = Probe(subject, specimen.scene).elastic(specimen.state);
      measured.row(describe(specimen, material), measure(specimen.state.x, f));
    }
  }
  return measured;
}

std::vector<BendingMaterial> paper_variants() {
  std::vector<BendingMaterial> variants;
  for (const BendingMaterial& material : bending_variants()) {
    if (material.law == "sine") variants.push_back(material);
  }
  return variants;
}

Finding forces_sum_to_zero(const Subject& subject) {
  return judge_worst(over_specimens(subject, paper_variants(), "sum |F_i|", net_force_of), 32,
                     why_sums);
}

Finding torques_sum_to_zero(const Subject& subject) {
  return judge_worst(over_specimens(subject, paper_variants(), "sum |x_i||F_i|", net_torque), 32,
                     why_sums);
}

Finding other_laws_keep_momentum(const Subject& subject) {
  std::vector<BendingMaterial> variants;
  for (const BendingLaw& law : bending_laws()) {
    for (BendingMaterial material : paper_variants()) {
      material.law = law.name;
      if (law.name != "sine") variants.push_back(material);
    }
  }
  const Table forces = over_specimens(subject, variants, "sum |F_i|", net_force_of);
  const Table torques = over_specimens(subject, variants, "sum |x_i||F_i|", net_torque);
  Worst worst;
  worst.observe(forces.worst("measured"));
  worst.observe(torques.worst("measured"));
  return {{worst.value(), 32, 0, "epsilon of the sum of sizes", why_sums},
          {forces.column("case"),
           {"net force", "epsilon sum |F_i|", forces.numbers("measured")},
           {"net torque", "epsilon sum |x_i||F_i|", torques.numbers("measured")}},
          "the sum of sizes is sum |F_i| for the net force, sum |x_i||F_i| for the net torque"};
}

/// The elastic forces of a whole specimen in 50 digits: the sum over its hinges, N each.
struct Expected {
  PerParticle3 force;  // 3 x N [N]
  // sum over the hinges at a particle of the change caused by a rounding of magnitude 1 [N]
  PerParticle scale;
  PerParticle uncertainty;  // N
};

oracles::Quad<double> as_quad(const Corners& x) {
  oracles::Quad<double> quad;
  for (int k = 0; k < 4; ++k) quad[k] = {x[k].x(), x[k].y(), x[k].z()};
  return quad;
}

Expected expected_elastic(const Specimen& specimen) {
  const Eigen::Index count = specimen.state.x.cols();
  Expected expected{PerParticle3::Zero(3, count), PerParticle::Zero(count),
                    PerParticle::Zero(count)};
  for (size_t h = 0; h < specimen.scene.mesh.hinges.size(); ++h) {
    const oracles::HingeInput input = hinge_input(specimen, h);
    const auto force = oracles::bending_elastic_50(input);
    const oracles::Quad<double> u = oracles::bending_mode(as_quad(input.x));
    const Corners& weighed =
        input.elastic_geometry == oracles::Geometry::rest ? input.rest : input.x;
    const double c = oracles::anisotropy_factor(as_quad(weighed));
    const double largest = std::max({length(u[0]), length(u[1]), length(u[2]), length(u[3])});
    const double scale =
        input.ke * c * largest * std::max(aspect_ratio(input.x), aspect_ratio(weighed));
    for (int k = 0; k < 4; ++k) {
      const int i = specimen.scene.mesh.hinges[h].particles[k];
      expected.force.col(i) += force.value[k];
      expected.scale[i] += scale;
      expected.uncertainty[i] += force.uncertainty + epsilon * expected.force.col(i).norm();
    }
  }
  return expected;
}

/// The worst particle, in units of epsilon times its scale.
oracles::Estimate worst_difference(const PerParticle3& f, const Expected& expected) {
  Worst difference, uncertainty;
  for (Eigen::Index i = 0; i < f.cols(); ++i) {
    const double unit = epsilon * expected.scale[i];
    difference.observe((f.col(i) - expected.force.col(i)).norm() / unit);
    uncertainty.observe(expected.uncertainty[i] / unit);
  }
  return {difference.value(), uncertainty.value()};
}

Finding force_is_as_defined(const Subject& subject) {
  std::vector<Specimen> specimens = sheets_and_hinges();
  Table measured = roundings_of("ke c |u| thinness");
  for (size_t k = 0; k < specimens.size(); ++k) {
    Specimen& specimen = specimens[k];
    const bool is_sheet = specimen.scene.mesh.hinges.size() > 1;
    for (const BendingMaterial& material : paper_variants()) {
      // sheets take them in turn
      if (is_sheet && (material.weighting == Weighting::rest) != (k % 2 == 0)) continue;
      specimen.scene.bending = material;
      const PerParticle3 f = Probe(subject, specimen.scene).elastic(specimen.state);
      measured.row(describe(specimen, material), worst_difference(f, expected_elastic(specimen)));
    }
  }
  return judge_worst(measured, 64,
                     "a hinge's force takes fewer than 64 roundings, and the normals magnify them "
                     "by the triangles' thinness (longest side squared over twice the area)");
}

}  // namespace

std::vector<Check> bending_checks() {
  return {
      {"bending.forces-sum-to-zero",
       "The elastic bending forces on crumpled sheets and on single hinges sum to zero, with rest "
       "and with current weighting.",
       "BMF03 section 4", forces_sum_to_zero},
      {"bending.torques-sum-to-zero",
       "The torques of the elastic bending forces on crumpled sheets and single hinges sum to "
       "zero, with either weighting.",
       "BMF03 section 4", torques_sum_to_zero},
      {"bending.other-laws-conserve-momentum",
       "Forces and torques still sum to zero when another function of the angle replaces the sine.",
       "BMF03 section 4: other magnitudes must multiply all four forces alike",
       other_laws_keep_momentum},
      {"bending.force-is-as-defined",
       "On crumpled sheets and on hinges of all angles, with rest angles, the elastic force is the "
       "printed one to rounding.",
       "BMF03 section 4, evaluated in 50 digits", force_is_as_defined}};
}

}  // namespace foldproof
