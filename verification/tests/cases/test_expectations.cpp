// [expect] and [ablation] of a case: read with their places, added to, judged as they say.
#include <catch2/catch.hpp>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/judge.h"
#include "verification/cases/replaced_shape.h"
#include "verification/files/level_set_folder.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/cases/small_sheet.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

const std::string why = "why = \"w\"\n";

Case trial(const std::string& more, const std::vector<std::string>& overrides = {}) {
  const ScratchFolder folder;
  return read_case(folder.write("trial.toml", small_sheet + more), overrides);
}

std::vector<Record> judge_trial(const Case& input_case) {
  const Scene& scene = input_case.scene;
  const BuiltScene built = build(scene, computing_provider());
  CaseJudge judge(input_case, built.objects, computing_provider());
  const RunResult result =
      simulate(built.system, integrator_named(scene.integrator), built.start, scene.schedule,
               {[&](const State& s) { judge.record(s); },
                [&](const Diagnostics& row) { judge.record(row); }});
  return judge.records(result);
}

/// "key " of each expectation that a shipped case has.
std::string usual(const Case& of) {
  std::string all;
  for (const Expectation& one : with_usual_expectations(of).expectations) all += one.key + " ";
  return all;
}

/// A quantity of a run that ends so.
double at_end(const char* key, const Scene& scene, const PerParticle3& x) {
  RunResult result;
  result.last = start_state(scene);
  result.last.x = x;
  const Repetition repetition(scene, computing_provider());
  return find_quantity(key)->of_run({scene, {}, result, repetition});
}

/// A folder with a case of the mesh square.obj above a sphere: one bound for any cloth, two for
/// this shape; and with other meshes; ball.obj starts in no plane.
struct MeshCase {
  ScratchFolder folder;

  MeshCase() {
    folder.write("mine.toml", R"(cloth = { mesh = "square.obj", density = 0.2 }
stretch = { stiffness = 40 }
time = { end = 0.02 }
object = [{ shape = "sphere", radius = 0.1, move = [0, 0, -0.5] }]
[expect]
never_crosses_itself = { at_most = 0, why = "any" }
takes_steps = { at_least = 1e9, why = "this" }
stays_flat = { at_most = 0, why = "this" }
)");
    const auto write = [&](const char* name, const TriangleMesh& mesh) {
      write_obj(folder.file(name), mesh.rest, mesh.triangles);
    };
    write("square.obj", make_sheet({.width = 0.2, .height = 0.2, .columns = 3, .rows = 3}));
    write("other.obj", make_sheet({.width = 0.2, .height = 0.2, .columns = 4, .rows = 4}));
    write("ball.obj", make_icosphere(0.1, 1));
  }
  Case with(const std::vector<std::string>& overrides) const {
    return read_case(folder.file("mine.toml"), overrides);
  }
  std::string mesh(const std::string& name) const { return "cloth.mesh=" + folder.file(name); }
};

/// "key: reason" of each bound that is not asked.
std::vector<std::string> not_asked(const Case& input_case) {
  std::vector<std::string> found;
  for (const Expectation& expectation : input_case.expectations)
    if (!expectation.not_asked.empty())
      found.push_back(expectation.key + ": " + expectation.not_asked);
  return found;
}

using Keys = std::vector<std::string>;

}  // namespace

TEST_CASE("expect: what is wrong is refused with its line") {
  const std::string flat = "[expect.stays_flat]\nat_most = 0\n";
  const std::vector<std::pair<std::string, std::string>> rows = {
      {"[expect.stays_flatt]\nat_most = 0\n" + why, "trial.toml:5: unknown quantity 'stays_flatt'"},
      {"[expect.leaves_its_plane]\nat_least = 0\n" + why, "trial.toml:6: at_least must be > 0"},
      {"[expect.stays_flat]\nat_least = 0\n" + why, "needs the key 'at_most'"},
      {flat, "trial.toml:5: "},
      {flat + "why = \"\"\n", "trial.toml:7: 'why' is empty"},
      {flat + why + "despite_error = \"\"\n", "trial.toml:8: 'despite_error' is empty"},
      {flat + why + "more = 1\n", "trial.toml:8: unknown key 'more'"},
      {"[expect.folds_to]\nat_least = 3\n" + why, "trial.toml:5: 'folds_to' cannot be expected"},
      {"[ablation]\nuntil = 0\n", "trial.toml:6: 'until' must be > 0"},
      {"[ablation]\nstretch = \"\"\n", "trial.toml:6: say why"},
      {"[ablation]\ncoarser_mesh = [\"a=1\", \"b\"]\n", "trial.toml:6: 'b' is not"},
      {"[ablation]\ncoarser_mesh = \"cloth.columns=\"\n", "is not table.key=number"},
      {"[ablation]\ncoarser_mesh = \"cloth.mesh=a.obj\"\n", "is not table.key=number"}};
  for (const auto& [text, piece] : rows) CHECK_THROWS_WITH(trial(text), Contains(piece));
  for (const std::string& allowed :
       {"[expect.is_carried]\nat_least = 1e-9\n" + why, flat + why + "despite_error = \"d\"\n",
        "[expect.stays_flat]\nat_most = -1\n" + why})
    CHECK_NOTHROW(trial(allowed));
}

