#include "reference/filters/object_collision.h"

#include <algorithm>

#include "reference/fast/out_of_reach.h"
#include "reference/fast/loops.h"

namespace foldproof {

namespace {

/// Changes a point's velocity from `before` to `after` through its particles.
void set_velocity(const CollisionPoint& point, const Vector3& before, const Vector3& after,
                  PerParticle3& v) {
  if (point.count == 1) {
    v.col(point.particles[0]) = after;
    return;
  }
  for (int k = 0; k < point.count; ++k)
    v.col(point.particles[size_t(k)]) += point.shares[k] * (after - before);
}

/// The previous point in the loop: a point that its answers prove out of reach is not queried.
struct Neighbour {
  RememberedQuery around;
  Work work = {};
};

}  // namespace

void ObjectCollision::set_team(const Team& of, Eigen::Index) {
  const auto is_particle = [](const CollisionPoint& point) { return point.count == 1; };
  team = std::ranges::all_of(points, is_particle) ? of : Team();
}

void ObjectCollision::correct(const Span& span, const State& s, PerParticle3& v, Work& work) const {
  const double tau = forecast_time > 0 ? forecast_time : span.step;
  const bool moves = span.end > span.start;
  const bool ahead = response.query_time == QueryTime::at_end;
  const auto correct_point = [&](const CollisionPoint& point, Neighbour& last) {
    const Vector3 p = point.mean(s.x), before = point.mean(v);
    const Vector3 place = ahead ? Vector3(p + (span.end - span.start) * before) : p;
    if (last.around.out_of_reach(place, before, std::max(tau, span.step))) return;
    const std::span<ObjectPoint> answers = answers_at(last.around, point, place);
    const auto elsewhere = [&](const Vector3& there) {
      ++last.work.object_queries;
      const std::span<ObjectPoint> other = answers_at(last.around, point, there);
      return std::vector<ObjectPoint>(other.begin(), other.end());
    };
    const Vector3 after = response.velocity(answers, {p, before, span, tau, elsewhere});
    ++last.work.object_queries;
    if (after == before) return;
    if (moves) ++last.work.object_contacts;
    set_velocity(point, before, after, v);
  };
  const RememberedQuery around(objects, ahead ? Span{span.end, span.end, span.step} : span);
  for (const Neighbour& last : for_each_with(team, points, Neighbour{around}, correct_point))
    add(work, last.work);
}

}  // namespace foldproof
