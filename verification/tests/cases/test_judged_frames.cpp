// Frames of any program: those of the reference meet the laws, damaged ones are found by name.
#include <catch2/catch.hpp>

#include <set>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/judged_frames.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

/// A sheet falls onto a ball; the other hangs by a corner row and has strain limits. Their width
/// has more digits than a file of six.
constexpr const char* falling = R"([cloth]
shape = "sheet"
pattern = "one_diagonal"
width = 0.4123456789
height = 0.3
columns = 8
rows = 6
density = 0.2
turn = { axis = [1, 0, 0], angle = -90 }
[gravity]
[stretch]
stiffness = 40
[bending]
stiffness = 1e-3
[[object]]
shape = "sphere"
radius = 0.1
move = [0.2, -0.11, -0.15]
[time]
end = 0.2
frames_per_second = 50
[expect.comes_to_rest]
at_most = 1.1
why = "a trial"
[expect.takes_steps]
at_least = 3
why = "a trial"
)";

constexpr const char* hanging = R"([cloth]
shape = "sheet"
pattern = "one_diagonal"
width = 0.4123456789
height = 0.3
columns = 8
rows = 6
density = 0.2
turn = { axis = [1, 0, 0], angle = -90 }
[gravity]
[stretch]
stiffness = 40
[strain_limits]
extension = 0.1
compression = 0.1
[bending]
stiffness = 1e-3
[[hold]]
particles = [0, 8]
[time]
end = 0.2
frames_per_second = 50
)";

/// The falling sheet, far above its ball, with a velocity; soft, so that every scheme is stable
/// with a step a frame.
std::string far_above() {
  std::string text = falling;
  const auto put = [&](const std::string& old, const std::string& now) {
    text.replace(text.find(old), old.size(), now);
  };
  put("stiffness = 40", "stiffness = 0.03"), put("stiffness = 1e-3", "stiffness = 1e-6");
  put("move = [0.2, -0.11, -0.15]", "move = [0.28, -0.4, -0.12]");
  put("[gravity]", "[start]\nvelocity = [0.3, 0.2, 0.1]\n[gravity]");
  put("end = 0.2", "end = 0.36");
  put("frames_per_second = 50\n",
      "frames_per_second = 50\n[expect.makes_contact]\nat_least = 1\nwhy = \"a trial\"\n");
  return text;
}

std::string hanging_softly() {
  std::string text = hanging;
  text.replace(text.find("[strain_limits]"), text.find("[bending]") - text.find("[strain_limits]"),
               "");
  text.replace(text.find("stiffness = 40"), 14, "stiffness = 0.03");
  return text.replace(text.find("stiffness = 1e-3"), 16, "stiffness = 1e-6");
}

struct Frames {
  Case of;
  BuiltScene built;
  std::vector<TimedMesh> frames;

  explicit Frames(const std::string& text) : Frames(text, "C", 0) {}

  /// step: 0 for the case's own [s]
  Frames(const std::string& text, std::string_view integrator, double step)
      : of(case_of(text)), built(build(of.scene, computing_provider())) {
    Schedule schedule = of.scene.schedule;
    schedule.step.fixed = step;
    simulate(built.system, integrator_named(integrator), built.start, schedule,
             {[&](const State& s) {
                frames.push_back({"frame", s.time, s.x, of.scene.mesh.triangles});
              },
              {}});
  }

  static Case case_of(const std::string& text) {
    const ScratchFolder folder;
    return with_usual_expectations(read_case(folder.write("trial.toml", text)));
  }

  /// As if they were played faster.
  Frames& hasten(double factor) {
    for (TimedMesh& frame : frames) frame.time /= factor;
    return *this;
  }

  Frames& freeze() {
    for (TimedMesh& frame : frames) frame.x = frames.front().x;
    return *this;
  }

  Frames& drift(const Vector3& velocity) {
    for (TimedMesh& frame : frames) frame.x.colwise() += velocity * frame.time;
    return *this;
  }

