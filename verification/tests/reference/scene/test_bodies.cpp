// Bodies of triangles in a case: files, fields, frames and deformations.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <filesystem>

#include "reference/bodies/body_deformation.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/field_recipe.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
/// 2 m high, 1 m wide, 0.5 m deep.
const std::string tetrahedron =
    "v 0 1 5\nv 1 1 5\nv 0 1 5.5\nv 0.25 3 5\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";

/// Cases of bodies beside which a tetrahedron lies, and a folder of frames.
struct Bodies {
  Bodies() {
    folder.write("body.obj", tetrahedron);
    std::filesystem::create_directory(folder.file("frames"));
    folder.write("frames/0.obj", "v 0 0 5\nv 1 0 5\nv 0 1 5\nv 0 0 7\n" + faces);
    folder.write("frames/1.obj", "v 0 0 5\nv 1 0 5\nv 0 1 5\nv 0 0 9\n" + faces);
  }

  /// An object whose keys begin on line 7; the run ends at 0.7 s.
  SceneObject object(const std::string& keys, const SceneLimits& limits = {},
                     const std::vector<std::string>& overrides = {}) const {
    return read_scene_text(hinge_cloth + "[[object]]\n" + keys + "[time]\nend = 0.7\n",
                           folder.file("some.toml"), overrides, limits)
        .objects.at(0);
  }

  std::string refusal(const std::string& keys, const SceneLimits& limits = {},
                      const std::vector<std::string>& overrides = {}) const {
    try {
      object(keys, limits, overrides);
    } catch (const InputError& error) {
      const std::string said = error.what(), file = folder.file("some.toml:");
      return said.starts_with(file) ? said.substr(file.size()) : "elsewhere: " + said;
    }
    return "none";
  }

  ScratchFolder folder;
};

const std::string body = "mesh = \"body.obj\"\n";
const std::string frames = "frames = \"frames\"\n";

template <class Recipe>
Recipe recipe(const SceneObject& part) {
  return std::get<Recipe>(part.field->of);
}

std::string deform(const std::string& kind, const std::string& amplitude) {
  return "[[object.deform]]\nkind = \"" + kind + "\"\namplitude = " + amplitude +
         "\nperiod = 0.8\n";
}

void check_settings(const OctreeSettings& s, const Bounds& bounds, double cell, double tolerance) {
  const OctreeSettings expected = octree_about(bounds, cell, tolerance);
  CHECK(s.width == Approx(expected.width).epsilon(1e-14));
  CHECK(s.depth == expected.depth);
  CHECK((s.corner - expected.corner).norm() < 1e-13);
  CHECK(s.tolerance == Approx(tolerance).epsilon(1e-14));
}

}  // namespace

TEST_CASE("a body of triangles is a grid of 64 cells unless its keys say otherwise", "[scene]") {
  const Bodies bodies;
  const SceneObject part = bodies.object(body);
  CHECK(part.shape == "mesh");
  CHECK(part.object.name == "mesh 1");
  CHECK(part.vertices.cols() == 4);
  CHECK(part.triangles.size() == 4);
  CHECK(part.field->where == bodies.folder.file("some.toml:6"));
  CHECK(part.field->accuracy == 0);
  CHECK(recipe<GridRecipe>(part).method.cells == 64);
  CHECK(recipe<GridRecipe>(part).method.margin == 4);
  CHECK(recipe<GridRecipe>(part).method.band == 3);
  CHECK(recipe<GridRecipe>(part).method.order == MarchingOrder::second);
  CHECK(recipe<GridRecipe>(part).repair == Repair::refuse);
  CHECK(recipe<GridRecipe>(part).soup.rest == part.vertices);
  CHECK(std::holds_alternative<GridSolid>(std::get<RigidObject>(part.object.body).solid));
  const SceneObject finer = bodies.object(body + "cells = 23\nfield = \"grid\"\n");
  CHECK(recipe<GridRecipe>(finer).method.cells == 23);
  CHECK(finer.field->where == bodies.folder.file("some.toml:8"));
  const SceneObject accurate = bodies.object(body + "cells = 23\naccuracy = 0.01\n");
  CHECK(accurate.field->accuracy == 0.01);
  CHECK(accurate.field->where == bodies.folder.file("some.toml:9"));
  CHECK(bodies.refusal(body + "accuracy = 0\n") == "8: 'accuracy' must be > 0");
  CHECK_THAT(bodies.refusal(body + "cells = 0\n"), StartsWith("8: 'cells' must lie in 1 .."));
}

