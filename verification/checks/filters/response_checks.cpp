// Interface forecasting for one point at one object (BMF03 section 5.2).
#include "verification/specimens/check.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

/// One particle before and after the correction, relative to the object.
struct Answer {
  KnownPoint known;
  Vector3 before, after;           // velocities [m/s]
  double forecast;                 // phi + tau (v_p - v).N before [m]
  double push;                     // change of the normal velocity [m/s]
  Vector3 sliding, still_sliding;  // tangential relative velocity before and after [m/s]
  double speed;                    // of all velocities that enter [m/s]
};

Answer answer_of(const Contact& contact, const PerParticle3& after, Eigen::Index i) {
  Answer a;
  a.known = contact.known(contact.state.x.col(i), contact.span);
  a.before = contact.state.v.col(i);
  a.after = after.col(i);
  const Vector3& n = a.known.normal;
  const Vector3 relative = a.before - a.known.velocity, relative_after = a.after - a.known.velocity;
  a.forecast = a.known.phi + contact.tau * relative.dot(n);
  a.push = (a.after - a.before).dot(n);
  a.sliding = relative - relative.dot(n) * n;
  a.still_sliding = relative_after - relative_after.dot(n) * n;
  a.speed = a.before.norm() + a.known.velocity.norm() + std::abs(a.known.phi) / contact.tau;
  return a;
}

/// Smallest forecast whose sign is known in spite of rounding [m]; lengths are near 1 m.
double unsure(const Contact& contact) { return 100 * epsilon * (1 + 4 * contact.tau); }

// Error of phi and of the object's velocity due to rounding of positions near 1 m, in velocities of
// a step of a hundredth of a second: the scale of all bounds below.
constexpr const char* why_roundings =
    "a few dozen roundings in converting to the object's frame and back, of lengths of a metre, "
    "divided by the step where a mean velocity is computed";
double velocity_scale(const Contact& contact, const Answer& a) {
  return a.speed + 1 / contact.span.step;
}

/// The worst of a quantity in roundings, over the contacts' particles that `wanted` accepts.
Finding worst_over(const Subject& subject,
                   const std::function<bool(const Contact&, const Answer&)>& wanted,
                   const std::function<double(const Contact&, const Answer&)>& roundings) {
  Table measured = roundings_of("speed");
  for (const Contact& contact : known_contacts()) {
    const PerParticle3 after =
        corrected_by_objects(subject, contact.scene, contact.span, contact.state);
    Worst worst;
    long queries = 0;
    for (Eigen::Index i = 0; i < after.cols(); ++i) {
      const Answer a = answer_of(contact, after, i);
      if (!wanted(contact, a)) continue;
      worst.observe(roundings(contact, a));
      ++queries;
    }
    measured.row(contact.name + ", " + std::to_string(queries) + " particles",
                 queries > 20 ? worst.value() : nan);
  }
  return judge_worst(measured, 40, why_roundings);
}

bool is_treated(const Contact& contact, const Answer& a) { return a.forecast < -unsure(contact); }

Finding forecast_finding(const Subject& subject) {
  return worst_over(subject, is_treated, [](const Contact& contact, const Answer& a) {
    const double phi = a.known.phi + contact.tau * (a.after - a.known.velocity).dot(a.known.normal);
    return std::abs(phi) / (epsilon * (contact.tau * velocity_scale(contact, a) + 1));
  });
}

Finding coulomb_finding(const Subject& subject) {
  return worst_over(subject, is_treated, [](const Contact& contact, const Answer& a) {
    const double wanted = std::min(a.sliding.norm(), contact.friction * a.push);
    return std::abs((a.sliding - a.still_sliding).norm() - wanted) /
           (epsilon * velocity_scale(contact, a));
  });
}

Finding cone_finding(const Subject& subject) {
  return worst_over(
      subject, [](const Contact&, const Answer&) { return true; },
      [](const Contact& contact, const Answer& a) {
        const double beyond = (a.sliding - a.still_sliding).norm() - contact.friction * a.push;
        return std::max(0.0, beyond) / (epsilon * velocity_scale(contact, a));
      });
}

