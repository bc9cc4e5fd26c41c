// How deforming bodies are made: values kept from frame to frame, displacements, and sequences.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "reference/level_set/deforming.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/level_set/octree_nodes.h"
#include "reference/mesh/obj.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;
using Catch::Contains;

namespace {

/// The value of a node as the header promises it: the nearest surface point of this frame, or that
/// of the frame before where it is close enough.
struct SlowNode {
  double phi, least;
  int triangle;
  Vector3 weight;
};

using SlowNodes = std::map<std::array<double, 3>, SlowNode>;

/// Shares of the triangle's area.
Vector3 weights_at(const PerParticle3& x, const Triangle& t, const Vector3& p) {
  Vector3 areas;
  for (int k = 0; k < 3; ++k) {
    const Vector3 one = x.col(t[(k + 1) % 3]), other = x.col(t[(k + 2) % 3]);
    areas[k] = (one - p).cross(other - p).norm();
  }
  return areas / areas.sum();
}

Vector3 point_of(const PerParticle3& x, const Triangle& t, const Vector3& weight) {
  return weight[0] * x.col(t[0]) + weight[1] * x.col(t[1]) + weight[2] * x.col(t[2]);
}

struct SlowFrame {
  const MeshSequence& sequence;
  const OctreeSettings& settings;
  std::size_t frame;
  const SlowNodes* before;
  SlowNodes nodes = {};
  long searches = 0;

  SlowNode search(const Vector3& p) {
    ++searches;
    const PerParticle3& x = sequence.positions[frame];
    SlowNode node{make_mesh_distance(x, sequence.triangles).at(p).phi, 0, -1, {}};
    double least = INFINITY;
    for (std::size_t t = 0; t < sequence.triangles.size(); ++t) {
      const Triangle& triangle = sequence.triangles[t];
      const NearestFeature found =
          nearest_on_triangle({x.col(triangle[0]), x.col(triangle[1]), x.col(triangle[2])}, p);
      if (!(found.squared_distance < least)) continue;
      least = found.squared_distance;
      node.triangle = int(t);
      node.weight = weights_at(x, triangle, found.point);
    }
    node.least = std::abs(node.phi);
    return node;
  }

  /// The farthest that a vertex has moved.
  double displacement() const {
    double most = 0;
    for (Eigen::Index i = 0; i < sequence.positions[0].cols(); ++i)
      most = std::max(
          most, (sequence.positions[frame].col(i) - sequence.positions[frame - 1].col(i)).norm());
    return most;
  }

  SlowNode make(const Vector3& p) {
    const auto old = before ? before->find({p.x(), p.y(), p.z()}) : SlowNodes::const_iterator{};
    if (!before || old == before->end() || old->second.least <= displacement()) return search(p);
    SlowNode node = old->second;
    const PerParticle3& x = sequence.positions[frame];
    const double phi = (p - point_of(x, sequence.triangles[node.triangle], node.weight)).norm();
    // phi - least = (beyond/2) (least - band)
    const double half = 0.5 * settings.beyond;
    const double least = (phi + half * settings.band) / (1 + half);
    if (std::abs(make_mesh_distance(x, sequence.triangles).at(p).phi) < least) return search(p);
    node.phi = std::copysign(phi, node.phi);
    node.least = least;
    return node;
  }

