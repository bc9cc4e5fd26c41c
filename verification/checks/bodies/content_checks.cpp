// Level sets cached between runs: keys that change with every input, and content from untrusted
// files.
#include "verification/files/deforming_content.h"
#include "verification/files/grid_content.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/ugly_solids.h"

namespace foldproof {

namespace {

/// One change, and the function that makes it.
template <class T>
struct Change {
  std::string what;
  std::function<void(T&)> act;
};

/// Counts the single changes that leave the key as it was: there must be none. The `key` of an
/// unchanged copy must be the same.
template <class T>
Finding keys_are_distinct(const T& original, const std::vector<Change<T>>& changes,
                          const std::function<std::string(const T&)>& key) {
  Table measured{{"case", ""}, {"keys that do not follow", "1"}};
  T copy = original;
  measured.row("nothing changed", key(copy) == key(original) && key(original).size() == 16 ? 0 : 1);
  for (const Change<T>& change : changes) {
    T changed = original;
    change.act(changed);
    measured.row(change.what, key(changed) != key(original) ? 0 : 1);
  }
  return judge_worst(measured, 0, "a key is made of every bit that counts");
}

template <class T>
Finding rejections_of(const T& sound, const std::vector<Change<T>>& breaks) {
  Table measured{{"case", ""}, {"accepted, or refused without the word", "1"}};
  measured.row("sound content is accepted",
               rejection_message([&] { require_valid_content(sound); }).empty() ? 0 : 1);
  for (const Change<T>& breaking : breaks) {
    T broken = sound;
    breaking.act(broken);
    const std::string reason = breaking.what.substr(breaking.what.find(": ") + 2);
    measured.row(breaking.what, !is_rejected([&] { require_valid_content(broken); }, reason));
  }
  return judge_worst(measured, 0, "inconsistent content is refused before anything uses it");
}

double next_after(double value) { return std::nextafter(value, INFINITY); }

// ---- grids

struct GridInput {
  TriangleSoup soup;
  GridMethod method;
  Repair repair;
};

GridInput grid_input() {
  const TriangleMesh ball = make_icosphere(0.31, 1);
  return {{ball.rest, ball.triangles, {}}, {11, 2, 3, MarchingOrder::second}, Repair::refuse};
}

Finding grid_origin_finding() {
  return keys_are_distinct<GridInput>(
      grid_input(),
      {{"a coordinate, by a rounding",
        [](GridInput& of) { of.soup.rest(2, 7) = next_after(of.soup.rest(2, 7)); }},
       {"a triangle turned",
        [](GridInput& of) { std::swap(of.soup.triangles[3][0], of.soup.triangles[3][1]); }},
       {"a triangle less", [](GridInput& of) { of.soup.triangles.pop_back(); }},
       {"cells", [](GridInput& of) { of.method.cells = 12; }},
       {"margin", [](GridInput& of) { of.method.margin = 3; }},
       {"band", [](GridInput& of) { of.method.band = next_after(3); }},
       {"order", [](GridInput& of) { of.method.order = MarchingOrder::first; }},
       {"repair", [](GridInput& of) { of.repair = Repair::winding; }}},
      [](const GridInput& of) { return input_key(of.soup, of.method, of.repair); });
}

Grid small_grid() {
  const GridInput input = grid_input();
  return *make_level_set(input.soup, input.method, input.repair);
}

Finding grid_content_finding() {
  return keys_are_distinct<Grid>(
      small_grid(),
      {{"a value, by a rounding", [](Grid& grid) { grid.phi[17] = next_after(grid.phi[17]); }},
       {"two values exchanged", [](Grid& grid) { std::swap(grid.phi[16], grid.phi[17]); }},
       {"a value less", [](Grid& grid) { grid.phi.pop_back(); }},
       {"origin", [](Grid& grid) { grid.lattice.origin[1] = next_after(grid.lattice.origin[1]); }},
       {"spacing", [](Grid& grid) { grid.lattice.spacing = next_after(grid.lattice.spacing); }},
       {"nodes", [](Grid& grid) { ++grid.lattice.nodes[2]; }}},
      [](const Grid& grid) { return content_key(grid); });
}

Finding grid_sound_finding() {
  return rejections_of<Grid>(
      small_grid(),
      {{"no place: place", [](Grid& grid) { grid.lattice.origin[0] = NAN; }},
       {"infinitely far: place", [](Grid& grid) { grid.lattice.origin[2] = INFINITY; }},
       {"no spacing: spacing", [](Grid& grid) { grid.lattice.spacing = 0; }},
       {"one node along an axis: no cells", [](Grid& grid) { grid.lattice.nodes[1] = 1; }},
       {"a value too many: as many as its nodes", [](Grid& grid) { grid.phi.push_back(1); }},
       {"a value that is none: not finite", [](Grid& grid) { grid.phi.back() = NAN; }},
       {"an infinite value: not finite", [](Grid& grid) { grid.phi[5] = -INFINITY; }}});
}

// ---- deforming bodies

struct BodyInput {
  MeshSequence sequence;
  OctreeSettings settings;
};

BodyInput body_input() {
  const auto bent = [](const Vector3& X, double t) -> Vector3 {
    return X + t * Vector3(0.3 * X.y() * X.y(), X.x(), 0);
  };
  return {deformed_mesh(make_icosphere(0.21, 1), bent, {0, 0.3, 0.7}),
          {Vector3::Constant(-0.5), 1, 4, 3, 1e-3, 0.04, 0.3, 0, HangingNodes::constrained}};
}

Finding body_origin_finding() {
  using Settings = OctreeSettings;
  std::vector<Change<BodyInput>> changes = {
      {"a coordinate of a later frame, by a rounding",
       [](BodyInput& of) {
         of.sequence.positions[2](1, 5) = next_after(of.sequence.positions[2](1, 5));
       }},
      {"a triangle turned",
       [](BodyInput& of) { std::swap(of.sequence.triangles[3][0], of.sequence.triangles[3][2]); }},
      {"a time", [](BodyInput& of) { of.sequence.times[1] = next_after(0.3); }},
      {"a frame less",
       [](BodyInput& of) { of.sequence.times.pop_back(), of.sequence.positions.pop_back(); }}};
  const auto setting = [&](const std::string& name, void (*act)(Settings&)) {
    changes.push_back({name, [act](BodyInput& of) { act(of.settings); }});
  };
  setting("corner", [](Settings& how) { how.corner[2] = next_after(how.corner[2]); });
  setting("width", [](Settings& how) { how.width = next_after(how.width); });
  setting("depth", [](Settings& how) { how.depth = 5; });
  setting("surface depth", [](Settings& how) { how.surface_depth = 2; });
  setting("tolerance", [](Settings& how) { how.tolerance = next_after(how.tolerance); });
  setting("band", [](Settings& how) { how.band = next_after(how.band); });
  setting("beyond", [](Settings& how) { how.beyond = next_after(how.beyond); });
  setting("reach", [](Settings& how) { how.reach = 1e-300; });
  setting("hanging nodes", [](Settings& how) { how.hanging = HangingNodes::free; });
  return keys_are_distinct<BodyInput>(body_input(), changes, [](const BodyInput& of) {
    return input_key(of.sequence, of.settings);
  });
}

DeformingBody small_body() {
  const BodyInput input = body_input();
  return make_deforming_body(input.sequence, input.settings, BetweenFrames::carried);
}

using Body = DeformingBody;

Finding body_content_finding() {
  return keys_are_distinct<Body>(
      small_body(),
      {{"a value, by a rounding",
        [](Body& body) {
          body.frames[1].field.phi[3][7] = next_after(body.frames[1].field.phi[3][7]);
        }},
       {"a displacement ahead",
        [](Body& body) {
          body.frames[0].to_next[2][1][0] = next_after(body.frames[0].to_next[2][1][0]);
        }},
       {"a displacement since",
        [](Body& body) {
          body.frames[2].from_previous[2][1][2] = next_after(body.frames[2].from_previous[2][1][2]);
        }},
       {"a time", [](Body& body) { body.frames[1].time = next_after(body.frames[1].time); }},
       {"a branch", [](Body& body) { body.frames[0].field.branches[1].inner ^= 4; }},
       {"a part", [](Body& body) { body.frames[0].field.part[1] += 1; }},
       {"a setting", [](Body& body) { body.frames[2].field.settings.band *= 2; }},
       {"a frame less", [](Body& body) { body.frames.pop_back(); }}},
      [](const Body& body) { return content_key(body); });
}

Finding body_sound_finding() {
  return rejections_of<Body>(
      small_body(),
      {{"no frames: no frame", [](Body& body) { body.frames.clear(); }},
       {"times that do not rise: time is not later", [](Body& body) { body.frames[1].time = 0; }},
       {"no branches: branches do not fit",
        [](Body& body) { body.frames[1].field.branches.clear(); }},
       {"children out of order: branches do not fit",
        [](Body& body) { ++body.frames[1].field.branches[1].children; }},
       {"channels out of order: branches do not fit",
        [](Body& body) { ++body.frames[1].field.branches[1].channels; }},
       {"a branch without channels: branches do not fit",
        [](Body& body) { body.frames[1].field.branches[2].parts = 0; }},
       {"a value less: branches do not fit",
        [](Body& body) { body.frames[1].field.phi.pop_back(); }},
       {"a part less: branches do not fit",
        [](Body& body) { body.frames[1].field.part.pop_back(); }},
       {"branches below the finest: deeper than its depth",
        [](Body& body) { body.frames[1].field.settings.depth = 2; }},
       {"no way on: displacements to the next frame",
        [](Body& body) { body.frames[1].to_next.clear(); }},
       {"a way on from the last: displacements to the next frame",
        [](Body& body) { body.frames[2].to_next = body.frames[1].to_next; }},
       {"no way back: displacements from the frame before",
        [](Body& body) { body.frames[1].from_previous.pop_back(); }},
       {"a way back from the first: displacements from the frame before",
        [](Body& body) { body.frames[0].from_previous = body.frames[1].from_previous; }},
       {"a time that is none: not finite", [](Body& body) { body.frames[0].time = -INFINITY; }},
       {"a value that is none: not finite",
        [](Body& body) { body.frames[2].field.phi[4][26] = NAN; }},
       {"a displacement that is none: not finite",
        [](Body& body) { body.frames[0].to_next[0][13][1] = INFINITY; }},
       {"a displacement back that is none: not finite",
        [](Body& body) { body.frames[2].from_previous[0][0][2] = NAN; }}});
}

}  // namespace

std::vector<Check> content_checks() {
  const std::string source = "good practice";
  return {
      {"content.grid-recipe-keys-cover-every-number",
       "The key of a grid's input changes with every kind of number in it, bit for bit.",
       "Fowler, Noll and Vo 1991", grid_origin_finding},
      {"content.grid-keys-cover-every-value",
       "The key of a grid follows its values and its lattice, bit for bit.",
       "Fowler, Noll and Vo 1991", grid_content_finding},
      {"content.invalid-grids-are-rejected",
       "A grid that no build made is refused, with the reason.", source, grid_sound_finding},
      {"content.deforming-recipe-keys-cover-every-number",
       "The key of a deforming body's input changes with every kind of number in it, bit for bit.",
       "Fowler, Noll and Vo 1991", body_origin_finding},
      {"content.deforming-body-keys-cover-every-value",
       "The key of a deforming body follows every kind of number in it, bit for bit.",
       "Fowler, Noll and Vo 1991", body_content_finding},
      {"content.invalid-deforming-bodies-are-rejected",
       "A deforming body with inconsistent content is refused, with the reason.", source,
       body_sound_finding},
  };
}

}  // namespace foldproof
