// Contents of bodies: their keys, what is refused when they are read, and who makes them.
#include <catch2/catch.hpp>
#include <set>

#include "reference/bodies/content_key.h"
#include "reference/bodies/deforming_content.h"
#include "reference/bodies/grid_content.h"
#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {

/// A ball of 80 triangles and 42 vertices.
TriangleSoup ball_soup() {
  const TriangleMesh ball = make_icosphere(0.8, 1);
  return {ball.rest, ball.triangles, {}};
}

}  // namespace

TEST_CASE("content keys are FNV-1a of the bytes, with the published values") {
  const auto key = [](const std::string& text) {
    ContentKey of;
    of.add(text.data(), text.size());
    return of.text();
  };
  CHECK(key("") == "cbf29ce484222325");
  CHECK(key("a") == "af63dc4c8601ec8c");
  CHECK(key("foobar") == "85944171f73967e8");
  // a list is its length and its values
  ContentKey list, parts, single, bytes;
  list.add(std::vector<int>{7, 300});
  parts.add(std::uint64_t(2));
  parts.add(7);
  parts.add(300);
  CHECK(list.text() == parts.text());
  const double number = 0.37;
  ContentKey whole, whole_bytes;
  const std::uint64_t large = 0x123456789abcdef0;
  whole.add(large);
  whole_bytes.add(reinterpret_cast<const char*>(&large), sizeof large);
  CHECK(whole.text() == whole_bytes.text());
  single.add(number);
  bytes.add(reinterpret_cast<const char*>(&number), sizeof number);
  CHECK(single.text() == bytes.text());
}

TEST_CASE("a grid that was read has at least two nodes along each axis and finite values") {
  Grid good{{Vector3(0.1, 0.2, 0.3), 0.4, {2, 3, 2}}, std::vector<double>(12, 0.7)};
  CHECK_NOTHROW(require_valid_content(good));
  for (size_t axis = 0; axis < 3; ++axis) {
    Grid flat = good;
    flat.lattice.nodes[axis] = 1;
    flat.phi.resize(size_t(flat.lattice.size()));
    CHECK_THROWS_WITH(require_valid_content(flat), Contains("its lattice has no cells"));
    Grid nowhere_grid = good;
    nowhere_grid.lattice.origin[long(axis)] = NAN;
    CHECK_THROWS_WITH(require_valid_content(nowhere_grid), Contains("no place or no spacing"));
  }
  for (const double spacing : {0.0, -0.4, double(NAN), double(INFINITY)}) {
    Grid wrong = good;
    wrong.lattice.spacing = spacing;
    CHECK_THROWS_WITH(require_valid_content(wrong), Contains("no place or no spacing"));
  }
  for (const size_t count : {11, 13}) {
    Grid wrong = good;
    wrong.phi.resize(count, 0.7);
    CHECK_THROWS_WITH(require_valid_content(wrong), Contains("not as many as its nodes"));
  }
  for (const size_t at : {0, 11}) {
    Grid wrong = good;
    wrong.phi[at] = INFINITY;
    CHECK_THROWS_WITH(require_valid_content(wrong), Equals("grid: a value is not finite"));
  }
}

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