  const SlowNode& at(const Vector3& p) {
    const std::array<double, 3> key{p.x(), p.y(), p.z()};
    const auto known = nodes.find(key);
    return known != nodes.end() ? known->second : nodes[key] = make(p);
  }
};

void check_displacements(const std::vector<BranchNodes<Vector3>>& found, SlowFrame& slow,
                         const Octree& tree, std::size_t from) {
  const PerParticle3 moved = slow.sequence.positions[from + 1] - slow.sequence.positions[from];
  const std::vector<OctreePlace> places = branch_places(tree);
  REQUIRE(found.size() == places.size());
  double worst = 0;
  for (std::size_t b = 0; b < places.size(); ++b) {
    BranchNodes<Vector3> expected;
    for (int n = 0; n < 27; ++n) {
      const SlowNode& node = slow.at(node_position(tree.settings, places[b], n));
      expected[n] = point_of(moved, slow.sequence.triangles[node.triangle], node.weight);
    }
    if (tree.settings.hanging == HangingNodes::constrained)
      constrain(hanging_nodes(tree, places[b]), expected);
    for (int n = 0; n < 27; ++n) worst = std::max(worst, (found[b][n] - expected[n]).norm());
  }
  CHECK(worst < 1e-12);
}

/// All frames of a body against slow ones; returns how many values were kept in all.
long check_body(const MeshSequence& sequence, const OctreeSettings& settings) {
  const DeformingBody body = make_deforming_body(sequence, settings, BetweenFrames::carried);
  const std::size_t frames = sequence.times.size();
  REQUIRE(body.frames.size() == frames);
  SlowNodes before;
  long kept = 0;
  for (std::size_t k = 0; k < frames; ++k) {
    const DeformingFrame& frame = body.frames[k];
    SlowFrame slow{sequence, settings, k, k > 0 ? &before : nullptr};
    const Octree tree = make_octree({[&](const Vector3& p) {
                                      return Distance{slow.at(p).phi, Vector3::Zero()};
                                    }},
                                    settings);
    CHECK(frame.time == sequence.times[k]);
    REQUIRE(frame.field.phi.size() == tree.phi.size());
    double worst = 0;
    for (std::size_t b = 0; b < tree.phi.size(); ++b)
      for (int n = 0; n < 27; ++n)
        worst = std::max(worst, std::abs(frame.field.phi[b][n] - tree.phi[b][n]));
    CHECK(worst < 1e-13);
    CHECK(frame.nodes == long(slow.nodes.size()));
    CHECK(frame.searches == slow.searches);
    kept += long(slow.nodes.size()) - slow.searches;
    if (k + 1 < frames)
      check_displacements(frame.to_next, slow, tree, k);
    else
      CHECK(frame.to_next.empty());
    if (k > 0)
      check_displacements(frame.from_previous, slow, tree, k - 1);
    else
      CHECK(frame.from_previous.empty());
    before = slow.nodes;
  }
  return kept;
}

PerParticle3 irregular() {
  PerParticle3 x(3, 4);
  x << 0.71, 0.32, 0.43, 0.56, 0.47, 0.73, 0.26, 0.52, 0.38, 0.35, 0.43, 0.71;
  return x;
}

/// A tetrahedron whose vertices each move their own way, a little, much, and a little again.
MeshSequence moving_tetrahedron() {
  PerParticle3 ways(3, 4);
  ways << 0.011, -0.007, 0.004, 0.009, -0.006, 0.012, 0.003, -0.008, 0.005, 0.002, -0.013, 0.007;
  const PerParticle3 x = irregular();
  return {{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}},
          {0.3, 0.5, 1.1, 1.2},
          {x, x + ways, x - 6 * ways, x - 5.3 * ways}};
}

OctreeSettings sampling() {
  return {{0, 0, 0}, 1, 4, 2, 0.008, 0.03, 0.5, 0, HangingNodes::constrained};
}

