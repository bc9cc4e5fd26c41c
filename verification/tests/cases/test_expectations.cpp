// The [expect] table of a case: read with its place, judged as it says.
#include <catch2/catch.hpp>
#include <fstream>

#include "reference/mesh/obj.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/judge.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/cases/small_sheet.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

const std::string sheet = small_sheet + R"([gravity]
[time]
end = 0.05
frames_per_second = 100
)";

Case trial(const std::string& more) {
  const ScratchFolder folder;
  return read_case(folder.write("trial.toml", sheet + more));
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

/// A square of so many triangles a side, in the folder.
std::string written_square(const ScratchFolder& folder, const std::string& name, int side) {
  const TriangleMesh mesh =
      make_sheet({.width = 0.2, .height = 0.2, .columns = side, .rows = side});
  write_obj(folder.file(name), mesh.rest, mesh.triangles);
  return folder.file(name);
}

/// A case of the mesh square.obj above a sphere, in the folder: one bound for any cloth, one
/// for this shape.
std::string written_mesh_case(const ScratchFolder& folder) {
  written_square(folder, "square.obj", 3);
  const std::string path = folder.file("mine.toml");
  std::ofstream(path)
      << "[cloth]\nmesh = \"square.obj\"\ndensity = 0.2\n[stretch]\nstiffness = 40\n"
         "[time]\nend = 0.02\n[[object]]\nshape = \"sphere\"\nradius = 0.1\n"
         "move = [0, 0, -0.5]\n"
         "[expect.never_crosses_itself]\nat_most = 0\nwhy = \"any\"\n"
         "[expect.takes_steps]\nat_least = 1e9\nwhy = \"this\"\n"
         "[expect.stays_flat]\nat_most = 0\nwhy = \"this\"\n";
  return path;
}

/// "key: reason" of each bound that is not asked.
std::vector<std::string> not_asked(const Case& input_case) {
  std::vector<std::string> found;
  for (const Expectation& expectation : input_case.expectations)
    if (!expectation.not_asked.empty())
      found.push_back(expectation.key + ": " + expectation.not_asked);
  return found;
}

}  // namespace

TEST_CASE("expect: bounds and reasons are read, and named after the case") {
  const Case input_case = trial("[expect.stays_flat]\nat_most = 2.5e-7\nwhy = \"words\"\n");
  REQUIRE(input_case.expectations.size() == 1);
  CHECK(input_case.expectations[0].bound == 2.5e-7);
  CHECK(input_case.expectations[0].why == "words");
  CHECK(finding_name(input_case.scene, input_case.expectations[0]) == "case.trial.stays-flat");
}

TEST_CASE("expect: what is wrong is refused with its line") {
  CHECK_THROWS_WITH(
      trial("[expect.stays_flatt]\nat_most = 0\nwhy = \"w\"\n"),
      Contains("trial.toml:14") && Contains("stays_flatt") && Contains("stays_flat,"));
  CHECK_THROWS_WITH(trial("[expect.leaves_its_plane]\nat_least = 0\nwhy = \"w\"\n"),
                    Contains("at_least must be > 0"));
  CHECK_THROWS_WITH(trial("[expect.stays_flat]\nat_least = 0\nwhy = \"w\"\n"),
                    Contains("needs the key 'at_most'"));
  CHECK_THROWS_WITH(trial("[expect.stays_flat]\nat_most = 0\n"),
                    Contains("trial.toml:14") && Contains("'why'"));
  CHECK_THROWS_WITH(trial("[expect.stays_flat]\nat_most = 0\nwhy = \"\"\n"),
                    Contains("trial.toml:16"));
  CHECK_THROWS_WITH(trial("[expect.stays_flat]\nat_most = 0\nwhy = \"w\"\nmore = 1\n"),
                    Contains("trial.toml:17") && Contains("'more'"));
  CHECK_THROWS_WITH(trial("[expect.folds_to]\nat_least = 3\nwhy = \"w\"\n"),
                    Contains("trial.toml:14") && Contains("no [bending]"));
}

