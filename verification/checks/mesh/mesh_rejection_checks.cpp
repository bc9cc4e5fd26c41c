#include <fstream>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

/// A file that must be refused, and the words that the message must contain.
struct BadFile {
  std::string name, text;
  int line;             // named by the message
  std::string keyword;  // contained in the message
};

const char* const square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";  // four lines

std::vector<BadFile> bad_files() {
  const std::string four = square;
  return {
      {"a coordinate that is no number", "v 0 0 0\nv 1 zero 0\nv 1 1 0\nf 1 2 3\n", 2,
       "not a number"},
      {"a coordinate too large for a double", "v 0 0 0\nv 1 0 0\nv 1 1e999 0\nf 1 2 3\n", 3,
       "does not fit"},
      {"an infinite coordinate", "v 0 0 0\nv inf 0 0\nv 1 1 0\nf 1 2 3\n", 2, "not finite"},
      {"a NaN", "v 0 0 0\nv 1 0 0\nv 1 nan 0\nf 1 2 3\n", 3, "not finite"},
      {"a vertex of two numbers", "v 0 0 0\nv 1 0\nv 1 1 0\nf 1 2 3\n", 2, "a vertex of 2"},
      {"a face of two vertices", four + "f 1 2 3\nf 1 3\n", 6, "a face of 2"},
      {"an index 0", four + "f 1 2 3\nf 0 3 4\n", 6, "index 0"},
      {"an index too large", four + "f 1 2 3\nf 1 3 5\n", 6, "out of range"},
      {"a negative index too large", four + "f 1 2 3\nf 1 3 -5\n", 6, "out of range"},
      {"an index that is a word", four + "f 1 2 three\n", 5, "no corner of a face"},
      {"a corner with a bad slash", four + "f 1/x 2 3\n", 5, "no corner of a face"},
      {"an unused vertex", four + "f 1 2 3\n", 4, "unused"},
      {"a face without area", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 4\nf 1 2 3\n", 6,
       "no area"},
      {"a face of one vertex twice", four + "f 1 2 3\nf 3 4 4\n", 6, "no area"},
      {"three triangles at an edge", four + "v 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 3 5\n", 8,
       "three triangles"},
      {"opposite orientations", four + "f 1 2 3\nf 1 4 3\n", 6, "orientation"},
      {"a face given twice", four + "f 1 2 3\nf 1 3 4\nf 1 2 3\n", 7, "given twice"},
      {"two fans at a vertex", four + "v -1 0 0\nv -1 -1 0\nf 1 2 3\nf 1 3 4\nf 1 5 6\n", 1, "fan"},
      {"no face", four, 4, "without a face"},
      {"nothing", "", 1, "empty"}};
}

/// The messages without the folder of the run, so that they are the same each time.
std::string without_folder(const std::string& message) {
  const size_t slash = message.rfind('/', message.find(".obj"));
  return slash == std::string::npos ? message : message.substr(slash + 1);
}

/// Adds a row for each bad file: the number of parts that its refusal lacks.
void try_bad_files(Table& measured) {
  const ScratchFolder folder;
  const auto observe = [&](const std::string& name, const std::string& path,
                           std::vector<std::string> parts) {
    const std::string message = rejection_message([&] { read_mesh(path); });
    measured.row("file with " + name, count_missing(message, parts), without_folder(message));
  };
  for (const BadFile& bad : bad_files()) {
    const std::string path = folder.file("bad.obj");
    std::ofstream(path, std::ios::binary) << bad.text;
    observe(bad.name, path, {path + ":" + std::to_string(bad.line) + ":", bad.keyword});
  }
  const std::string missing = folder.file("missing.obj");
  observe("a file that is not there", missing, {missing, "cannot be opened"});
}

/// A mesh made by code that must be refused.
struct BadMesh {
  std::string name;
  PerParticle3 rest;
  std::vector<Triangle> triangles;
  std::vector<std::string> parts;  // of the message
};

std::vector<BadMesh> bad_meshes() {
  PerParticle3 rest(3, 4);
  rest << 0, 0.7, 0.8, 0.1, 0, 0, 0.6, 0.9, 0, 0.1, 0, 0.2;
  PerParticle3 infinite = rest, line = rest;
  infinite(2, 3) = INFINITY;
  line.col(3) = 0.4 * rest.col(0) + 0.6 * rest.col(2);
  return {{"no triangles", rest, {}, {"mesh", "no triangles"}},
          {"an index too large",
           rest,
           {{0, 1, 2}, {0, 2, 4}},
           {"triangle 1", "index 4", "out of range"}},
          {"a negative index",
           rest,
           {{0, 1, 2}, {0, 2, -3}},
           {"triangle 1", "index -3", "out of range"}},
          {"an unused vertex", rest, {{0, 1, 2}}, {"vertex 3", "unused"}},
          {"an infinite coordinate", infinite, {{0, 1, 2}, {0, 2, 3}}, {"vertex 3", "not finite"}},
          {"a triangle without area", line, {{0, 1, 2}, {0, 2, 3}}, {"triangle 1", "no area"}},
          {"a triangle without area, small",
           1e-160 * line,
           {{0, 1, 2}, {0, 2, 3}},
           {"triangle 1", "no area"}},
          {"opposite orientations", rest, {{0, 1, 2}, {0, 3, 2}}, {"triangle 1", "orientation"}}};
}

Finding bad_meshes_are_rejected() {
  Table measured("case; file, line or keyword not named [1]; message");
  try_bad_files(measured);
  for (const BadMesh& bad : bad_meshes()) {
    const std::string message =
        rejection_message([&] { make_triangle_mesh(bad.rest, bad.triangles); });
    measured.row("mesh with " + bad.name, count_missing(message, bad.parts), message);
  }
  return judge_worst(
      measured, "file, line or keyword not named", 0,
      "each refusal must name the place, file and line or triangle or vertex, and the reason");
}

Finding small_and_large_meshes_are_accepted() {
  Table measured{{"case", ""}, {"meshes refused", "1"}};
  const TriangleMesh mesh = make_sheet({SheetPattern::one_diagonal, 0.7, 0.4, 4, 3});
  for (const double size : {1e-150, 1e-9, 3.0, 1e9, 1e150}) {
    const std::string message =
        rejection_message([&] { make_triangle_mesh(size * mesh.rest, mesh.triangles); });
    char name[32];
    std::snprintf(name, sizeof name, "size %g m", size);
    measured.row(name, message.empty() ? 0 : 1);
  }
  return judge_worst(measured, 0,
                     "whether a triangle has an area does not depend on the unit of length");
}

}  // namespace

std::vector<Check> mesh_rejection_checks() {
  return {{"mesh.invalid-meshes-are-rejected",
           "The reference refuses every mesh that is not an oriented manifold and every malformed "
           "OBJ file, naming the place and the reason.",
           "a rule of this suite: nothing fails in silence", bad_meshes_are_rejected},
          {"mesh.good-meshes-of-any-size-are-accepted",
           "The reference accepts a good mesh whatever its size, from 1e-150 m to 1e150 m.",
           "a rule of this suite: no hidden scale", small_and_large_meshes_are_accepted}};
}

}  // namespace foldproof