/// Reversed, sideways and increased sliding: none of the three may occur.
Finding reversal_finding(const Subject& subject) {
  return worst_over(subject, is_treated, [](const Contact& contact, const Answer& a) {
    const double scale = epsilon * velocity_scale(contact, a);
    const double speed = a.sliding.norm();
    if (!(speed > 1e-9)) return a.still_sliding.norm() / scale;
    const Vector3 direction = a.sliding / speed;
    const double along = a.still_sliding.dot(direction);
    const double aside = (a.still_sliding - along * direction).norm();
    return std::max({0.0, -along, along - speed, aside, std::isnan(along) ? along : 0.0}) / scale;
  });
}

Finding untouched_finding(const Subject& subject) {
  double differ = 0, untreated = 0;
  for (Contact contact : known_contacts())
    for (const char* const response : {"forecast", "forecast_deepest"}) {
      contact.scene.collision.response = response;
      const PerParticle3 after =
          corrected_by_objects(subject, contact.scene, contact.span, contact.state);
      for (Eigen::Index i = 0; i < after.cols(); ++i) {
        const Answer a = answer_of(contact, after, i);
        if (!(a.forecast > unsure(contact))) continue;
        ++untreated;
        differ += count_differing_entries(after.col(i), contact.state.v.col(i));
      }
    }
  return {{untreated > 100 ? differ : nan, 0, 0, "numbers",
           "a point that is forecast to be outside must keep its velocity, bit for bit"},
          Table{{"untreated particles", "1"}}.with_row(untreated)};
}

//   N0   N1       over the step the plane turns by theta from N0 to N1 and takes the point's place
//    |  /         with it; the point slides by w across N0, of which |w.N1| <= |w| sin(theta) is
//  --p-----w-->   depth, and of a depth that it had 1 - cos(theta) is left
Finding turning_finding(const Subject& subject) {
  Table measured{{"case", ""},
                 {"deepest point after the step", "|w| sin(theta) + depth (1 - cos(theta))"}};
  for (const Contact& contact : known_contacts()) {
    const double h = contact.span.end - contact.span.start;
    if (!contact.name.starts_with("slope") || contact.tau != contact.span.step) continue;
    const PerParticle3 after =
        corrected_by_objects(subject, contact.scene, contact.span, contact.state);
    const Span end{contact.span.end, contact.span.end, contact.span.step};
    Worst worst;
    for (Eigen::Index i = 0; i < after.cols(); ++i) {
      const Answer a = answer_of(contact, after, i);
      if (!is_treated(contact, a)) continue;
      const KnownPoint then = contact.known(contact.state.x.col(i) + h * a.after, end);
      const double turned = a.known.normal.cross(then.normal).norm();
      const double depth = std::abs(a.known.phi) * (1 - a.known.normal.dot(then.normal));
      worst.observe(-then.phi / (h * a.still_sliding.norm() * turned + depth + unsure(contact)));
    }
    measured.row(contact.name, worst.value());
  }
  return judge_worst(measured, 1,
                     "geometry of a plane that turns, and roundings of lengths of a metre");
}

Finding galilean_finding(const Subject& subject) {
  const Vector3 shared(5.3, -7.1, 3.7);
  Table measured = roundings_of("speed");
  for (Contact contact : known_contacts()) {
    contact.span = {0, contact.span.step, contact.span.step};  // the frames coincide at time 0
    contact.state.time = 0;
    Contact seen = contact;
    seen.state.v.colwise() += shared;
    auto& body = std::get<RigidObject>(seen.scene.objects[0].object.body);
    std::get<Motion>(body.motion).velocity += shared;
    const PerParticle3 here =
        corrected_by_objects(subject, contact.scene, contact.span, contact.state);
    PerParticle3 there = corrected_by_objects(subject, seen.scene, seen.span, seen.state);
    there.colwise() -= shared;
    measured.row(contact.name,
                 largest_difference(here, there) /
                     (epsilon * (1 / contact.span.step + shared.norm() + largest_speed(here))));
  }
  return judge_worst(measured, 40, why_roundings);
}

/// A sheet of particles through the middle of a body, row by row, each with a random velocity.
struct Crossing {
  Scene scene;
  State state;
};

Crossing crossing(const std::vector<SceneObject>& parts) {
  Crossing crossing{loose_particles(25), {}};
  crossing.scene.objects = parts;
  Random random(23);
  const PerParticle3 x = crossing.scene.x.colwise() - crossing.scene.x.rowwise().mean();
  crossing.state = {0, x + 0.01 * random.vectors(x.cols(), 1), random.vectors(x.cols(), 2)};
  return crossing;
}

