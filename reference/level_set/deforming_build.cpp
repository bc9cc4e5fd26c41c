#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <numeric>
#include <optional>

#include "reference/fast/shared_map.h"
#include "reference/fast/loops.h"
#include "reference/level_set/deforming.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/level_set/octree_nodes.h"
#include "reference/level_set/winding.h"
#include "reference/mesh/mesh_frames.h"
#include "reference/mesh/triangle_soup.h"

namespace foldproof {

namespace {

/// The barycentric weights of a point of the triangle.
Vector3 barycentric(const Corners3& corners, const Vector3& p) {
  const Vector3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], ap = p - corners[0];
  const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm();
  const double determinant = bb * cc - bc * bc;
  if (!(determinant > 0)) return {1, 0, 0};
  const double b = (cc * ap.dot(ab) - bc * ap.dot(ac)) / determinant;
  const double c = (bb * ap.dot(ac) - bc * ap.dot(ab)) / determinant;
  return {1 - b - c, b, c};
}

/// Interpolates the corners' columns of x, 3 x N, at a point of the triangle.
Vector3 at_point_of(const Triangle& t, const Vector3& weight, const PerParticle3& x) {
  Vector3 sum = Vector3::Zero();
  for (int k = 0; k < 3; ++k) sum += weight[k] * x.col(t[k]);
  return sum;
}

/// Data of a node: its distance, and the surface point that it refers to.
struct NodeValue {
  double phi;  // m
  // lower bound on |phi|; below the measured one if the point is kept from the frame before [m]
  double least;
  int triangle;    // of the sequence
  Vector3 weight;  // of the triangle's corners, at the point
};

/// The fraction of a cell's allowed error beyond the band by which a kept value may be too large.
constexpr double kept_share = 0.5;

[[noreturn]] void reject_without_inside(std::size_t frame) {
  throw InputError("mesh sequence: frame " + std::to_string(frame) +
                   ": repair finds no inside: the winding number is below 1/2 at every node; close "
                   "the mesh, or give finer cells");
}

/// A frame's triangles, for their winding number.
struct WindingMesh {
  MeshDistance mesh;
  std::vector<Dipole> dipoles;

  double at(const Vector3& p) const { return winding_number(mesh, dipoles, p, 2); }
};

WindingMesh winding_mesh(const MeshSequence& sequence, std::size_t frame) {
  WindingMesh of{make_mesh_distance(sequence.positions[frame], sequence.triangles), {}};
  of.dipoles = make_dipoles(of.mesh);
  return of;
}

/// The triangles that have the inside behind them and not before them.
std::vector<int> bounding_triangles(const WindingMesh& of, const Team& team) {
  std::vector<char> bounds(of.mesh.triangles.size());
  for_each_item(team, of.mesh.triangles, [&](const Triangle& t, std::size_t k) {
    const Vector3 a = of.mesh.x.col(t[0]), b = of.mesh.x.col(t[1]) - a, c = of.mesh.x.col(t[2]) - a;
    const Vector3 n = b.cross(c);
    if (!(n.norm() > 0)) return;
    const double before = of.at(a + (b + c) / 3 + 1e-6 * n / std::sqrt(n.norm()));
    bounds[k] = before < 0.5 && before >= -0.5;
  });
  std::vector<int> kept;
  for (std::size_t k = 0; k < bounds.size(); ++k)
    if (bounds[k]) kept.push_back(int(k));
  return kept;
}

/// The values at the nodes of a frame's octree, each computed once: every cell around a node
/// requests it, and so do the displacements once the octree is complete.
///
/// In the band the nearest point is searched for. Beyond it the nearest point of the frame before,
/// moved with the mesh, is kept unless another is nearer by more than kept_share allows. That test
/// is a short search, which skips every box farther away. The sign of the frame before is kept if
/// the surface was farther away than it has moved. Several threads may query at once.
class NodeValues {
 public:
  NodeValues(const MeshSequence& sequence, std::size_t frame, const OctreeSettings& settings,
             const Team& team)
      : settings_(settings) {
    std::vector<Triangle> surface = sequence.triangles;
    if (sequence.inside == Inside::winding) {
      winding_ = winding_mesh(sequence, frame);
      numbers_ = bounding_triangles(*winding_, team);
      if (numbers_.empty()) reject_without_inside(frame);
      surface.clear();
      for (const int t : numbers_) surface.push_back(sequence.triangles[std::size_t(t)]);
    } else {
      numbers_.resize(surface.size());
      std::iota(numbers_.begin(), numbers_.end(), 0);
    }
    mesh_ = make_mesh_distance(sequence.positions[frame], std::move(surface));
  }

