// Speed of the test for crossings of moving features.
#include <vector>

#include "convergence/contact/crossing_families.h"
#include "scripts/program/bench/bench_parts.h"
#include "verification/specimens/random.h"

namespace foldproof {

Record crossing_rate() {
  Random random(19);
  std::vector<CrossingQuery> queries;
  for (int k = 0; k < 20000; ++k)
    queries.push_back(
        random_query(random, k % 2 == 0 ? PairKind::vertex_triangle : PairKind::edge_edge));
  double approach = 0;
  const double seconds = least_seconds([&] {
    for (const CrossingQuery& q : queries)
      approach += first_approach(q.kind, q.x, q.displacement, 1e-6).has_value();
  });
  return rate(
      "crossing-queries",
      "Vertices and triangles, edges and edges that move at random: do they meet? One thread.",
      approach > 0 ? 1e9 * seconds / double(queries.size()) : 0,
      {500, "ns", "lower", "a handful of planes, each from one search for the nearest points"});
}

}  // namespace foldproof
