#include "reference/filters/cloth_pairs.h"

#include <algorithm>

#include "reference/fast/loops.h"
#include "reference/filters/pair_search.h"

namespace foldproof {

namespace {

constexpr int triangles_per_leaf = 4;
constexpr int levels_of_tasks = 7;  // of the tree, opened to divide a search

struct ParticlePair {
  int a, b;
};

/// For each particle, the box over its straight path, widened by margin/2 on all sides.
std::vector<Bounds> particle_boxes(const PerParticle3& x, const PerParticle3& end, double margin,
                                   const Team& team) {
  const Vector3 wider = Vector3::Constant(margin / 2);
  std::vector<Bounds> boxes(static_cast<size_t>(x.cols()));
  for_each_index(team, x.cols(), [&](Eigen::Index i) {
    boxes[size_t(i)] = {x.col(i).cwiseMin(end.col(i)) - wider,
                        x.col(i).cwiseMax(end.col(i)) + wider};
  });
  return boxes;
}

/// Does each box lie within the larger box of the same particle?
bool lie_within(const std::vector<Bounds>& boxes, const std::vector<Bounds>& larger) {
  return std::equal(boxes.begin(), boxes.end(), larger.begin(), larger.end(),
                    [](const Bounds& inner, const Bounds& outer) { return outer.contains(inner); });
}

/// Do the boxes of the two features overlap? Most pairs are rejected on one of the first axes.
bool overlap(const FeaturePair& pair, const std::vector<Bounds>& particles) {
  const int of_first = pair.kind == PairKind::vertex_triangle ? 1 : 2;
  std::array<const Bounds*, 4> boxes;
  for (size_t k = 0; k < 4; ++k) boxes[k] = &particles[size_t(pair.particles[k])];
  const auto span = [&](int from, int until, int axis) {
    double low = boxes[size_t(from)]->min()[axis], high = boxes[size_t(from)]->max()[axis];
    for (int k = from + 1; k < until; ++k) {
      low = std::min(low, boxes[size_t(k)]->min()[axis]);
      high = std::max(high, boxes[size_t(k)]->max()[axis]);
    }
    return std::pair(low, high);
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = span(0, of_first, axis);
    const auto [other_low, other_high] = span(of_first, 4, axis);
    if (!(low <= other_high && other_low <= high)) return false;
  }
  return true;
}

/// The boxes of this motion.
struct Boxes {
  const ClothTree& cloth;
  const std::vector<char>& moved;
  std::vector<Bounds> particles, triangles, nodes;
  std::vector<char> triangle_moved, node_moved;  // empty: all are searched

  Boxes(const ClothTree& of, std::vector<Bounds> particle_boxes, const std::vector<char>& which);

  bool skips(int node_a, int node_b) const {
    return (!moved.empty() && !node_moved[size_t(node_a)] && !node_moved[size_t(node_b)]) ||
           !nodes[size_t(node_a)].intersects(nodes[size_t(node_b)]);
  }
};

/// A search of these boxes, and the pairs found.
struct Search {
  const Boxes& boxes;
  std::vector<FeaturePair>& found;
  long box_tests = 0;
  const ClothTree& cloth = boxes.cloth;
  const std::vector<char>& moved = boxes.moved;
  const std::vector<Bounds>&particles = boxes.particles, &triangles = boxes.triangles;

