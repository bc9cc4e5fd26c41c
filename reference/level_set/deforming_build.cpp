#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <unordered_map>

#include "reference/level_set/deforming.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/level_set/octree_nodes.h"
#include "reference/mesh/obj.h"

namespace foldproof {

namespace {

/// The weights of the triangle's corners at a point of it.
Vector3 barycentric(const Corners3& corners, const Vector3& p) {
  const Vector3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], ap = p - corners[0];
  const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm();
  const double determinant = bb * cc - bc * bc;
  if (!(determinant > 0)) return {1, 0, 0};
  const double b = (cc * ap.dot(ab) - bc * ap.dot(ac)) / determinant;
  const double c = (bb * ap.dot(ac) - bc * ap.dot(ab)) / determinant;
  return {1 - b - c, b, c};
}

/// What is nearest to the nodes of an octree, each looked for once: every cell about a node asks for it anew, and so
/// do the displacements once the octree stands.
class NodeFeatures {
 public:
  explicit NodeFeatures(const MeshDistance& mesh) : mesh_(mesh) {}

  const NearestFeature& at(const Vector3& p) {
    const auto [place, is_new] = known_.try_emplace({p.x(), p.y(), p.z()});
    if (is_new) place->second = nearest_feature(mesh_, p, std::numeric_limits<double>::infinity());
    return place->second;
  }

 private:
  using Position = std::array<double, 3>;  // m

  struct Hash {
    std::size_t operator()(const Position& p) const {
      std::uint64_t hash = 0;
      for (const double x : p) hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15;
      return std::size_t(hash ^ hash >> 32);
    }
  };

  const MeshDistance& mesh_;
  std::unordered_map<Position, NearestFeature, Hash> known_;
};

/// What the surface point that is nearest to a node is displaced by, its vertices moving from `from` to `to`.
Vector3 displacement_near(const MeshDistance& mesh, const PerParticle3& from, const PerParticle3& to,
                          const NearestFeature& nearest) {
  const Triangle& t = mesh.triangles[mesh.tree.order[nearest.triangle]];
  const Vector3 weight = barycentric(mesh.corners[nearest.triangle], nearest.point);
  Vector3 u = Vector3::Zero();
  for (int k = 0; k < 3; ++k) u += weight[k] * (to.col(t[k]) - from.col(t[k]));
  return u;
}

/// What the vertices move by, and the mesh and its nearest features at the one end that belongs to the octree.
struct Displaced {
  const MeshDistance& mesh;
  NodeFeatures& features;
  const PerParticle3 &from, &to;  // 3 x N [m]
};

std::vector<BranchNodes<Vector3>> node_displacements(const Octree& tree, const Displaced& displaced) {
  const std::vector<OctreePlace> places = branch_places(tree);
  std::vector<BranchNodes<Vector3>> all(places.size());
  for (std::size_t b = 0; b < places.size(); ++b) {
    for (int n = 0; n < 27; ++n) {
      const NearestFeature& nearest = displaced.features.at(node_position(tree.settings, places[b], n));
      all[b][n] = displacement_near(displaced.mesh, displaced.from, displaced.to, nearest);
    }
    if (tree.settings.hanging == HangingNodes::constrained) constrain(hanging_nodes(tree, places[b]), all[b]);
  }
  return all;
}

DeformingFrame make_frame(const MeshSequence& sequence, std::size_t k, const OctreeSettings& settings) {
  const PerParticle3& x = sequence.positions[k];
  const MeshDistance mesh = make_mesh_distance(x, sequence.triangles);
  NodeFeatures features(mesh);
  const DistanceFunction distance = [&](const Vector3& p) {
    return signed_distance(mesh, features.at(p), p);
  };
  DeformingFrame frame{sequence.times[k], make_octree({distance}, settings), {}, {}};
  if (k + 1 < sequence.times.size())
    frame.to_next = node_displacements(frame.field, {mesh, features, x, sequence.positions[k + 1]});
  if (k > 0)
    frame.from_previous = node_displacements(frame.field, {mesh, features, sequence.positions[k - 1], x});
  return frame;
}

void require_usable(const MeshSequence& sequence) {
  const std::size_t frames = sequence.times.size();
  if (frames == 0 || sequence.positions.size() != frames)
    throw InputError("mesh sequence: it needs a frame, and a time for each");
  for (std::size_t k = 1; k < frames; ++k) {
    const std::string where = "mesh sequence: frame " + std::to_string(k);
    if (!(sequence.times[k] > sequence.times[k - 1])) throw InputError(where + ": the times must rise");
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

MeshSequence read_obj_sequence(const std::string& folder, double interval) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".obj") files.push_back(entry.path().string());
  if (files.empty())
    throw InputError(folder + ": no folder with *.obj files; a mesh sequence is one file a frame");
  if (!(interval > 0)) throw InputError(folder + ": the time between two frames must be positive");
  std::sort(files.begin(), files.end());
  MeshSequence sequence;
  for (std::size_t k = 0; k < files.size(); ++k) {
    TriangleMesh mesh = read_obj(files[k]);
    if (k == 0) sequence.triangles = mesh.triangles;
    if (mesh.triangles != sequence.triangles)
      throw InputError(files[k] + ": its triangles are not those of " + files[0] +
                       "; all frames must share them");
    sequence.times.push_back(double(k) * interval);
    sequence.positions.push_back(std::move(mesh.rest));
  }
  return sequence;
}

DeformingBody make_deforming_body(const MeshSequence& sequence, const OctreeSettings& settings,
                                  BetweenFrames between) {
  require_usable(sequence);
  DeformingBody body{{}, between};
  for (std::size_t k = 0; k < sequence.times.size(); ++k)
    body.frames.push_back(make_frame(sequence, k, settings));
  return body;
}

}  // namespace foldproof