  /// displacement: the farthest that any vertex has moved since the frame before [m].
  void follow(const NodeValues& before, double displacement) {
    before_ = &before.known_;
    displacement_ = displacement;
  }

  const NodeValue& at(const Vector3& p) {
    const Position position = {p.x(), p.y(), p.z()};
    return known_.at(position, [&] { return found(p, position); });
  }

  long searches() const { return searches_; }
  long nodes() const { return known_.size(); }

 private:
  using Position = std::array<double, 3>;  // m

  struct Hash {
    std::size_t operator()(const Position& p) const {
      std::uint64_t hash = 0;
      for (const double x : p) hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15;
      return std::size_t(hash ^ hash >> 32);
    }
  };

  NodeValue value_at(const Vector3& p, const NearestFeature& nearest) {
    ++searches_;
    double phi = signed_distance(mesh_, nearest, p).phi;
    if (winding_) phi = std::copysign(phi, 0.5 - winding_->at(p));
    return {phi, std::abs(phi), numbers_[mesh_.tree.order[nearest.triangle]],
            barycentric(mesh_.corners[nearest.triangle], nearest.point)};
  }

  NodeValue found(const Vector3& p, const Position& position) {
    const NodeValue* old = before_ && !winding_ ? before_->find(position) : nullptr;
    if (old && old->least > displacement_) return kept_or_nearer(p, *old);
    return value_at(p, nearest_feature(mesh_, p, std::numeric_limits<double>::infinity()));
  }

  NodeValue kept_or_nearer(const Vector3& p, const NodeValue& old) {
    const Triangle& t = mesh_.triangles[old.triangle];
    const double most = (p - at_point_of(t, old.weight, mesh_.x)).norm();
    const double share = kept_share * settings_.beyond;
    // most - least = share (least - band); in the band least exceeds most, so the search finds the
    // nearest point
    const double least = (most + share * settings_.band) / (1 + share);
    const NearestFeature nearer = nearest_feature(mesh_, p, least);
    if (nearer.triangle >= 0) return value_at(p, nearer);
    return {std::copysign(most, old.phi), least, old.triangle, old.weight};
  }

  using Known = SharedMap<Position, NodeValue, Hash>;
  MeshDistance mesh_;
  std::vector<int> numbers_;            // of the mesh's triangles in the sequence
  std::optional<WindingMesh> winding_;  // of all triangles, where that decides
  const OctreeSettings& settings_;
  const Known* before_ = nullptr;
  double displacement_ = 0;  // m
  std::atomic<long> searches_ = 0;
  Known known_;
};

/// Displacements of the points of all nodes from the frame `from` to the frame `to`.
std::vector<BranchNodes<Vector3>> node_displacements(const Octree& tree, NodeValues& values,
                                                     const MeshSequence& sequence, std::size_t from,
                                                     std::size_t to, const Team& team) {
  const PerParticle3 moved = sequence.positions[to] - sequence.positions[from];
  const std::vector<OctreePlace> places = branch_places(tree);
  std::vector<BranchNodes<Vector3>> all(places.size());
  for_each_item(team, places, [&](const OctreePlace& place, std::size_t b) {
    BranchNodes<Vector3>& nodes = all[b];
    for (int n = 0; n < 27; ++n) {
      const NodeValue& node = values.at(node_position(tree.settings, place, n));
      nodes[n] = at_point_of(sequence.triangles[node.triangle], node.weight, moved);
    }
    if (tree.settings.hanging == HangingNodes::constrained)
      constrain(hanging_nodes(tree, place), nodes);
  });
  return all;
}

DeformingFrame make_frame(const MeshSequence& sequence, std::size_t k, NodeValues& values,
                          const OctreeSettings& settings, const Team& team) {
  const DistanceFunction distance = [&](const Vector3& p) {
    return Distance{values.at(p).phi, Vector3::Zero()};  // the octree does not use directions
  };
  DeformingFrame frame{sequence.times[k], make_octree({distance}, settings, team), {}, {}, 0, 0};
  if (k + 1 < sequence.times.size())
    frame.to_next = node_displacements(frame.field, values, sequence, k, k + 1, team);
  if (k > 0)
    frame.from_previous = node_displacements(frame.field, values, sequence, k - 1, k, team);
  const auto has_inside = [](const auto& nodes) {
    return std::ranges::any_of(nodes, [](double phi) { return phi < 0; });
  };
  if (sequence.inside == Inside::winding && std::ranges::none_of(frame.field.phi, has_inside))
    reject_without_inside(k);
  frame.nodes = values.nodes();
  frame.searches = values.searches();
  return frame;
}

double largest_displacement(const PerParticle3& from, const PerParticle3& to) {
  return (to - from).colwise().norm().maxCoeff();
}

void require_usable(const MeshSequence& sequence) {
  const std::size_t frames = sequence.times.size();
  if (frames == 0 || sequence.positions.size() != frames)
    throw InputError("mesh sequence: it needs a frame, and a time for each");
  for (std::size_t k = 1; k < frames; ++k) {
    const std::string where = "mesh sequence: frame " + std::to_string(k);
    if (!(sequence.times[k] > sequence.times[k - 1]))
      throw InputError(where + ": the times must rise");
    if (sequence.positions[k].cols() != sequence.positions[0].cols())
      throw InputError(where + ": it must have as many vertices as the first");
  }
}

}  // namespace

