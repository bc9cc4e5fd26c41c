// Laws of frames placed by hand: the numbers of their evidence, their bounds, and what they need.
#include <Eigen/Geometry>

#include "verification/cases/frame_laws.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Law law(const std::string& name) {
  for (const FrameLaw& one : frame_laws())
    if (one.name == "frames." + name) return one.run;
  throw std::logic_error("no law " + name);
}

const std::vector<double> some_times = {0, 0.1, 0.24, 0.31};

/// Cloth that moves away by `way` a frame, and comes apart a little.
void add_moving(Frames& cloth, const Vector3& way) {
  for (std::size_t k = 0; k < some_times.size(); ++k) {
    PerParticle3 x = cloth.of.scene.x;
    x.colwise() += way * double(k);
    x.col(Eigen::Index(5 + k)) += Vector3(0.01, -0.02, 0.015) * double(k);
    cloth.add(some_times[k], x);
  }
}

const std::string ball = "[[object]]\nshape = \"sphere\"\nradius = 0.1\nmove = [0.1, 0.12, -0.2]\n";

}  // namespace

TEST_CASE("laws of frames: each has its name, and the one of the start comes first") {
  std::vector<std::string> names;
  for (const FrameLaw& one : frame_laws()) {
    names.push_back(one.name);
    CHECK(one.claim.back() == '.');
    CHECK(!one.source.empty());
  }
  CHECK(names == std::vector<std::string>{
                     "frames.start-is-that-of-the-case", "frames.end-is-reached",
                     "frames.prescribed-particles-follow", "frames.never-cross-themselves",
                     "frames.vertices-stay-outside", "frames.touches-objects",
                     "frames.springs-stay-within-limits", "frames.folds-never-pass-through",
                     "frames.energy-stays-in-budget", "frames.motion-stays-in-budget",
                     "frames.centre-falls-freely", "frames.starts-as-fast-as-the-reference"});
}

TEST_CASE("laws of frames: the start is compared in mean edges, particle by particle") {
  Frames cloth(sheet(""));
  PerParticle3 x = cloth.of.scene.x;
  for (Eigen::Index i = 0; i < 12; ++i) x.col(i) += Vector3(1e-4, 2e-4, -2e-4) * double(i);
  cloth.add(0, x);
  const Finding finding = law("start-is-that-of-the-case")(cloth.motion());
  // 9 edges along x, 8 along y and 6 diagonals
  const double edge = (9 * 0.1 + 8 * 0.12 + 6 * std::hypot(0.1, 0.12)) / 23;
  for (std::size_t i = 0; i < 12; ++i) {
    CHECK(finding.evidence.numbers("particle")[i] == double(i));
    CHECK(finding.evidence.numbers("distance from the case's start")[i] ==
          exactly(3e-4 * double(i) / edge));
  }
  CHECK(finding.evidence.rows() == 12);
  CHECK(finding.verdict.bound == 0.01);
  CHECK(finding.verdict.measured == exactly(33e-4 / edge));
  cloth.frames[0].time = 0.01;
  CHECK(cloth.missing(law("start-is-that-of-the-case")) == "a frame at t = 0");
  cloth.frames[0].triangles.pop_back();
  CHECK_THAT(cloth.missing(law("start-is-that-of-the-case")), StartsWith("the case's mesh"));
}

TEST_CASE("laws of frames: what is missing at the end is counted in frames") {
  const auto finding = [](double last) {
    Frames cloth(sheet(""));  // until 0.5 s, 50 frames per second
    cloth.add(0, cloth.of.scene.x), cloth.add(last, cloth.of.scene.x);
    return law("end-is-reached")(cloth.motion());
  };
  const Finding early = finding(0.43);
  CHECK(early.evidence.numbers("last frame") == std::vector<double>{0.43});
  CHECK(early.evidence.numbers("end of the case") == std::vector<double>{0.5});
  CHECK(early.verdict.measured == exactly(3.5));
  CHECK(early.verdict.bound == 1);
  CHECK(finding(0.487).verdict.measured == exactly(0.65));
  CHECK(finding(0.6).evidence.numbers("missing") == std::vector<double>{0});
}

