// Contents of bodies: their keys, and what is refused when they are read.
#include <catch2/catch.hpp>

#include "verification/files/content_key.h"
#include "verification/files/deforming_content.h"
#include "verification/files/grid_content.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

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
  CHECK(input_key(MeshSequence{{}, {}, {x}}, coarse) !=
        input_key(MeshSequence{{}, {}, {x}, Inside::winding}, coarse));
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
