// Frames of any program: those of the reference meet the laws, damaged ones are found by name.
#include <catch2/catch.hpp>
#include <set>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/frame_motion.h"
#include "verification/cases/judged_frames.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

/// Its width has more digits than a file of six.
const std::string judged_cloth = R"([cloth]
shape = "sheet"
pattern = "one_diagonal"
width = 0.4123456789
height = 0.3
columns = 8
rows = 6
density = 0.2
turn = { axis = [1, 0, 0], angle = -90 }
)";
const std::string stiff_cloth = "time = { end = 0.2, frames_per_second = 50 }\n" + judged_cloth +
                                "[stretch]\nstiffness = 40\n[bending]\nstiffness = 1e-3\n";
/// Soft, so that every scheme is stable with a step a frame.
const std::string soft_cloth = "time = { end = 0.36, frames_per_second = 50 }\n" + judged_cloth +
                               "[stretch]\nstiffness = 0.03\n[bending]\nstiffness = 1e-6\n";
const std::string ball_below = "[gravity]\n[[object]]\nshape = \"sphere\"\nradius = 0.1\nmove = ";
const std::string held_corners = "[[hold]]\nparticles = [0, 8]\n";

const std::string falling = stiff_cloth + ball_below + R"([0.2, -0.11, -0.15]
[expect]
comes_to_rest = { at_most = 1.1, why = "a trial" }
takes_steps = { at_least = 3, why = "a trial" }
)";
/// Far above its ball, with a velocity.
const std::string far_above = soft_cloth + "[start]\nvelocity = [0.3, 0.2, 0.1]\n" + ball_below +
                              "[0.28, -0.4, -0.12]\n[expect.makes_contact]\nat_least = 1\n"
                              "why = \"a trial\"\n";
const std::string weightless =
    stiff_cloth + "[strain_limits]\nextension = 0.1\ncompression = 0.1\n" + held_corners;
const std::string hanging = weightless + "[gravity]\n";
const std::string hanging_softly = soft_cloth + "[gravity]\n" + held_corners;

using Names = std::set<std::string>;

struct Frames {
  Case of;
  BuiltScene built;
  std::vector<TimedMesh> frames;

  /// step: 0 for the case's own [s]
  explicit Frames(const std::string& text, std::string_view integrator = "C", double step = 0)
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

  Frames& each(const std::function<void(TimedMesh&)>& change) {
    for (TimedMesh& frame : frames) change(frame);
    return *this;
  }
  /// As if they were played faster.
  Frames& hasten(double factor) {
    return each([=](TimedMesh& frame) { frame.time /= factor; });
  }
  Frames& freeze() {
    return each([x = frames.front().x](TimedMesh& frame) { frame.x = x; });
  }
  Frames& drift(const Vector3& velocity) {
    return each([=](TimedMesh& frame) { frame.x.colwise() += velocity * frame.time; });
  }

  std::vector<Record> records() const { return judge_frames(of, built, frames).records; }

  Names failing() const {
    Names names;
    for (const Record& record : records())
      if (record.outcome != Outcome::holds && record.outcome != Outcome::not_applicable)
        names.insert(record.name);
    return names;
  }
  bool fails(const std::string& law) const { return failing().contains("frames." + law); }

  Outcome outcome_of(const std::string& name) const {
    for (const Record& record : records())
      if (record.name == name || record.name == "frames." + name) return *record.outcome;
    throw std::logic_error("no finding " + name);
  }
};

}  // namespace

TEST_CASE("judged frames: those of the reference meet every law that applies") {
  const Frames frames(falling), held(hanging);
  CHECK(frames.failing() == Names{});
  CHECK(held.failing() == Names{});
  CHECK(frames.outcome_of("case.trial.comes-to-rest") == Outcome::holds);
  CHECK(frames.outcome_of("case.trial.takes-steps") == Outcome::not_applicable);
  CHECK(frames.outcome_of("prescribed-particles-follow") == Outcome::not_applicable);
  for (const char* law :
       {"springs-stay-within-limits", "prescribed-particles-follow", "energy-stays-in-budget"})
    CHECK(held.outcome_of(law) == Outcome::holds);
}

TEST_CASE("judged frames: files of six digits raise no alarm") {
  for (const std::string& text : {falling, hanging}) {
    Frames frames(text);
    const double exact = frames.frames[0].x(0, 8);  // of a corner, prescribed where one is
    // coordinates are below 1 m
    frames.each([](TimedMesh& frame) { frame.x = (frame.x.array() * 1e6).round() / 1e6; });
    CHECK(std::abs(frames.frames[0].x(0, 8) - exact) > 1e-7);  // or nothing is shown
    CHECK(frames.failing() == Names{});
  }
}