  std::set<std::string> failing() const {
    std::set<std::string> names;
    for (const Record& record : judge_frames(of, built, frames).records)
      if (record.outcome != Outcome::holds && record.outcome != Outcome::not_applicable)
        names.insert(record.name);
    return names;
  }

  Outcome outcome_of(const std::string& name) const {
    for (const Record& record : judge_frames(of, built, frames).records)
      if (record.name == name) return *record.outcome;
    throw std::logic_error("no finding " + name);
  }
};

using Names = std::set<std::string>;

}  // namespace

TEST_CASE("judged frames: those of the reference meet every law that applies") {
  for (const char* text : {falling, hanging}) CHECK(Frames(text).failing() == Names{});
  const Frames frames(falling);
  CHECK(frames.outcome_of("case.trial.comes-to-rest") == Outcome::holds);
  CHECK(frames.outcome_of("case.trial.takes-steps") == Outcome::not_applicable);
  CHECK(frames.outcome_of("frames.prescribed-particles-follow") == Outcome::not_applicable);
  const Frames held(hanging);
  CHECK(held.outcome_of("frames.springs-stay-within-limits") == Outcome::holds);
  CHECK(held.outcome_of("frames.prescribed-particles-follow") == Outcome::holds);
  CHECK(held.outcome_of("frames.energy-stays-in-budget") == Outcome::holds);
}

TEST_CASE("judged frames: files of six digits raise no alarm") {
  for (const char* text : {falling, hanging}) {
    Frames frames(text);
    const double exact = frames.frames[0].x(0, 8);  // of a corner, prescribed where one is
    // coordinates are below 1 m
    for (TimedMesh& frame : frames.frames) frame.x = (frame.x.array() * 1e6).round() / 1e6;
    CHECK(std::abs(frames.frames[0].x(0, 8) - exact) > 1e-7);  // or nothing is shown
    CHECK(frames.failing() == Names{});
  }
}

TEST_CASE("judged frames: wrong units, order and times are told from a wrong motion") {
  Frames units(falling);
  for (TimedMesh& frame : units.frames) frame.x *= 1.02;
  CHECK(units.failing().contains("frames.start-is-that-of-the-case"));
  Frames order(falling);
  for (TimedMesh& frame : order.frames) frame.x.col(3).swap(frame.x.col(4));
  CHECK(order.failing().contains("frames.start-is-that-of-the-case"));
  Frames early(falling);
  early.frames.resize(early.frames.size() - 3);
  CHECK(early.failing() == Names{"frames.end-is-reached"});
}

TEST_CASE("judged frames: cloth that passes through itself is found") {
  Frames frames(hanging);
  PerParticle3& x = frames.frames[4].x;  // an edge is drawn through the middle of the sheet
  x.col(1) = x.col(30) + Vector3(0.01, 0.05, 0.01);
  x.col(0) = x.col(30) + Vector3(0.01, -0.05, 0.01);
  CHECK(frames.failing().contains("frames.never-cross-themselves"));
  CHECK(frames.failing().contains("frames.prescribed-particles-follow"));
}

TEST_CASE("judged frames: cloth inside an object is found") {
  Frames frames(falling);
  // sinks into the ball
  for (TimedMesh& frame : frames.frames) frame.x.row(1).array() -= 0.05 * frame.time / 0.2;
  CHECK(frames.failing().contains("frames.vertices-stay-outside"));
}

TEST_CASE("judged frames: overstretched edges are found") {
  Frames frames(hanging);
  PerParticle3& x = frames.frames.back().x;
  for (int i = 54; i < 63; ++i) x.col(i) += Vector3(0, -0.02, 0);  // the lowest row
  CHECK(frames.failing().contains("frames.springs-stay-within-limits"));
}

