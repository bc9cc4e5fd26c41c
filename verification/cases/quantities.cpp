#include "verification/cases/quantities.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "verification/cases/self_crossings.h"

namespace foldproof {

namespace {

constexpr double degrees_per_radian = 180 / pi;

// ---- of the whole run

double energy_unaccounted(const RunView& run) {
  return run.summary.balance.value() / run.summary.largest_exchange;
}

double energy_drift(const RunView& run) {
  const DiagnosticsSummary& summary = run.summary;
  return std::abs(summary.late / summary.late_time - summary.early / summary.early_time) /
         summary.largest_exchange;
}

/// An upper bound on sum m |v| at any time, by Cauchy and Schwarz from the kinetic energy [kg m/s].
double momentum_scale(const RunView& run) {
  return std::sqrt(2 * masses_of(run.scene).sum() * run.summary.largest_kinetic);
}

double linear_change(const RunView& run) {
  return run.summary.linear.value() / momentum_scale(run);
}

/// An upper bound on sum m |x| |v| while the cloth is no farther from the origin than at
/// its start or end.
double angular_change(const RunView& run) {
  const double reach =
      std::sqrt(std::max(run.scene.x.colwise().squaredNorm().maxCoeff(),
                         run.result.last.x.colwise().squaredNorm().maxCoeff()));  // m
  return run.summary.angular.value() / (reach * momentum_scale(run));
}

// ---- of one frame

double distance_from_plane(const Scene& scene, const State& s) {
  Worst worst;
  for (Eigen::Index i = 0; i < s.x.cols(); ++i)
    worst.observe(std::abs(s.x(2, i) - scene.mesh.rest(2, 0)));
  return worst.value();
}

double angle_change(const Scene& scene, const State& s) {
  const std::vector<double> angles = hinge_angles(scene.mesh, s.x);
  Worst worst;
  for (size_t h = 0; h < angles.size(); ++h)
    worst.observe(std::abs(std::remainder(angles[h] - scene.rest_angles[h], 2 * pi)) *
                  degrees_per_radian);
  return worst.value();
}

double largest_angle(const Scene& scene, const State& s, double sign) {
  double largest = -180;
  for (const double angle : hinge_angles(scene.mesh, s.x)) {
    if (std::isnan(angle)) return nan;
    largest = std::max(largest, sign * angle * degrees_per_radian);
  }
  return largest;
}

double folded_forward(const Scene& scene, const State& s) { return largest_angle(scene, s, 1); }
double folded_back(const Scene& scene, const State& s) { return largest_angle(scene, s, -1); }

double length_change(const Scene& scene, const State& s) {
  Worst worst;
  for (const double strain : strains_of(scene, s.x)) worst.observe(std::abs(strain));
  return worst.value();
}

/// The objects' answers for each particle in a frame.
std::vector<Nearest> nearest_at(std::span<const Object> objects, const State& s) {
  ObjectsOverSpan now(objects, {s.time, s.time, 0});
  std::vector<Nearest> nearest;
  for (Eigen::Index i = 0; i < s.x.cols(); ++i) nearest.push_back(nearest_of(now.at(s.x.col(i))));
  return nearest;
}

/// Of free particles. Those held between two objects are inside by their motion, and not counted.
double penetration(const Scene& scene, std::span<const Object> objects, const State& s) {
  std::vector<char> free(size_t(s.x.cols()), 1);
  for (const PrescribedParticle& p : scene.prescribed) free[size_t(p.particle)] = 0;
  Worst worst;
  const std::vector<Nearest> nearest = nearest_at(objects, s);
  for (size_t i = 0; i < nearest.size(); ++i)
    if (free[i] && !nearest[i].held_between()) worst.observe(-nearest[i].first.phi);
  return worst.value();
}

double depth_at_end(const RunView& run) {
  return penetration(run.scene, run.objects, run.result.last);
}

/// How far a pinched particle is from the surface where its two objects are equally deep, at most.
double off_centre(const Scene&, std::span<const Object> objects, const State& s) {
  Worst worst;
  for (const Nearest& nearest : nearest_at(objects, s)) {
    if (!nearest.held_between()) continue;
    const double slope = (nearest.first.normal - nearest.second.normal).norm();
    worst.observe(std::abs(nearest.first.phi - nearest.second.phi) / slope);
  }
  return worst.value();
}

double pinched_particles(const Scene&, std::span<const Object> objects, const State& s) {
  double count = 0;
  for (const Nearest& nearest : nearest_at(objects, s)) count += nearest.held_between() ? 1 : 0;
  return count;
}

double fastest(const Scene&, const State& s) {
  Worst worst;
  for (Eigen::Index i = 0; i < s.v.cols(); ++i) worst.observe(s.v.col(i).norm());
  return worst.value();
}

/// The rate of the rigid turn about the vertical axis through the origin that has the cloth's
/// angular momentum.
double turning_rate(const Scene& scene, const State& s) {
  const PerParticle mass = masses_of(scene);
  double momentum = 0, inertia = 0;  // kg m^2/s, kg m^2
  for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
    momentum += mass[i] * (s.x(2, i) * s.v(0, i) - s.x(0, i) * s.v(2, i));
    inertia += mass[i] * (s.x(0, i) * s.x(0, i) + s.x(2, i) * s.x(2, i));
  }
  return std::abs(momentum / inertia) * degrees_per_radian;
}

/// Of the mean of all particles, since the start.
double shift(const Scene& scene, const State& s) {
  return (s.x.rowwise().mean() - scene.x.rowwise().mean()).norm();
}

/// Across gravity.
double shift_aside(const Scene& scene, const State& s) {
  const Vector3 moved = s.x.rowwise().mean() - scene.x.rowwise().mean(),
                down = scene.gravity->normalized();
  return (moved - moved.dot(down) * down).norm();
}

// ---- refusals

std::string without_plane(const Scene& scene) {
  if (distance_from_plane(scene, start_state(scene)) >
      0.01 * (scene.x.rowwise().maxCoeff() - scene.x.rowwise().minCoeff()).maxCoeff())
    return "the cloth does not start in a plane of constant z";
  return "";
}

}  // namespace