TEST_CASE("a body is in its own frame, fitted, and drawn in its place", "[scene]") {
  const Bodies bodies;
  const SceneObject part = bodies.object(body + "fit = 1\nmove = [10, 20, 30]\n");
  CHECK(recipe<GridRecipe>(part).soup.rest.col(3) == Vector3(0.125, 1.5, 2.5));
  CHECK(part.vertices.col(3) == Vector3(10.125, 21.5, 32.5));
  CHECK(std::get<RigidObject>(part.object.body).place.translation == Vector3(10, 20, 30));
}

TEST_CASE("an octree's finest cells and tolerance follow from its keys", "[scene]") {
  const Bodies bodies;
  const Bounds bounds(Vector3(0, 1, 5), Vector3(1, 3, 5.5));
  const std::string octree = body + "field = \"octree\"\n";
  const SceneObject plain = bodies.object(octree);
  check_settings(recipe<OctreeRecipe>(plain).settings, bounds, 2.0 / 64, 0.2 / 64);
  CHECK(recipe<OctreeRecipe>(plain).x == plain.vertices);
  CHECK(recipe<OctreeRecipe>(plain).triangles == plain.triangles);
  CHECK(std::holds_alternative<OctreeSolid>(std::get<RigidObject>(plain.object.body).solid));
  const SceneObject told = bodies.object(octree + "cells = 50\ntolerance = 0.003\n");
  check_settings(recipe<OctreeRecipe>(told).settings, bounds, 0.04, 0.003);
  CHECK(told.field->where == bodies.folder.file("some.toml:9"));
  const SceneObject accurate = bodies.object(octree + "accuracy = 0.01\n");
  CHECK(accurate.field->accuracy == 0.01);
  CHECK(accurate.field->where == bodies.folder.file("some.toml:9"));
  CHECK(bodies.refusal(octree + "tolerance = 0\n") == "9: 'tolerance' must be > 0");
}

TEST_CASE("an exact body keeps its triangles, and knows the keys of the other fields", "[scene]") {
  const Bodies bodies;
  const SceneObject exact = bodies.object(body + "field = \"exact\"\ncells = 9\n");
  CHECK(recipe<ExactRecipe>(exact).x == exact.vertices);
  CHECK(recipe<ExactRecipe>(exact).triangles == exact.triangles);
  CHECK(exact.field->accuracy == 0);
  CHECK(std::holds_alternative<MeshSolid>(std::get<RigidObject>(exact.object.body).solid));
  CHECK_THAT(bodies.refusal(body + "field = \"exact\"\ncells = 0\n"),
             StartsWith("9: 'cells' must lie in 1 .."));
  CHECK(bodies.refusal(body + "field = \"cloud\"\n") ==
        "8: unknown field 'cloud'; known: grid, octree, exact");
}