namespace {

/// Turns a corner of a flat hinge about its edge [degrees].
void fold_to(PerParticle3& x, const Hinge& hinge, double degrees) {
  const Vector3 end = x.col(hinge.particles[2]);
  const Vector3 axis = (Vector3(x.col(hinge.particles[3])) - end).normalized();
  const Vector3 arm = Vector3(x.col(hinge.particles[0])) - end;
  x.col(hinge.particles[0]) =
      end + Eigen::AngleAxisd(degrees * pi / 180, axis).toRotationMatrix() * arm;
}

}  // namespace

TEST_CASE("judged frames: a triangle that goes through its neighbour is found") {
  Frames frames(hanging);
  frames.freeze();  // flat
  const Hinge hinge = frames.of.scene.mesh.hinges[0];
  fold_to(frames.frames[1].x, hinge, 175);
  fold_to(frames.frames[2].x, hinge, 185);
  CHECK(frames.outcome_of("frames.folds-never-pass-through") == Outcome::fails);
}

TEST_CASE("judged frames: folds that turn over between two frames are inconclusive") {
  Frames frames(hanging);
  frames.freeze();
  const std::vector<Hinge>& hinges = frames.of.scene.mesh.hinges;
  fold_to(frames.frames[1].x, hinges.front(), 116);
  fold_to(frames.frames[2].x, hinges.front(), -116);
  fold_to(frames.frames[1].x, hinges.back(), 85);
  fold_to(frames.frames[2].x, hinges.back(), -85);
  CHECK(frames.outcome_of("frames.folds-never-pass-through") == Outcome::inconclusive);
}

TEST_CASE("judged frames: cloth that rises from nowhere is found") {
  Frames frames(falling);
  // as it started, but higher and higher: only its weight has energy
  const PerParticle3 start = frames.frames[0].x;
  for (TimedMesh& frame : frames.frames)
    frame.x = start.colwise() + Vector3(0, 0.3 * frame.time, 0);
  CHECK(frames.failing().contains("frames.energy-stays-in-budget"));
}

TEST_CASE("judged frames: cloth that stretches from nowhere is found") {
  Frames frames(falling);
  // wider and wider at one height: only its springs have energy
  const PerParticle3 start = frames.frames[0].x;
  for (TimedMesh& frame : frames.frames) {
    frame.x = start;
    frame.x.row(0) *= 1 + 0.5 * frame.time;
  }
  CHECK(frames.failing().contains("frames.energy-stays-in-budget"));
}

TEST_CASE("judged frames: of another mesh crossings and depths are judged, the rest declined") {
  Frames frames(falling);
  const TriangleMesh finer = make_sheet({SheetPattern::one_diagonal, 0.4123456789, 0.3, 16, 12});
  for (TimedMesh& frame : frames.frames) {
    frame.triangles = finer.triangles;
    frame.x.resize(3, finer.rest.cols());
    frame.x << finer.rest.row(0), Eigen::RowVectorXd::Zero(finer.rest.cols()), -finer.rest.row(1);
  }
  const FramesJudgement judged = judge_frames(frames.of, frames.built, frames.frames);
  CHECK(judged.matching == Matching::surface);
  CHECK(frames.failing() == Names{});
  CHECK(frames.outcome_of("frames.never-cross-themselves") == Outcome::holds);
  CHECK(frames.outcome_of("frames.energy-stays-in-budget") == Outcome::not_applicable);
  for (TimedMesh& frame : frames.frames) frame.x.row(1).array() -= 0.1;
  CHECK(frames.failing() == Names{"frames.vertices-stay-outside"});
}

TEST_CASE("judged frames: every scheme moves as it should, with a step a frame") {
  for (const Integrator& integrator : integrators()) {
    INFO(integrator.name);
    const Frames far(far_above(), integrator.name, 0.02);
    for (const char* law : {"frames.centre-falls-freely", "frames.motion-stays-in-budget"})
      CHECK(far.outcome_of(law) == Outcome::holds);
    const Frames held(hanging_softly(), integrator.name, 0.02);
    for (const char* law :
         {"frames.starts-as-fast-as-the-reference", "frames.motion-stays-in-budget"})
      CHECK(held.outcome_of(law) == Outcome::holds);
  }
}

