// Collision response of a cloth point to the objects that it is about to enter: the paper's
// interface forecasting (BMF03 section 5.2). For comparison, the same against one object only, and
// two cruder ones.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "reference/level_set/object.h"
#include "reference/types.h"

namespace foldproof {

/// A point with a velocity that may be corrected.
struct MovingPoint {
  Vector3 p, v;  // m, m/s
  Span span;     // v moves p over this span
  double tau;    // the forecast time [s], > 0
  // the objects' answers at another place [m], in the objects' order, which may overwrite those
  // that a response was given; empty: not known
  std::function<std::vector<ObjectPoint>(const Vector3&)> elsewhere = {};
};

/// Interface forecasting against one object:
///   phi_new = phi + tau (v_p - v).N                     the signed distance forecast, tau ahead
///   v_pN'   = v_pN - phi_new/tau  if phi_new < 0        the point will be on the surface
///   v_T'    = max(0, 1 - mu (v_pN' - v_pN)/|v_T|) v_T   Coulomb friction against the relative v_T
/// Unchanged, bit for bit, if phi_new >= 0. v_p [m/s], tau [s] > 0, mu from `at`.
Vector3 forecast_velocity(const ObjectPoint& at, const Vector3& v_p, double tau);

/// A point inside two objects, held on the surface between them. A velocity along N_a - N_b,
/// inwards or outwards, makes psi = phi_a - phi_b zero at the time tau ahead. Along that surface
/// the point is free, except for friction against the mean of the two objects' velocities; the
/// normal forces are the pushes that a and b would exert alone. A point that is not pinched yet is
/// treated the same way if leaving one object leads into another that faces it. If N_a and N_b
/// nearly coincide there is no surface between them: response against a alone.
Vector3 velocity_between(const ObjectPoint& a, const ObjectPoint& b, const MovingPoint& point);

/// Where a response queries the objects.
enum class QueryTime {
  at_start,  // at the point, at the span's start
  at_end     // where its velocity takes the point, at the span's end
};

/// A collision response; `velocity` returns v, bit for bit, where no response is needed.
struct Response {
  std::string_view name, about;
  QueryTime query_time;
  // may reorder the answers
  Vector3 (*velocity)(std::span<ObjectPoint> answers, const MovingPoint& point);
};

/// The table of responses; the first is the paper's.
const std::vector<Response>& responses();

/// Throws InputError with the known names.
const Response& response_named(std::string_view name);

}  // namespace foldproof