TEST_CASE("judged frames: a crossed start whose layers touch may meet more often by rounding") {
  Frames frames(R"(time = { end = 0.002, frames_per_second = 1000 }
[cloth]
shape = "sheet"
pattern = "equilateral"
width = 0.24
height = 0.05
columns = 32
rows = 8
density = 0.2
turn = { axis = [1, 0, 0], angle = -90 }
move = [-0.05, 0, 0.025]
[start]
folded = { layers = 2, gap = 0.012, along = [1, 0, 0], up = [0, 1, 0], dip = 0.017 }
[stretch]
stiffness = 20
[self_collision]
thickness = 0.0015
stiffness = 5
[expect.tangle_does_not_grow]
at_most = 29
why = "as many as at the start"
)");
  CHECK(frames.failing() == Names{});
  const double exact = crossings_in(frames.frames[0]);
  frames.each([](TimedMesh& frame) { frame.x = (frame.x.array() * 1e6).round() / 1e6; });
  CHECK(crossings_in(frames.frames[0]) > exact);  // or nothing is shown
  CHECK(frames.failing() == Names{});
}

TEST_CASE("judged frames: bounds of the case allow for six decimals, also of a small cloth") {
  const std::string still = R"(time = { end = 0.1, frames_per_second = 50 }
cloth = { shape = "sheet", width = 0.0412345678, height = 0.03, columns = 3, rows = 2, density = 1 }
expect = { keeps_its_place = { at_most = 1e-12, why = "still" } }
)";
  Frames frames(still);
  const auto place = "case.trial.keeps-its-place";
  frames.each([](TimedMesh& frame) { frame.x = (frame.x.array() * 1e6).round() / 1e6; });
  CHECK(frames.frames[0].x != frames.of.scene.x);
  CHECK(frames.failing() == Names{});
  CHECK(frames.each([](TimedMesh& frame) { frame.x.row(0).array() += 4e-6; }).outcome_of(place) ==
        Outcome::fails);
}

TEST_CASE("judged frames: wrong units, order and times are told from a wrong motion") {
  Frames units(falling), order(falling), early(falling);
  units.each([](TimedMesh& frame) { frame.x *= 1.02; });
  order.each([](TimedMesh& frame) { frame.x.col(3).swap(frame.x.col(4)); });
  early.frames.resize(early.frames.size() - 3);
  CHECK(units.fails("start-is-that-of-the-case"));
  CHECK(order.fails("start-is-that-of-the-case"));
  CHECK(early.failing() == Names{"frames.end-is-reached"});
}

TEST_CASE("judged frames: cloth that passes through itself is found") {
  Frames frames(hanging);
  PerParticle3& x = frames.frames[4].x;  // an edge is drawn through the middle of the sheet
  x.col(1) = x.col(30) + Vector3(0.01, 0.05, 0.01);
  x.col(0) = x.col(30) + Vector3(0.01, -0.05, 0.01);
  CHECK(frames.fails("never-cross-themselves"));
  CHECK(frames.fails("prescribed-particles-follow"));
}

TEST_CASE("judged frames: cloth inside an object is found") {
  CHECK(Frames(falling).drift({0, -0.25, 0}).fails("vertices-stay-outside"));  // sinks into it
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
  CHECK(frames.outcome_of("folds-never-pass-through") == Outcome::fails);
}

TEST_CASE("judged frames: folds that turn over between two frames are inconclusive") {
  Frames frames(hanging);
  frames.freeze();
  const std::vector<Hinge>& hinges = frames.of.scene.mesh.hinges;
  fold_to(frames.frames[1].x, hinges.front(), 116);
  fold_to(frames.frames[2].x, hinges.front(), -116);
  fold_to(frames.frames[1].x, hinges.back(), 85);
  fold_to(frames.frames[2].x, hinges.back(), -85);
  CHECK(frames.outcome_of("folds-never-pass-through") == Outcome::inconclusive);
}

TEST_CASE("judged frames: cloth that rises from nowhere is found") {
  // as it started, but higher and higher: only its weight has energy
  CHECK(Frames(falling).freeze().drift({0, 0.3, 0}).fails("energy-stays-in-budget"));
}

TEST_CASE("judged frames: cloth that stretches from nowhere is found") {
  Frames frames(falling);
  // wider and wider at one height: only its springs have energy
  frames.freeze().each([](TimedMesh& frame) { frame.x.row(0) *= 1 + 0.5 * frame.time; });
  CHECK(frames.fails("energy-stays-in-budget"));
}

