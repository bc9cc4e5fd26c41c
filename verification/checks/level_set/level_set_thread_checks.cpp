// Level sets computed on several threads: bit for bit the result of one thread.
#include "reference/bodies/repair.h"
#include "reference/level_set/deforming.h"
#include "reference/mesh/shapes.h"
#include "verification/checks/level_set/octree_samples.h"
#include "verification/specimens/check.h"
#include "verification/specimens/followed_runs.h"
#include "verification/specimens/ugly_solids.h"

namespace foldproof {

namespace {

Numbers numbers_of(const Grid& grid) { return grid.phi; }

void add(const Octree& tree, Numbers& all) {
  for (const OctreeBranch& branch : tree.branches)
    all.insert(all.end(), {double(branch.children), double(branch.channels), double(branch.inner),
                           double(branch.parts)});
  all.insert(all.end(), tree.part.begin(), tree.part.end());
  for (const BranchNodes<double>& nodes : tree.phi)
    all.insert(all.end(), nodes.begin(), nodes.end());
  all.push_back(double(tree.evaluations));
}

void add(const std::vector<BranchNodes<Vector3>>& displacements, Numbers& all) {
  for (const BranchNodes<Vector3>& nodes : displacements)
    for (const Vector3& u : nodes) all.insert(all.end(), u.begin(), u.end());
}

Numbers numbers_of(const Octree& tree) {
  Numbers all;
  add(tree, all);
  return all;
}

/// Includes the searches: each node counts once, even if several threads have reached it.
Numbers numbers_of(const DeformingBody& body) {
  Numbers all;
  for (const DeformingFrame& frame : body.frames) {
    add(frame.field, all);
    add(frame.to_next, all);
    add(frame.from_previous, all);
    all.insert(all.end(), {double(frame.nodes), double(frame.searches)});
  }
  return all;
}

TriangleSoup statue() { return soup_of(make_statue(1, 3)); }

/// The same without some of its triangles.
TriangleSoup statue_with_holes() {
  TriangleSoup soup = statue();
  std::erase_if(soup.triangles, [](const Triangle& t) { return t[0] % 11 == 0; });
  return soup;
}

/// Two overlapping bodies, which both need channels where they meet.
std::vector<DistanceFunction> two_bodies() {
  return {tilted_torus,
          [](const Vector3& p) { return Sphere{0.17}.at(p - Vector3(0.21, 0.05, -0.04)); }};
}

/// Bends and moves a little more in each frame: some values are kept, others are searched again.
MeshSequence bending_ball() {
  const auto deformation = [](const Vector3& X, double t) -> Vector3 {
    return X + t * Vector3(0.03 + 0.4 * X.z() * X.z(), -0.02, 0.05 * X.x());
  };
  return deformed_mesh(make_icosphere(0.15, 3), deformation, {0, 0.5, 1.1});
}

/// A way to make a level set on a given number of threads.
struct NamedMaking {
  std::string name;
  std::function<Numbers(int threads)> numbers_on;
};

std::vector<NamedMaking> makings() {
  const GridMethod method{31, 3, 3, MarchingOrder::second};
  const OctreeSettings settings = sampling(6, 1e-3, HangingNodes::constrained);
  return {
      {"grid about a statue",
       [=](int threads) {
         return numbers_of(*make_level_set(statue(), method, Repair::refuse, threads));
       }},
      {"grid about a statue with holes",
       [=](int threads) {
         return numbers_of(*make_level_set(statue_with_holes(), method, Repair::winding, threads));
       }},
      {"octree of two bodies",
       [=](int threads) { return numbers_of(make_octree(two_bodies(), settings, threads)); }},
      {"frames of a ball that bends", [=](int threads) {
         return numbers_of(
             make_deforming_body(bending_ball(), settings, BetweenFrames::carried, threads));
       }}};
}

Finding threads_finding() {
  Table measured("case; threads [1]; numbers [1]; numbers that differ [1]");
  for (const NamedMaking& making : makings()) {
    const Numbers alone = making.numbers_on(1);
    for (const int threads : {2, 3, 7})
      measured.row(making.name, threads, alone.size(),
                   alone.empty() ? NAN : bits_that_differ(alone, making.numbers_on(threads)));
  }
  return judge_worst(measured, 0,
                     "a node's value depends on its place alone, and nodes are put together in the "
                     "order of one thread");
}

}  // namespace

std::vector<Check> level_set_thread_checks() {
  return {{"level-set.threads-change-no-bit",
           "A level set made on several threads has the bits of one made on one.", "good practice",
           threads_finding}};
}

}  // namespace foldproof
