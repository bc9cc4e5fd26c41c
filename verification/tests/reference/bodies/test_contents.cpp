// Contents of bodies: their keys, what is refused when they are read, and who makes them.
#include <catch2/catch.hpp>

#include "reference/bodies/content_key.h"
#include "reference/bodies/deforming_content.h"
#include "reference/bodies/grid_content.h"
#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

MeshSequence moving_ball() {
  const TriangleMesh ball = make_icosphere(0.3, 1);
  MeshSequence sequence{ball.triangles, {0.1, 0.4, 0.5}, {}};
  for (int k = 0; k < 3; ++k) sequence.positions.push_back(ball.rest.array() + 0.02 * k);
  return sequence;
}

const OctreeSettings coarse{Vector3(-0.6, -0.7, -0.65), 1.3, 3, 2, 0.01, 0.2, 0.5, 0.05,
                            HangingNodes::constrained};

}  // namespace

TEST_CASE("content keys are FNV-1a of the bytes, with the published values") {
  const auto key = [](const std::string& text) {
    ContentKey of;
    of.add(text.data(), text.size());
    return of.text();
  };
  CHECK(key("") == "cbf29ce484222325");
  CHECK(key("foobar") == "85944171f73967e8");
  // the same numbers in meshes of other sizes are other meshes
  const PerParticle3 x = PerParticle3::Zero(3, 4);
  CHECK(input_key(MeshSequence{{}, {}, {x}}, coarse) !=
        input_key(MeshSequence{{}, {}, {x.leftCols(1), x.leftCols(3)}}, coarse));
}

TEST_CASE("a deforming body that was read is refused frame by frame, with what is wrong") {
  const DeformingBody good = make_deforming_body(moving_ball(), coarse, BetweenFrames::carried);
  CHECK_NOTHROW(require_valid_content(good));
  const auto refused = [&](size_t frame, const std::string& why, const auto& change) {
    DeformingBody wrong = good;
    change(wrong.frames[frame], wrong.frames[frame].field);
    CHECK_THROWS_WITH(require_valid_content(wrong),
                      Contains("frame " + std::to_string(frame) + ": ") && Contains(why));
  };
  for (const size_t k : {0, 1, 2}) {
    const std::string unfit = "do not fit together", deep = "deeper than its depth",
                      infinite = "not finite";
    refused(k, unfit, [](auto&, auto& field) { field.branches.clear(); });
    refused(k, unfit, [](auto&, auto& field) { field.branches.pop_back(); });
    refused(k, unfit, [](auto&, auto& field) { field.phi.pop_back(); });
    refused(k, unfit, [](auto&, auto& field) { field.part.pop_back(); });
    refused(k, unfit, [](auto&, auto& field) { field.branches[1].parts = 0; });
    refused(k, unfit, [](auto&, auto& field) { ++field.branches[0].children; });
    refused(k, unfit, [](auto&, auto& field) { ++field.branches[2].channels; });
    refused(k, unfit, [](auto&, auto& field) { field.branches.back().inner ^= 4; });
    refused(k, deep, [](auto&, auto& field) { field.settings.depth = 2; });
    refused(k, deep, [](auto&, auto& field) { field.settings.depth = 0; });
    refused(k, "the next frame", [](auto& frame, auto&) { frame.to_next.emplace_back(); });
    refused(k, "the frame before", [](auto& frame, auto&) { frame.from_previous.emplace_back(); });
    refused(k, infinite, [](auto&, auto& field) { field.phi.back()[26] = NAN; });
    if (k < 2) refused(k, infinite, [](auto& frame, auto&) { frame.to_next[0][0].z() = INFINITY; });
    if (k == 0) refused(0, infinite, [](auto& frame, auto&) { frame.time = -INFINITY; });
    if (k == 0) continue;
    refused(k, infinite, [](auto& frame, auto&) { frame.from_previous.back()[26].x() = NAN; });
    refused(k, "not later", [&](auto& frame, auto&) { frame.time = good.frames[k - 1].time; });
  }
  CHECK_THROWS_WITH(require_valid_content(DeformingBody{{}, BetweenFrames::carried}),
                    Contains("no frame"));
}

TEST_CASE("a branch that is nobody's child is refused, though the numbers add up") {
  const auto check = [](int depth, const std::vector<OctreeBranch>& branches, size_t channels,
                        const std::string& refusal) {
    DeformingBody body{{}, BetweenFrames::carried};
    body.frames.resize(1);
    Octree& tree = body.frames[0].field;
    tree.settings = coarse;
    tree.settings.depth = depth;
    tree.branches = branches;
    tree.part.resize(channels);
    tree.phi.resize(channels);
    if (refusal.empty())
      CHECK_NOTHROW(require_valid_content(body));
    else
      CHECK_THROWS_WITH(require_valid_content(body), Contains(refusal));
  };
  check(9, {{1, 0, 1, 1}, {2, 1, 0, 1}}, 2, "");
  check(1, {{1, 0, 1, 1}, {2, 1, 0, 1}}, 2, "its branches are deeper than its depth");
  check(2, {{1, 0, 1, 1}, {2, 1, 0, 1}}, 2, "");
  check(2, {{1, 0, 1, 2}, {2, 2, 0, 1}}, 3, "");
  check(2, {{1, 0, 1, 2}, {2, 2, 0, 0}}, 2, "do not fit together");  // without a channel
  check(2, {{1, 0, 0, 1}, {1, 1, 1, 1}}, 2, "do not fit together");
}

TEST_CASE("a provider that remembers tells level sets apart by all that makes them") {
  const LevelSetProvider memo =
      memoizing_provider({[](const auto&...) { return std::make_shared<const Grid>(); },
                          [](const auto&...) { return std::make_shared<const DeformingBody>(); }});
  const auto grid = [&](int cells, Repair repair) {
    return memo.make_level_set({}, {cells, 2, 2, MarchingOrder::first}, repair);
  };
  const auto first = grid(9, Repair::refuse);
  CHECK(grid(9, Repair::refuse) == first);
  CHECK(grid(9, Repair::winding) != first);
  CHECK(grid(10, Repair::refuse) != first);
  const auto body = memo.make_deforming_body({}, coarse, BetweenFrames::carried);
  CHECK(memo.make_deforming_body({}, coarse, BetweenFrames::carried) == body);
  CHECK(memo.make_deforming_body({}, coarse, BetweenFrames::blended) != body);
}