TEST_CASE("a deforming body that was read is refused frame by frame, with what is wrong") {
  const DeformingBody good = make_deforming_body(moving_ball(), coarse, BetweenFrames::carried);
  CHECK_NOTHROW(require_valid_content(good));
  const auto refused = [&](size_t frame, const std::string& why, const auto& change) {
    DeformingBody wrong = good;
    change(wrong.frames[frame]);
    CHECK_THROWS_WITH(require_valid_content(wrong),
                      Equals("deforming body, frame " + std::to_string(frame) + ": " + why));
  };
  for (const size_t k : {0, 1, 2}) {
    refused(k, "its branches do not fit together", [](auto& f) { f.field.branches.clear(); });
    refused(k, "its branches do not fit together", [](auto& f) { f.field.branches.pop_back(); });
    refused(k, "its branches do not fit together", [](auto& f) { f.field.phi.pop_back(); });
    refused(k, "its branches do not fit together", [](auto& f) { f.field.part.pop_back(); });
    refused(k, "its branches do not fit together", [](auto& f) { f.field.branches[1].parts = 0; });
    refused(k, "its branches do not fit together", [](auto& f) { ++f.field.branches[0].children; });
    refused(k, "its branches do not fit together", [](auto& f) { ++f.field.branches[2].channels; });
    refused(k, "its branches do not fit together",
            [](auto& f) { f.field.branches.back().inner ^= 4; });
    refused(k, "its branches are deeper than its depth",
            [](auto& f) { f.field.settings.depth = 2; });
    refused(k, "its branches are deeper than its depth",
            [](auto& f) { f.field.settings.depth = 0; });
    refused(k, "displacements to the next frame do not fit",
            [](auto& f) { f.to_next.emplace_back(); });
    refused(k, "displacements from the frame before do not fit",
            [](auto& f) { f.from_previous.emplace_back(); });
    refused(k, "a value is not finite", [](auto& f) { f.field.phi.back()[26] = NAN; });
    if (k < 2) refused(k, "a value is not finite", [](auto& f) { f.to_next[0][0].z() = INFINITY; });
    if (k > 0)
      refused(k, "a value is not finite", [](auto& f) { f.from_previous.back()[26].x() = NAN; });
  }
  for (const size_t k : {1, 2})
    refused(k, "its time is not later than that before",
            [&](auto& f) { f.time = good.frames[k - 1].time; });
  refused(0, "a value is not finite", [](auto& f) { f.time = -INFINITY; });
  CHECK_THROWS_WITH(require_valid_content(DeformingBody{{}, BetweenFrames::carried}),
                    Equals("deforming body: no frame"));
}

TEST_CASE("a branch that is nobody's child is refused, though the numbers add up") {
  DeformingBody body{{}, BetweenFrames::carried};
  body.frames.resize(1);
  Octree& tree = body.frames[0].field;
  tree.settings = coarse;
  tree.settings.depth = 9;
  tree.branches = {{1, 0, 1, 1}, {2, 1, 0, 1}};
  tree.part.resize(2);
  tree.phi.resize(2);
  CHECK_NOTHROW(require_valid_content(body));
  tree.settings.depth = 1;
  CHECK_THROWS_WITH(require_valid_content(body),
                    Contains("its branches are deeper than its depth"));
  tree.settings.depth = 2;
  CHECK_NOTHROW(require_valid_content(body));
  tree.branches = {{1, 0, 1, 2}, {2, 2, 0, 1}};
  tree.part.resize(3);
  tree.phi.resize(3);
  CHECK_NOTHROW(require_valid_content(body));
  tree.branches = {{1, 0, 1, 2}, {2, 2, 0, 0}};  // without a channel
  tree.part.resize(2);
  tree.phi.resize(2);
  CHECK_THROWS_WITH(require_valid_content(body), Contains("do not fit together"));
  tree.branches = {{1, 0, 0, 1}, {1, 1, 1, 1}};
  CHECK_THROWS_WITH(require_valid_content(body), Contains("do not fit together"));
}

