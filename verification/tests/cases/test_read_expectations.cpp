// [expect] and [ablation] of a case: exact messages, what is read, and what is added to it.
#include <catch2/catch.hpp>

#include "verification/cases/expectations.h"
#include "verification/cases/quantities.h"
#include "verification/cases/replaced_shape.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/cases/small_sheet.h"

using namespace foldproof;

namespace {

const std::string sheet = small_sheet + R"([time]
end = 0.05
frames_per_second = 100
)";

Case trial(const std::string& more, const std::vector<std::string>& overrides = {}) {
  const ScratchFolder folder;
  return read_case(folder.write("trial.toml", sheet + more), overrides);
}

std::string refusal(const std::string& more) {
  try {
    trial(more);
  } catch (const InputError& error) {
    const std::string message = error.what();
    return message.substr(message.find("trial.toml"));
  }
  return "";
}

/// "key<=bound" of each expectation that a shipped case has.
std::vector<std::string> usual(const Case& of) {
  std::vector<std::string> all;
  for (const Expectation& one : with_usual_expectations(of).expectations) all.push_back(one.key);
  return all;
}

using Keys = std::vector<std::string>;

}  // namespace

TEST_CASE("expect: each refusal names its line, its key and its reason") {
  std::string known;
  for (const Quantity& quantity : quantities())
    known += (known.empty() ? "" : ", ") + std::string(quantity.key);
  CHECK(refusal("[expect.stays_flatt]\nat_most = 0\nwhy = \"w\"\n") ==
        "trial.toml:13: unknown quantity 'stays_flatt' in [expect]; known: " + known);
  CHECK(refusal("[expect.folds_to]\nat_least = 3\nwhy = \"w\"\n") ==
        "trial.toml:13: 'folds_to' cannot be expected: the case has no [bending]");
  CHECK(refusal("[expect.is_carried]\nat_least = 0\nwhy = \"w\"\n") ==
        "trial.toml:14: at_least must be > 0, for nothing falls short of less");
  CHECK(refusal("[expect.is_carried]\nat_least = 1e-9\nwhy = \"w\"\n") == "");
  CHECK(refusal("[expect.stays_flat]\nat_most = -1\nwhy = \"w\"\n") == "");
  CHECK(refusal("[expect.stays_flat]\nat_most = 0\nwhy = \"\"\n") ==
        "trial.toml:15: 'why' is empty; a bound carries its reason in words");
  CHECK(refusal("[expect.stays_flat]\nat_most = 0\nwhy = \"w\"\ndespite_error = \"\"\n") ==
        "trial.toml:16: 'despite_error' is empty; say why the bound is narrower than the error");
  CHECK(refusal("[expect.stays_flat]\nat_most = 0\nwhy = \"w\"\ndespite_error = \"d\"\n") == "");
}

TEST_CASE("expect: parts and coarser meshes of [ablation] are read, and refused with their line") {
  const Case of = trial(
      "[ablation]\ncoarser_mesh = [\"cloth.columns=2\", \"cloth.rows=1.5\"]\nuntil = 0.03\n"
      "stretch = \"it is needed\"\nbending = \"left out\"\n");
  CHECK(of.coarser_mesh == Keys{"cloth.columns=2", "cloth.rows=1.5"});
  CHECK(of.ablated_until == 0.03);
  REQUIRE(of.declared.size() == 2);
  std::vector<std::string> parts;
  for (const DeclaredPart& one : of.declared) parts.push_back(one.part + ": " + one.why);
  std::ranges::sort(parts);
  CHECK(parts == Keys{"bending: left out", "stretch: it is needed"});
  CHECK(trial("[ablation]\ncoarser_mesh = \"cloth.columns=09\"\n").coarser_mesh ==
        Keys{"cloth.columns=09"});
  CHECK(trial("[ablation]\ncoarser_mesh = \"\"\n").coarser_mesh.empty());
  CHECK(trial("[ablation]\nuntil = 0.01\n").coarser_mesh.empty());
  CHECK(trial("").ablated_until == 0);
  CHECK(trial("").declared.empty());
  CHECK(refusal("[ablation]\nuntil = 0\n") == "trial.toml:14: 'until' must be > 0 s");
  CHECK(refusal("[ablation]\nstretch = \"\"\n") ==
        "trial.toml:14: say why this part is there, or left out, in words");
  for (const std::string bad : {"cloth.columns", "cloth.columns=", "cloth.mesh=a.obj", "=", "a=1-"})
    CHECK(refusal("[ablation]\ncoarser_mesh = [\"a=1\", \"" + bad + "\"]\n") ==
          "trial.toml:14: '" + bad + "' is not table.key=number");
}