TEST_CASE("judged frames: a law that does not apply says what it needs") {
  const Frames frames(falling);
  int found = 0;
  for (const Record& record : judge_frames(frames.of, frames.built, frames.frames).records)
    if (record.finding.note == "needs prescribed particles: the case has no [[hold]]") ++found;
  CHECK(found == 1);
}

TEST_CASE("judged frames: each law of dynamics is asked where it applies") {
  const Frames far(far_above()), near(falling);
  CHECK(far.outcome_of("frames.centre-falls-freely") == Outcome::holds);
  CHECK(far.outcome_of("frames.touches-objects") == Outcome::holds);
  CHECK(far.outcome_of("frames.starts-as-fast-as-the-reference") == Outcome::not_applicable);
  CHECK(near.outcome_of("frames.touches-objects") == Outcome::not_applicable);
  CHECK(near.outcome_of("frames.centre-falls-freely") == Outcome::not_applicable);
  CHECK(near.outcome_of("frames.starts-as-fast-as-the-reference") == Outcome::holds);
}

TEST_CASE("judged frames: cloth that falls too fast, too slowly, aside or not at all is found") {
  for (const double factor : {4.0, 1.25, 0.8}) {
    const Names names = Frames(far_above()).hasten(factor).failing();
    CHECK(names.contains("frames.centre-falls-freely"));
    CHECK(names.contains("frames.motion-stays-in-budget") == (factor > 1));
  }
  CHECK(Frames(far_above()).drift({0.2, 0, 0}).failing().contains("frames.centre-falls-freely"));
  CHECK(Frames(far_above()).drift({0, -0.3, 0}).failing().contains("frames.centre-falls-freely"));
  const Names names = Frames(far_above()).freeze().failing();
  CHECK(names.contains("frames.centre-falls-freely"));
  CHECK(names.contains("frames.touches-objects"));
}

TEST_CASE("judged frames: cloth that falls with four fifths of g is found") {
  Frames frames(far_above());
  for (TimedMesh& frame : frames.frames)
    frame.x.row(1).array() += 0.2 * 9.80665 * frame.time * frame.time / 2;
  CHECK(frames.failing().contains("frames.centre-falls-freely"));
}

TEST_CASE("judged frames: the start of a multistep method is no other fall") {
  // BDF2 after a step of backward Euler: shifted by 3/4 g h^2 (1 - 3^-n)
  const double h = 0.02, shift = 0.75 * 9.80665 * h * h;
  for (const double factor : {1.0, 3.0}) {
    Frames frames(far_above());
    for (std::size_t n = 0; n < frames.frames.size(); ++n)
      frames.frames[n].x.row(1).array() -= factor * shift * (1 - std::pow(3, -double(n)));
    CHECK(frames.failing().contains("frames.centre-falls-freely") == (factor > 1));
  }
}

TEST_CASE("judged frames: held cloth that starts too fast, too slowly or not at all is found") {
  for (const double factor : {4.0, 1.25, 0.8}) {
    Frames frames(hanging);
    CHECK(frames.hasten(factor).failing().contains("frames.starts-as-fast-as-the-reference"));
  }
  CHECK(Frames(hanging).freeze().failing() == Names{"frames.starts-as-fast-as-the-reference"});
  CHECK(Frames(hanging).hasten(2).failing().contains("frames.motion-stays-in-budget"));
}

TEST_CASE("judged frames: speeds that come of rounding alone have no energy") {
  std::string text = hanging;  // without gravity, it stays where it is
  Frames frames(text.erase(text.find("[gravity]"), 10));
  for (std::size_t k = 0; k < frames.frames.size(); ++k)
    frames.frames[k].x.array() += (k % 4 < 2 ? 1 : -1) * 0.5e-6;
  CHECK(frames.outcome_of("frames.motion-stays-in-budget") == Outcome::holds);
}
