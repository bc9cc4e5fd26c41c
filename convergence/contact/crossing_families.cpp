#include "convergence/contact/crossing_families.h"

#include <cmath>

#include "verification/specimens/random.h"

namespace foldproof {

namespace {

/// Whole coordinates from -largest to largest, times `unit`.
Vector3 whole_point(Random& random, int largest, int unit = 1) {
  Vector3 p;
  for (double& c : p) c = unit * std::floor(random.uniform(-largest, largest + 1));
  return p;
}

Corners4 whole_points(Random& random, int largest, int unit = 1) {
  Corners4 x;
  for (int k = 0; k < 4; ++k) x.col(k) = whole_point(random, largest, unit);
  return x;
}

CrossingQuery between(PairKind kind, const Corners4& start, const Corners4& end) {
  return {kind, start, end - start};
}

bool is_heads(Random& random) { return random.uniform(0, 1) < 0.5; }

/// Points of a plane, which itself moves.
Corners4 flat_points(Random& random, const Vector3& u, const Vector3& w) {
  const Vector3 origin = whole_point(random, 5);
  Corners4 x;
  for (int k = 0; k < 4; ++k)
    x.col(k) =
        origin + std::floor(random.uniform(-4, 5)) * u + std::floor(random.uniform(-4, 5)) * w;
  return x;
}

CrossingQuery coplanar_throughout(Random& random, PairKind kind) {
  const Vector3 u = whole_point(random, 3), w = whole_point(random, 3);
  return between(kind, flat_points(random, u, w), flat_points(random, u, w));
}

/// The vertex, or an end of the second edge, is halfway exactly on a corner or in the middle of a
/// side of the triangle, or on an end or in the middle of the first edge. Multiples of four leave
/// halves and means whole.
CrossingQuery on_the_border_halfway(Random& random, PairKind kind) {
  const Corners4 start = whole_points(random, 5, 4);
  Corners4 end = whole_points(random, 5, 4);
  const bool is_vertex = kind == PairKind::vertex_triangle;
  const int touching = is_vertex ? 0 : 2, corner = is_vertex ? 1 : 0;
  const Vector3 there = (start.col(corner) + end.col(corner)) / 2;
  const Vector3 next = (start.col(corner + 1) + end.col(corner + 1)) / 2;
  const Vector3 touched = is_heads(random) ? there : Vector3((there + next) / 2);
  end.col(touching) = 2 * touched - start.col(touching);
  return between(kind, start, end);
}

/// Some points that meet inside: the vertex in the triangle, the edges in both their middles.
Corners4 met_points(Random& random, PairKind kind) {
  Corners4 x = whole_points(random, 5, 4);
  if (kind == PairKind::vertex_triangle) {
    x.col(0) = (2 * x.col(1) + x.col(2) + x.col(3)) / 4;
  } else {
    const Vector3 middle = (x.col(0) + x.col(1)) / 2, half = whole_point(random, 9);
    x.col(2) = middle + half;
    x.col(3) = middle - half;
  }
  return x;
}

CrossingQuery met_at_an_end(Random& random, PairKind kind) {
  const Corners4 met = met_points(random, kind), other = whole_points(random, 5, 4);
  return is_heads(random) ? between(kind, met, other) : between(kind, other, met);
}

/// Both edges, or the triangle's first side and the line from its third corner to the
/// vertex, are parallel.
Corners4 parallel_points(Random& random, PairKind kind) {
  Corners4 x = whole_points(random, 6);
  const Vector3 d = whole_point(random, 3);
  const auto along = [&] { return Vector3(std::floor(random.uniform(-3, 4)) * d); };
  if (kind == PairKind::edge_edge) {
    x.col(1) = x.col(0) + along();
    x.col(3) = x.col(2) + along();
  } else {
    x.col(2) = x.col(1) + along();
    x.col(0) = x.col(3) + along();
  }
  return x;
}

CrossingQuery parallel_throughout(Random& random, PairKind kind) {
  return between(kind, parallel_points(random, kind), parallel_points(random, kind));
}

/// Triangles that are segments and edges that are points; every other one is met halfway.
CrossingQuery without_area_or_length(Random& random, PairKind kind) {
  Corners4 start = whole_points(random, 5, 4), end = whole_points(random, 5, 4);
  for (Corners4* x : {&start, &end}) {
    if (kind == PairKind::vertex_triangle)
      x->col(3) = 2 * x->col(2) - x->col(1);
    else
      x->col(3) = x->col(2);
  }
  const bool is_vertex = kind == PairKind::vertex_triangle;
  const int first = is_vertex ? 1 : 0, second = is_vertex ? 3 : 1;
  const Vector3 met = (start.col(first) + start.col(second) + end.col(first) + end.col(second)) / 4;
  if (is_heads(random)) return between(kind, start, end);
  for (int k = is_vertex ? 0 : 2; k < (is_vertex ? 1 : 4); ++k) end.col(k) = 2 * met - start.col(k);
  return between(kind, start, end);
}

/// Nothing moves against the other; every other pair moves along together.
CrossingQuery motionless(Random& random, PairKind kind) {
  const Corners4 x = is_heads(random) ? met_points(random, kind) : whole_points(random, 2);
  const Vector3 shift = is_heads(random) ? whole_point(random, 9) : Vector3::Zero();
  return {kind, x, shift.replicate<1, 4>()};
}

/// The vertex and a side of the triangle, or an end of one edge and the other edge, share a plane
/// throughout, so that they meet on the border at a time that no fraction is. Of two triangles that
/// share the side neither may miss it.
CrossingQuery through_a_side(Random& random, PairKind kind) {
  CrossingQuery query = coplanar_throughout(random, kind);
  query.x.col(3) = whole_point(random, 10);
  query.displacement.col(3) = whole_point(random, 10);
  return query;
}

}  // namespace

oracles::Features features_of(PairKind kind) {
  return kind == PairKind::vertex_triangle ? oracles::Features::vertex_and_triangle
                                           : oracles::Features::edge_and_edge;
}

bool meets_exactly(const CrossingQuery& query) {
  return oracles::ever_meet(features_of(query.kind),
                            oracles::exact_motion(query.x, query.displacement));
}

bool meets_exactly_before(const CrossingQuery& query, double end) {
  if (!(end > 0)) return false;
  const oracles::ExactMotion motion = oracles::exact_motion(query.x, query.displacement);
  return oracles::ever_meet(features_of(query.kind),
                            oracles::until(motion, std::nextafter(end, 0)));
}

CrossingQuery random_query(Random& random, PairKind kind) {
  const Corners4 start = whole_points(random, 10);
  return between(kind, start, whole_points(random, 10));
}

const std::vector<CrossingFamily>& degenerate_families() {
  static const std::vector<CrossingFamily> families = {
      {"coplanar throughout", coplanar_throughout},
      {"on a corner or a side halfway", on_the_border_halfway},
      {"met at the start or at the end", met_at_an_end},
      {"parallel throughout", parallel_throughout},
      {"without area or length", without_area_or_length},
      {"motionless", motionless},
      {"through a side", through_a_side}};
  return families;
}

CrossingQuery far_away(const CrossingQuery& query) {
  const Vector3 place(1000, -998, 1001);
  return {query.kind, (query.x / 16).colwise() + place, query.displacement / 16};
}

}  // namespace foldproof