/// The same particles, each in a scene of its own.
PerParticle3 corrected_alone(const Subject& subject, const Crossing& crossing, const Span& span) {
  PerParticle3 all(3, crossing.state.x.cols());
  for (Eigen::Index i = 0; i < all.cols(); ++i) {
    Scene alone = loose_particles(2);
    alone.objects = crossing.scene.objects;
    const State state{0, crossing.state.x.col(i).replicate(1, alone.x.cols()),
                      crossing.state.v.col(i).replicate(1, alone.x.cols())};
    all.col(i) = corrected_by_objects(subject, alone, span, state).col(0);
  }
  return all;
}

Finding neighbours_finding(const Subject& subject) {
  constexpr double radius = 0.31, step = 0.01;
  const DistanceFunction ball = [](const Vector3& p) { return Sphere{radius}.at(p); };
  const auto tree = std::make_shared<const Octree>(make_octree(
      {ball}, {Vector3::Constant(-0.5), 1, 6, 3, 1e-3, 0.05, 0.25, 0, HangingNodes::constrained}));
  Table answers("body [1]; particles answered [1]; numbers that differ [1]");
  double worst = 0;
  Motion turning, flying;
  turning.angular_velocity = {0, 1, 3};
  flying.velocity = {0, 0, -20};  // by its diameter in a step: contact is forecast from far away
  const SceneObject flies =
      with_motion(object_at("two balls, one flying", Sphere{0.1}, {{1, 0, 0, 0}, {0.25, 0, 0.25}}),
                  flying, 0.3);
  const SceneObject still = object_at("", Sphere{0.1}, {{1, 0, 0, 0}, {-0.3, 0, 0}});
  for (const std::vector<SceneObject>& parts :
       {std::vector{with_motion(object_at("ball", Sphere{radius}, {}), turning, 0.3)},
        std::vector{with_motion(object_at("octree", OctreeSolid{tree}, {}), turning, 0.3)},
        std::vector{with_motion(object_at("pin", Capsule{0.03, 0.7}, {}), turning, 0.3)},
        std::vector{flies, still}}) {
    const Crossing crossed = crossing(parts);
    const Span span{0, step, step};
    const PerParticle3 together = corrected_by_objects(subject, crossed.scene, span, crossed.state);
    const auto changed = (together - crossed.state.v).colwise().any().count();
    const double differ =
        count_differing_entries(together, corrected_alone(subject, crossed, span));
    answers.row(parts.front().object.name, changed, differ);
    worst = changed > 0 ? worst + differ : nan;
  }
  return {{worst, 0, 0, "numbers",
           "a neighbour's distance may save a query, but only where the answer cannot matter"},
          answers,
          "625 particles in rows through the middle of each body, together and one at a time"};
}

}  // namespace

std::vector<Check> response_checks() {
  return {
      {"contact.forecast-ends-on-the-surface",
       "A point that is treated is forecast to lie on the surface: phi + tau (v_p - v).N = 0.",
       "BMF03 section 5.2", forecast_finding},
      {"contact.untreated-points-are-bitwise-unchanged",
       "A point that is forecast to stay outside keeps its velocity bit for bit.",
       "BMF03 section 5.2", untouched_finding},
      {"contact.friction-obeys-coulomb",
       "Friction takes mu times the change of the normal velocity from the sliding velocity, or "
       "all of it.",
       "BMF03 section 5.2", coulomb_finding},
      {"contact.impulse-stays-in-the-friction-cone",
       "The tangential impulse is at most mu times the normal one.", "BMF03 section 5.2",
       cone_finding},
      {"contact.sliding-is-never-reversed",
       "Friction shortens the sliding velocity: it never turns, reverses or lengthens it, and zero "
       "stays zero.",
       "BMF03 section 5.2", reversal_finding},
      {"contact.response-is-galilean-invariant",
       "A velocity added to both cloth and object does not change the response.", "mechanics",
       galilean_finding},
      {"contact.turning-plane-is-penetrated-as-derived",
       "A point enters a plane that turns in a step by no more than the distance it slides times "
       "the sine of the turn.",
       "BMF03 section 5.2", turning_finding},
      {"contact.neighbours-do-not-matter",
       "A particle gets the same bits alone and among its neighbours.", "BMF03 section 5.2",
       neighbours_finding},
  };
}

}  // namespace foldproof