TEST_CASE(
    "expect: shipped cases must end, must not cross themselves, and account for their energy "
    "unless they say otherwise") {
  const std::string all =
      "runs_to_its_end energy_is_accounted_for is_reproducible never_crosses_itself ";
  const std::string without_energy = "runs_to_its_end is_reproducible never_crosses_itself ";
  const std::string bending = "[bending]\nstiffness = 1e-3\n", hold = "[[hold]]\nparticles = [0]\n";
  for (const std::string& more : {std::string(), bending, hold}) CHECK(usual(trial(more)) == all);
  for (const std::string& more :
       {bending + "weighting = \"current\"\n", std::string("[strain_limits]\n"),
        hold + "velocity = [0, 0, 1]\n"})
    CHECK(usual(trial(more)) == without_energy);
  Case sticky = trial(""), apart = sticky, own = sticky;
  sticky.scene.sticky.emplace_back();
  CHECK(usual(sticky) == without_energy);
  apart.scene.self_collision = SelfCollisionSettings{};
  CHECK(usual(apart) == without_energy);
  CHECK_THAT(with_usual_expectations(apart).expectations[2].why, Contains("impact zones"));
  CHECK(usual(trial("[[object]]\nshape = \"half_space\"\nmove = [0, 0, -1]\n")) ==
        "runs_to_its_end is_reproducible faces_outside never_crosses_itself ");
  for (const Expectation& one : with_usual_expectations(own).expectations)
    CHECK(one.bound == (one.key == "energy_is_accounted_for" ? 0.01 : 0));
  own.expectations = {{"tangle_does_not_grow", 3, "w"}, {"energy_is_accounted_for", 0.3, "w"}};
  CHECK(usual(own) ==
        "tangle_does_not_grow energy_is_accounted_for runs_to_its_end is_reproducible ");
  CHECK(with_usual_expectations(own).expectations[1].bound == 0.3);
}

TEST_CASE("a case's level sets are made when it is built, each of them once") {
  const std::string statue =
      "[[object]]\nshape = \"statue\"\nheight = 0.1\nsubdivisions = 3\ncells = 9\n";
  const std::string twist = "[[object.deform]]\nkind = \"twist\"\namplitude = 3\nperiod = 0.1\n";
  const Case input_case = trial(statue + statue + statue + "field = \"octree\"\n" + statue + twist +
                                statue + "interpolation = \"blended\"\n" + twist);
  int grids = 0, bodies = 0;
  const LevelSetProvider compute = computing_provider();
  const LevelSetProvider kept = memoizing_provider(
      {[&](const TriangleSoup& soup, const GridMethod& method, Repair repair) {
         ++grids;
         return compute.make_level_set(soup, method, repair);
       },
       [&](const MeshSequence& sequence, const OctreeSettings& settings, BetweenFrames between) {
         ++bodies;
         return compute.make_deforming_body(sequence, settings, between);
       }});
  for (int times = 0; times < 2; ++times) {
    const BuiltScene built = build(input_case.scene, kept);
    REQUIRE(built.objects.size() == 5);
    const auto between = [&](std::size_t k) {
      return std::get<DeformingObject>(built.objects[k].body).body->between;
    };
    CHECK(between(3) == BetweenFrames::carried);
    CHECK(between(4) == BetweenFrames::blended);
    CHECK(grids == 1);   // two objects of one shape share it
    CHECK(bodies == 3);  // the octree, and either way between frames
  }
}

TEST_CASE(
    "expect: what is left of a height and of angles is that of the end, over that of the start") {
  const Scene scene = trial("[bending]\nstiffness = 1\n").scene;
  PerParticle3 x = scene.x;
  CHECK(at_end("keeps_its_height", scene, x) == 1);
  CHECK(at_end("crumples_by", scene, x) == 0);
  x.row(1) *= 0.25;
  CHECK(at_end("collapses_to", scene, x) == Approx(0.25));
  x = scene.x;
  x.row(2) = (x.row(0).array() - 0.1).max(0);  // two hinges on one grid line, by 45 degrees
  const double of_all = double(scene.mesh.hinges.size());
  CHECK(at_end("keeps_most_angles", scene, x) == Approx(45 * std::sqrt(2 / of_all)));
}

