// Level sets on one thread are made by the caller alone; on several they are the same.
#include <catch2/catch.hpp>
#include <mutex>
#include <set>
#include <thread>

#include "reference/bodies/level_set_provider.h"
#include "reference/level_set/narrow_band.h"
#include "reference/level_set/octree.h"
#include "reference/mesh/shapes.h"
#include "verification/checks/level_set/octree_samples.h"

using namespace foldproof;

namespace {

/// Threads that ask for a distance.
class Askers {
 public:
  Distance at(const Vector3& p) {
    {
      const std::lock_guard lock(one_at_a_time_);
      ids_.insert(std::this_thread::get_id());
    }
    return tilted_torus(p);
  }
  std::size_t count() const { return ids_.size(); }
  bool has_caller() const { return ids_.contains(std::this_thread::get_id()); }

 private:
  std::mutex one_at_a_time_;
  std::set<std::thread::id> ids_;
};

Seeds band_on(int threads, int cells, double width) {
  const TriangleMesh ball = make_icosphere(0.3, 2);
  const MeshDistance mesh = make_mesh_distance(ball.rest, ball.triangles);
  return narrow_band(mesh, lattice_about(mesh.tree.nodes[0].bounds, cells, 2), width, threads);
}

}  // namespace

TEST_CASE("an octree's bodies are asked by the caller alone if there is one thread") {
  Askers askers;
  make_octree({[&](const Vector3& p) { return askers.at(p); }},
              sampling(6, 1e-3, HangingNodes::constrained), 1);
  CHECK(askers.count() == 1);
  CHECK(askers.has_caller());
}

TEST_CASE("a grid's band is the same on more threads than it has blocks") {
  for (const int cells : {4, 13}) {
    const Seeds alone = band_on(1, cells, 1), shared = band_on(200, cells, 1);
    CHECK(alone.nodes.size() > 20);
    CHECK(alone.nodes == shared.nodes);
    CHECK(alone.phi == shared.phi);
  }
}

TEST_CASE("a provider on several threads makes what one on one thread makes") {
  const TriangleMesh ball = make_icosphere(0.3, 2);
  const TriangleSoup soup{ball.rest, ball.triangles, {}};
  const GridMethod method{15, 2, 2, MarchingOrder::second};
  const auto alone = computing_provider(), shared = computing_provider(3);
  CHECK(alone.make_level_set(soup, method, Repair::refuse)->phi ==
        shared.make_level_set(soup, method, Repair::refuse)->phi);
  const OctreeSettings settings = sampling(5, 3e-3, HangingNodes::constrained);
  CHECK(make_octree(alone, ball.rest, ball.triangles, settings)->phi ==
        make_octree(shared, ball.rest, ball.triangles, settings)->phi);
}