TEST_CASE("keys of what is asked for change with each number of it, and with the method") {
  TriangleSoup soup = ball_soup();
  soup.rest(1, 1) = 0;  // counts as others do
  const GridMethod method{9, 2, 3, MarchingOrder::first};
  std::set<std::string> keys{input_key(soup, method, Repair::refuse),
                             input_key(soup, method, Repair::winding)};
  const auto with = [&](const auto& change) {
    TriangleSoup other = soup;
    GridMethod changed = method;
    change(other, changed);
    keys.insert(input_key(other, changed, Repair::refuse));
  };
  with([](auto& s, auto&) { s.rest(2, 41) += 1e-12; });
  with([](auto& s, auto&) { s.rest(0, 0) += 1e-12; });
  with([](auto& s, auto&) { std::swap(s.triangles[3][0], s.triangles[3][1]); });
  with([](auto&, auto& m) { m.cells = 10; });
  with([](auto&, auto& m) { m.margin = 3; });
  with([](auto&, auto& m) { m.band = 2; });
  with([](auto&, auto& m) { m.order = MarchingOrder::second; });
  ContentKey of_numbers_alone;
  of_numbers_alone.add(soup.triangles);
  of_numbers_alone.add(std::uint64_t(42));
  of_numbers_alone.add(soup.rest.data(), 126);
  for (const int value : {9, 2}) of_numbers_alone.add(value);
  of_numbers_alone.add(3.0);
  for (const int value : {int(MarchingOrder::first), int(Repair::refuse)})
    of_numbers_alone.add(value);
  keys.insert(of_numbers_alone.text());
  CHECK(keys.size() == 10);

  MeshSequence sequence = moving_ball();
  sequence.positions[0](1, 1) = 0;  // counts as others do
  sequence.positions[0](2, 41) = 0.21;
  keys = {input_key(sequence, coarse)};
  const auto changed = [&](const auto& change) {
    MeshSequence other = sequence;
    OctreeSettings settings = coarse;
    change(other, settings);
    keys.insert(input_key(other, settings));
  };
  changed([](auto& s, auto&) { std::swap(s.triangles[3][0], s.triangles[3][1]); });
  changed([](auto& s, auto&) { s.times[2] += 0.1; });
  changed([](auto& s, auto&) { s.positions[0](2, 41) += 1e-12; });
  changed([](auto&, auto& of) { of.corner.z() += 1e-12; });
  changed([](auto&, auto& of) { of.width += 1e-12; });
  changed([](auto&, auto& of) { ++of.depth; });
  changed([](auto&, auto& of) { ++of.surface_depth; });
  changed([](auto&, auto& of) { of.tolerance *= 2; });
  changed([](auto&, auto& of) { of.band *= 2; });
  changed([](auto&, auto& of) { of.beyond *= 2; });
  changed([](auto&, auto& of) { of.reach *= 2; });
  changed([](auto&, auto& of) { of.hanging = HangingNodes::free; });
  ContentKey alone;
  alone.add(sequence.triangles);
  alone.add(sequence.times);
  for (const PerParticle3& x : sequence.positions) {
    alone.add(std::uint64_t(42));
    alone.add(x.data(), 126);
  }
  alone.add(coarse.corner.data(), 3);
  alone.add(coarse.width);
  for (const int value : {coarse.depth, coarse.surface_depth}) alone.add(value);
  for (const double value : {coarse.tolerance, coarse.band, coarse.beyond, coarse.reach})
    alone.add(value);
  alone.add(int(coarse.hanging));
  keys.insert(alone.text());
  CHECK(keys.size() == 14);
}

TEST_CASE("the same numbers in meshes of other sizes are other meshes") {
  TriangleSoup soup = ball_soup();
  soup.triangles.clear();
  const GridMethod method{9, 2, 3, MarchingOrder::first};
  std::set<std::string> keys;
  for (const int count : {0, 3}) {
    soup.rest = PerParticle3::Zero(3, count);
    keys.insert(input_key(soup, method, Repair::refuse));
  }
  MeshSequence one{{}, {}, {PerParticle3::Zero(3, 4)}},
      two{{}, {}, {PerParticle3::Zero(3, 1), PerParticle3::Zero(3, 3)}};
  CHECK(keys.size() == 2);
  CHECK(input_key(one, coarse) != input_key(two, coarse));
}

