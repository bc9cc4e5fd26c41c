#include "reference/level_set/fast_marching.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <stdexcept>
#include <string>

namespace foldproof {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A trial value in the queue. Nearest first, then by index, so that the order is reproducible.
struct Trial {
  double distance;  // |phi| [m]
  int node;
  bool operator>(const Trial& other) const {
    return distance != other.distance ? distance > other.distance : node > other.node;
  }
};

/// Known values along one axis next to a node: (T - value)^2 weight is its part of |grad T|^2.
struct Upwind {
  double value;   // m
  double weight;  // 1/m^2
};

struct March {
  Grid grid;  // |phi| with the side's sign; +-infinity: unknown
  MarchingOrder order;
  std::vector<std::uint8_t> known;  // one flag per node
  std::priority_queue<Trial, std::vector<Trial>, std::greater<Trial>> front;
};

/// phi of a known node on the side of `sign` or on the surface, as a distance; infinity
/// for all others.
double known_distance(const March& march, long node, double sign) {
  const double distance = sign * march.grid.phi[node];
  return march.known[node] && distance >= 0 ? distance : infinity;
}

/// The nearer of the two neighbours along the axis, with the one behind it for second order.
Upwind upwind(const March& march, const Node& node, int axis, double sign) {
  const Lattice& lattice = march.grid.lattice;
  const long index = lattice.index(node), stride = lattice.strides()[axis];
  double nearest = infinity, behind = infinity;
  for (const int direction : {-1, 1}) {
    const int nodes_beyond = direction < 0 ? node[axis] : lattice.nodes[axis] - 1 - node[axis];
    if (nodes_beyond < 1) continue;
    const long next = index + direction * stride;
    const double distance = known_distance(march, next, sign);
    if (!(distance < nearest)) continue;
    nearest = distance;
    behind = nodes_beyond > 1 ? known_distance(march, next + direction * stride, sign) : infinity;
  }
  const double per_h2 = 1 / (lattice.spacing * lattice.spacing);
  // (3 T - 4 T1 + T2)/(2 h) = (3/2) (T - (4 T1 - T2)/3)/h
  if (march.order == MarchingOrder::second && behind <= nearest && nearest < infinity)
    return {(4 * nearest - behind) / 3, 2.25 * per_h2};
  return {nearest, per_h2};
}

/// The larger root T of sum weight (T - value)^2 = 1 over the axes; axes with a value at or beyond
/// T are not upwind and are left out, the farthest first. Values are measured from the nearest, so
/// that nothing large cancels.
double solve(std::array<Upwind, 3> axes) {
  std::sort(axes.begin(), axes.end(),
            [](const Upwind& a, const Upwind& b) { return a.value < b.value; });
  const double nearest = axes[0].value;
  double beyond = infinity, sum = 0, mean = 0, squares = 0;  // T = nearest + beyond
  for (const Upwind& axis : axes) {
    const double value = axis.value - nearest;
    if (!(value < beyond)) break;
    sum += axis.weight;
    mean += axis.weight * value;
    squares += axis.weight * value * value;
    const double discriminant = mean * mean - sum * (squares - 1);
    beyond = (mean + std::sqrt(discriminant)) / sum;
  }
  return nearest + beyond;
}

/// Gives an unknown node a trial value from its known neighbours.
void update(March& march, const Node& node, double sign) {
  const long index = march.grid.lattice.index(node);
  double& phi = march.grid.phi[index];
  if (std::isfinite(phi) && phi * sign < 0)
    throw std::logic_error("march: the seeds do not part inside from outside");
  std::array<Upwind, 3> axes;
  for (int axis = 0; axis < 3; ++axis) axes[axis] = upwind(march, node, axis, sign);
  const double distance = solve(axes);
  if (distance == std::abs(phi)) return;
  phi = sign * distance;
  march.front.push({distance, int(index)});
}

void update_neighbours(March& march, long index) {
  const Lattice& lattice = march.grid.lattice;
  const Node node = lattice.node(index);
  // -0 is on the surface, counted as inside
  const double sign = std::signbit(march.grid.phi[index]) ? -1 : 1;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int direction : {-1, 1}) {
      Node next = node;
      next[axis] += direction;
      if (next[axis] < 0 || next[axis] >= lattice.nodes[axis] || march.known[lattice.index(next)])
        continue;
      update(march, next, sign);
    }
  }
}

March start_march(const Lattice& lattice, const Seeds& seeds, MarchingOrder order) {
  if (seeds.nodes.empty())
    throw InputError("march: no node lies next to the surface; give a finer grid");
  March march{{lattice, std::vector<double>(lattice.size(), infinity)},
              order,
              std::vector<std::uint8_t>(lattice.size(), 0),
              {}};
  for (size_t i = 0; i < seeds.nodes.size(); ++i) {
    march.grid.phi[seeds.nodes[i]] = seeds.phi[i];
    march.known[seeds.nodes[i]] = 1;
  }
  return march;
}

/// 1/t^2 of the crossing between a node of value a and its neighbour of value b, in cells; 0
/// if there is none.
double crossing(float a, float b) {
  if ((a < 0) == (b < 0)) return 0;
  const double t = double(a) / (double(a) - double(b));
  return 1 / (t * t);
}

}  // namespace

Grid march(const Lattice& lattice, const Seeds& seeds, MarchingOrder order) {
  March march = start_march(lattice, seeds, order);
  for (const long node : seeds.nodes) update_neighbours(march, node);
  while (!march.front.empty()) {
    const Trial next = march.front.top();
    march.front.pop();
    // a value that has been replaced since it was queued
    if (march.known[next.node] || next.distance != std::abs(march.grid.phi[next.node])) continue;
    march.known[next.node] = 1;
    update_neighbours(march, next.node);
  }
  return std::move(march.grid);
}

Seeds seeds_from_sides(const Lattice& lattice, const std::vector<float>& side) {
  Seeds seeds;
  const std::array<long, 3> strides = lattice.strides();
  for (long index = 0; index < lattice.size(); ++index) {
    const Node node = lattice.node(index);
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double behind = node[axis] > 0 ? crossing(side[index], side[index - strides[axis]]) : 0;
      const bool nodes_beyond = node[axis] + 1 < lattice.nodes[axis];
      const double ahead = nodes_beyond ? crossing(side[index], side[index + strides[axis]]) : 0;
      sum += std::max(behind, ahead);
    }
    if (!(sum > 0)) continue;
    seeds.nodes.push_back(index);
    seeds.phi.push_back(std::copysign(lattice.spacing / std::sqrt(sum), side[index]));
  }
  return seeds;
}

}  // namespace foldproof