TEST_CASE("judged frames: of another mesh crossings and depths are judged, the rest declined") {
  Frames frames(falling);
  const TriangleMesh finer = make_sheet({SheetPattern::one_diagonal, 0.4123456789, 0.3, 16, 12});
  frames.each([&](TimedMesh& frame) {
    frame.triangles = finer.triangles;
    frame.x.setZero(3, finer.rest.cols());
    frame.x.row(0) = finer.rest.row(0), frame.x.row(2) = -finer.rest.row(1);
  });
  CHECK(frames.failing() == Names{});
  CHECK(frames.outcome_of("never-cross-themselves") == Outcome::holds);
  CHECK(frames.outcome_of("energy-stays-in-budget") == Outcome::not_applicable);
  frames.each([](TimedMesh& frame) { frame.x.row(1).array() -= 0.1; });
  CHECK(frames.failing() == Names{"frames.vertices-stay-outside"});
}

TEST_CASE("judged frames: every scheme moves as it should, with a step a frame") {
  for (const Integrator& integrator : integrators()) {
    INFO(integrator.name);
    const Frames far(far_above, integrator.name, 0.02), held(hanging_softly, integrator.name, 0.02);
    CHECK(far.outcome_of("centre-falls-freely") == Outcome::holds);
    CHECK(far.outcome_of("motion-stays-in-budget") == Outcome::holds);
    CHECK(held.outcome_of("starts-as-fast-as-the-reference") == Outcome::holds);
    CHECK(held.outcome_of("motion-stays-in-budget") == Outcome::holds);
  }
}

TEST_CASE("judged frames: a law that does not apply says what it needs") {
  const std::string note = "needs prescribed particles: the case has no [[hold]]";
  CHECK(std::ranges::count(Frames(falling).records(), note,
                           [](const Record& record) { return record.finding.note; }) == 1);
}

TEST_CASE("judged frames: each law of dynamics is asked where it applies") {
  const Frames far(far_above), near(falling);
  const auto none = Outcome::not_applicable;
  CHECK(far.outcome_of("centre-falls-freely") == Outcome::holds);
  CHECK(far.outcome_of("touches-objects") == Outcome::holds);
  CHECK(far.outcome_of("starts-as-fast-as-the-reference") == none);
  CHECK(near.outcome_of("touches-objects") == none);
  CHECK(near.outcome_of("centre-falls-freely") == none);
  CHECK(near.outcome_of("starts-as-fast-as-the-reference") == Outcome::holds);
}

TEST_CASE("judged frames: cloth that falls too fast, too slowly, aside or not at all is found") {
  for (const double factor : {4.0, 1.25, 0.8}) {
    const Names names = Frames(far_above).hasten(factor).failing();
    CHECK(names.contains("frames.centre-falls-freely"));
    CHECK(names.contains("frames.motion-stays-in-budget") == (factor > 1));
  }
  for (const Vector3& velocity : {Vector3(0.2, 0, 0), Vector3(0, -0.3, 0)})
    CHECK(Frames(far_above).drift(velocity).fails("centre-falls-freely"));
  CHECK(Frames(far_above).freeze().fails("centre-falls-freely"));
  CHECK(Frames(far_above).freeze().fails("touches-objects"));
}

TEST_CASE("judged frames: cloth that falls with four fifths of g is found") {
  Frames frames(far_above);
  frames.each([](TimedMesh& frame) {
    frame.x.row(1).array() += 0.2 * 9.80665 * frame.time * frame.time / 2;
  });
  CHECK(frames.fails("centre-falls-freely"));
}

TEST_CASE("judged frames: the start of a multistep method is no other fall") {
  // BDF2 after a step of backward Euler: shifted by 3/4 g h^2 (1 - 3^-n)
  const double h = 0.02, shift = 0.75 * 9.80665 * h * h;
  for (const double factor : {1.0, 3.0}) {
    Frames frames(far_above);
    frames.each([=](TimedMesh& frame) {
      frame.x.row(1).array() -= factor * shift * (1 - std::pow(3, -frame.time / h));
    });
    CHECK(frames.fails("centre-falls-freely") == (factor > 1));
  }
}

TEST_CASE("judged frames: held cloth that starts too fast, too slowly or not at all is found") {
  for (const double factor : {4.0, 1.25, 0.8})
    CHECK(Frames(hanging).hasten(factor).fails("starts-as-fast-as-the-reference"));
  CHECK(Frames(hanging).freeze().failing() == Names{"frames.starts-as-fast-as-the-reference"});
  CHECK(Frames(hanging).hasten(2).fails("motion-stays-in-budget"));
}

TEST_CASE("judged frames: speeds that come of rounding alone have no energy") {
  Frames frames(weightless);  // it stays where it is
  for (std::size_t k = 0; k < frames.frames.size(); ++k)
    frames.frames[k].x.array() += (k % 4 < 2 ? 1 : -1) * 0.5e-6;
  CHECK(frames.outcome_of("motion-stays-in-budget") == Outcome::holds);
}
