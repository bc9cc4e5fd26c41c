// Evidence of judged frames and of comparisons, number by number.
#include <Eigen/Geometry>

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

/// Sinks unevenly; in the last frame an edge passes through its middle.
void add_sinking(Frames& cloth) {
  for (std::size_t k = 0; k < 4; ++k) {
    PerParticle3 x = cloth.of.scene.x;
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      x.col(i) += Vector3(0.004, 0.002, -0.003) * double(k * (1 + std::size_t(i)));
    if (k == 3) x.col(0) = Vector3(0.25, 0.235, -0.2), x.col(1) = Vector3(0.25, 0.21, 0.2);
    cloth.add(0.1 * double(k + k * k), x);
  }
}

double length_of(const Edge& edge, const PerParticle3& x) {
  return (x.col(edge.a) - x.col(edge.b)).norm();
}

void check_curve(const Curve& curve, const std::string& label, const Table& table,
                 const std::string& column) {
  CHECK(curve.label == label);
  CHECK(curve.x == table.numbers("time"));
  CHECK(curve.y == table.numbers(column));
  CHECK(std::isnan(curve.floor));
}

}  // namespace

TEST_CASE("evidence of frames: numbers over time, folds of the last, and their figures") {
  Case of = sheet(everything);
  of.scene.stretch->rest_length_scale = 0.97;
  Frames cloth(of);
  add_sinking(cloth);
  const FrameMotion motion = cloth.motion();
  const FramesJudgement judged = judge_frames(cloth.of, cloth.built, cloth.frames);
  REQUIRE(judged.evidence.tables.size() == 2);
  const Table& table = judged.evidence.tables[0];
  CHECK(table.name == "frames");
  const Vector3 up = -Vector3(1.7, -8.9, 2.3).normalized();
  const PerParticle& mass = cloth.built.system.mass;
  for (std::size_t k = 0; k < 4; ++k) {
    const PerParticle3& x = cloth.frames[k].x;
    double longer = 0, shorter = 0, lowest = 1e9, mean = 0, speed = 0;
    for (const Edge& edge : of.scene.mesh.edges) {
      const double strain = length_of(edge, x) / (0.97 * length_of(edge, of.scene.mesh.rest)) - 1;
      longer = std::max(longer, strain), shorter = std::max(shorter, -strain);
    }
    for (Eigen::Index i = 0; i < 12; ++i) {
      lowest = std::min(lowest, up.dot(x.col(i))), mean += up.dot(x.col(i)) / 12;
      speed += mass[i] * motion.states[k].v.col(i).norm() / mass.sum();
    }
    CHECK(table.numbers("time")[k] == cloth.frames[k].time);
    CHECK(table.numbers("crossing pairs")[k] == crossings_in(cloth.frames[k]));
    CHECK(table.numbers("depth in objects")[k] == depth_in(motion, cloth.frames[k]));
    CHECK(table.numbers("largest extension")[k] == exactly(longer));
    CHECK(table.numbers("largest compression")[k] == exactly(shorter));
    CHECK(table.numbers("lowest vertex")[k] == exactly(lowest));
    CHECK(table.numbers("mean height")[k] == exactly(mean));
    CHECK(table.numbers("mean speed")[k] == exactly(speed));
  }
  CHECK(table.numbers("crossing pairs")[3] > 0);
  CHECK(table.numbers("depth in objects")[3] > 0);
  CHECK(table.numbers("largest compression")[0] == 0);
  const Table& folds = judged.evidence.tables[1];
  CHECK(folds.name == "folds");
  const FoldSpectrum last = fold_spectrum(of.scene.mesh, cloth.frames[3].x);
  CHECK(folds.numbers("share of the hinges' length") ==
        std::vector<double>(last.begin(), last.end()));
  CHECK(folds.texts("fold angle") ==
        std::vector<std::string>{"0 to 5 degrees", "5 to 15 degrees", "15 to 45 degrees",
                                 "45 to 90 degrees", "90 to 180 degrees"});

  const std::vector<Figure>& figures = judged.evidence.figures;
  REQUIRE(figures.size() == 3);
  CHECK(figures[0].name == "heights");
  check_curve(figures[0].curves.at(0), "lowest vertex", table, "lowest vertex");
  check_curve(figures[0].curves.at(1), "mean of the vertices", table, "mean height");
  CHECK(figures[1].name == "strains");
  check_curve(figures[1].curves.at(0), "largest extension", table, "largest extension");
  check_curve(figures[1].curves.at(1), "largest compression", table, "largest compression");
  CHECK(figures[2].name == "speeds");
  check_curve(figures[2].curves.at(0), "mean, by mass", table, "mean speed");
  for (const Figure& figure : figures) CHECK(std::isnan(figure.slope));
}