TEST_CASE("an open body is refused, and repaired by grids only", "[scene]") {
  const Bodies bodies;
  bodies.folder.write("body.obj", "v 0 1 5\nv 1 1 5\nv 0 1 5.5\nv 0.25 3 5\nf 1 2 3\nf 1 4 2\n");
  for (const char* field : {"grid", "octree", "exact"})
    CHECK_THAT(bodies.refusal(body + "field = \"" + field + "\"\n"),
               StartsWith("elsewhere: " + bodies.folder.file("body.obj")));
  CHECK_THAT(bodies.refusal(body + "repair = \"refuse\"\n"), StartsWith("elsewhere: "));
  const SceneObject repaired = bodies.object(body + "repair = \"winding\"\n");
  CHECK(recipe<GridRecipe>(repaired).repair == Repair::winding);
  CHECK(repaired.triangles.size() == 2);
  const std::string needs =
      "9: 'repair' needs field = \"grid\": over holes the distance is marched from node to node";
  CHECK(bodies.refusal(body + "field = \"octree\"\nrepair = \"winding\"\n") == needs);
  CHECK(bodies.refusal(body + "field = \"exact\"\nrepair = \"winding\"\n") == needs);
  CHECK(bodies.refusal(body + "repair = \"mend\"\n") ==
        "8: unknown repair 'mend'; known: refuse, winding");
  CHECK(bodies.refusal(body + "repair = \"winding\"\naccuracy = 0.01\n") ==
        "9: a mesh that is repaired has no exact distance to compare with");
  CHECK(bodies.refusal(body + "field = \"exact\"\naccuracy = 0.01\n") ==
        "9: field = \"exact\" has no error to choose");
}

TEST_CASE("a statue is a body of 5120 triangles unless its keys say otherwise", "[scene]") {
  const Bodies bodies;
  const std::string statue = "shape = \"statue\"\nheight = 0.5\n";
  const SceneObject coarse = bodies.object(statue + "subdivisions = 3\n", {1280, 3});
  CHECK(coarse.triangles.size() == 1280);
  CHECK(coarse.vertices.row(1).minCoeff() == Approx(0).margin(1e-12));
  CHECK(coarse.vertices.row(1).maxCoeff() == Approx(0.5).epsilon(1e-12));
  CHECK(coarse.shape == "statue");
  CHECK(bodies.refusal(statue + "subdivisions = 3\n", {1279, 3}) ==
        "9: 'subdivisions' asks for 1280 triangles; 1279 at most are made");
  CHECK(bodies.refusal(statue, {5119, 3}) ==
        "6: 'subdivisions' asks for 5120 triangles; 5119 at most are made");
  CHECK(bodies.refusal(statue + "subdivisions = 1000000000\n") ==
        "9: 'subdivisions' asks for inf triangles; 1e+07 at most are made");
  CHECK_THAT(bodies.refusal(statue + "subdivisions = 2\n"), StartsWith("7: "));
  CHECK(bodies.refusal("shape = \"statue\"\nheight = 0\n") == "8: 'height' must be > 0");
  CHECK(bodies.refusal("shape = \"sphere\"\nradius = 1\n" + deform("bend", "9")) ==
        "7: a body that deforms needs a mesh: shape = \"statue\", 'mesh' or 'frames'");
}

TEST_CASE("a body is deformed in its place, angles in degrees", "[scene]") {
  const Bodies bodies;
  const auto check = [&](const std::string& tables, const std::vector<BodyDeformation>& parts) {
    const SceneObject bent =
        bodies.object(body + "interval = 0.1\nmove = [10, 20, 30]\nfit = 1\n" + tables);
    const PerParticle3 placed =
        (0.5 * bodies.object(body).vertices).colwise() + Vector3(10, 20, 30);
    const Deformation expected = deformation_of(parts, bounds_of(placed));
    REQUIRE(bent.animation->times.size() == 8);
    for (size_t k = 0; k < 8; ++k)
      for (int i = 0; i < 4; ++i)
        CHECK((bent.animation->positions[k].col(i) - expected(placed.col(i), 0.1 * double(k)))
                  .norm() < 1e-13);
    CHECK(bent.vertices == bent.animation->positions[0]);
    CHECK(bent.shape == "mesh");
  };
  check(deform("bend", "18"), {{DeformationKind::bend, pi / 10, 0.8}});
  check(deform("twist", "-18"), {{DeformationKind::twist, -pi / 10, 0.8}});
  check(deform("breathe", "0.3"), {{DeformationKind::breathe, 0.3, 0.8}});
  check(deform("twist", "9") + deform("bend", "18"),
        {{DeformationKind::twist, pi / 20, 0.8}, {DeformationKind::bend, pi / 10, 0.8}});
  CHECK(bodies.refusal(body + "[[object.deform]]\nkind = \"melt\"\n") ==
        "9: unknown kind 'melt'; known: bend, twist, breathe");
  CHECK(bodies.refusal(body + "[[object.deform]]\namplitude = 9\nperiod = 0\n") ==
        "10: 'period' must be > 0");
}