std::string without_objects(const Scene& scene) {
  return scene.objects.empty() ? "the case has no [[object]]" : "";
}

std::string without_gravity(const Scene& scene) {
  return scene.gravity && scene.gravity->norm() > 0 ? "" : "the case has no [gravity]";
}

Vector3 up_in(const Scene& scene) {
  return without_gravity(scene).empty() ? Vector3(-scene.gravity->normalized()) : Vector3::UnitY();
}

std::string without_bending(const Scene& scene) {
  return scene.bending ? "" : "the case has no [bending]";
}

std::string without_springs(const Scene& scene) {
  return scene.stretch ? "" : "the case has no [stretch]";
}

void DiagnosticsSummary::record(const Diagnostics& row, double end) {
  if (!is_begun_) start = row;
  is_begun_ = true;
  const auto balance_of = [](const Diagnostics& of) { return of.energy.total() - of.damping_work; };
  balance.observe(std::abs(balance_of(row) - balance_of(start)));
  largest_exchange =
      std::max({largest_exchange, std::abs(row.energy.kinetic - start.energy.kinetic),
                std::abs(row.energy.stretch - start.energy.stretch),
                std::abs(row.energy.bending - start.energy.bending),
                std::abs(row.energy.gravity - start.energy.gravity)});
  largest_kinetic = std::max(largest_kinetic, row.energy.kinetic);
  linear.observe((row.linear_momentum - start.linear_momentum).norm());
  contacts = std::max(contacts, row.work.object_contacts);
  last_kinetic = row.energy.kinetic;
  angular.observe((row.angular_momentum - start.angular_momentum).norm());
  if (row.time <= 0.1 * end) {
    early += row.step * balance_of(row);
    early_time += row.step;
  }
  if (row.time >= 0.9 * end) {
    late += row.step * balance_of(row);
    late_time += row.step;
  }
}

