#include "verification/checks/forces/work.h"
#include "verification/specimens/check.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

/// Specimens of the energy checks: two crumpled sheets and some hinges.
std::vector<Specimen> specimens() {
  std::vector<Specimen> all = crumpled_sheets();
  std::vector<Specimen> chosen = {all[4], all[7]};
  for (const double angle : {0.2, -1.4, 2.5})
    chosen.push_back(random_hinge(unsigned(40 + 10 * angle), angle));
  return chosen;
}

/// Largest displacement of a path from a specimen's state that folds no hinge through pi and
/// flattens no triangle [m].
double excursion(const Specimen& specimen) {
  return 0.08 * smallest_height(specimen.scene.mesh.triangles, specimen.state.x);
}

Finding force_is_minus_gradient(const Subject& subject) {
  Table measured = roundings_of("(integral |F||dx| + |E|)");
  for (Specimen& specimen : specimens()) {
    for (const BendingMaterial& material : bending_variants()) {
      if (material.weighting != Weighting::rest) continue;
      specimen.scene.bending = material;
      const Path path = random_line(specimen.state.x, excursion(specimen), 77);
      measured.row(describe(specimen, material),
                   energy_against_work(Probe(subject, specimen.scene), path));
    }
  }
  return judge_worst(measured, 256,
                     "80 to 640 forces and two energies enter the balance, each good to a few "
                     "roundings of its scale times the thinness of crumpled triangles, about 3; "
                     "the quadrature's own error is the uncertainty");
}

/// Energy of one hinge in units of ke c, for any law [1].
double potential_50(const oracles::HingeInput& input, std::string_view law, double rest_weight) {
  if (law == "sine") return oracles::bending_energy_50(input).value / (input.ke * rest_weight);
  const double squared = std::pow(oracles::hinge_angle_50(input.x).value - input.theta0, 2);
  return squared / 4 + squared * squared / 8;  // the integral of (change + change^3)/2
}

Finding energy_is_as_defined(const Subject& subject) {
  Table measured = roundings_of("ke c (1 + potential) thinness");
  std::vector<Specimen> list = sheets_and_hinges();
  for (size_t k = 0; k < list.size(); ++k) {
    Specimen& specimen = list[k];
    const bool is_sheet = specimen.scene.mesh.hinges.size() > 1;
    for (const BendingMaterial& material : bending_variants()) {
      if (material.weighting != Weighting::rest) continue;
      // sheets take the laws in turn
      if (is_sheet && (material.law == "sine") != (k % 2 == 0)) continue;
      specimen.scene.bending = material;
      double energy = 0, scale = 0;
      for (size_t h = 0; h < specimen.scene.mesh.hinges.size(); ++h) {
        const oracles::HingeInput input = hinge_input(specimen, h);
        const HingeShape rest =
            hinge_shape(input.rest[0], input.rest[1], input.rest[2], input.rest[3]);
        const double weight = input.ke * rest.edge * rest.edge / rest.area_sum;
        const double potential = potential_50(input, material.law, weight / input.ke);
        energy += weight * potential;
        scale += weight * (1 + potential) * (aspect_ratio(input.x) + aspect_ratio(input.rest));
      }
      const double error = std::abs(Probe(subject, specimen.scene).energy(specimen.state) - energy);
      measured.row(describe(specimen, material), error / (epsilon * scale));
    }
  }
  return judge_worst(measured, 64,
                     "theta and c take about 16 roundings each, magnified by the thinness, and "
                     "hinges are added one by one");
}

/// A hinge or sheet moved around a closed path.
struct Loop {
  std::string name;
  RoundTrip trip;
};

std::vector<Loop> loops(const Subject& subject, Weighting weighting) {
  std::vector<Loop> list;
  for (Specimen& specimen : specimens()) {
    for (BendingMaterial material : bending_variants()) {
      if (material.weighting != weighting) continue;
      specimen.scene.bending = material;
      const Path path = random_loop(specimen.state.x, excursion(specimen), 53);
      list.push_back(
          {describe(specimen, material), round_trip(Probe(subject, specimen.scene), path)});
    }
  }
  return list;
}

Finding no_work_round_a_loop(const Subject& subject) {
  Table measured = roundings_of("integral |F||dx|");
  for (const Loop& loop : loops(subject, Weighting::rest)) {
    const double unit = epsilon * loop.trip.scale;
    measured.row(loop.name,
                 oracles::Estimate{std::abs(loop.trip.work) / unit, loop.trip.uncertainty / unit});
  }
  return judge_worst(measured, 64,
                     "forces along the path are good to a few dozen roundings; the quadrature's "
                     "error is the uncertainty");
}

Finding work_round_a_loop(const Subject& subject) {
  Table measured(
      "case; uncertainty of the work over the work [of the work]; work over integral |F||dx| [1]");
  for (const Loop& loop : loops(subject, Weighting::current)) {
    const double rounding = 64 * epsilon * loop.trip.scale;
    measured.row(loop.name, (loop.trip.uncertainty + rounding) / std::abs(loop.trip.work),
                 loop.trip.work / loop.trip.scale);
  }
  return judge_worst(measured, "uncertainty of the work over the work", 0.01,
                     "a work of 100 times its uncertainty is not zero; the uncertainty is the "
                     "quadrature's error and 64 roundings",
                     "The paper does not say where |E|^2/(|N1| + |N2|) is taken. Only at rest is "
                     "the force the gradient of an energy.");
}

}  // namespace

std::vector<Check> bending_energy_checks() {
  return {
      {"bending.force-is-minus-gradient-of-energy",
       "With rest weighting the elastic force's work along any path is the energy's loss, for each "
       "law of the angle.",
       "derived from BMF03 section 4", force_is_minus_gradient},
      {"bending.energy-is-as-defined",
       "With rest weighting the energy is ke c times the integral of the law over theta from the "
       "rest angle.",
       "derived from BMF03 section 4, evaluated in 50 digits", energy_is_as_defined},
      {"bending.rest-weighting-does-no-work-round-a-closed-path",
       "With |E|^2/(|N1| + |N2|) taken at rest the elastic force does no work round a closed path.",
       "derived from BMF03 section 4", no_work_round_a_loop},
      {"bending.current-weighting-does-work-round-a-closed-path",
       "With |E|^2/(|N1| + |N2|) taken at the current positions the elastic force does work round "
       "a closed path: it has no energy.",
       "derived from BMF03 section 4", work_round_a_loop}};
}

}  // namespace foldproof