TEST_CASE("expect: what is added to a shipped case depends on what acts on its cloth") {
  const Keys all = {"runs_to_its_end", "energy_is_accounted_for", "is_reproducible",
                    "never_crosses_itself"},
             without_energy = {"runs_to_its_end", "is_reproducible", "never_crosses_itself"};
  CHECK(usual(trial("")) == all);
  CHECK(usual(trial("[bending]\nstiffness = 1e-3\n")) == all);
  CHECK(usual(trial("[bending]\nstiffness = 1e-3\nweighting = \"current\"\n")) == without_energy);
  CHECK(usual(trial("[strain_limits]\n")) == without_energy);
  CHECK(usual(trial("[[hold]]\nparticles = [1]\n")) == all);
  CHECK(usual(trial("[[hold]]\nparticles = [1]\nvelocity = [0, 0, 1]\n")) == without_energy);
  Case sticky = trial("");
  sticky.scene.sticky.emplace_back();
  CHECK(usual(sticky) == without_energy);
  Case apart = trial("");
  apart.scene.self_collision = SelfCollisionSettings{};
  CHECK(usual(apart) == without_energy);
  CHECK(usual(trial("[[object]]\nshape = \"half_space\"\nmove = [0, 0, -1]\n")) ==
        Keys{"runs_to_its_end", "is_reproducible", "faces_outside", "never_crosses_itself"});
  Case tangled = trial("");
  tangled.expectations = {{"tangle_does_not_grow", 3, "w"}, {"runs_to_its_end", 7, "own"}};
  CHECK(usual(tangled) == Keys{"tangle_does_not_grow", "runs_to_its_end", "energy_is_accounted_for",
                               "is_reproducible"});
  const Case kept = with_usual_expectations(tangled);
  CHECK(kept.expectations[1].bound == 7);
  CHECK(kept.expectations[2].bound == 0.01);
  for (const Expectation& one : with_usual_expectations(trial("")).expectations)
    CHECK(one.bound == (one.key == "energy_is_accounted_for" ? 0.01 : 0));
}

TEST_CASE("expect: a scene is driven where a prescribed particle drifts, swings or turns") {
  const auto driven = [](const Motion& motion) {
    Scene scene;
    scene.prescribed = {{3, Vector3(1, 2, 3), {}}, {4, Vector3(1, 2, 3), motion}};
    return is_driven(scene);
  };
  Motion still, drifts, swings, turns;
  still.frequency = 3, still.phase = 1, still.center = Vector3(1, 2, 3);
  drifts.velocity = Vector3(0, 1e-9, 0);
  swings.amplitude = Vector3(0, 0, 1e-9);
  turns.angular_velocity = Vector3(1e-9, 0, 0);
  CHECK(!driven(still));
  CHECK(driven(drifts));
  CHECK(driven(swings));
  CHECK(driven(turns));
  CHECK(!is_driven(Scene{}));
}

TEST_CASE("expect: a finding is named after the scene as it is, and the key with hyphens") {
  Scene scene;
  scene.name = "a_scene_of_mine";
  CHECK(finding_name(scene, {"keeps_its_place", 1, "w"}) == "case.a_scene_of_mine.keeps-its-place");
}

TEST_CASE("shapes: what replaces them is named, all of it, and the same again is no replacement") {
  const auto reason = [](const std::vector<std::string>& overrides) -> std::string {
    const std::string bound = "[expect.takes_steps]\nat_least = 2\nwhy = \"w\"\n";
    const std::string objects =
        "[[object]]\nshape = \"sphere\"\nradius = 0.1\nmove = [0, 0, -3]\n"
        "[[object]]\nshape = \"sphere\"\nradius = 0.2\nmove = [0, 0, -9]\n";
    return trial(bound + objects, overrides).expectations.at(0).not_asked;
  };
  CHECK(reason({}) == "");
  CHECK(reason({"cloth.columns=5", "object.1.radius=0.3"}) == "");
  CHECK(reason({"cloth.shape=sheet", "object.0.shape=sphere"}) == "");
  CHECK(reason({"object.1.shape=capsule", "object.1.length=0.4"}) ==
        "written for sphere; this run uses capsule");
  CHECK(reason({"object.0.shape=capsule", "object.0.length=0.4", "object.1.shape=capsule",
                "object.1.length=0.4"}) ==
        "written for sphere and sphere; this run uses capsule and capsule");
  CHECK(reason({"object=[{shape = \"half_space\", move = [0, 0, -1]}]"}) ==
        "written for the file's 'object'; this run uses another 'object'");
}

TEST_CASE("shapes: a mesh that is the same file does not hide what else is replaced") {
  const ScratchFolder folder;
  const std::string mesh = folder.write("a.obj", "v 0 0 0\n");
  const CaseKeys keys = parse_case_text(
      "[[object]]\nmesh = \"a.obj\"\nshape = \"sphere\"\nframes = \"b\"\n", folder.file("one.toml"),
      {"object.0.mesh=" + mesh, "object.0.shape=capsule", "object.0.frames=c"});
  CHECK(replaced_shape(keys) == "written for sphere and b; this run uses capsule and c");
}
