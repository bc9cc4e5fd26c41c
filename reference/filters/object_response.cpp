#include "reference/filters/object_response.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace foldproof {

namespace {

// Objects whose normals differ by less than this (5.7 degrees) have no distinct surface between
// them.
constexpr double least_difference_of_normals = 0.1;

// A point that would reach the surface within this fraction of the step is on it.
constexpr double touching = 1e-3;

/// The sliding velocity after friction, when the normal velocity changes by `push` [m/s].
double kept_by_friction(double mu, double push, double speed) {
  return speed > 0 ? std::max(0.0, 1 - mu * push / speed) : 0;
}

double forecast_distance(const ObjectPoint& at, const Vector3& v_p, double tau) {
  return at.phi + tau * (v_p - at.velocity).dot(at.normal);
}

//     \  p  /     Between walls that meet, N_a + N_b leads out of both: a point does not move
//    a \   / b    against it. Between walls that are parallel, it moves as it likes.
//       \ /
/// v without what leads deeper into both; `mean`, of the two objects [m/s], is no such motion.
Vector3 without_sinking(const ObjectPoint& a, const ObjectPoint& b, const Vector3& v,
                        const Vector3& mean) {
  const Vector3 out = a.normal + b.normal;
  if (!(out.norm() > least_difference_of_normals)) return v;
  const double speed = (v - mean).dot(out.normalized());
  return speed < 0 ? Vector3(v - speed * out.normalized()) : v;
}

//   v += u_a N_a + u_b N_b  with  phi_new = 0 of both:   u_a +   c u_b = -phi_new_a / tau
//                                                      c u_a +     u_b = -phi_new_b / tau
//   and c = N_a.N_b; where it is positive, the way out of one leads out of the other, too: c = 0
/// Leads a point out of both, and onto both where the way out of one leads back into the other.
Vector3 velocity_into_corner(const ObjectPoint& a, const ObjectPoint& b, const Vector3& v,
                             double tau) {
  const double c = std::min(0.0, a.normal.dot(b.normal));
  const double out_of_a = -forecast_distance(a, v, tau) / tau;  // m/s
  const double out_of_b = -forecast_distance(b, v, tau) / tau;  // m/s
  return v + ((out_of_a - c * out_of_b) * a.normal + (out_of_b - c * out_of_a) * b.normal) /
                 (1 - c * c);
}

/// Whether a point with velocity v [m/s] enters `b` nowhere on its way, though a forecast enters
/// the plane through b's nearest surface. From that plane on the way is followed as far as b's
/// distance reaches, and where it is on b's surface in small, then longer parts.
bool leads_past(const ObjectPoint& b, const Vector3& v, const MovingPoint& point) {
  constexpr double shortest = 1e-4;  // of tau
  constexpr double level = 1e-6;     // of the way in tau: a depth that still is the surface
  constexpr double steady = 1e-2;    // of the speed: a change of b's velocity that does not matter
  constexpr int most_places = 100;
  const Vector3 relative = v - b.velocity;
  const double speed = relative.norm(), approach = -relative.dot(b.normal);  // m/s
  if (!(approach > 0) || !std::isfinite(speed)) return false;
  double small = shortest * point.tau, time = b.phi / approach + small;
  for (int k = 0; k < most_places && time <= point.tau; ++k) {
    const ObjectPoint there = point.elsewhere(point.p + time * relative)[size_t(b.part)];
    if (there.phi < -level * speed * point.tau) return false;
    // it turns: from there its surface is elsewhere at the end
    if ((there.velocity - b.velocity).norm() > steady * speed) return false;
    const bool is_clear = there.phi > speed * shortest * point.tau;
    small = is_clear ? shortest * point.tau : 2 * small;
    time += is_clear ? there.phi / speed : small;
  }
  return time > point.tau;
}

/// Treats each object once, deepest forecast first, so that it also treats an object that will be
/// entered but is not the nearest. If the way out of one leads into another, the point is led to
/// both surfaces; if the two face each other, it is held between them.
Vector3 forecast_each(std::span<ObjectPoint> left, const MovingPoint& point) {
  Vector3 v = point.v;
  std::optional<ObjectPoint> before;
  const auto deeper = [&](const ObjectPoint& a, const ObjectPoint& b) {
    return forecast_distance(a, v, point.tau) < forecast_distance(b, v, point.tau);
  };
  while (!left.empty()) {
    const auto deepest = std::min_element(left.begin(), left.end(), deeper);
    if (!(forecast_distance(*deepest, v, point.tau) < 0)) break;
    if (before && face_each_other(*before, *deepest))
      return velocity_between(*before, *deepest, point);
    v = forecast_velocity(*deepest, v, point.tau);
    if (before && forecast_distance(*before, v, point.tau) < 0)
      v = velocity_into_corner(*before, *deepest, v, point.tau);
    before = *deepest;
    std::rotate(deepest, deepest + 1, left.end());
    left = left.first(left.size() - 1);
  }
  return v;
}

//    -- p ->          b's nearest side is hidden by a. A forecast against that side would stop the
//   -----.-----       point, though its way along a never enters b.
//     a  |  b
/// Objects that the way along the surface of the nearest one leads past are left out, if the way
/// that the others leave leads past them, too.
Vector3 forecast(std::span<ObjectPoint> answers, const MovingPoint& point) {
  if (answers.size() < 2 || !point.elsewhere) return forecast_each(answers, point);
  const ObjectPoint nearest = nearest_of(answers).first;
  const auto may_be_hidden = [&](const ObjectPoint& b) {
    return b.part != nearest.part && b.phi > 0 && forecast_distance(b, point.v, point.tau) < 0 &&
           !face_each_other(nearest, b);
  };
  if (std::ranges::none_of(answers, may_be_hidden)) return forecast_each(answers, point);
  // `elsewhere` may overwrite the answers
  std::vector<ObjectPoint> all(answers.begin(), answers.end()), hidden, left;
  const Vector3 along = forecast_velocity(nearest, point.v, point.tau);
  for (const ObjectPoint& b : all)
    (may_be_hidden(b) && leads_past(b, along, point) ? hidden : left).push_back(b);
  const Vector3 v = forecast_each(left, point);
  const bool enters = std::ranges::any_of(hidden, [&](const ObjectPoint& b) {
    return forecast_distance(b, v, point.tau) < 0 && !leads_past(b, v, point);
  });
  return enters ? forecast_each(all, point) : v;
}

Vector3 forecast_deepest(std::span<ObjectPoint> answers, const MovingPoint& point) {
  return forecast_velocity(nearest_of(answers).first, point.v, point.tau);
}

/// v with `push` [m/s] added along the normal, and friction.
Vector3 push_out_velocity(const ObjectPoint& at, const Vector3& v, double push) {
  const Vector3 relative = v - at.velocity;
  const Vector3 sliding = relative - relative.dot(at.normal) * at.normal;
  return v + push * at.normal - (1 - kept_by_friction(at.friction, push, sliding.norm())) * sliding;
}

/// Puts the point on the surface if it would be inside after the step. A velocity that ends the
/// step loses its component into a surface that the point is on.
Vector3 projection(std::span<ObjectPoint> answers, const MovingPoint& point) {
  const double h = point.span.end - point.span.start;
  const ObjectPoint at = nearest_of(answers).first;
  const double inwards = -(point.v - at.velocity).dot(at.normal);  // m/s
  double push = 0;
  if (h > 0 && at.phi < 0) push = -at.phi / h;
  if (h == 0 && at.phi < touching * point.span.step * inwards) push = inwards;
  return push > 0 ? push_out_velocity(at, point.v, push) : point.v;
}

/// A point inside after the step gets the velocity that takes it out in one step.
Vector3 push_out(std::span<ObjectPoint> answers, const MovingPoint& point) {
  if (point.span.end > point.span.start) return point.v;
  const ObjectPoint at = nearest_of(answers).first;
  return at.phi < 0 ? forecast_velocity(at, point.v, point.span.step) : point.v;
}

}  // namespace

