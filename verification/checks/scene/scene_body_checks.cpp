// Bodies of triangles in a case: sampled by an octree, and deforming.
#include <filesystem>
#include <fstream>

#include "reference/bodies/level_set_provider.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/mesh/mesh_file.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/random.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

constexpr double radius = 0.13;      // m
constexpr double degree = pi / 180;  // rad

/// A ball as an OBJ file, and an [[object]] that uses it with these keys.
std::string ball_body(const ScratchFolder& folder, const std::string& keys) {
  const TriangleMesh ball = make_icosphere(radius, 3);
  write_obj(folder.file("ball.obj"), ball.rest, ball.triangles);
  return "[[object]]\nmesh = \"ball.obj\"\n" + keys + "\n";
}

/// A case in the folder.
Scene read_case_in(const ScratchFolder& folder, const std::string& tables) {
  return trial_scene(tables, {}, folder.file("trial.toml"));
}

/// The first object as it is built.
Object first_object(const Scene& scene) { return build_objects(scene, computing_provider()).at(0); }

Octree octree_of(const Scene& scene) {
  return *std::get<OctreeSolid>(std::get<RigidObject>(first_object(scene).body).solid).tree;
}

/// The largest error near the surface, at points on both sides of the ball's faces [tolerances].
double octree_miss(const Octree& tree) {
  const TriangleMesh ball = make_icosphere(radius, 3);
  const MeshDistance exact = make_mesh_distance(ball.rest, ball.triangles);
  Random random(4451);
  Worst worst;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 p = random.vectors(1, 1).col(0).normalized() * radius * random.uniform(0.9, 1.1);
    worst.observe(std::abs(tree.at(p).phi - exact.at(p).phi) / tree.settings.tolerance);
  }
  return worst.value();
}

Finding octree_finding() {
  const ScratchFolder folder;
  const Octree coarse =
      octree_of(read_case_in(folder, ball_body(folder, "field = \"octree\"\ncells = 23")));
  const Octree given = octree_of(
      read_case_in(folder, ball_body(folder, "field = \"octree\"\ncells = 41\ntolerance = 5e-4")));
  const auto cell = [](const Octree& tree) {
    return tree.settings.width / std::pow(2.0, tree.settings.depth);
  };
  const PerParticle3 x = make_icosphere(radius, 3).rest;
  const double longest = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
  Table measured{{"case", ""},
                 {"miss in tolerances, or a hundred roundings off what was written", "1"}};
  measured.row("finest cells", std::abs(cell(coarse) * 23 / longest - 1) / (100 * epsilon));
  measured.row("finest cells, other number",
               std::abs(cell(given) * 41 / longest - 1) / (100 * epsilon));
  measured.row("a tenth of a cell",
               std::abs(coarse.settings.tolerance / (0.1 * cell(coarse)) - 1) / (100 * epsilon));
  measured.row("tolerance as written", given.settings.tolerance == 5e-4 ? 0 : INFINITY);
  measured.row("distances", octree_miss(coarse));
  measured.row("distances, tolerance as written", octree_miss(given));
  return judge_worst(measured, 2,
                     "an octree keeps its tolerance, to which hanging nodes add another");
}

/// Position of the body's point X, derived independently of the reference: about the centre of the
/// arc, at R = height/angle beside the base.
Vector3 bend_point(const Vector3& X, double angle, double height) {
  const double R = height / angle, phi = X.y() / R;
  return {R - (R - X.x()) * std::cos(phi), (R - X.x()) * std::sin(phi), X.z()};
}

Vector3 twist_point(const Vector3& X, double angle, double height) {
  return Eigen::AngleAxisd(angle * X.y() / height, Vector3::UnitY()) * X;
}

Vector3 breathe_point(const Vector3& X, double growth, double height) {
  const double from_middle = 2 * X.y() / height - 1;
  const double factor = 1 + growth * (1 - from_middle * from_middle);
  return {factor * X.x(), X.y(), factor * X.z()};
}

using Shaping = std::function<Vector3(const Vector3& X, double share, double height)>;

/// Largest distance of the drawn surface from the placed ball, deformed by hand; heights are
/// measured from its lowest point [m].
double surface_miss(const Scene& scene, const Shaping& shaping, double period, double t) {
  const TriangleMesh ball = make_icosphere(radius, 3);
  const Vector3 move(0.2, -0.1, 0.3);
  PerParticle3 x(3, ball.particles());
  for (int i = 0; i < ball.particles(); ++i)
    x.col(i) = Eigen::AngleAxisd(30 * degree, Vector3(1, 2, 2) / 3) * ball.rest.col(i) + move;
  const Vector3 low = x.rowwise().minCoeff(), high = x.rowwise().maxCoeff(),
                middle = (low + high) / 2;
  const Vector3 base(middle.x(), low.y(), middle.z());
  const double share = std::pow(std::sin(pi * t / period), 2);
  const PerParticle3 seen = surface_at(scene.objects.at(0), t);
  Worst worst;
  for (int i = 0; i < ball.particles(); ++i)
    worst.observe((shaping(x.col(i) - base, share, (high - low).y()) + base - seen.col(i)).norm());
  return worst.value();
}