TEST_CASE("laws of frames: prescribed particles are compared with where they should be") {
  Frames cloth(sheet("[[hold]]\nparticles = [4, 7]\nvelocity = [0.3, 0.1, -0.2]\n"));
  for (std::size_t k = 0; k < some_times.size(); ++k) {
    PerParticle3 x = cloth.of.scene.x;
    x.colwise() += Vector3(0.3, 0.1, -0.2) * some_times[k];
    x.col(0) += Vector3(5, 5, 5);
    x.col(4) += Vector3(0.02, 0.03, 0.06) * double(k);
    x.col(7) += Vector3(0.01, 0.01, -0.02) * double(k);
    cloth.add(some_times[k], x);
  }
  const Finding finding = law("prescribed-particles-follow")(cloth.motion());
  for (std::size_t k = 0; k < some_times.size(); ++k) {
    CHECK(finding.evidence.numbers("time")[k] == some_times[k]);
    CHECK(finding.evidence.numbers("largest distance from the prescribed place")[k] ==
          exactly(0.07 * double(k)));
  }
  CHECK(finding.verdict.bound == exactly(2 * rounding_of(cloth.frames)));
  Frames free(sheet(""));
  free.add(0, free.of.scene.x);
  CHECK_THAT(free.missing(law("prescribed-particles-follow")), StartsWith("prescribed particles:"));
  cloth.frames[0].triangles.pop_back();
  CHECK_THAT(cloth.missing(law("prescribed-particles-follow")), StartsWith("the case's mesh"));
}

namespace {

/// A corner of the sheet is brought through its middle.
PerParticle3 crossed(PerParticle3 x) {
  x.col(0) = Vector3(0.17, 0.13, -0.05);
  x.col(1) = Vector3(0.17, 0.11, 0.05);
  return x;
}

}  // namespace

TEST_CASE("laws of frames: crossings are bounded by those of the case's start") {
  const auto finding = [](const Case& of) {
    Frames cloth(of);
    const PerParticle3 flat = sheet("").scene.x;
    cloth.add(0.1, flat), cloth.add(0.3, crossed(flat));
    return law("never-cross-themselves")(cloth.motion());
  };
  const Finding from_flat = finding(sheet(""));
  const std::vector<double> counts = from_flat.evidence.numbers("crossings");
  CHECK(from_flat.evidence.numbers("time") == std::vector<double>{0.1, 0.3});
  CHECK(counts[0] == 0);
  CHECK(counts[1] > 0);
  CHECK(from_flat.verdict.bound == 0);
  CHECK(from_flat.verdict.measured == counts[1]);
  Case tangled = sheet("");
  tangled.scene.x = crossed(tangled.scene.x);
  CHECK(finding(tangled).verdict.bound == counts[1]);
  Frames lost(sheet(""));
  PerParticle3 x = lost.of.scene.x;
  x(1, 4) = foldproof::nan;
  lost.add(0, x);
  CHECK(std::isnan(law("never-cross-themselves")(lost.motion()).verdict.measured));
}

TEST_CASE("laws of frames: depths in objects are bounded by the case, or by the triangles") {
  const double r = 1.25 * std::hypot(0.1, 0.12) / 2;  // of a cell's half, a quarter larger
  const auto finding = [](const std::vector<Expectation>& expected) {
    Case of = sheet(ball);
    of.expectations = expected;
    Frames cloth(of);
    add_moving(cloth, Vector3(0, 0, -0.07));
    return std::pair(law("vertices-stay-outside")(cloth.motion()), rounding_of(cloth.frames));
  };
  const auto [usual, rounding] = finding({});
  for (std::size_t k = 0; k < some_times.size(); ++k) {
    double depth = 0;
    for (Eigen::Index i = 0; i < 12; ++i) {
      Vector3 p = sheet("").scene.x.col(i) + Vector3(0, 0, -0.07) * double(k);
      if (i == Eigen::Index(5 + k)) p += Vector3(0.01, -0.02, 0.015) * double(k);
      depth = std::max(depth, 0.1 - (p - Vector3(0.1, 0.12, -0.2)).norm());
    }
    CHECK(usual.evidence.numbers("time")[k] == some_times[k]);
    CHECK(usual.evidence.numbers("depth of the deepest vertex")[k] == exactly(depth));
  }
  CHECK(usual.verdict.measured > 0.05);
  CHECK(usual.verdict.bound == exactly(r / 10 + rounding));
  CHECK_THAT(usual.verdict.why_bound, StartsWith("empirical: a tenth"));
  const Finding stated = finding({{"stays_outside", 0.037, "so it is"}}).first;
  CHECK(stated.verdict.bound == exactly(0.037 + rounding));
  CHECK(stated.verdict.why_bound == "of the case: so it is");
  CHECK(finding({{"lies_inside", 1, ""}, {"stays_outside", 0.02, "w"}}).first.verdict.bound ==
        exactly(0.02 + rounding));
  Case inside = sheet(ball);
  inside.expectations = {{"lies_inside", 1, ""}};
  Frames cloth(inside);
  cloth.add(0, inside.scene.x);
  CHECK_THAT(cloth.missing(law("vertices-stay-outside")), StartsWith("a bound: the case expects"));
  Frames bare(sheet(""));
  bare.add(0, bare.of.scene.x);
  CHECK(bare.missing(law("vertices-stay-outside")) == "objects: the case has no [[object]]");
}