Vector3 forecast_velocity(const ObjectPoint& at, const Vector3& v_p, double tau) {
  const Vector3 relative = v_p - at.velocity;
  const double phi_new = at.phi + tau * relative.dot(at.normal);
  if (phi_new >= 0) return v_p;

  const double push = -phi_new / tau;  // v_pN' - v_pN [m/s]
  const Vector3 sliding = relative - relative.dot(at.normal) * at.normal;
  const double kept = kept_by_friction(at.friction, push, sliding.norm());
  return at.velocity - at.phi / tau * at.normal + kept * sliding;
}

//        a        N_a, N_b point out of a and b; between the two surfaces the point is inside both
//   ----------    psi = phi_a - phi_b grows towards b; it is zero where both are equally deep
//    N_a | psi=0
//   ----------    d(psi)/dt = (v_p - v_a).N_a - (v_p - v_b).N_b
//        b
Vector3 velocity_between(const ObjectPoint& a, const ObjectPoint& b, const MovingPoint& point) {
  const Vector3 across = a.normal - b.normal;
  if (!(across.norm() > least_difference_of_normals))
    return forecast_velocity(a, point.v, point.tau);
  // m/s
  const double push_a = std::max(0.0, -forecast_distance(a, point.v, point.tau) / point.tau);
  const double push_b = std::max(0.0, -forecast_distance(b, point.v, point.tau) / point.tau);

  const Vector3 n = across.normalized();
  const double psi_new =
      forecast_distance(a, point.v, point.tau) - forecast_distance(b, point.v, point.tau);
  const Vector3 mean = (a.velocity + b.velocity) / 2;
  const Vector3 relative = point.v - mean;
  const Vector3 sliding = relative - relative.dot(n) * n;
  const double kept =
      kept_by_friction(1, a.friction * push_a + b.friction * push_b, sliding.norm());
  const Vector3 v = point.v - psi_new / (point.tau * across.norm()) * n - (1 - kept) * sliding;
  return without_sinking(a, b, v, mean);
}

const std::vector<Response>& responses() {
  static const std::vector<Response> table = {
      {"forecast", "interface forecasting; pinched points are held between (BMF03 section 5.2)",
       QueryTime::at_start, forecast},
      {"forecast_deepest",
       "interface forecasting against the deepest or nearest object alone, pinched or not",
       QueryTime::at_start, forecast_deepest},
      {"projection", "points are put on the surface after the step", QueryTime::at_end, projection},
      {"push_out",
       "points found inside after a step are given the velocity that takes them out in the next",
       QueryTime::at_start, push_out},
  };
  return table;
}

const Response& response_named(std::string_view name) {
  std::string known;
  for (const Response& response : responses()) {
    if (response.name == name) return response;
    known += (known.empty() ? "" : ", ") + std::string(response.name);
  }
  throw InputError("unknown response '" + std::string(name) + "'; known: " + known);
}

}  // namespace foldproof