TEST_CASE(
    "expect: shipped cases must end, must not cross themselves, and account for their energy "
    "unless they say otherwise") {
  const Case usual = with_usual_expectations(trial(""));
  REQUIRE(usual.expectations.size() == 4);
  CHECK(usual.expectations[0].key == "runs_to_its_end");
  CHECK(usual.expectations[1].key == "energy_is_accounted_for");
  CHECK(usual.expectations[2].key == "is_reproducible");
  CHECK(usual.expectations[2].bound == 0);
  CHECK(usual.expectations[3].key == "never_crosses_itself");
  CHECK(usual.expectations[3].bound == 0);
  const Case own = with_usual_expectations(
      trial("[expect.energy_is_accounted_for]\nat_most = 0.3\nwhy = \"w\"\n"));
  REQUIRE(own.expectations.size() == 4);
  CHECK(own.expectations[0].bound == 0.3);
  const Case driven =
      with_usual_expectations(trial("[[hold]]\nparticles = [0]\nvelocity = [0, 0, 1]\n"));
  CHECK(driven.expectations.size() == 3);
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
    const std::span<const Object> objects = built.objects;
    REQUIRE(objects.size() == 5);
    CHECK(std::get<DeformingObject>(objects[3].body).body->between == BetweenFrames::carried);
    CHECK(std::get<DeformingObject>(objects[4].body).body->between == BetweenFrames::blended);
    CHECK(grids == 1);   // two objects of one shape share it
    CHECK(bodies == 3);  // the octree, and either way between frames
  }
}

TEST_CASE(
    "expect: what crosses is counted, and a case that keeps cloth from itself gives its own "
    "reason") {
  Case input_case = trial("[expect.never_crosses_itself]\nat_most = 1\nwhy = \"w\"\n");
  CHECK(find_quantity("never_crosses_itself")
            ->of_frame(input_case.scene, start_state(input_case.scene)) == 0);
  State folded = start_state(input_case.scene);
  // one half on the other
  folded.x.row(0) = (folded.x.row(0).array() - folded.x.row(0).mean()).abs();
  CHECK(find_quantity("never_crosses_itself")->of_frame(input_case.scene, folded) > 10);
  folded.x(0, 0) = NAN;
  CHECK(std::isnan(find_quantity("never_crosses_itself")->of_frame(input_case.scene, folded)));
  input_case.scene.self_collision = SelfCollisionSettings{0.01, 1, 0, 8, true};
  input_case.expectations.clear();
  const Case usual = with_usual_expectations(input_case);
  REQUIRE(usual.expectations.size() == 3);
  CHECK(usual.expectations[2].key == "never_crosses_itself");
  CHECK_THAT(usual.expectations[2].why, Contains("impact zones"));
  input_case.expectations = {{"tangle_does_not_grow", 29, "it starts crossed"}};
  CHECK(with_usual_expectations(input_case).expectations.size() == 3);
}

TEST_CASE(
    "expect: what is left of a height and of angles is that of the end, over that of the start") {
  const Case input_case = trial("[bending]\nstiffness = 1\n");
  RunResult result;
  result.last = start_state(input_case.scene);
  const DiagnosticsSummary summary;
  const Repetition repetition(input_case.scene, computing_provider());
  const RunView run{input_case.scene, summary, result, repetition};
  CHECK(find_quantity("keeps_its_height")->of_run(run) == 1);
  CHECK(find_quantity("crumples_by")->of_run(run) == 0);
  PerParticle3& x = result.last.x;
  x.row(1) *= 0.25;
  CHECK(find_quantity("collapses_to")->of_run(run) == Approx(0.25));
  x = input_case.scene.x;
  int turned = 0;  // the hinges on one grid line, by 45 degrees
  for (const Hinge& hinge : input_case.scene.mesh.hinges)
    turned += std::abs(x(0, hinge.particles[2]) - 0.1) < 1e-9 &&
              std::abs(x(0, hinge.particles[3]) - 0.1) < 1e-9;
  REQUIRE(turned == 2);
  x.row(2) = (x.row(0).array() - 0.1).max(0);
  const double of_all = double(input_case.scene.mesh.hinges.size());
  CHECK(find_quantity("keeps_most_angles")->of_run(run) == Approx(45 * std::sqrt(turned / of_all)));
}

TEST_CASE("expect: creases are counted line by line, and lie half a wavelength apart") {
  Case input_case = trial("[bending]\nstiffness = 1\n");
  Scene& scene = input_case.scene;
  scene.mesh = make_sheet({.width = 0.24, .height = 0.05, .columns = 24, .rows = 5});
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  RunResult result;
  result.last = State{0, scene.mesh.rest, PerParticle3::Zero(3, scene.mesh.particles())};
  const DiagnosticsSummary summary;
  const Repetition repetition(scene, computing_provider());
  const RunView run{scene, summary, result, repetition};
  const Quantity &creases = *find_quantity("forms_creases"),
                 &wavelength = *find_quantity("wrinkles_stay_short");
  CHECK(creases.of_run(run) == 0);
  CHECK(std::isnan(wavelength.of_run(run)));
  PerParticle3& x = result.last.x;
  // a zigzag, folded by 2 atan(0.3) = 33 degrees every 4 cm
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const double along = std::abs(std::remainder(scene.mesh.rest(0, i), 0.08));
    x(2, i) = 0.3 * along;
  }
  CHECK(creases.of_run(run) == 5);
  CHECK(wavelength.of_run(run) == Approx(0.08));
  x.row(2) *= 0.5;  // 17 degrees
  CHECK(creases.of_run(run) == 0);
}