const std::string place = "turn = { axis = [1, 2, 2], angle = 30 }\nmove = [0.2, -0.1, 0.3]\n";

std::string deform(const std::string& kind, double amplitude, double period) {
  return "[[object.deform]]\nkind = \"" + kind + "\"\namplitude = " + std::to_string(amplitude) +
         "\nperiod = " + std::to_string(period) + "\n";
}

Finding deformation_finding() {
  const ScratchFolder folder;
  const std::string keys = place + "cells = 12\ninterval = 0.05\n";
  Differences differences;
  const auto observe = [&](const std::string& what, const std::string& parts,
                           const Shaping& shaping, double period) {
    const Scene scene = read_case_in(folder, ball_body(folder, keys + parts));
    for (const double t : {0.0, 0.05, 0.2, 0.3})
      differences.is_near(what + " at " + std::to_string(t) + " s",
                          surface_miss(scene, shaping, period, t));
    const PerParticle3 between =
        (surface_at(scene.objects[0], 0.1) + surface_at(scene.objects[0], 0.15)) / 2;
    differences.is_near(what + " between frames",
                        (surface_at(scene.objects[0], 0.125) - between).cwiseAbs().maxCoeff());
  };
  observe(
      "bend", deform("bend", 70, 0.47),
      [](const Vector3& X, double share, double height) {
        return share == 0 ? X : bend_point(X, 70 * degree * share, height);
      },
      0.47);
  observe(
      "twist", deform("twist", -130, 0.31),
      [](const Vector3& X, double share, double height) {
        return twist_point(X, -130 * degree * share, height);
      },
      0.31);
  observe(
      "breathe", deform("breathe", 0.35, 0.61),
      [](const Vector3& X, double share, double height) {
        return breathe_point(X, 0.35 * share, height);
      },
      0.61);
  observe(
      "twist, then bend", deform("twist", 55, 0.4) + deform("bend", -40, 0.4),
      [](const Vector3& X, double share, double height) {
        const Vector3 x = twist_point(X, 55 * degree * share, height);
        return share == 0 ? x : bend_point(x, -40 * degree * share, height);
      },
      0.4);
  return differences.judged(
      100,
      "sines, cosines and products of lengths below 1 m, with a few dozen roundings in either way");
}

/// Two frames of a ball in a folder; returns the folder's name.
std::string written_frames(const ScratchFolder& folder) {
  const TriangleMesh ball = make_icosphere(radius, 2);
  const std::string frames = folder.file("frames");
  std::filesystem::create_directory(frames);
  write_obj(frames + "/b00.obj", ball.rest, ball.triangles);
  write_obj(frames + "/b01.obj", 1.1 * ball.rest, ball.triangles);
  return "frames";
}