TEST_CASE("keys of what was made change with each number of it") {
  const Grid grid{{Vector3(0.1, 0.2, 0.3), 0.4, {2, 3, 4}}, std::vector<double>(24, 0.7)};
  std::set<std::string> keys{content_key(grid)};
  const auto with = [&](const auto& change) {
    Grid other = grid;
    change(other);
    keys.insert(content_key(other));
  };
  for (const int axis : {0, 1, 2}) {
    with([&](Grid& g) { g.lattice.origin[axis] += 1e-12; });
    with([&](Grid& g) { ++g.lattice.nodes[size_t(axis)]; });
  }
  with([](Grid& g) { g.lattice.spacing += 1e-12; });
  with([](Grid& g) { g.phi.back() += 1e-12; });
  CHECK(keys.size() == 9);

  const DeformingBody body = make_deforming_body(moving_ball(), coarse, BetweenFrames::carried);
  keys = {content_key(body)};
  const auto changed = [&](const auto& change) {
    DeformingBody other = body;
    change(other.frames[1]);
    keys.insert(content_key(other));
  };
  changed([](auto& f) { f.time += 1e-12; });
  changed([](auto& f) { f.field.settings.reach += 1e-12; });
  changed([](auto& f) { ++f.field.branches.back().children; });
  changed([](auto& f) { ++f.field.branches.back().channels; });
  changed([](auto& f) { ++f.field.branches.back().inner; });
  changed([](auto& f) { ++f.field.branches.back().parts; });
  changed([](auto& f) { ++f.field.part.back(); });
  changed([](auto& f) { f.field.phi.back()[26] += 1e-12; });
  changed([](auto& f) { f.to_next.back()[26].z() += 1e-12; });
  changed([](auto& f) { f.from_previous.back()[26].z() += 1e-12; });
  CHECK(keys.size() == 11);
}

TEST_CASE("a provider that remembers makes each level set once, and copies share it") {
  int grids = 0, bodies = 0;
  const LevelSetProvider counting{
      [&](const TriangleSoup&, const GridMethod& method, Repair) {
        ++grids;
        return std::make_shared<const Grid>(Grid{{{}, double(method.cells), {2, 2, 2}}, {}});
      },
      [&](const MeshSequence& sequence, const OctreeSettings&, BetweenFrames between) {
        ++bodies;
        DeformingBody body{{}, between};
        body.frames.resize(sequence.times.size());
        return std::make_shared<const DeformingBody>(body);
      }};
  const LevelSetProvider memo = memoizing_provider(counting), copy = memo;
  const TriangleSoup soup = ball_soup();
  const GridMethod method{9, 2, 2, MarchingOrder::first}, finer{10, 2, 2, MarchingOrder::first};
  const auto first = memo.make_level_set(soup, method, Repair::refuse);
  CHECK(copy.make_level_set(soup, method, Repair::refuse) == first);
  CHECK(memo.make_level_set(soup, method, Repair::winding) != first);
  CHECK(memo.make_level_set(soup, finer, Repair::refuse)->lattice.spacing == 10);
  CHECK(grids == 3);
  const auto body = memo.make_deforming_body(moving_ball(), coarse, BetweenFrames::carried);
  CHECK(memo.make_deforming_body(moving_ball(), coarse, BetweenFrames::carried) == body);
  CHECK(memo.make_deforming_body(moving_ball(), coarse, BetweenFrames::blended) != body);
  CHECK(bodies == 2);
}

TEST_CASE("one mesh's octree is the only frame of a body at time 0") {
  MeshSequence asked;
  DeformingBody made;
  made.frames.resize(2);
  made.frames[0].field.evaluations = 77;
  LevelSetProvider provider;
  provider.make_deforming_body = [&](const MeshSequence& sequence, const OctreeSettings&,
                                     BetweenFrames between) {
    asked = sequence;
    CHECK(between == BetweenFrames::blended);
    return std::make_shared<const DeformingBody>(made);
  };
  const TriangleMesh ball = make_icosphere(0.3, 1);
  CHECK(make_octree(provider, ball.rest, ball.triangles, coarse)->evaluations == 77);
  CHECK(asked.times == std::vector<double>{0});
  CHECK(asked.triangles == ball.triangles);
  REQUIRE(asked.positions.size() == 1);
  CHECK(asked.positions[0] == ball.rest);
}

TEST_CASE("a provider that computes gives what the functions of its names give") {
  const LevelSetProvider provider = computing_provider();
  const DeformingBody body = make_deforming_body(moving_ball(), coarse, BetweenFrames::carried);
  const auto provided = provider.make_deforming_body(moving_ball(), coarse, BetweenFrames::carried);
  CHECK(content_key(*provided) == content_key(body));
  CHECK(provided->between == BetweenFrames::carried);
}