std::string refusal(const MeshSequence& sequence) {
  try {
    make_deforming_body(sequence, sampling(), BetweenFrames::carried);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a frame's nodes keep the nearest point of the frame before where it is near enough") {
  OctreeSettings settings = sampling();
  CHECK(check_body(moving_tetrahedron(), settings) > 100);
  settings.hanging = HangingNodes::free;
  settings.beyond = 0.2;
  settings.depth = 3;
  CHECK(check_body(moving_tetrahedron(), settings) > 10);
}

TEST_CASE("a node just as far as the mesh has moved is searched anew") {
  PerParticle3 x(3, 4);
  x << 0.25, 0.75, 0.25, 0.25, 0.25, 0.25, 0.75, 0.25, 0.5, 0.5, 0.5, 0.25;
  PerParticle3 lower = x;
  lower.row(2).array() -= 0.125;
  OctreeSettings settings = sampling();
  settings.surface_depth = 3;
  CHECK(check_body({{{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}}, {0, 0.5}, {x, lower}}, settings) >
        10);
}

TEST_CASE("a triangle without area moves its surroundings as its first corner moves") {
  PerParticle3 x(3, 3), moved;
  x << 0.25, 0.5, 0.375, 0.375, 0.375, 0.375, 0.5, 0.5, 0.5;
  moved = x;
  moved.row(0) += Eigen::RowVector3d(0.03, 0.07, -0.01);
  const DeformingBody body =
      make_deforming_body({{{0, 1, 2}}, {0, 0.5}, {x, moved}}, sampling(), BetweenFrames::carried);
  for (const BranchNodes<Vector3>& nodes : body.frames[0].to_next)
    for (const Vector3& u : nodes) CHECK((u - Vector3(0.03, 0, 0)).norm() < 1e-15);
}

TEST_CASE("a mesh sequence needs a frame, and positions for each") {
  MeshSequence sequence = moving_tetrahedron();
  CHECK(refusal(sequence).empty());
  sequence.positions.pop_back();
  CHECK_THAT(refusal(sequence), Contains("it needs a frame, and a time for each"));
  CHECK_THAT(refusal({sequence.triangles, {}, {}}), Contains("it needs a frame"));
  CHECK(refusal({sequence.triangles, {0.7}, {irregular()}}).empty());
}

TEST_CASE("the times of a mesh sequence rise from each frame to the next") {
  for (const std::size_t k : {1, 2, 3})
    for (const bool equal : {true, false}) {
      MeshSequence sequence = moving_tetrahedron();
      sequence.times[k] = equal ? sequence.times[k - 1] : NAN;
      CHECK(refusal(sequence) ==
            "mesh sequence: frame " + std::to_string(k) + ": the times must rise");
    }
}

TEST_CASE("all frames of a mesh sequence have as many vertices as the first") {
  for (const std::size_t k : {1, 2, 3})
    for (const int vertices : {3, 5}) {
      MeshSequence sequence = moving_tetrahedron();
      sequence.positions[k] = PerParticle3::Constant(3, vertices, 0.4);
      CHECK(refusal(sequence) == "mesh sequence: frame " + std::to_string(k) +
                                     ": it must have as many vertices as the first");
    }
}

TEST_CASE("a deformed mesh has each vertex where the deformation takes it at each time") {
  TriangleMesh mesh;
  mesh.rest = irregular();
  mesh.triangles = {{0, 1, 3}, {1, 2, 3}};
  const Deformation deformation = [](const Vector3& X, double t) -> Vector3 {
    return X + t * Vector3(X.y(), -X.z(), 2 * X.x());
  };
  const MeshSequence sequence = deformed_mesh(mesh, deformation, {0.2, 0.9, 1.7});
  CHECK(sequence.triangles == mesh.triangles);
  CHECK(sequence.times == std::vector<double>{0.2, 0.9, 1.7});
  REQUIRE(sequence.positions.size() == 3);
  for (int k = 0; k < 3; ++k) {
    REQUIRE(sequence.positions[k].cols() == 4);
    for (int i = 0; i < 4; ++i)
      CHECK(Vector3(sequence.positions[k].col(i)) ==
            deformation(mesh.rest.col(i), sequence.times[k]));
  }
}

TEST_CASE("between frames vertices move straight and evenly, at rest before and after") {
  const MeshSequence sequence = moving_tetrahedron();
  const auto check_positions = [&](double t, const PerParticle3& expected) {
    CHECK((positions_at(sequence, t) - expected).norm() < 1e-15);
  };
  check_positions(-1, sequence.positions[0]);
  check_positions(0.3, sequence.positions[0]);
  check_positions(0.35, 0.75 * sequence.positions[0] + 0.25 * sequence.positions[1]);
  check_positions(0.5, sequence.positions[1]);
  check_positions(0.98, 0.2 * sequence.positions[1] + 0.8 * sequence.positions[2]);
  check_positions(1.2, sequence.positions[3]);
  check_positions(7, sequence.positions[3]);
}

TEST_CASE("a folder's OBJ files are frames in the order of their names, other files are none") {
  const ScratchFolder folder;
  const std::vector<Triangle> triangles{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}};
  for (const int k : {4, 1, 7, 0, 3, 6, 2, 5})
    write_obj(folder.file("f" + std::to_string(k) + ".obj"),
              irregular() + 0.1 * PerParticle3::Constant(3, 4, k), triangles);
  folder.write("notes.txt", "no mesh");
  const MeshSequence sequence = read_obj_sequence(folder.file("."), 0.25);
  CHECK(sequence.triangles == triangles);
  REQUIRE(sequence.positions.size() == 8);
  REQUIRE(sequence.times.size() == 8);
  for (int k = 0; k < 8; ++k) {
    CHECK(sequence.times[k] == 0.25 * k);
    CHECK(sequence.positions[k] == irregular() + 0.1 * PerParticle3::Constant(3, 4, k));
  }
}

TEST_CASE("a folder is read up to the number of frames allowed, a thousand if nothing is said") {
  const ScratchFolder folder;
  const std::string path = folder.file(".");
  const std::vector<Triangle> triangles{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}};
  for (const char* name : {"a.obj", "b.obj", "c.obj"})
    write_obj(folder.file(name), irregular(), triangles);
  CHECK(read_obj_sequence(path, 0.04, 3).times.size() == 3);
  CHECK_THROWS_WITH(read_obj_sequence(path, 0.04, 2),
                    path + ": 3 *.obj files; at most 2 frames are read, for each is a level set");
  for (int k = 0; k < 998; ++k) folder.write("d" + std::to_string(k) + ".obj", "");
  CHECK_THROWS_WITH(read_obj_sequence(path, 0.04), Contains(": 1001 *.obj files; at most 1000 "));
}

TEST_CASE("the time between a folder's frames is positive") {
  const ScratchFolder folder;
  const std::string path = folder.file(".");
  write_obj(folder.file("a.obj"), irregular(), {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}});
  CHECK_NOTHROW(read_obj_sequence(path, 1e-9));
  for (const double interval : {0.0, -0.5, double(NAN)})
    CHECK_THROWS_WITH(read_obj_sequence(path, interval),
                      path + ": the time between two frames must be positive");
}

TEST_CASE("frames of other triangles than the first's are refused by name") {
  const ScratchFolder folder;
  const std::string path = folder.file(".");
  CHECK_THROWS_WITH(read_obj_sequence(path, 0.04), Contains(path + ": no folder with *.obj files"));
  CHECK_THROWS_WITH(read_obj_sequence(folder.file("none"), 0.04), Contains("no folder with"));
  write_obj(folder.file("a.obj"), irregular(), {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}});
  write_obj(folder.file("b.obj"), irregular(), {{1, 3, 0}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}});
  CHECK_THROWS_WITH(read_obj_sequence(path, 0.04),
                    Contains("b.obj: its triangles are not those of ") &&
                        Contains("a.obj; all frames must share them"));
}