namespace {

std::vector<Quantity> quantities_of_the_run() {
  return {
      {"runs_to_its_end", "stops", "The run reaches its end with finite values.", Sense::at_most,
       Scope::any_cloth, nullptr, [](const RunView& run) { return run.result.stop ? 1. : 0.; },
       nullptr},
      {"is_reproducible", "steps",
       "Ten steps each after the start, after the middle frame and before the last give the same "
       "bits when repeated in another thread.",
       Sense::at_most, Scope::any_cloth, nullptr,
       [](const RunView& run) { return run.repetition.count_differing_steps(); }, nullptr},
      {"takes_steps", "steps", "The run takes as many steps as it should.", Sense::at_least,
       Scope::this_shape, nullptr, [](const RunView& run) { return double(run.result.steps); },
       nullptr},
      {"solves_converge", "solves",
       "The linear solves reach their tolerance before their cap on iterations.", Sense::at_most,
       Scope::any_cloth, nullptr,
       [](const RunView& run) { return double(run.result.work.unfinished_solves); }, nullptr},
      {"energy_is_accounted_for", "1",
       "Kinetic, elastic and gravitational energy minus the work of damping is conserved, relative "
       "to the energy exchanged.",
       Sense::at_most, Scope::any_cloth, nullptr, energy_unaccounted, nullptr},
      {"energy_does_not_drift", "1",
       "The mean of that energy over the last tenth of the run equals its mean over the first "
       "tenth, relative to the energy exchanged.",
       Sense::at_most, Scope::any_cloth, nullptr, energy_drift, nullptr},
      {"linear_momentum_is_conserved", "1", "Linear momentum is conserved, over sqrt(2 m E_kin).",
       Sense::at_most, Scope::any_cloth, nullptr, linear_change, nullptr},
      {"angular_momentum_is_conserved", "1",
       "Angular momentum about the origin is conserved, relative to the cloth's extent times "
       "sqrt(2 m E_kin).",
       Sense::at_most, Scope::any_cloth, nullptr, angular_change, nullptr},
  };
}

std::vector<Quantity> quantities_of_shape_and_place() {
  return {
      {"stays_flat", "m", "No particle leaves the plane of constant z in which the cloth lies.",
       Sense::at_most, Scope::this_shape, distance_from_plane, nullptr, without_plane},
      {"leaves_its_plane", "m",
       "Some particle leaves the plane of constant z in which the cloth lies.", Sense::at_least,
       Scope::this_shape, distance_from_plane, nullptr, without_plane},
      {"keeps_its_angles", "degrees", "Every hinge stays near its rest angle.", Sense::at_most,
       Scope::this_shape, angle_change, nullptr, without_bending},
      {"folds_to", "degrees", "Some hinge folds this far to the positive side.", Sense::at_least,
       Scope::this_shape, folded_forward, nullptr, without_bending},
      {"folds_back_to", "degrees", "Some hinge folds this far to the negative side.",
       Sense::at_least, Scope::this_shape, folded_back, nullptr, without_bending},
      {"keeps_its_lengths", "1", "Every edge stays near its rest length.", Sense::at_most,
       Scope::this_shape, length_change, nullptr, without_springs},
      {"stays_outside", "m",
       "No free particle is deeper inside an object than this, except particles between two "
       "objects.",
       Sense::at_most, Scope::any_cloth, nullptr, nullptr, without_objects, penetration},
      {"lies_inside", "m",
       "At the end some free particle is this deep inside an object; particles between two objects "
       "do not count.",
       Sense::at_least, Scope::this_shape, nullptr, depth_at_end, without_objects},
      {"makes_contact", "points", "Objects correct the motion of some points in some step.",
       Sense::at_least, Scope::this_shape, nullptr,
       [](const RunView& run) { return double(run.summary.contacts); }, without_objects},
      {"is_pinched", "particles", "Particles are inside two objects that face each other.",
       Sense::at_least, Scope::this_shape, nullptr, nullptr, without_objects, pinched_particles},
      {"stays_between", "m", "Particles inside two objects stay equally deep in both.",
       Sense::at_most, Scope::any_cloth, nullptr, nullptr, without_objects, off_centre},
      {"never_crosses_itself", "pairs",
       "In no frame does an edge of the cloth meet one of its own triangles; touching counts.",
       Sense::at_most, Scope::any_cloth, self_crossings, nullptr, nullptr},
      {"tangle_does_not_grow", "pairs",
       "In no frame do more edges than this meet triangles of the same cloth.", Sense::at_most,
       Scope::this_shape, self_crossings, nullptr, nullptr},
      {"ends_untangled", "pairs", "At the end no edge of the cloth meets one of its own triangles.",
       Sense::at_most, Scope::any_cloth, nullptr, self_crossings_at_end, nullptr},
      {"keeps_its_place", "m", "The mean of all particles stays where it was.", Sense::at_most,
       Scope::this_shape, shift, nullptr, nullptr},
      {"is_carried", "m", "The mean of all particles is carried away from where it was.",
       Sense::at_least, Scope::this_shape, shift, nullptr, nullptr},
      {"is_carried_aside", "m", "The mean of all particles is carried aside, across gravity.",
       Sense::at_least, Scope::this_shape, shift_aside, nullptr, without_gravity},
      {"speed_is_limited", "m/s", "No particle is faster than this.", Sense::at_most,
       Scope::this_shape, fastest, nullptr, nullptr},
      {"reaches_turning_rate", "degrees/s",
       "The cloth ends up turning about the vertical axis at this rate.", Sense::at_least,
       Scope::this_shape, turning_rate, nullptr, nullptr},
      {"comes_to_rest", "1",
       "At the end the kinetic energy is small relative to its largest value.", Sense::at_most,
       Scope::this_shape, nullptr,
       [](const RunView& run) { return run.summary.last_kinetic / run.summary.largest_kinetic; },
       nullptr},
  };
}

}  // namespace

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> table = [] {
    std::vector<Quantity> all = quantities_of_the_run();
    for (const Quantity& more : quantities_of_shape_and_place()) all.push_back(more);
    for (const Quantity& more : face_quantities()) all.push_back(more);
    for (const Quantity& more : sticking_quantities()) all.push_back(more);
    for (const Quantity& more : strain_quantities()) all.push_back(more);
    for (const Quantity& more : standing_quantities()) all.push_back(more);
    for (const Quantity& more : wrinkle_quantities()) all.push_back(more);
    return all;
  }();
  return table;
}

double value_at(const Quantity& quantity, const Scene& scene, std::span<const Object> objects,
                const State& frame) {
  return quantity.of_objects ? quantity.of_objects(scene, objects, frame)
                             : quantity.of_frame(scene, frame);
}

const Quantity* find_quantity(std::string_view key) {
  for (const Quantity& quantity : quantities())
    if (key == quantity.key) return &quantity;
  return nullptr;
}

}  // namespace foldproof