TEST_CASE("expect: creases are counted line by line, and lie half a wavelength apart") {
  Scene scene = trial("[bending]\nstiffness = 1\n").scene;
  scene.mesh = make_sheet({.width = 0.24, .height = 0.05, .columns = 24, .rows = 5});
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  PerParticle3 x = scene.mesh.rest;
  CHECK(at_end("forms_creases", scene, x) == 0);
  CHECK(std::isnan(at_end("wrinkles_stay_short", scene, x)));
  for (Eigen::Index i = 0; i < x.cols(); ++i)  // folded by 2 atan(0.3) = 33 degrees every 4 cm
    x(2, i) = 0.3 * std::abs(std::remainder(x(0, i), 0.08));
  CHECK(at_end("forms_creases", scene, x) == 5);
  CHECK(at_end("wrinkles_stay_short", scene, x) == Approx(0.08));
  x.row(2) *= 0.5;  // 17 degrees
  CHECK(at_end("forms_creases", scene, x) == 0);
}

TEST_CASE(
    "expect: a bound that is kept holds, one that is not fails, and a run that stops says "
    "nothing") {
  const std::string flat = "[expect.stays_flat]\nat_most = 0\n" + why;
  const std::string leaves = "[expect.leaves_its_plane]\nat_least = 1e-9\n" + why;
  const std::string thrown = "[start]\nvelocity = [0, 0, 0.5]\n";
  const auto record_of = [](const std::string& more, const Keys& overrides = {}) {
    return judge_trial(trial(more, overrides))[0];
  };
  CHECK(record_of(flat).outcome == Outcome::holds);
  CHECK(record_of(leaves).outcome == Outcome::fails);
  CHECK(record_of(thrown + flat).outcome == Outcome::fails);
  const Record reached = record_of(thrown + leaves);
  CHECK(reached.outcome == Outcome::holds);
  CHECK(reached.finding.verdict.measured == Approx(1e-9 - 0.025));
  CHECK_THAT(reached.finding.note, Contains("reached 0.025 m"));
  const Record stopped = record_of(flat, {"time.max_steps=1", "time.safety=0.01"});
  CHECK(stopped.outcome == Outcome::fails);
  CHECK_THAT(stopped.finding.note, Contains("cap"));
}

TEST_CASE("expect: bounds of a shape are not asked where an override puts another in its place") {
  const MeshCase one;
  const std::string reason =
      ": written for square.obj; this run uses " + one.folder.file("other.obj");
  const Case changed = one.with({one.mesh("other.obj")});
  CHECK(not_asked(changed) == Keys{"stays_flat" + reason, "takes_steps" + reason});
  const std::vector<Record> records = judge_trial(changed), as_written = judge_trial(one.with({}));
  REQUIRE(records.size() == 3);
  CHECK(records[0].outcome == Outcome::holds);
  for (const size_t k : {1, 2}) {
    CHECK(records[k].outcome == Outcome::not_applicable);
    CHECK(": " + records[k].finding.note == reason);
    CHECK(std::isnan(records[k].finding.verdict.measured));
  }
  CHECK(as_written[1].outcome == Outcome::holds);
  CHECK(as_written[2].outcome == Outcome::fails);
  // numbers that an override sets, the same file, and bounds that it states
  CHECK(not_asked(one.with({"stretch.stiffness=50", "cloth.fit=0.3"})).empty());
  CHECK(not_asked(one.with({one.mesh("square.obj")})).empty());
  const Case stated = one.with({one.mesh("other.obj"), "expect.takes_steps.at_least=3"});
  CHECK(not_asked(stated).size() == 1);
  CHECK(stated.expectations[2].bound == 3);
  CHECK(stated.expectations[2].not_asked.empty());
  // bounds that have no meaning for the new shape are not refused, unless the override states them
  const Case ball = one.with({one.mesh("ball.obj")});
  CHECK(not_asked(ball).size() == 2);
  CHECK(judge_trial(ball)[1].outcome == Outcome::not_applicable);
  CHECK_THROWS_WITH(one.with({one.mesh("ball.obj"), "expect.stays_flat.at_most=1"}),
                    Contains("plane of constant z"));
}

TEST_CASE("shapes: a mesh that is the same file does not hide what else is replaced") {
  const ScratchFolder folder;
  const std::string mesh = folder.write("a.obj", "v 0 0 0\n");
  const CaseKeys keys = parse_case_text(
      "[[object]]\nmesh = \"a.obj\"\nshape = \"sphere\"\nframes = \"b\"\n", folder.file("one.toml"),
      {"object.0.mesh=" + mesh, "object.0.shape=capsule", "object.0.frames=c"});
  CHECK(replaced_shape(keys) == "written for sphere and b; this run uses capsule and c");
  const std::string ball = "object = [{ shape = \"sphere\" }]\n", path = folder.file("one.toml");
  CHECK(replaced_shape(parse_case_text(ball, path, {"object.0.shape=sphere"})) == "");
  CHECK_THAT(replaced_shape(parse_case_text(ball, path, {"object=[{ shape = \"box\" }]"})),
             Contains("the file's 'object'"));
}