TEST_CASE("a deforming body has a level set each interval, up to the end that it needs",
          "[scene]") {
  const Bodies bodies;
  const auto times = [&](const std::string& keys, double most = 1000) {
    return bodies.object(body + keys + deform("bend", "9"), {1e7, most}).animation->times;
  };
  // the run ends at 0.7 s: 21 intervals of 1/30 s, of which roundings must not make 22
  const std::vector<double> plain = times("");
  REQUIRE(plain.size() == 22);
  CHECK(plain[1] == 1.0 / 30);
  CHECK(plain[21] == 21 * (1.0 / 30));
  CHECK(times("interval = 0.25\n") == std::vector<double>{0, 0.25, 0.5, 0.75});
  CHECK(times("interval = 0.25\nuntil = 0.5\n") == std::vector<double>{0, 0.25, 0.5});
  CHECK(times("interval = 0.25\nuntil = 0.5000001\n").size() == 4);
  CHECK(times("interval = 0.25\nuntil = 0.51\n") == std::vector<double>{0, 0.25, 0.5, 0.75});
  CHECK(times("interval = 0.25\nuntil = 0.5\n", 3).size() == 3);
  CHECK(bodies.refusal(body + "interval = 0.25\nuntil = 0.5\n" + deform("bend", "9"), {1e7, 2}) ==
        "8: more than 2 level sets; a longer 'interval' or an earlier 'until' gives fewer");
  CHECK(bodies.refusal(body + "interval = 0\n" + deform("bend", "9")) ==
        "8: 'interval' must be > 0");
  CHECK(bodies.refusal(body + "until = 0\n" + deform("bend", "9")) == "8: 'until' must be > 0");
}

TEST_CASE("frames are read from a folder, an interval apart, fitted and put in place", "[scene]") {
  const Bodies bodies;
  const SceneObject plain = bodies.object(frames);
  CHECK(plain.shape == "animation");
  CHECK(plain.object.name == "animation 1");
  CHECK(plain.animation->times == std::vector<double>{0, 1.0 / 30});
  CHECK(plain.animation->positions[1].col(3) == Vector3(0, 0, 9));
  CHECK(std::get<DeformingObject>(plain.object.body).body == nullptr);
  CHECK(plain.vertices == plain.animation->positions[0]);
  CHECK(plain.triangles == plain.animation->triangles);
  // the first frame is 2 m high
  const SceneObject fitted = bodies.object(frames +
                                           "fit = 4\ninterval = 0.25\nmove = [10, 20, 30]\n"
                                           "turn = { axis = [0, 0, 1], angle = 90 }\n");
  CHECK(fitted.animation->times == std::vector<double>{0, 0.25});
  CHECK((fitted.animation->positions[1].col(3) - Vector3(10, 20, 48)).norm() < 1e-14);
  CHECK((fitted.animation->positions[0].col(1) - Vector3(10, 22, 40)).norm() < 1e-14);
  CHECK(bodies.refusal(frames + "interval = 0\n") == "8: 'interval' must be > 0");
  CHECK(bodies.refusal(frames, {1e7, 2}) == "none");
  CHECK_THAT(bodies.refusal(frames, {1e7, 1}), StartsWith("7: "));
  CHECK_THAT(bodies.refusal("frames = \"nothing\"\n"), StartsWith("7: ") && Contains("nothing"));
  CHECK(bodies.refusal(frames + deform("bend", "9")) ==
        "8: 'frames' are an animation; they do not go with [[object.deform]]");
}