TEST_CASE("laws of frames: contact is judged by the nearest vertex of any frame") {
  const double r = 1.25 * std::hypot(0.1, 0.12) / 2;
  Case of = sheet(ball);
  of.expectations = {{"takes_steps", 1, ""}, {"makes_contact", 1, ""}};
  Frames cloth(of);
  for (const double z : {0.3, -0.03, 0.1, 0.4}) {
    PerParticle3 x = of.scene.x;
    x.row(2).setConstant(z);
    cloth.add(z == 0.3 ? 0 : 0.5 + z, x);
  }
  const Finding finding = law("touches-objects")(cloth.motion());
  // vertex 5 is straight above the ball
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(finding.evidence.numbers("time")[k] == cloth.frames[k].time);
    CHECK(finding.evidence.numbers("distance of the nearest vertex from an object")[k] ==
          exactly(cloth.frames[k].x(2, 5) + 0.1));
  }
  CHECK(finding.verdict.measured == exactly(0.07));
  CHECK(finding.verdict.bound == exactly(r));
  CHECK(finding.verdict.uncertainty == 0);
  CHECK(finding.verdict.unit == "m");
  cloth.frames[2].x(0, 3) = foldproof::nan;
  CHECK_THROWS_WITH(law("touches-objects")(cloth.motion()), "frame 2: a position is not finite");
  for (const char* key :
       {"makes_contact", "is_pinched", "lies_inside", "stays_between", "sticks"}) {
    Case one = sheet(ball);
    one.expectations = {{key, 1, ""}};
    Frames frames(one);
    frames.add(0, one.scene.x);
    const std::string missing = frames.missing(law("touches-objects"));
    CHECK(missing.starts_with("contact: the case") == (std::string(key) == "sticks"));
    Case bare = sheet("");
    bare.expectations = one.expectations;
    Frames without(bare);
    without.add(0, bare.scene.x);
    CHECK_THAT(without.missing(law("touches-objects")), StartsWith("objects: the case has no"));
  }
}

TEST_CASE("laws of frames: strains beyond a limit, and what rounding adds to the tolerance") {
  const std::string limits =
      "[stretch]\nstiffness = 31\n[strain_limits]\nextension = 0.13\ncompression = 0.04\n"
      "tolerance = 0.003\n";
  const auto finding = [&](const std::vector<Expectation>& expected) {
    Case of = sheet(limits);
    of.expectations = expected;
    Frames cloth(of);
    add_moving(cloth, Vector3(0.2, 0.1, 0.3));
    Table measured = law("springs-stay-within-limits")(cloth.motion()).evidence;
    for (std::size_t k = 0; k < cloth.frames.size(); ++k) {
      double beyond = 0;
      for (const Edge& edge : of.scene.mesh.edges) {
        const auto length = [&](const PerParticle3& x) {
          return (x.col(edge.b) - x.col(edge.a)).norm();
        };
        const double strain = length(cloth.frames[k].x) / length(of.scene.mesh.rest) - 1;
        beyond = std::max({beyond, strain - 0.13, -strain - 0.04});
      }
      CHECK(measured.numbers("time")[k] == some_times[k]);
      CHECK(measured.numbers("strain beyond a limit")[k] == exactly(beyond));
    }
    return std::pair(law("springs-stay-within-limits")(cloth.motion()).verdict,
                     2 * rounding_of(cloth.frames) / 0.1);
  };
  const auto [usual, rounding] = finding({});
  CHECK(usual.measured > 0.2);
  CHECK(usual.bound == exactly(0.003 + rounding));
  CHECK_THAT(usual.why_bound, StartsWith("the case's own limits"));
  const Verdict stated = finding({{"stays_within_strain_limits", 0.07, "so it is"}}).first;
  CHECK(stated.bound == exactly(0.07 + rounding));
  CHECK(stated.why_bound == "of the case: so it is");
  const auto missing = [](Case of) {
    Frames cloth(std::move(of));
    cloth.add(0, cloth.of.scene.x);
    return cloth.missing(law("springs-stay-within-limits"));
  };
  CHECK(missing(sheet(limits)) == "");
  CHECK_THAT(missing(sheet("[stretch]\nstiffness = 31\n")), StartsWith("a limit: the case has no"));
}
