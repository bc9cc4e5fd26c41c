// Bodies of triangles in a case: files, fields, frames and deformations.
#include <catch2/catch.hpp>
#include <filesystem>

#include "reference/scene/field_recipe.h"
#include "verification/specimens/check.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;
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

  std::string refusal(const std::string& keys, const SceneLimits& limits = {}) const {
    const std::string said = rejection_message([&] { object(keys, limits); });
    const std::string file = folder.file("some.toml:");
    return said.starts_with(file) ? said.substr(file.size()) : said;
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

}  // namespace

TEST_CASE("a body is a grid in its own frame, fitted, and drawn in its place", "[scene]") {
  const Bodies bodies;
  const SceneObject part =
      bodies.object(body + "fit = 1\nmove = [10, 20, 30]\ncells = 23\naccuracy = 0.01\n");
  CHECK(recipe<GridRecipe>(part).soup.rest.col(3) == Vector3(0.125, 1.5, 2.5));
  CHECK(recipe<GridRecipe>(part).method.cells == 23);
  CHECK(part.field->accuracy == 0.01);
  CHECK(part.field->where == bodies.folder.file("some.toml:11"));
  CHECK(part.vertices.col(3) == Vector3(10.125, 21.5, 32.5));
  CHECK(std::get<RigidObject>(part.object.body).place.translation == Vector3(10, 20, 30));
  CHECK(recipe<GridRecipe>(bodies.object(body)).method.cells == 64);
}