TEST_CASE("a deforming body's octree covers all frames, its cells go by the first", "[scene]") {
  const Bodies bodies;
  const Bounds all(Vector3(0, 0, 5), Vector3(1, 1, 9));
  const SceneObject plain = bodies.object(frames);
  check_settings(recipe<AnimationRecipe>(plain).settings, all, 2.0 / 64, 0.2 / 64);
  CHECK(recipe<AnimationRecipe>(plain).animation == plain.animation);
  CHECK(recipe<AnimationRecipe>(plain).between == BetweenFrames::carried);
  CHECK(plain.field->where == bodies.folder.file("some.toml:6"));
  const SceneObject told = bodies.object(
      frames + "cells = 40\ntolerance = 0.03\ninterpolation = \"blended\"\nfield = \"octree\"\n");
  check_settings(recipe<AnimationRecipe>(told).settings, all, 0.05, 0.03);
  CHECK(recipe<AnimationRecipe>(told).between == BetweenFrames::blended);
  CHECK(told.field->where == bodies.folder.file("some.toml:8"));
  CHECK(recipe<AnimationRecipe>(bodies.object(frames + "interpolation = \"carried\"\n")).between ==
        BetweenFrames::carried);
  CHECK(bodies.refusal(frames + "field = \"grid\"\n") == "8: unknown field 'grid'; known: octree");
  CHECK(bodies.refusal(frames + "interpolation = \"none\"\n") ==
        "8: unknown interpolation 'none'; known: carried, blended");
  CHECK(bodies.refusal(frames + "cells = 500000\n") == "none");
  CHECK(bodies.refusal(frames + "cells = 1000000000\n") ==
        "8: 'cells' must be below 2^20 for an octree");
}

TEST_CASE("a frame that is not closed is named with its time and another remedy", "[scene]") {
  const Bodies bodies;
  bodies.folder.write("frames/1.obj", "v 0 0 5\nv 1 0 5\nv 0 1 5\nv 0 0 -9\n" + faces);
  const std::string inverted = bodies.refusal(frames + "interval = 0.25\n");
  CHECK_THAT(inverted, StartsWith("7: frame 1 (0.250000 s): "));
  CHECK_THAT(inverted, EndsWith("; mend it, or give a smaller amplitude"));
  CHECK_THAT(inverted, !Contains("repair"));
  // half way up, widths become -2 of what they were
  bodies.folder.write(
      "body.obj", "v 0 1 5\nv 1 2 5\nv 0 2 5.5\nv 0.25 3 5\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
  CHECK_THAT(bodies.refusal(body + "[[object.deform]]\nkind = \"breathe\"\namplitude = -3\n"
                                   "period = 0.8\n"),
             StartsWith("8: frame ") && EndsWith("; mend it, or give a smaller amplitude"));
}

TEST_CASE("links in a folder of frames stay within the case's, unless it is of --set", "[scene]") {
  const Bodies bodies;
  const ScratchFolder elsewhere;
  const std::string frame =
      elsewhere.write("2.obj", "v 0 0 5\nv 1 0 5\nv 0 1 5\nv 0 0 8\n" + faces);
  std::filesystem::create_symlink(frame, bodies.folder.file("frames/2.obj"));
  CHECK_THAT(bodies.refusal(frames), StartsWith("7: ") && Contains("lies outside"));
  const std::string typed = bodies.folder.file("frames");
  CHECK(bodies.object(frames, {}, {"object.frames='" + typed + "'"}).animation->times.size() == 3);
}
