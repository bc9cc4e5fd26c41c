#include "reference/scene/read_cloth_mesh.h"

#include <cmath>
#include <filesystem>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/pattern.h"
#include "reference/mesh/seams.h"
#include "reference/mesh/shapes.h"
#include "reference/mesh/split_fans.h"
#include "reference/scene/key_values.h"

namespace foldproof {

namespace {

struct PatternName {
  const char* name;
  SheetPattern pattern;
};

constexpr PatternName patterns[] = {
    {"one_diagonal", SheetPattern::one_diagonal},       {"alternating", SheetPattern::alternating},
    {"union_jack", SheetPattern::union_jack},           {"criss_cross", SheetPattern::criss_cross},
    {"equilateral", SheetPattern::equilateral},         {"jittered", SheetPattern::jittered},
    {"random_delaunay", SheetPattern::random_delaunay},
};

SheetPattern read_pattern(const KeyTable& keys) {
  const std::string wanted = keys.text_or("pattern", "one_diagonal");
  std::string known;
  for (const auto& [name, pattern] : patterns) {
    if (name == wanted) return pattern;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw InputError(keys.where("pattern") + ": unknown pattern '" + wanted + "'; known: " + known);
}

int count(const KeyTable& keys, const std::string& key) {
  const long value = keys.integer(key);
  if (!(value >= 1 && value <= 1'000'000))
    throw InputError(keys.where(key) + ": '" + key + "' must lie in 1 .. 1,000,000");
  return int(value);
}

TriangleMesh read_sheet(const KeyTable& keys, const SceneLimits& limits) {
  Sheet sheet;
  sheet.pattern = read_pattern(keys);
  sheet.width = keys.number("width");
  sheet.height = keys.number("height");
  sheet.columns = count(keys, "columns");
  sheet.rows = count(keys, "rows");
  // at most three in the other patterns
  const double in_a_cell = sheet.pattern == SheetPattern::criss_cross ? 4 : 3;
  reject_many_triangles(keys, "columns", in_a_cell * sheet.columns * sheet.rows, limits);
  sheet.jitter = keys.number_or("jitter", 0);
  const long seed = keys.integer_or("seed", 1);
  if (!(seed >= 0 && seed <= 4294967295))
    throw InputError(keys.where("seed") + ": 'seed' must lie in 0 .. 4294967295");
  sheet.seed = unsigned(seed);
  const bool is_jittered = sheet.pattern == SheetPattern::jittered;
  for (const char* key : {"jitter", "seed"})
    if (keys.has(key) && !is_jittered &&
        (key[0] == 'j' || sheet.pattern != SheetPattern::random_delaunay))
      throw InputError(keys.where(key) + ": '" + key + "' changes nothing in this pattern; give " +
                       "pattern = \"jittered\", or leave it out");
  sheet.grading = keys.number_or("grading", 1);
  return make_sheet(sheet);
}

TriangleMesh read_disc(const KeyTable& keys, const SceneLimits& limits) {
  const int rings = count(keys, "rings");
  reject_many_triangles(keys, "rings", 6.0 * rings * rings, limits);
  return make_disc(keys.number("radius"), rings);
}

TriangleMesh read_cylinder(const KeyTable& keys, const SceneLimits& limits) {
  const int around = count(keys, "around"), along = count(keys, "along");
  reject_many_triangles(keys, "around", 2.0 * around * along, limits);
  return make_cylinder(keys.number("radius"), keys.number("height"), around, along);
}

/// Division of an icosahedron: its edges are halved `subdivisions` times, or cut into `divisions`
/// parts.
struct Fineness {
  int subdivisions, divisions;  // one of them is 0
};

Fineness read_fineness(const KeyTable& keys, const SceneLimits& limits) {
  if (keys.has("divisions")) {
    if (keys.has("subdivisions"))
      throw InputError(keys.where("divisions") + ": give 'subdivisions' or 'divisions', not both");
    const int divisions = count(keys, "divisions");
    reject_many_triangles(keys, "divisions", 20.0 * divisions * divisions, limits);
    return {0, divisions};
  }
  const int subdivisions = count(keys, "subdivisions");
  reject_many_triangles(keys, "subdivisions", std::ldexp(20.0, 2 * subdivisions), limits);
  return {subdivisions, 0};
}

TriangleMesh read_sphere(const KeyTable& keys, const SceneLimits& limits) {
  const Fineness fineness = read_fineness(keys, limits);
  const double radius = keys.number("radius");
  return fineness.divisions > 0 ? make_geodesic_sphere(radius, fineness.divisions)
                                : make_icosphere(radius, fineness.subdivisions);
}

TriangleMesh read_statue(const KeyTable& keys, const SceneLimits& limits) {
  const Fineness fineness = read_fineness(keys, limits);
  const double height = keys.number("height");
  return fineness.divisions > 0 ? make_even_statue(height, fineness.divisions)
                                : make_statue(height, fineness.subdivisions);
}

TriangleMesh make_shape(const KeyTable& keys, const SceneLimits& limits) {
  const std::string shape = keys.text("shape");
  if (shape == "sheet") return read_sheet(keys, limits);
  if (shape == "disc") return read_disc(keys, limits);
  if (shape == "cylinder") return read_cylinder(keys, limits);
  if (shape == "sphere") return read_sphere(keys, limits);
  if (shape == "statue") return read_statue(keys, limits);
  if (shape == "hinge")
    return make_hinge(keys.number("length"), keys.number("angle") * radians_per_degree);
  throw InputError(keys.where("shape") + ": unknown shape '" + shape +
                   "'; known: sheet, disc, cylinder, sphere, statue, hinge");
}

/// Reads the mesh file, sews its panels together if `seams` is given, and with `repair` splits
/// vertices that connect parts in a single point.
PlacedMesh read_mesh(const KeyTable& keys, const std::string& folder) {
  enum class ClothRepair { refuse, split };
  const std::string file = mesh_file(keys, folder, "cloth");
  const auto repair = choice<ClothRepair>(
      keys, "repair", {{"refuse", ClothRepair::refuse}, {"split", ClothRepair::split}});
  MeshFile read = read_mesh_file(file);
  TriangleSoup soup = std::move(read.soup);
  UnsewnMesh unsewn;
  if (keys.has("seams")) {
    unsewn = {soup.triangles, soup.rest.cols(), positive(keys, "seams")};
    soup = close_seams(std::move(soup), unsewn.distance);
  }
  if (repair == ClothRepair::refuse)
    return {make_triangle_mesh(std::move(soup.rest), std::move(soup.triangles), soup.origin),
            {},
            {},
            std::move(unsewn),
            1,
            std::move(read.groups)};
  const Eigen::Index vertices = soup.rest.cols();
  SplitMesh split = split_fans(std::move(soup));
  if (split.mesh.particles() == vertices) split.copy_of.clear();
  return {std::move(split.mesh), {}, std::move(split.copy_of),
          std::move(unsewn),     1,  std::move(read.groups)};
}

PlacedMesh read_or_make(const KeyTable& cloth, const std::string& folder,
                        const SceneLimits& limits) {
  if (cloth.has("mesh")) return read_mesh(cloth, folder);
  return {with_error_location(cloth.where("shape"), [&] { return make_shape(cloth, limits); }), {}};
}

/// Rotates and translates the positions, in this order.
void place(const KeyTable& keys, PerParticle3& x) {
  if (keys.has("turn")) {
    const PerParticle3 rotated = read_turn(keys).toRotationMatrix() * x;
    x = rotated;
  }
  x.colwise() += keys.vector_or("move", Vector3::Zero());
}

/// The positions (3 x n [m]) and copies of them, each rotated and moved from the one before.
PerParticle3 repeat(const PerParticle3& x, int copies, const Eigen::Matrix3d& turn,
                    const Vector3& move) {
  const Eigen::Index n = x.cols();
  PerParticle3 all(3, n * copies);
  all.leftCols(n) = x;
  for (Eigen::Index c = 1; c < copies; ++c) {
    const PerParticle3 before = all.middleCols((c - 1) * n, n);
    const Vector3 middle = before.rowwise().mean();
    all.middleCols(c * n, n) =
        (turn * (before.colwise() - middle)).colwise() + Vector3(middle + move);
  }
  return all;
}

/// Copies of the cloth; their rest shapes are moved, too, so that they lie apart.
void copy(const KeyTable& keys, const SceneLimits& limits, PlacedMesh& cloth) {
  const int copies = count(keys, "count"), n = cloth.mesh.particles();
  reject_many_triangles(keys, "count", double(copies) * double(cloth.mesh.triangles.size()),
                        limits);
  const Vector3 move = keys.vector("move");
  const Eigen::Matrix3d turn = read_turn(keys).toRotationMatrix();
  std::vector<Triangle> triangles;
  for (int c = 0; c < copies; ++c)
    for (const Triangle& t : cloth.mesh.triangles)
      triangles.push_back({c * n + t[0], c * n + t[1], c * n + t[2]});
  const std::vector<FlatTriangle> pattern = std::move(cloth.mesh.pattern);
  const FaceGroups groups = cloth.groups;
  const int per_copy = int(cloth.mesh.triangles.size());
  cloth.mesh =
      make_triangle_mesh(repeat(cloth.mesh.rest, copies, turn, move), std::move(triangles));
  cloth.start = repeat(cloth.start, copies, turn, move);
  const std::vector<int> of_one = cloth.copy_of;
  for (int c = 1; c < copies; ++c)
    for (const int v : of_one) cloth.copy_of.push_back(c * n + v);
  for (int c = 0; c < copies; ++c)
    cloth.mesh.pattern.insert(cloth.mesh.pattern.end(), pattern.begin(), pattern.end());
  for (const auto& [name, of_first] : groups)
    for (int c = 1; c < copies; ++c)
      for (const int t : of_first) cloth.groups[name].push_back(c * per_copy + t);
}

/// Gives the mesh the flat pattern that 'pattern' names.
void read_flat_pattern(const KeyTable& cloth, const std::string& folder, TriangleMesh& mesh) {
  for (const char* key : {"pleats", "repair"})
    if (cloth.has(key))
      throw InputError(cloth.where(key) + ": '" + std::string(key) +
                       "' does not go with the flat pattern of a mesh");
  if (cloth.text("pattern") == "vt") {
    if (!cloth.has("pattern_scale"))
      throw InputError(cloth.where("pattern") +
                       ": texture coordinates have no unit; give pattern_scale, the metres in one "
                       "of theirs");
    MeshFile read = read_mesh_file(mesh_file(cloth, folder, "cloth"));
    mesh.pattern = pattern_of_textures(std::move(read.textures), positive(cloth, "pattern_scale"),
                                       read.soup.origin);
    return;
  }
  const std::string file = path_of(cloth, "pattern", folder);
  if (!std::filesystem::exists(file))
    throw InputError(cloth.where("pattern") + ": there is no mesh file '" + file +
                     "'; 'pattern' names the flat panels of the mesh");
  const double scale =
      positive_or(cloth, "pattern_scale", cloth.has("scale") ? positive(cloth, "scale") : 1);
  mesh.pattern = pattern_of(read_mesh_file(file).soup, scale, mesh);
}

}  // namespace

std::string mesh_file(const KeyTable& keys, const std::string& folder, const std::string& table) {
  const std::string file = path_of(keys, "mesh", folder);
  const std::string where = keys.where("mesh");
  if (file.empty())
    throw InputError(where + ": this case takes a mesh of yours: --set " + table +
                     ".mesh=FILE.obj");
  if (!std::filesystem::exists(file))
    throw InputError(where + ": there is no mesh file '" + file + "'");
  return file;
}

double fit_factor(const KeyTable& keys, const PerParticle3& x) {
  if (keys.has("scale")) {
    if (keys.has("fit"))
      throw InputError(keys.where("scale") + ": 'fit' and 'scale' both set the size; give one");
    return positive(keys, "scale");
  }
  if (!keys.has("fit")) return 1;
  const double size = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
  const double wanted = keys.number("fit");
  if (!(wanted > 0)) throw InputError(keys.where("fit") + ": 'fit' must be > 0 m");
  return wanted / size;
}

double scale_to_fit(const KeyTable& keys, PerParticle3& x) {
  const double factor = fit_factor(keys, x);
  x *= factor;
  return factor;
}

PlacedMesh read_cloth_mesh(const KeyTable& cloth, const std::string& folder,
                           const SceneLimits& limits) {
  if (cloth.has("shape") == cloth.has("mesh"))
    throw InputError(cloth.where("mesh") +
                     ": [cloth] needs either 'shape' or 'mesh' (an OBJ or PLY file), and not both");
  PlacedMesh result = read_or_make(cloth, folder, limits);

  const auto pleats = cloth.table("pleats");
  result.start = result.mesh.rest;
  if (pleats) {
    result.mesh.rest = with_error_location(cloth.where("pleats"), [&] {
      return pleated_positions(result.mesh, count(*pleats, "columns"),
                               pleats->number("angle") * radians_per_degree);
    });
    if (!pleats->flag_or("start_flat", true)) result.start = result.mesh.rest;
  }
  result.scale = scale_to_fit(cloth, result.start);
  result.unsewn.distance *= result.scale;
  place(cloth, result.start);
  if (!pleats) result.mesh.rest = result.start;
  if (cloth.has("mesh") && cloth.has("pattern")) read_flat_pattern(cloth, folder, result.mesh);
  if (const auto copies = cloth.table("copies"))
    with_error_location(cloth.where("copies"), [&] { copy(*copies, limits, result); });
  for (const char* key : {"fit", "scale"})
    if (pleats && cloth.has(key))
      throw InputError(cloth.where(key) + ": '" + key + "' does not go with pleats");
  return result;
}

}  // namespace foldproof