TEST_CASE(
    "expect: a bound that is kept holds, one that is not fails, and a run that stops says "
    "nothing") {
  const std::string flat = "[expect.stays_flat]\nat_most = 0\nwhy = \"w\"\n";
  const std::string leaves = "[expect.leaves_its_plane]\nat_least = 1e-9\nwhy = \"w\"\n";
  CHECK(judge_trial(trial(flat))[0].outcome == Outcome::holds);
  CHECK(judge_trial(trial(leaves))[0].outcome == Outcome::fails);
  const std::string thrown = "[start]\nvelocity = [0, 0, 0.5]\n";
  CHECK(judge_trial(trial(thrown + flat))[0].outcome == Outcome::fails);
  const Record reached = judge_trial(trial(thrown + leaves))[0];
  CHECK(reached.outcome == Outcome::holds);
  CHECK(reached.finding.verdict.measured == Approx(1e-9 - 0.025));
  CHECK_THAT(reached.finding.note, Contains("reached 0.025 m"));
  const std::string capped = "max_steps = 1\nsafety = 0.01\n";
  const Record stopped = judge_trial(trial(capped + flat))[0];
  CHECK(stopped.outcome == Outcome::fails);
  CHECK_THAT(stopped.finding.note, Contains("cap"));
}

TEST_CASE("expect: bounds of a shape are not asked where an override puts another in its place") {
  const ScratchFolder folder;
  const std::string path = written_mesh_case(folder),
                    other = written_square(folder, "other.obj", 4);
  const std::string reason = ": written for square.obj; this run uses " + other;
  const Case changed = read_case(path, {"cloth.mesh=" + other});
  CHECK(not_asked(changed) ==
        std::vector<std::string>{"stays_flat" + reason, "takes_steps" + reason});
  const std::vector<Record> records = judge_trial(changed);
  REQUIRE(records.size() == 3);
  CHECK(records[0].outcome == Outcome::holds);
  for (const size_t k : {1, 2}) {
    CHECK(records[k].outcome == Outcome::not_applicable);
    CHECK(": " + records[k].finding.note == reason);
    CHECK(std::isnan(records[k].finding.verdict.measured));
  }
  const std::vector<Record> as_written = judge_trial(read_case(path));
  CHECK(as_written[1].outcome == Outcome::holds);
  CHECK(as_written[2].outcome == Outcome::fails);
}

TEST_CASE(
    "expect: numbers that an override sets, and bounds that it states, are asked all the same") {
  const ScratchFolder folder;
  const std::string path = written_mesh_case(folder),
                    other = written_square(folder, "other.obj", 4);
  CHECK(not_asked(read_case(path, {"stretch.stiffness=50", "cloth.fit=0.3"})).empty());
  // the same file
  CHECK(not_asked(read_case(path, {"cloth.mesh=" + folder.file("square.obj")})).empty());
  const Case stated = read_case(path, {"cloth.mesh=" + other, "expect.takes_steps.at_least=3"});
  REQUIRE(not_asked(stated).size() == 1);
  CHECK(stated.expectations[2].bound == 3);
  CHECK(stated.expectations[2].not_asked.empty());
}

TEST_CASE(
    "expect: objects and tables that are replaced are named, and bounds without a meaning not "
    "refused") {
  const ScratchFolder folder;
  const std::string path = written_mesh_case(folder);
  const std::vector<std::string> box = {
      R"(object=[{shape = "box", size = [0.1, 0.1, 0.1], move = [0, 0, -1]}])"};
  REQUIRE(not_asked(read_case(path, box)).size() == 2);
  CHECK_THAT(not_asked(read_case(path, box))[0], Contains("written for the file's 'object'"));
  const std::vector<std::string> statue = {"object.shape=statue", "object.height=0.1",
                                           "object.subdivisions=3"};
  CHECK_THROWS_WITH(read_case(path, statue), Contains("unknown key 'radius'"));
  const TriangleMesh upright = make_icosphere(0.1, 1);  // starts in no plane
  write_obj(folder.file("ball.obj"), upright.rest, upright.triangles);
  const Case ball = read_case(path, {"cloth.mesh=" + folder.file("ball.obj")});
  CHECK(not_asked(ball).size() == 2);
  CHECK(judge_trial(ball)[1].outcome == Outcome::not_applicable);
  CHECK_THROWS_WITH(
      read_case(path, {"cloth.mesh=" + folder.file("ball.obj"), "expect.stays_flat.at_most=1"}),
      Contains("plane of constant z"));
}
