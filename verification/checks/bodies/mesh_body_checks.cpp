// Checks of bodies that a case file takes from OBJ files.
#include <filesystem>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/mesh_file.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/random.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

constexpr double radius = 0.7;  // m

std::string body(const std::string& file, const std::string& keys) {
  return "[[object]]\nmesh = \"" + std::filesystem::path(file).filename().string() + "\"\n" + keys +
         "\n";
}

/// A case in the same folder as the file.
Scene read_case_beside(const std::string& file, const std::string& keys) {
  const std::string path = std::filesystem::path(file).replace_filename("trial.toml").string();
  return trial_scene(body(file, keys), {}, path);
}

/// Direction of the triangles that are left out first [1].
Vector3 above_the_hole() {
  const TriangleMesh ball = make_icosphere(radius, 3);
  return ball.rest.col(ball.triangles[0][1]).normalized();
}

/// A ball of 1280 triangles; the first `missing` are left out, and triangles 100 to 100 + `flipped`
/// are reversed.
std::string write_ball(const ScratchFolder& folder, int missing, int flipped) {
  TriangleMesh ball = make_icosphere(radius, 3);
  for (int t = 100; t < 100 + flipped; ++t) std::swap(ball.triangles[t][0], ball.triangles[t][1]);
  ball.triangles.erase(ball.triangles.begin(), ball.triangles.begin() + missing);
  const std::string path = folder.file("ball.obj");
  write_obj(path, ball.rest, ball.triangles);
  return path;
}

Finding open_bodies_are_rejected() {
  const ScratchFolder folder;
  Table measured{{"case", ""}, {"file, reason or remedy missing from the refusal", "1"}};
  const auto observe = [&](const std::string& name, const std::string& file,
                           const std::string& keys, const std::vector<std::string>& parts) {
    const std::string message = rejection_message([&] { read_case_beside(file, keys); });
    measured.row(name, count_missing(message, parts));
  };
  observe("hole", write_ball(folder, 1, 0), "", {"ball.obj:", "a hole", "repair"});
  observe("hole, exact distance", write_ball(folder, 1, 0), "field = \"exact\"",
          {"ball.obj:", "a hole"});
  observe("flipped triangles", write_ball(folder, 0, 3), "", {"ball.obj:", "opposite orientation"});
  observe("exact distance and repair", write_ball(folder, 1, 0),
          "field = \"exact\"\nrepair = \"winding\"", {"repair", "grid"});
  observe("an unknown repair", write_ball(folder, 1, 0), "repair = \"glue\"", {"glue", "winding"});
  return judge_worst(measured, 0, "each refusal must name the file or the key, and the reason");
}

/// Largest error of phi at distances 0.5 to 1.2 from the ball's centre; half of the points are
/// below or above the triangles that may be missing [cells].
double error_of(const Scene& scene, double cell) {
  const auto solid = std::get<RigidObject>(build_objects(scene, computing_provider()).at(0).body);
  Random random(109);
  Worst worst;
  for (int i = 0; i < 500; ++i) {
    const Vector3 hole = i % 2 == 0 ? Vector3(Vector3::Zero()) : Vector3(5 * above_the_hole());
    const Vector3 p = (hole + random.vectors(1, 1).col(0)).normalized() * random.uniform(0.5, 1.2);
    worst.observe(std::abs(solid.at(p, {0, 0, 1}).phi - (p.norm() - radius)) / cell);
  }
  return worst.value();
}

Finding bodies_are_solid() {
  const ScratchFolder folder;
  constexpr double cell = 2 * radius / 32;
  Table measured{{"case", ""}, {"largest error of phi", "cells"}};
  measured.row("whole, grid",
               error_of(read_case_beside(write_ball(folder, 0, 0), "cells = 32"), cell));
  measured.row("whole, exact",
               error_of(read_case_beside(write_ball(folder, 0, 0), "field = \"exact\""), cell));
  measured.row(
      "four triangles missing, seven flipped",
      error_of(read_case_beside(write_ball(folder, 4, 7), "cells = 32\nrepair = \"winding\""),
               cell));
  return judge_worst(
      measured, 1,
      "faces lie up to 0.15 cells within the ball; a hole of four triangles is three cells wide, "
      "and a membrane over it flatter than the ball by half a cell");
}

}  // namespace

std::vector<Check> mesh_body_checks() {
  return {{"level-set.cases-reject-open-bodies",
           "A case whose body has holes or flipped triangles is refused with the line of the "
           "body's file.",
           "ours", open_bodies_are_rejected},
          {"level-set.bodies-from-obj-files-have-the-right-distance",
           "A body from an OBJ file of a ball, intact or repaired, has the ball's distance.",
           "ours", bodies_are_solid}};
}

}  // namespace foldproof