TEST_CASE("evidence of frames: without a weight heights are along y, without springs at rest") {
  for (const bool is_zero : {false, true}) {
    Case of = sheet("");
    if (is_zero) of.scene.gravity = Vector3::Zero();
    Frames cloth(of);
    add_sinking(cloth);
    cloth.frames.pop_back();
    const Table table = judge_frames(cloth.of, cloth.built, cloth.frames).evidence.tables.at(0);
    CHECK(table.numbers("lowest vertex")[0] == exactly(0));
    CHECK(table.numbers("mean height")[0] == exactly(0.12));
    CHECK(table.numbers("largest extension")[0] == exactly(0));
    CHECK(table.numbers("largest extension")[2] > 0.01);
    CHECK(table.numbers("depth in objects")[2] == 0);
  }
}

TEST_CASE("evidence of frames: a small weight points down") {
  Case of = sheet("");
  of.scene.gravity = Vector3(0.6, 0.2, -0.3);
  Frames cloth(of);
  add_sinking(cloth);
  const Table table = judge_frames(cloth.of, cloth.built, cloth.frames).evidence.tables.at(0);
  CHECK(table.numbers("mean height")[0] ==
        exactly(-Vector3(0.6, 0.2, -0.3).dot(Vector3(0.15, 0.12, 0)) / 0.7));
}

TEST_CASE("evidence of frames: each law has a record with its claim and its source") {
  Frames cloth(sheet(everything));
  add_sinking(cloth);
  const std::vector<Record> records = judge_frames(cloth.of, cloth.built, cloth.frames).records;
  REQUIRE(records.size() == frame_laws().size());
  for (std::size_t k = 0; k < records.size(); ++k) {
    CHECK(records[k].name == frame_laws()[k].name);
    CHECK(records[k].claim == frame_laws()[k].claim);
    CHECK(records[k].source == frame_laws()[k].source);
    CHECK(records[k].kind == "check");
  }
  CHECK(records[2].finding.note == "needs prescribed particles: the case has no [[hold]]");
  CHECK(records[3].outcome == Outcome::fails);
  CHECK(records[3].finding.note == "");
}

TEST_CASE("evidence of frames: another mesh has heights, but neither strains nor speeds") {
  Frames cloth(sheet(everything));
  add_sinking(cloth);
  for (TimedMesh& frame : cloth.frames) frame.triangles.pop_back();
  const FramesJudgement judged = judge_frames(cloth.of, cloth.built, cloth.frames);
  CHECK(judged.matching == Matching::surface);
  REQUIRE(judged.evidence.tables.size() == 1);
  CHECK(judged.evidence.figures.size() == 1);
  for (const char* none : {"largest extension", "largest compression", "mean speed"})
    CHECK(std::isnan(judged.evidence.tables[0].numbers(none)[2]));
  CHECK(judged.evidence.tables[0].numbers("lowest vertex")[2] < 0);
}

