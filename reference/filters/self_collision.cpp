#include "reference/filters/self_collision.h"

#include <algorithm>

#include "reference/fast/kept_values.h"
#include "reference/fast/loops.h"
#include "reference/filters/approach.h"
#include "reference/filters/impact_zones.h"
#include "reference/forces/degenerate.h"
#include "reference/mesh/self_intersection.h"

namespace foldproof {

namespace {

// fraction of the thickness: the least distance that motions may leave
constexpr double min_distance_share = 0.1;
// of the mean edge: margin of a search for many steps
constexpr double least_spare = 0.12, most_spare = 0.3;
constexpr long tests_of_a_pair = 4;  // of boxes, by a step that selects
// s: the time in which a piercing edge moves one thickness relative to the pierced triangle
constexpr double untangling_time = 0.01;
// by which the side of a triangle may grow in a step, of the mean edge and of the cloth's size
constexpr double most_edges = 10, most_sizes = 0.1;

/// Where sides grow so much the step is far too long, and nearly all pairs would meet: finding them
/// takes minutes and gigabytes.
void reject_explosion(const ClothTree& cloth, const PerParticle3& x, const PerParticle3& way) {
  const double most =
      std::max(most_edges * cloth.mean_edge, most_sizes * bounds_of(x).sizes().norm());  // m
  for (const Triangle& t : cloth.triangles)
    for (const auto& [a, b] : {std::pair(t[0], t[1]), {t[1], t[2]}, {t[2], t[0]}})
      if ((way.col(a) - way.col(b)).squaredNorm() > most * most)
        throw DegenerateElement(
            "divergence: two corners of a triangle part by more than ten mean edges in one step",
            {a, b});
}

/// The motion of one step, and the corrections that keep it free of crossings.
struct Step {
  const SelfCollision& filter;
  const State& s;
  PerParticle3& v;
  double h;  // s
  Work& work;
  const std::vector<char>& tangled;  // N, or empty: particles that may pass through each other
  // N: particles whose velocity has changed since all pairs were last tested; empty: all
  std::vector<char> moved = {};
  // m
  double min_distance = min_distance_share * filter.layers.least_thickness(filter.settings);