MeshSequence deformed_mesh(const TriangleMesh& mesh, const Deformation& deformation,
                           std::vector<double> times) {
  MeshSequence sequence{mesh.triangles, std::move(times), {}};
  for (double t : sequence.times) {
    PerParticle3 x(3, mesh.rest.cols());
    for (Eigen::Index i = 0; i < x.cols(); ++i) x.col(i) = deformation(mesh.rest.col(i), t);
    sequence.positions.push_back(std::move(x));
  }
  return sequence;
}

PerParticle3 positions_at(const MeshSequence& sequence, double t) {
  const std::vector<double>& times = sequence.times;
  const auto next = std::upper_bound(times.begin(), times.end(), t);
  if (next == times.begin()) return sequence.positions.front();
  if (next == times.end()) return sequence.positions.back();
  const std::size_t k = std::size_t(next - times.begin());
  const double part = (t - times[k - 1]) / (times[k] - times[k - 1]);
  return (1 - part) * sequence.positions[k - 1] + part * sequence.positions[k];
}

MeshSequence read_mesh_sequence(const SequenceSource& source) {
  if (!(source.interval >= 0))
    throw InputError(source.path + ": the time between two frames must be positive");
  std::vector<MeshFrame> frames =
      read_mesh_frames({.path = source.path,
                        .remedy = "frames that are an interval apart need even numbers",
                        .most = std::size_t(source.most)});
  const Eigen::Index vertices = frames.front().x.cols();
  MeshSequence sequence{{}, {}, {}, source.inside};
  for (std::size_t k = 0; k < frames.size(); ++k) {
    MeshFrame& frame = frames[k];
    if (!frame.triangles.empty() && !source.triangles.empty())
      throw InputError(frame.file +
                       ": has triangles of its own; give 'mesh' or 'frames', and not both");
    if (frame.triangles.empty()) frame.triangles = source.triangles;
    if (frame.triangles.empty())
      throw InputError(frame.file + ": has no triangles; name a file that has them by 'mesh'");
    for (const Triangle& t : frame.triangles)
      if (*std::ranges::max_element(t) >= vertices)
        throw InputError(frame.file + ": has fewer vertices than the triangles of 'mesh'");
    TriangleSoup mesh = without_unused_vertices({frame.x, frame.triangles, {frame.file, {}, {}}});
    if (source.inside == Inside::normals)
      make_triangle_mesh(mesh.rest, mesh.triangles, mesh.origin);
    if (k == 0) sequence.triangles = mesh.triangles;
    if (mesh.triangles != sequence.triangles || frame.x.cols() != vertices)
      throw InputError(frame.file + ": its triangles are not those of " + frames[0].file +
                       "; all frames must share them");
    const double interval = source.interval > 0 ? source.interval : 1.0 / 30;
    const double counted = (frame.number - frames[0].number) * interval;
    sequence.times.push_back(frame.time && source.interval == 0 ? *frame.time : counted);
    sequence.positions.push_back(std::move(mesh.rest));
  }
  return sequence;
}

DeformingBody make_deforming_body(const MeshSequence& sequence, const OctreeSettings& settings,
                                  BetweenFrames between, const Team& team) {
  require_usable(sequence);
  DeformingBody body{{}, between};
  std::unique_ptr<NodeValues> before;
  for (std::size_t k = 0; k < sequence.times.size(); ++k) {
    auto values = std::make_unique<NodeValues>(sequence, k, settings, team);
    if (before)
      values->follow(*before,
                     largest_displacement(sequence.positions[k - 1], sequence.positions[k]));
    body.frames.push_back(make_frame(sequence, k, *values, settings, team));
    before = std::move(values);
  }
  return body;
}

}  // namespace foldproof