TEST_CASE("evidence of frames: an expectation that frames cannot show says why") {
  Case of = sheet(everything);
  for (const Quantity& row : quantities()) of.expectations.push_back({row.key, 1, "w"});
  of.expectations[8].not_asked = "another shape";  // stays_flat
  of.scene.sticky.clear();
  of.scene.strain_limits = StrainLimits{};
  Frames cloth(of);
  add_sinking(cloth);
  const auto note = [&](const std::string& key) -> std::string {
    for (const Record& record : judge_frames(cloth.of, cloth.built, cloth.frames).records)
      if (record.name == "case." + cloth.of.scene.name + "." + key)
        return record.outcome == Outcome::not_applicable ? record.finding.note : "asked";
    return "by a law";
  };
  for (const char* key :
       {"runs-to-its-end", "never-crosses-itself", "stays-outside", "stays-within-strain-limits"})
    CHECK(note(key) == "by a law");
  for (const char* key :
       {"comes-to-rest", "ends-untangled", "lies-inside", "keeps-its-height", "collapses-to",
        "keeps-most-angles", "crumples-by", "forms-creases", "wrinkles-stay-short", "is-carried",
        "faces-outside", "keeps-its-lengths"})
    CHECK(note(key) == "asked");
  for (const char* key : {"sticks", "lets-go", "keeps-hold"})
    CHECK(note(key) == "frames do not show what sticks to what");
  for (const char* key :
       {"takes-steps", "is-reproducible", "energy-does-not-drift", "makes-contact"})
    CHECK(note(key) == "frames do not show the steps of a run");
  CHECK(note("stays-flat") == "another shape");
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
  const std::vector<Record> records = judge_frames(cloth.of, cloth.built, cloth.frames).records;
  CHECK(records.size() == 13);
  CHECK(records.back().finding.verdict.measured == exactly(0.04 / 2.25));
}

TEST_CASE("comparison: distances, energies, crossings, folds and depths, number by number") {
  Frames cloth(sheet(everything));
  add_sinking(cloth);
  const ComparedRun run{cloth.of.scene, cloth.built, Matching::particles};
  std::vector<FrameComparison> all;
  for (std::size_t k = 0; k < 4; ++k) {
    const State at{0.1, cloth.frames[3 - k].x, PerParticle3::Zero(3, 12)};
    all.push_back(compare_frame(run, at, cloth.frames[k]));
    const FrameComparison& c = all.back();
    double squares = 0, weighted = 0, largest = 0;
    const PerParticle& mass = cloth.built.system.mass;
    for (Eigen::Index i = 0; i < 12; ++i) {
      const double d = (at.x.col(i) - cloth.frames[k].x.col(i)).norm();
      squares += d * d / 12, weighted += mass[i] * d * d / mass.sum();
      largest = std::max(largest, d);
    }
    CHECK(c.file == "frame " + std::to_string(k));
    CHECK(c.time == cloth.frames[k].time);
    CHECK(c.distance.rms == exactly(std::sqrt(squares)));
    CHECK(c.distance.weighted == exactly(std::sqrt(weighted)));
    CHECK(c.distance.largest == exactly(largest));
    const auto check_shape = [&](const ClothShape& shape, const TimedMesh& of_frame) {
      const Energies e = energies(cloth.built.system, {0, of_frame.x, PerParticle3::Zero(3, 12)});
      CHECK(shape.stretch == exactly(e.stretch));
      CHECK(shape.bending == exactly(e.bending));
      CHECK(shape.crossings == crossings_in(of_frame));
      CHECK(shape.depth == exactly(depth_in(cloth.motion(), of_frame)));
      CHECK(shape.folds == fold_spectrum(cloth.of.scene.mesh, of_frame.x));
    };
    check_shape(c.frame, cloth.frames[k]), check_shape(c.run, cloth.frames[3 - k]);
  }
  const ComparisonEvidence evidence = evidence_of(all, Matching::particles);
  const Table& table = evidence.tables.at(0);
  for (std::size_t k = 0; k < 4; ++k) {
    const FrameComparison& c = all[k];
    const std::vector<std::pair<const char*, double>> row = {
        {"time", c.time},
        {"rms distance", c.distance.rms},
        {"largest distance", c.distance.largest},
        {"weighted rms", c.distance.weighted},
        {"stretch, run", c.run.stretch},
        {"stretch, frame", c.frame.stretch},
        {"bending, run", c.run.bending},
        {"bending, frame", c.frame.bending},
        {"crossings, run", double(c.run.crossings)},
        {"crossings, frame", double(c.frame.crossings)},
        {"depth, run", c.run.depth},
        {"depth, frame", c.frame.depth}};
    for (const auto& [column, value] : row) CHECK(table.numbers(column)[k] == value);
    for (std::size_t b = 0; b < 5; ++b) {
      CHECK(evidence.tables.at(1).numbers("time")[5 * k + b] == c.time);
      CHECK(evidence.tables.at(1).texts("fold angle")[5 * k + b] == name_of_fold_band(b));
      CHECK(evidence.tables.at(1).numbers("share, run")[5 * k + b] == c.run.folds[b]);
      CHECK(evidence.tables.at(1).numbers("share, frame")[5 * k + b] == c.frame.folds[b]);
    }
  }
  const std::vector<Figure>& figures = evidence.figures;
  REQUIRE(figures.size() == 2);
  check_curve(figures[0].curves.at(0), "root mean square", table, "rms distance");
  check_curve(figures[0].curves.at(1), "largest", table, "largest distance");
  check_curve(figures[0].curves.at(2), "weighted with masses or areas", table, "weighted rms");
  check_curve(figures[1].curves.at(0), "stretch, run", table, "stretch, run");
  check_curve(figures[1].curves.at(1), "stretch, frames", table, "stretch, frame");
  check_curve(figures[1].curves.at(2), "bending, run", table, "bending, run");
  check_curve(figures[1].curves.at(3), "bending, frames", table, "bending, frame");
  CHECK(figures[0].caption == "Compared vertex by vertex.");
  CHECK(evidence_of(all, Matching::surface).figures[0].caption == "Compared by nearest points.");
  for (const Figure& figure : figures) CHECK(std::isnan(figure.slope));
}

