#include "reference/filters/object_collision.h"

#include <algorithm>

#include "reference/fast/out_of_reach.h"
#include "reference/fast/loops.h"

namespace foldproof {

namespace {

/// The velocity `after` of a point instead of `before`, given to its particles.
void set_velocity(const CollisionPoint& point, const Vector3& before, const Vector3& after,
                  PerParticle3& v) {
  if (point.count == 1) {
    v.col(point.particles[0]) = after;
    return;
  }
  for (int k = 0; k < point.count; ++k)
    v.col(point.particles[size_t(k)]) += point.shares[k] * (after - before);
}

/// Corrects the points one after the other; `around` knows the latest query.
Work correct_points(const ObjectCollision& filter, std::span<const CollisionPoint> points,
                    const Span& span, const State& s, ObjectsOverSpan around, PerParticle3& v) {
  const Response& response = filter.response;
  const double tau = filter.forecast_time > 0 ? filter.forecast_time : span.step;
  const bool moves = span.end > span.start;
  const bool ahead = response.query_time == QueryTime::at_end;
  Work work;
  for (const CollisionPoint& point : points) {
    const Vector3 p = point.mean(s.x), before = point.mean(v);
    const Vector3 place = ahead ? Vector3(p + (span.end - span.start) * before) : p;
    if (out_of_reach(around, place, before, std::max(tau, span.step))) continue;
    const Vector3 after = response.velocity(around.at(place), {p, before, span, tau});
    ++work.object_queries;
    if (after == before) continue;
    if (moves) ++work.object_contacts;
    set_velocity(point, before, after, v);
  }
  return work;
}

}  // namespace

void ObjectCollision::use_threads(int count, Eigen::Index) {
  const auto is_particle = [](const CollisionPoint& point) { return point.count == 1; };
  threads = std::ranges::all_of(points, is_particle) ? count : 1;
}

void ObjectCollision::correct(const Span& span, const State& s, PerParticle3& v, Work& work) const {
  const bool ahead = response.query_time == QueryTime::at_end;
  const ObjectsOverSpan around(objects, ahead ? Span{span.end, span.end, span.step} : span);
  const auto n = Eigen::Index(points.size());
  std::vector<Work> done(size_t(n / block_of_sums + 1));
  for_each_block(threads, n, block_of_sums, [&](Eigen::Index first, Eigen::Index count) {
    done[size_t(first / block_of_sums)] = correct_points(
        *this, std::span(points).subspan(size_t(first), size_t(count)), span, s, around, v);
  });
  for (const Work& part : done) add(work, part);
}

}  // namespace foldproof