TEST_CASE("a deforming body has a level set each interval, up to the end that it needs",
          "[scene]") {
  const Bodies bodies;
  const auto times = [&](const std::string& keys, double most = 1000) {
    return bodies.object(body + keys + deform("bend", "9"), {1e7, most}).animation->times;
  };
  // the run ends at 0.7 s: 21 intervals of 1/30 s, of which roundings must not make 22
  CHECK(times("").size() == 22);
  CHECK(times("")[21] == 21 * (1.0 / 30));
  CHECK(times("interval = 0.25\n") == std::vector<double>{0, 0.25, 0.5, 0.75});
  CHECK(times("interval = 0.25\nuntil = 0.5\n", 3) == std::vector<double>{0, 0.25, 0.5});
  CHECK(times("interval = 0.25\nuntil = 0.5000001\n").size() == 4);
  CHECK_THAT(
      bodies.refusal(body + "interval = 0.25\nuntil = 0.5\n" + deform("bend", "9"), {1e7, 2}),
      StartsWith("8: more than 2 level sets"));
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

TEST_CASE("a wrong interval of frames is refused with one place", "[scene]") {
  const Bodies bodies;
  CHECK(bodies.refusal(frames + "interval = 0\n") == "8: 'interval' must be > 0");
}

TEST_CASE("a body's vertices that no triangle uses are ignored, as are those of frames",
          "[scene]") {
  const Bodies bodies;
  bodies.folder.write("spare.obj",
                      "v 9 9 9\nv nan 0 0\nv 0 1 5\nv 1 1 5\nv 0 1 5.5\nv 0.25 3 5\n"
                      "f 3 4 5\nf 3 6 4\nf 4 6 5\nf 5 6 3\nv inf 0 0\n");
  const SceneObject part = bodies.object("mesh = \"spare.obj\"\n"), without = bodies.object(body);
  CHECK(part.vertices == without.vertices);
  CHECK(part.triangles == without.triangles);
  bodies.folder.write("open.obj",
                      "v 9 9 9\nv 0 1 5\nv 1 1 5\nv 0 1 5.5\nv 0.25 3 5\n"
                      "f 2 3 4\nf 2 5 3\nf 3 5 4\n");
  CHECK_THAT(
      bodies.refusal("mesh = \"open.obj\"\n"),
      Contains("open.obj:6: a hole: the edge between vertex 2 (line 2) and vertex 4 (line 4)"));
  for (const char* k : {"0", "1"})
    bodies.folder.write("frames/" + std::string(k) + ".obj",
                        "v 0 0 5\nv 1 0 5\nv 0 1 5\nv 0 0 7\nv nan 0 0\n" + faces);
  CHECK(bodies.object(frames).vertices.cols() == 4);
}

TEST_CASE("frames that are no solids are refused by name, or repaired", "[scene]") {
  const Bodies bodies;
  const std::string open = faces.substr(0, faces.size() - 8), apex = "v 0 0 5\nv 1 0 5\nv 0 1 5\n";
  bodies.folder.write("frames/0.obj", apex + "v 0 0 7\n" + open);
  bodies.folder.write("frames/1.obj", apex + "v 0 0 9\n" + open);
  CHECK_THAT(bodies.refusal(frames), StartsWith("7: frame 0 (0.000000 s): ") &&
                                         Contains("a hole") &&
                                         Contains("; mend it, or set repair = \"winding\""));
  const auto animation = recipe<AnimationRecipe>(bodies.object(frames + "repair = \"winding\"\n"));
  CHECK(animation.animation->inside == Inside::winding);
  CHECK(animation.animation->triangles.size() == 3);
  const auto octree =
      recipe<OctreeRecipe>(bodies.object(body + "field = \"octree\"\nrepair = \"winding\"\n"));
  CHECK(octree.inside == Inside::winding);
}

TEST_CASE("how 'fit' scales is noted, and warned of where meshes of --set come apart", "[scene]") {
  const Bodies bodies;
  const auto scene = [&](const std::string& cloth_keys, const std::string& object_keys,
                         const std::vector<std::string>& overrides) {
    return read_scene_text("[cloth]\ndensity = 0.2\nmesh = \"body.obj\"\n" + cloth_keys +
                               "[[object]]\n" + body + object_keys + "[time]\nend = 0.7\n",
                           bodies.folder.file("some.toml"), overrides);
  };
  const std::string typed = "object.mesh=" + bodies.folder.file("body.obj");
  const Scene shrunk = scene("", "name = \"doll\"\nfit = 0.5\n", {typed});
  REQUIRE(shrunk.notes.size() == 1);
  CHECK(shrunk.notes[0] == "object 'doll': fit = 0.5 m scales the mesh by 0.25");
  REQUIRE(shrunk.warnings.size() == 1);
  CHECK_THAT(shrunk.warnings[0], Contains("some.toml:7: 'fit' scales the mesh of object 'doll' by "
                                          "0.25, that of the cloth by 1; --set object.fit="));
  CHECK(scene("fit = 0.5\n", "", {typed}).warnings.size() == 1);
  CHECK(scene("fit = 0.5\n", "fit = 0.5\n", {typed}).warnings.empty());
  CHECK(scene("", "fit = 0.5\n", {}).warnings.empty());                  // as the case has it
  CHECK(scene("scale = 0.5\n", "fit = 2\n", {typed}).warnings.empty());  // which changes nothing
  CHECK(scene("", "", {typed, "object.fit=0.5"}).warnings.empty());
  const Scene unset = scene("", "fit = 0.5\n", {typed, "object.fit="});
  CHECK(unset.warnings.empty());
  CHECK(unset.notes.empty());
  CHECK(unset.objects[0].vertices.row(1).maxCoeff() == 3);
}

TEST_CASE("bodies and frames whose faces are each apart name the key that sews them", "[scene]") {
  const Bodies bodies;
  const std::string v[] = {"v 0 1 5\n", "v 1 1 5\n", "v 0 1 5.5\n", "v 0.25 3 5\n"};
  std::string soup;
  for (const auto& [a, b, c] : {Triangle{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}})
    soup += v[a] + v[b] + v[c] + "f -3 -2 -1\n";
  bodies.folder.write("body.obj", soup);
  for (const char* file : {"frames/0.obj", "frames/1.obj"}) bodies.folder.write(file, soup);
  for (const std::string& keys : {body, frames}) {
    CHECK_THAT(bodies.refusal(keys), Contains("at 8 places vertices coincide") &&
                                         Contains("seams = 2e-06 of [[object]]"));
    CHECK(bodies.object(keys + "seams = 1e-6\n").vertices.cols() == 4);
  }
}
