// The two responses that forecasting is compared with: projection after the step, and pushing out
// in the next one.
#include "verification/specimens/check.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/differences.h"

namespace foldproof {

namespace {

/// v with `push` [m/s] along the normal, and Coulomb's friction against it.
Vector3 expected_answer(const KnownPoint& at, const Vector3& v, double push, double friction) {
  const Vector3 relative = v - at.velocity,
                sliding = relative - relative.dot(at.normal) * at.normal;
  const double lost = std::min(sliding.norm(), friction * push);
  return v + push * at.normal - lost * sliding.normalized();
}

/// The push needed by a point with this velocity [m/s], 0 for none; NaN where roundings decide.
using Push = std::function<double(const Contact&, const KnownPoint&, const Vector3& v)>;

double known_push(double depth, double push) {
  return std::abs(depth) < 1e-12 ? NAN : depth > 0 ? push : 0;
}

/// Actual against expected response for the particles of all contacts. `moves`: the velocity moves
/// the particles through the step; otherwise it ends the step.
Finding response_finding(const Subject& subject, const std::string& response, bool moves,
                         const Push& push) {
  Table measured = roundings_of("speed");
  for (Contact contact : known_contacts()) {
    if (contact.tau != contact.span.step) continue;  // these responses do not look ahead
    contact.scene.collision.response = response;
    if (!moves) contact.span.end = contact.span.start;
    const PerParticle3 after =
        corrected_by_objects(subject, contact.scene, contact.span, contact.state);
    const Span then{contact.span.end, contact.span.end, contact.span.step};
    Worst worst;
    int answers = 0, untouched = 0;
    for (Eigen::Index i = 0; i < after.cols(); ++i) {
      const Vector3 v = contact.state.v.col(i);
      const Vector3 place = contact.state.x.col(i) + (contact.span.end - contact.span.start) * v;
      const KnownPoint at = contact.known(place, then);
      const double needed = push(contact, at, v);
      if (std::isnan(needed)) continue;
      ++(needed > 0 ? answers : untouched);
      const Vector3 expected = needed > 0 ? expected_answer(at, v, needed, contact.friction) : v;
      const double speed = v.norm() + at.velocity.norm() + 1 / contact.span.step;
      worst.observe((after.col(i) - expected).norm() / (needed > 0 ? epsilon * speed : 1e-300));
    }
    measured.row(contact.name + ", " + std::to_string(answers) + " answered",
                 answers > 20 && untouched > 20 ? worst.value() : NAN);
  }
  return judge_worst(
      measured, 40,
      "a few dozen roundings in converting to the object's frame and back, of lengths of a metre "
      "over the step; a point that needs no correction keeps its velocity bit for bit");
}

Finding projection_finding(const Subject& subject) {
  return response_finding(subject, "projection", true,
                          [](const Contact& contact, const KnownPoint& at, const Vector3&) {
                            return known_push(-at.phi, -at.phi / contact.span.step);
                          });
}

/// The velocity that ends the step: a point that would reach the surface within a thousandth of the
/// step counts as on it.
Finding stopping_finding(const Subject& subject) {
  return response_finding(subject, "projection", false,
                          [](const Contact& contact, const KnownPoint& at, const Vector3& v) {
                            const double inwards = -(v - at.velocity).dot(at.normal);
                            return known_push(1e-3 * contact.span.step * inwards - at.phi,
                                              std::max(inwards, 0.0));
                          });
}

Finding push_out_finding(const Subject& subject) {
  return response_finding(subject, "push_out", false,
                          [](const Contact& contact, const KnownPoint& at, const Vector3& v) {
                            const double forecast =
                                at.phi / contact.span.step + (v - at.velocity).dot(at.normal);
                            return known_push(-at.phi, std::max(-forecast, 0.0));
                          });
}

Finding no_push_finding(const Subject& subject) {
  double differ = 0;
  for (Contact contact : known_contacts()) {
    contact.scene.collision.response = "push_out";
    differ += count_differing_entries(
        corrected_by_objects(subject, contact.scene, contact.span, contact.state), contact.state.v);
  }
  return {{differ, 0, 0, "numbers",
           "only the velocity at the end of a step is changed, not the one that moves the point"},
          {}};
}

}  // namespace

std::vector<Check> object_response_checks() {
  const std::string source = "what BMF03 section 5.2 is compared with";
  return {
      {"contact.projection-ends-on-the-surface",
       "With the response 'projection' a point that enters an object in a step is put on its "
       "surface along the normal, with friction; others keep every bit.",
       source, projection_finding},
      {"contact.projection-removes-inward-velocity-at-contact",
       "With 'projection' the velocity at the end of a step has no component into a surface that "
       "the point is on.",
       source, stopping_finding},
      {"contact.push-out-expels-points-in-one-step",
       "With 'push_out' a point inside gets the velocity that moves it to the surface in one step.",
       source, push_out_finding},
      {"contact.push-out-does-not-look-ahead",
       "With 'push_out' the velocity that moves the cloth in a step is not changed by a bit.",
       source, no_push_finding}};
}

}  // namespace foldproof