TEST_CASE("comparison: surfaces by the nearest points of both, weighted with vertices' areas") {
  Frames cloth(sheet(""));
  PerParticle3 x(3, 3);  // one triangle, 0.5 m above a larger sheet's corner
  x << 0.02, 0.12, 0.02, 0.03, 0.03, 0.23, 0.5, 0.5, 0.5;
  const TimedMesh frame{"one", 0.1, x, {{0, 1, 2}}};
  const State at{0, cloth.of.scene.x, cloth.of.scene.v};
  const FrameComparison c =
      compare_frame({cloth.of.scene, cloth.built, Matching::surface}, at, frame);
  double squares = 0, weighted = 0, largest = 0;
  const PerParticle areas = lumped_masses(cloth.of.scene.mesh, 1);
  for (Eigen::Index i = 0; i < 12; ++i) {
    double nearest = 1e9;  // over a fine lattice of the triangle
    for (int a = 0; a <= 400; ++a)
      for (int b = 0; a + b <= 400; ++b)
        nearest = std::min(nearest, (at.x.col(i) - x.col(0) - a / 400.0 * (x.col(1) - x.col(0)) -
                                     b / 400.0 * (x.col(2) - x.col(0)))
                                        .norm());
    squares += nearest * nearest, weighted += areas[i] * nearest * nearest;
    largest = std::max(largest, nearest);
  }
  const double area = 0.1 * 0.2 / 2;
  squares += 3 * 0.25, weighted += area * 0.25;
  CHECK(c.distance.largest == Approx(largest).epsilon(1e-5));
  CHECK(c.distance.rms == Approx(std::sqrt(squares / 15)).epsilon(1e-5));
  CHECK(c.distance.weighted == Approx(std::sqrt(weighted / (0.3 * 0.24 + area))).epsilon(1e-5));
}