  void within(int node);
  void between(int a, int b);
  void between_leaves(const BoxNode& a, const BoxNode& b);
  void compare(int s, int t);
  void add_vertex(int vertex, int triangle);
  void add_edges(const ParticlePair& e, const ParticlePair& f);
};

Boxes::Boxes(const ClothTree& of, std::vector<Bounds> particle_boxes,
             const std::vector<char>& which)
    : cloth(of), moved(which), particles(std::move(particle_boxes)) {
  triangles.resize(cloth.triangles.size());
  triangle_moved.assign(moved.empty() ? 0 : triangles.size(), 0);
  for_each_item(cloth.team, cloth.triangles, [&](const Triangle& triangle, size_t t) {
    for (const int corner : triangle) {
      triangles[t].extend(particles[size_t(corner)]);
      if (!moved.empty() && moved[size_t(corner)]) triangle_moved[t] = 1;
    }
  });
  // nodes are depth first: both children come after their parent
  const BoxTree& tree = cloth.tree;
  nodes.resize(tree.nodes.size());
  node_moved.assign(moved.empty() ? 0 : nodes.size(), 0);
  for (int n = int(nodes.size()) - 1; n >= 0; --n) {
    const BoxNode& node = tree.nodes[size_t(n)];
    const auto take = [&](const Bounds& box, const std::vector<char>& flags, size_t i) {
      nodes[size_t(n)].extend(box);
      if (!moved.empty() && flags[i]) node_moved[size_t(n)] = 1;
    };
    if (node.right < 0) {
      for (int i = node.first; i < node.first + node.count; ++i) {
        const size_t t = size_t(tree.order[size_t(i)]);
        take(triangles[t], triangle_moved, t);
      }
    } else {
      for (const int child : {n + 1, node.right})
        take(nodes[size_t(child)], node_moved, size_t(child));
    }
  }
}

/// Pairs of triangles below one node.
void Search::within(int node) {
  const BoxNode& here = cloth.tree.nodes[size_t(node)];
  if (!moved.empty() && !boxes.node_moved[size_t(node)]) return;
  if (here.right < 0) {
    for (int i = here.first; i < here.first + here.count; ++i)
      for (int j = i + 1; j < here.first + here.count; ++j)
        compare(cloth.tree.order[size_t(i)], cloth.tree.order[size_t(j)]);
    return;
  }
  within(node + 1);
  within(here.right);
  between(node + 1, here.right);
}

/// Pairs of a triangle below one node and one below another; the larger node is opened first.
void Search::between(int a, int b) {
  ++box_tests;
  if (boxes.skips(a, b)) return;
  const BoxNode &at_a = cloth.tree.nodes[size_t(a)], &at_b = cloth.tree.nodes[size_t(b)];
  if (at_a.right < 0 && at_b.right < 0) {
    between_leaves(at_a, at_b);
  } else if (at_a.right >= 0 && (at_b.right < 0 || at_a.count >= at_b.count)) {
    between(a + 1, b);
    between(at_a.right, b);
  } else {
    between(a, b + 1);
    between(a, at_b.right);
  }
}

void Search::between_leaves(const BoxNode& a, const BoxNode& b) {
  for (int i = a.first; i < a.first + a.count; ++i)
    for (int j = b.first; j < b.first + b.count; ++j)
      compare(cloth.tree.order[size_t(i)], cloth.tree.order[size_t(j)]);
}

/// Compares the features that triangles s and t own.
void Search::compare(int s, int t) {
  if (!moved.empty() && !boxes.triangle_moved[size_t(s)] && !boxes.triangle_moved[size_t(t)])
    return;
  ++box_tests;
  if (!triangles[size_t(s)].intersects(triangles[size_t(t)])) return;
  const Triangle &at_s = cloth.triangles[size_t(s)], &at_t = cloth.triangles[size_t(t)];
  const OwnedFeatures &own_s = cloth.own[size_t(s)], &own_t = cloth.own[size_t(t)];
  for (size_t k = 0; k < 3; ++k) {
    if (own_s.corner[k]) add_vertex(at_s[k], t);
    if (own_t.corner[k]) add_vertex(at_t[k], s);
  }
  for (size_t k = 0; k < 3; ++k) {
    if (!own_s.side[k]) continue;
    for (size_t l = 0; l < 3; ++l)
      if (own_t.side[l]) add_edges({at_s[k], at_s[(k + 1) % 3]}, {at_t[l], at_t[(l + 1) % 3]});
  }
}

void Search::add_vertex(int vertex, int triangle) {
  const Triangle& t = cloth.triangles[size_t(triangle)];
  if (!particles[size_t(vertex)].intersects(triangles[size_t(triangle)])) return;
  if (std::find(t.begin(), t.end(), vertex) != t.end()) return;
  const FeaturePair pair{PairKind::vertex_triangle, {vertex, t[0], t[1], t[2]}};
  if (has_moved_particle(pair, moved)) found.push_back(pair);
}

void Search::add_edges(const ParticlePair& e, const ParticlePair& f) {
  if (e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b) return;
  const FeaturePair pair{PairKind::edge_edge, {e.a, e.b, f.a, f.b}};
  if (overlap(pair, particles) && has_moved_particle(pair, moved)) found.push_back(pair);
}

/// Splits within(node) into tasks a few levels down, in the same order: a node with itself, or two
/// nodes.
void add_tasks(const Boxes& boxes, int node, int levels, std::vector<std::pair<int, int>>& tasks) {
  if (!boxes.moved.empty() && !boxes.node_moved[size_t(node)]) return;
  const int right = boxes.cloth.tree.nodes[size_t(node)].right;
  if (levels == 0 || right < 0) return tasks.emplace_back(node, node), void();
  add_tasks(boxes, node + 1, levels - 1, tasks);
  add_tasks(boxes, right, levels - 1, tasks);
  tasks.emplace_back(node + 1, right);
}

}  // namespace

ClothTree make_cloth_tree(const TriangleMesh& mesh) {
  ClothTree cloth{mesh.triangles, std::vector<OwnedFeatures>(mesh.triangles.size()), {}, 0};
  cloth.tree = make_box_tree(triangle_bounds(mesh.rest, mesh.triangles), triangles_per_leaf);
  std::vector<char> vertex_has_owner(size_t(mesh.particles()), 0);
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (size_t k = 0; k < 3; ++k) {
      char& taken = vertex_has_owner[size_t(mesh.triangles[t][k])];
      cloth.own[t].corner[k] = !taken;
      taken = 1;
    }
  // the first of its triangles owns the edge
  for (const Edge& edge : mesh.edges) {
    cloth.mean_edge +=
        (mesh.rest.col(edge.b) - mesh.rest.col(edge.a)).norm() / double(mesh.edges.size());
    const size_t t = size_t(edge.triangles[0]);
    for (size_t k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (std::minmax(a, b) == std::minmax(edge.a, edge.b)) cloth.own[t].side[k] = true;
    }
  }
  return cloth;
}

bool has_moved_particle(const FeaturePair& pair, const std::vector<char>& moved) {
  return moved.empty() || std::any_of(pair.particles.begin(), pair.particles.end(),
                                      [&](int i) { return moved[size_t(i)] != 0; });
}

std::vector<FeaturePair> near_pairs(const ClothTree& cloth, const PerParticle3& x,
                                    const PerParticle3& end, double margin,
                                    const std::vector<char>& moved) {
  return counted_near_pairs(cloth, x, end, margin, moved).pairs;
}

PairSearch counted_near_pairs(const ClothTree& cloth, const PerParticle3& x,
                              const PerParticle3& end, double margin,
                              const std::vector<char>& moved) {
  const Boxes boxes(cloth, particle_boxes(x, end, margin, cloth.team), moved);
  std::vector<std::pair<int, int>> tasks;
  add_tasks(boxes, 0, levels_of_tasks, tasks);
  std::vector<PairSearch> parts(tasks.size());
  for_each_item(cloth.team, tasks, [&](const std::pair<int, int>& task, size_t k) {
    Search search{boxes, parts[k].pairs};
    const auto [a, b] = task;
    a == b ? search.within(a) : search.between(a, b);
    parts[k].box_tests = search.box_tests;
  });
  PairSearch done;
  for (const PairSearch& part : parts) {
    done.pairs.insert(done.pairs.end(), part.pairs.begin(), part.pairs.end());
    done.box_tests += part.box_tests;
  }
  return done;
}

std::vector<FeaturePair> touching_pairs(const ClothTree& cloth, const PerParticle3& x,
                                        double distance) {
  std::vector<FeaturePair> pairs = near_pairs(cloth, x, x, distance);
  std::erase_if(pairs, [&](const FeaturePair& pair) {
    return !(nearness(pair.kind, corners_of(pair, x)).distance < distance);
  });
  return pairs;
}

PairsAhead pairs_ahead(const ClothTree& cloth, const PerParticle3& x, double margin) {
  PairSearch search = counted_near_pairs(cloth, x, x, margin);
  return {particle_boxes(x, x, margin, cloth.team), std::move(search.pairs), cloth.team,
          search.box_tests};
}

bool is_inside(const PairsAhead& ahead, const PerParticle3& x, double margin) {
  return lie_within(particle_boxes(x, x, margin, ahead.team), ahead.boxes);
}

std::optional<std::vector<FeaturePair>> pairs_among(const PairsAhead& ahead, const PerParticle3& x,
                                                    const PerParticle3& end, double margin,
                                                    const std::vector<char>& moved) {
  // features whose boxes overlap now also overlap in the larger boxes; the order of the pairs
  // depends only on the tree
  const std::vector<Bounds> boxes = particle_boxes(x, end, margin, ahead.team);
  if (!lie_within(boxes, ahead.boxes)) return {};
  const auto near_pair = [&](const FeaturePair& pair) -> std::optional<FeaturePair> {
    if (overlap(pair, boxes) && has_moved_particle(pair, moved)) return pair;
    return {};
  };
  return found_among<FeaturePair>(ahead.team, ahead.pairs, near_pair);
}

}  // namespace foldproof