  std::vector<FeaturePair> pairs() const;
  std::optional<Approach> approach(const FeaturePair& pair) const;
  long resolve_all(int round);
  void resolve(const FeaturePair& pair, const Approach& contact, int round);
  bool join_approaching_pairs(ImpactZones& zones, std::vector<char>& is_off_its_path);
  void move_zones(ImpactZones& zones, std::vector<char>& is_off_its_path);
};

/// near_pairs, selected from the pairs that the run keeps where these suffice.
std::vector<FeaturePair> pairs_of(const SelfCollision& filter, const Work& work,
                                  const PerParticle3& x, const PerParticle3& end, double margin,
                                  const std::vector<char>& moved = {}) {
  if (work.kept)
    if (auto pairs = pairs_among(work.kept->of<PairsAhead>(filter), x, end, margin, moved))
      return std::move(*pairs);
  return near_pairs(filter.cloth, x, end, margin, moved);
}

std::vector<FeaturePair> Step::pairs() const {
  std::vector<FeaturePair> found =
      pairs_of(filter, work, s.x, s.x + h * v, 2 * min_distance, moved);
  if (!tangled.empty()) remove_tangled_pairs(tangled, found);
  return found;
}

std::optional<Approach> Step::approach(const FeaturePair& pair) const {
  return first_approach(pair.kind, corners_of(pair, s.x), h * corners_of(pair, v), min_distance);
}

/// Treats each pair that would collide, in order, each with the current v. Returns their number.
long Step::resolve_all(int round) {
  const std::vector<FeaturePair> pairs_to_test = pairs();
  moved.assign(size_t(v.cols()), 0);
  work.crossing_queries += long(pairs_to_test.size());
  const long resolved = act_in_order(
      filter.cloth.team, pairs_to_test, [&](const FeaturePair& pair) { return approach(pair); },
      [&](const FeaturePair& pair) { return has_moved_particle(pair, moved); },
      [&](const FeaturePair& pair, const Approach& contact) {
        resolve(pair, contact, round);
        for (const int i : pair.particles) moved[size_t(i)] = 1;
      });
  work.crossings += resolved;
  return resolved;
}

/// The impulse between the points that would meet, along the line between them at that time. In the
/// first round they may approach to the thickness, where repulsion acts; later rounds stop their
/// approach. Friction as in repulsion.
void Step::resolve(const FeaturePair& pair, const Approach& contact, int round) {
  const Vector3& N = contact.at.normal;
  // along it, at the start [m]
  const double gap = (corners_of(pair, s.x) * contact.at.weights).dot(N);
  const Vector3 relative = corners_of(pair, v) * contact.at.weights;
  const double thickness = filter.layers.thickness_of(pair, contact.at.weights, filter.settings),
               friction = filter.layers.friction_of(pair, contact.at.weights, filter.settings);
  const double allowed = round > 0 ? 0 : std::min(0.0, (thickness - gap) / h);  // m/s
  const double push = allowed - relative.dot(N);
  if (!(push > 0)) return;
  push_apart(pair, contact.at.weights, push * N + friction_impulse(relative, N, push, friction),
             filter.inverse_mass, v);
}

/// Joins pairs that still collide into zones; false if there are none. is_off_its_path: marks
/// prescribed particles whose zone does not follow their motion.
bool Step::join_approaching_pairs(ImpactZones& zones, std::vector<char>& is_off_its_path) {
  bool any = false;
  for (const FeaturePair& pair : pairs()) {
    const bool prescribed = std::any_of(pair.particles.begin(), pair.particles.end(),
                                        [&](int i) { return is_off_its_path[size_t(i)]; });
    const bool are_joined = zones.are_joined(pair);
    if (are_joined && !prescribed) continue;
    ++work.crossing_queries;
    if (!approach(pair)) continue;
    if (are_joined)
      throw DegenerateElement("prescribed motion takes the cloth through itself",
                              {pair.particles.begin(), pair.particles.end()});
    zones.join(pair);
    any = true;
  }
  return any;
}

void Step::move_zones(ImpactZones& zones, std::vector<char>& is_off_its_path) {
  moved.assign(size_t(v.cols()), 0);
  for (const std::vector<int>& zone : zones.take_grown_zones()) {
    const double deviation = move_as_one(zone, s.x, filter.mass, filter.inverse_mass, v);
    for (const int i : zone) {
      moved[size_t(i)] = 1;
      is_off_its_path[size_t(i)] =
          filter.inverse_mass[i] == 0 && h * deviation > 1e-6 * min_distance;
    }
  }
}

}  // namespace

void SelfCollision::look_ahead(const State& s, const Work& work) const {
  if (!work.kept) return;
  PairsAhead& latest = work.kept->of<PairsAhead>(*this);
  ++latest.steps;
  // half of the margin is left for the coming step
  if (is_inside(latest, s.x, settings.thickness + latest.spare / 2)) return;
  // wider while a search tests more boxes than the steps that select from its pairs
  const bool was_dear =
      latest.box_tests > tests_of_a_pair * latest.steps * long(latest.pairs.size());
  const double spare = std::clamp(was_dear ? 1.3 * latest.spare : latest.spare / 1.3,
                                  least_spare * cloth.mean_edge, most_spare * cloth.mean_edge);
  latest = pairs_ahead(cloth, s.x, settings.thickness + spare);
  latest.spare = spare;
}

void SelfCollision::correct(const Span& span, const State& s, PerParticle3& v, Work& work) const {
  const double h = span.step;
  std::vector<FeaturePair> close = pairs_of(*this, work, s.x, s.x, settings.thickness);
  std::vector<char> tangled;
  if (!at_start.empty()) {
    const CrossingTriangles crossing = self_intersections(s.x, cloth.triangles);
    if (!crossing.empty()) tangled = tangled_particles(crossing, cloth.triangles, s.x.cols());
    if (!crossing.empty()) remove_tangled_pairs(tangled, close);
    push_out_of_tangle(crossing, cloth.triangles, s.x, settings.thickness / untangling_time,
                       inverse_mass, v);
  }
  work.close_pairs += repel(close, s.x, settings, layers, h, inverse_mass, v, cloth.team);
  if (!(span.end > span.start)) return;

  reject_explosion(cloth, s.x, h * v);
  Step step{*this, s, v, h, work, tangled};
  for (int round = 0; round < settings.rounds; ++round)
    if (step.resolve_all(round) == 0) return;

  ImpactZones zones(s.x.cols());
  std::vector<char> is_off_its_path(size_t(s.x.cols()), 0);
  while (step.join_approaching_pairs(zones, is_off_its_path))
    step.move_zones(zones, is_off_its_path);
  work.zones += zones.zones();
  work.zone_particles += zones.particles();
}

}  // namespace foldproof
