// Evidence of judged frames, number by number, and which expectations frames can show.
#include "verification/cases/judged_frames.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
using Catch::Matchers::StartsWith;

namespace {

const std::string everything =
    "[gravity]\nacceleration = [1.7, -8.9, 2.3]\n[stretch]\nstiffness = 31\n"
    "[bending]\nstiffness = 2e-3\n"
    "[[object]]\nshape = \"sphere\"\nradius = 0.13\nmove = [0.1, 0.12, -0.14]\n";

FramesJudgement judged(const Frames& cloth) {
  return judge_frames(cloth.of, cloth.built, cloth.frames);
}

}  // namespace

TEST_CASE("evidence of frames: numbers over time, folds of the last, and their figures") {
  Case of = sheet(everything);
  of.scene.stretch->rest_length_scale = 0.97;
  Frames cloth(of);
  for (const double scale : {0.9, 1.0, 1.2})  // the cloth is in the plane z = 0 from the origin on
    cloth.add(scale - 0.9, scale * of.scene.x + PerParticle3::Constant(3, 12, -0.1));
  cloth.add(0.5, crossed(of.scene.x));
  const ComparisonEvidence evidence = judged(cloth).evidence;
  const Table &table = evidence.tables.at(0), &folds = evidence.tables.at(1);
  const Vector3 up = -Vector3(1.7, -8.9, 2.3).normalized();
  const double middle = up.dot(Vector3(0.15, 0.12, 0)), low = up.sum() * -0.1;
  const FrameMotion motion = cloth.motion();
  const std::vector<std::pair<const char*, std::vector<double>>> columns = {
      {"time", {0, 0.1, 0.3}},
      {"crossing pairs", {0, 0, 0}},
      {"largest extension", {0, 1 / 0.97 - 1, 1.2 / 0.97 - 1}},
      {"largest compression", {1 - 0.9 / 0.97, 0, 0}},
      {"lowest vertex", {low + 0.9 * 0.3 * up.x(), low + 0.3 * up.x(), low + 1.2 * 0.3 * up.x()}},
      {"mean height", {low + 0.9 * middle, low + middle, low + 1.2 * middle}}};
  for (const auto& [column, values] : columns)
    for (std::size_t k = 0; k < 3; ++k) CHECK(table.numbers(column)[k] == exactly(values[k]));
  for (std::size_t k = 0; k < 4; ++k) {
    const PerParticle& mass = cloth.built.system.mass;
    CHECK(table.numbers("depth in objects")[k] == depth_in(motion, cloth.frames[k]));
    CHECK(table.numbers("mean speed")[k] ==
          exactly(motion.states[k].v.colwise().norm().dot(mass.transpose()) / mass.sum()));
  }
  CHECK(table.numbers("crossing pairs")[3] > 0);
  CHECK(table.numbers("depth in objects")[1] > 0);
  const FoldSpectrum last = fold_spectrum(of.scene.mesh, cloth.frames[3].x);
  CHECK(folds.numbers("share of the hinges' length") ==
        std::vector<double>(last.begin(), last.end()));
  for (const Figure& figure : evidence.figures)
    for (const Curve& curve : figure.curves) CHECK(curve.x == table.numbers("time"));
}

TEST_CASE("evidence of frames: heights are along y without a weight, and against a small one") {
  for (const Vector3& gravity : {Vector3(0, 0, 0), Vector3(0, 0.1, 0)}) {
    Case of = sheet("");
    of.scene.gravity = gravity;
    const Table table = judged(Frames(of, {0})).evidence.tables.at(0);
    CHECK(table.numbers("mean height")[0] == exactly(gravity.y() > 0 ? -0.12 : 0.12));
    CHECK(table.numbers("largest extension")[0] == exactly(0));  // without springs
  }
}

TEST_CASE("evidence of frames: another mesh has heights, but neither strains nor speeds") {
  Frames cloth(sheet(everything), {0, 0.1, 0.2});
  for (TimedMesh& frame : cloth.frames) frame.triangles.pop_back();
  const ComparisonEvidence evidence = judged(cloth).evidence;
  REQUIRE(evidence.tables.size() == 1);
  CHECK(evidence.figures.size() == 1);
  for (const char* none : {"largest extension", "largest compression", "mean speed"})
    CHECK(std::isnan(evidence.tables[0].numbers(none)[2]));
  CHECK(evidence.tables[0].numbers("lowest vertex")[2] < 0);
}

TEST_CASE("evidence of frames: an expectation that frames cannot show says why") {
  Case of = sheet(everything);
  for (const Quantity& row : quantities()) of.expectations.push_back({row.key, 1, "w"});
  of.expectations[8].not_asked = "another shape";  // stays_flat
  of.scene.strain_limits = StrainLimits{};
  Frames cloth(of, {0, 0.1, 0.2});
  const auto note = [&](const std::string& key) -> std::string {
    for (const Record& record : judged(cloth).records)
      if (record.name == "case." + cloth.of.scene.name + "." + key)
        return record.outcome == Outcome::not_applicable ? record.finding.note : "judged";
    return "by a law";
  };
  const std::vector<std::pair<std::string, std::vector<const char*>>> rows = {
      {"by a law",
       {"runs-to-its-end", "never-crosses-itself", "stays-outside", "stays-within-strain-limits"}},
      {"judged",
       {"comes-to-rest", "ends-untangled", "lies-inside", "keeps-its-height", "collapses-to",
        "keeps-most-angles", "crumples-by", "forms-creases", "wrinkles-stay-short", "is-carried",
        "faces-outside", "keeps-its-lengths"}},
      {"frames do not show what sticks to what", {"sticks", "lets-go", "keeps-hold"}},
      {"frames do not show the steps of a run",
       {"takes-steps", "is-reproducible", "energy-does-not-drift", "makes-contact"}},
      {"another shape", {"stays-flat"}}};
  for (const auto& [reason, keys] : rows)
    for (const char* key : keys) CHECK(note(key) == reason);
  for (TimedMesh& frame : cloth.frames) frame.triangles.pop_back();
  CHECK_THAT(note("is-carried"), StartsWith("the frames have another mesh than the case"));
  CHECK(note("stays-flat") == "another shape");
}

TEST_CASE("evidence of frames: rest is judged by the energies of the frames' differences") {
  Case of = sheet("");
  of.expectations = {{"comes_to_rest", 0.5, "w"}};
  Frames cloth(of);
  const std::vector<double> heights = {0, 1, 3, 3.5, 3.7};
  for (std::size_t k = 0; k < heights.size(); ++k)
    cloth.add(0.1 * double(k), of.scene.x.array() + heights[k]);
  // differences over neighbours: 1, 1.5, 1.25, 0.35, 0.2 a frame
  CHECK(judged(cloth).records.back().finding.verdict.measured == exactly(0.04 / 2.25));
}