Finding frames_finding() {
  const ScratchFolder folder;
  const std::string body = "[[object]]\nframes = \"" + written_frames(folder) +
                           "\"\ninterval = 0.07\nfit = 0.5\ncells = 12\nmove = [0.2, -0.1, 0.3]\n";
  const Scene carried = read_case_in(folder, body),
              blended = read_case_in(folder, body + "interpolation = \"blended\"\n");
  const PerParticle3 x = make_icosphere(radius, 2).rest;
  const double scale = 0.5 / (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
  const PerParticle3 first = (scale * x).colwise() + Vector3(0.2, -0.1, 0.3),
                     last = (1.1 * scale * x).colwise() + Vector3(0.2, -0.1, 0.3);
  const SceneObject& part = carried.objects.at(0);
  const auto between = [](const Scene& scene) {
    return std::get<DeformingObject>(first_object(scene).body).body->between;
  };
  Differences differences;
  differences.is_near("first frame", (surface_at(part, 0) - first).cwiseAbs().maxCoeff());
  differences.is_near("second frame", (surface_at(part, 0.07) - last).cwiseAbs().maxCoeff());
  differences.is_near("rests after it", (surface_at(part, 0.2) - last).cwiseAbs().maxCoeff());
  differences.is_near("half way",
                      (surface_at(part, 0.035) - (first + last) / 2).cwiseAbs().maxCoeff());
  differences.is("carried by default", between(carried) == BetweenFrames::carried);
  differences.is("blended if written", between(blended) == BetweenFrames::blended);
  return differences.judged(32,
                            "scaled, moved and averaged with a few roundings of lengths below 1 m");
}

/// The drawn surface lies on the level sets that the cloth touches, at frames and in between.
Finding surface_finding() {
  const ScratchFolder folder;
  Table measured{{"case", ""},
                 {"largest distance of the drawn surface from the level set", "tolerances"}};
  for (const std::string kind : {"bend", "twist", "breathe"}) {
    const Scene scene = read_case_in(
        folder, ball_body(folder, place + "cells = 16\ninterval = 0.02\n" +
                                      deform(kind, kind == "breathe" ? 0.3 : 40, 0.5)));
    const auto body = std::get<DeformingObject>(first_object(scene).body);
    const double tolerance = body.body->frames.front().field.settings.tolerance;
    Worst worst;
    for (const double t : {0.0, 0.02, 0.05, 0.23, 0.3}) {
      const PerParticle3 x = surface_at(scene.objects[0], t);
      for (Eigen::Index i = 0; i < x.cols(); ++i)
        worst.observe(std::abs(body.at(x.col(i), {t, t, 0}).phi) / tolerance);
    }
    measured.row(kind, worst.value());
  }
  return judge_worst(measured, 2,
                     "octrees miss by their tolerance, to which hanging nodes add another; carried "
                     "along, phi between frames errs by the square of the turn in a frame, 0.02 "
                     "rad, of a displacement of 5 mm: 1e-6 m, a thousandth of it");
}

/// A folder with one file more than the allowed number of frames; returns its name.
std::string too_many_frames(const ScratchFolder& folder) {
  const std::string frames = folder.file("many");
  std::filesystem::create_directory(frames);
  for (int k = 0; k <= 1000; ++k) std::ofstream(frames + "/" + std::to_string(k) + ".obj");
  return "many";
}

std::vector<RejectedCase> rejections(const ScratchFolder& folder) {
  const auto body = [&](const std::string& keys) {
    return ball_body(folder, "cells = 8\n" + keys);
  };
  const std::string twist = deform("twist", 20, 0.5),
                    sphere = "[[object]]\nshape = \"sphere\"\nradius = 0.3\n";
  const std::string frames = "[[object]]\nframes = \"" + written_frames(folder) + "\"\n";
  return {{body("field = \"octre\""), {"unknown field 'octre'", "octree", "exact"}},
          {body("field = \"octree\"\ntolerance = 0"), {"'tolerance' must be > 0"}},
          {body("field = \"exact\"\nrepair = \"winding\""), {"'repair' needs field = \"grid\""}},
          {body("tolerance = 1e-3"), {"unknown key 'tolerance'"}},
          {sphere + twist, {"needs a mesh", "statue"}},
          {body("interval = 0.2\nvelocity = [0, 0, 1]\n" + twist), {"unknown key 'velocity'"}},
          {body("field = \"grid\"\n" + twist), {"unknown field 'grid'", "octree"}},
          {body("interpolation = \"morphed\"\n" + twist),
           {"unknown interpolation 'morphed'", "carried"}},
          {body("interval = 1e-5\n" + twist), {"more than 1000 level sets", "interval"}},
          {body("interval = 0\n" + twist), {"'interval' must be > 0"}},
          {body("[[object.deform]]\nkind = \"melt\"\n"), {"unknown kind 'melt'", "breathe"}},
          {body("[[object.deform]]\nkind = \"bend\"\namplitude = 3\n"), {"period"}},
          {body("[[object.deform]]\nkind = \"bend\"\namplitude = 3\nperiod = 0\n"),
           {"'period' must be > 0"}},
          {body("interval = 0.2\n" + deform("bend", 20, 0.5) + "toward = 3\n"),
           {"unknown key 'toward'"}},
          {body("interval = 0.1\n" + deform("bend", 900, 0.6)),
           {"frame 1", "0.100000 s", "meets triangle", "smaller amplitude"}},
          {frames + twist, {"'frames' are an animation"}},
          {frames + "mesh = \"ball.obj\"\n", {"and not both"}},
          {frames + "interval = -1\n", {"'interval' must be > 0"}},
          {"[[object]]\nframes = \"" + too_many_frames(folder) + "\"\n",
           {"1001 frames", "at most 1000"}},
          {"[[object]]\nframes = \"nowhere\"\n", {"no such folder"}}};
}

Finding rejection_finding() {
  const ScratchFolder folder;
  return rejected_cases(rejections(folder), folder.file("trial.toml"));
}

}  // namespace

std::vector<Check> scene_body_checks() {
  const char* const source = "cases/KEYS.md";
  return {{"scene.octree-bodies-are-as-written",
           "The octree of a body has the cells and the tolerance that the case says, and meets the "
           "tolerance.",
           source, octree_finding},
          {"scene.deformations-are-as-written",
           "A body bends, twists and breathes as the case says, about the axis through its middle.",
           source, deformation_finding},
          {"scene.animation-frames-are-as-written",
           "The frames of an animated body are scaled, placed and timed as the case says.", source,
           frames_finding},
          {"scene.deforming-surfaces-lie-on-their-level-sets",
           "The surface drawn of a deforming body is that of the level sets that the cloth meets.",
           "BMF03 section 5.1", surface_finding},
          {"scene.invalid-bodies-are-rejected",
           "Invalid settings of octrees and deforming bodies are refused with file, line and what "
           "is known.",
           source, rejection_finding}};
}

}  // namespace foldproof
