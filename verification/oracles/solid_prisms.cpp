#include "verification/oracles/solid_prisms.h"

#include <algorithm>

namespace foldproof::oracles {

namespace {

long cross(const Whole2& a, const Whole2& b, const Whole2& p) {
  return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

bool is_between(long a, long b, long p) { return std::min(a, b) <= p && p <= std::max(a, b); }

bool is_on(const Whole2& a, const Whole2& b, const Whole2& p) {
  return cross(a, b, p) == 0 && is_between(a[0], b[0], p[0]) && is_between(a[1], b[1], p[1]);
}

/// Turns of the polygon around p, counted where its edges cross the line from p to the right.
int inside_polygon(const std::vector<Whole2>& polygon, const Whole2& p) {
  int turns = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Whole2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (is_on(a, b, p)) return 0;
    if (a[1] <= p[1] && b[1] > p[1] && cross(a, b, p) > 0) ++turns;
    if (b[1] <= p[1] && a[1] > p[1] && cross(a, b, p) < 0) --turns;
  }
  return turns != 0 ? 1 : -1;
}

}  // namespace

int inside_prism(const WholePrism& prism, const Whole3& p) {
  const int across = inside_polygon(prism.polygon, {p[0], p[1]});
  if (p[2] < prism.low || p[2] > prism.high || across < 0) return -1;
  return p[2] == prism.low || p[2] == prism.high || across == 0 ? 0 : 1;
}

int inside_nested(const std::vector<WholePrism>& prisms, const Whole3& p) {
  int side = -1;
  for (const WholePrism& prism : prisms) {
    const int inside = inside_prism(prism, p);
    if (inside == 0) return 0;
    if (inside > 0) side = -side;
  }
  return side;
}

}  // namespace foldproof::oracles
