#include "reference/scene/read_bodies.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include "reference/bodies/body_deformation.h"
#include "reference/bodies/closed_mesh.h"
#include "reference/mesh/mesh_file.h"
#include "reference/mesh/seams.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/key_values.h"
#include "reference/scene/read_cloth_mesh.h"

namespace foldproof {

namespace {

Repair read_repair(const KeyTable& keys) {
  return choice<Repair>(keys, "repair", {{"refuse", Repair::refuse}, {"winding", Repair::winding}});
}

/// scale: set to the factor of 'fit'.
TriangleSoup read_soup(const KeyTable& keys, const CaseContext& context, double& scale) {
  TriangleSoup soup;
  if (keys.has("shape") && keys.text("shape") != "statue")
    throw InputError(keys.where("shape") +
                     ": a body that deforms needs a mesh: shape = \"statue\", 'mesh' or 'frames'");
  if (keys.has("mesh")) {
    soup = without_unused_vertices(read_mesh_file(mesh_file(keys, context.folder, "object")).soup);
    if (keys.has("seams")) soup = close_seams(std::move(soup), positive(keys, "seams"));
  } else {
    const int subdivisions = int(count_or(keys, "subdivisions", 4));
    reject_many_triangles(keys, "subdivisions", std::ldexp(20.0, 2 * subdivisions), context.limits);
    TriangleMesh statue = with_error_location(
        keys.where("shape"), [&] { return make_statue(positive(keys, "height"), subdivisions); });
    soup = {std::move(statue.rest), std::move(statue.triangles), {}};
  }
  scale = scale_to_fit(keys, soup.rest);
  return soup;
}

/// The width of the finest cells: the longest side of the body at rest over the key `cells` [m].
double read_cell(const KeyTable& keys, const PerParticle3& x) {
  return bounds_of(x).sizes().maxCoeff() / double(count_or(keys, "cells", 64));
}

/// By default the octree's error may be a tenth of a cell: the error cell^2/(4 r) of a finest cell
/// on a surface of radius r = 2.5 cells.
OctreeSettings read_octree(const KeyTable& keys, const Bounds& bounds, double cell) {
  const double tolerance = positive_or(keys, "tolerance", cell / 10);
  return with_error_location(keys.where("cells"),
                             [&] { return octree_about(bounds, cell, tolerance); });
}

/// The largest error allowed, regardless of `cells` [m]; 0: none is given.
double read_accuracy(const KeyTable& keys, bool is_stored, Repair repair) {
  if (!keys.has("accuracy")) return 0;
  if (!is_stored)
    throw InputError(keys.where("accuracy") + ": field = \"exact\" has no error to choose");
  if (repair == Repair::winding)
    throw InputError(keys.where("accuracy") +
                     ": a mesh that is repaired has no exact distance to compare with");
  return positive(keys, "accuracy");
}

/// The refusal of make_closed_mesh, with the name of the frame and its own remedy.
void reject_open_frame(const MeshSequence& animation, size_t k, const std::string& where,
                       const std::string& remedy) {
  try {
    make_closed_mesh({animation.positions[k], animation.triangles, {}});
  } catch (const InputError& error) {
    std::string message = error.what();
    if (!message.ends_with("sews it"))
      message = message.substr(0, message.rfind(';')) + "; " + remedy;
    throw InputError(where + ": frame " + std::to_string(k) + " (" +
                     std::to_string(animation.times[k]) + " s): " + message);
  }
}

/// A folder of frames lies within the case file's folder; so must the targets of its links.
void reject_links_outside(const std::string& path, const std::string& case_folder,
                          const std::string& where) {
  std::error_code none;  // its reader refuses a missing folder
  for (const auto& entry : std::filesystem::directory_iterator(path, none))
    reject_outside(entry.path().string(), case_folder, where);
}

/// The recipe with the place of the key that sets the resolution of the field.
template <class Recipe>
std::shared_ptr<const FieldRecipe> recipe_of(const KeyTable& keys, Recipe of, double accuracy = 0) {
  const std::string where = keys.where(accuracy > 0 ? "accuracy" : "cells");
  return std::make_shared<const FieldRecipe>(FieldRecipe{std::move(of), where, accuracy});
}

/// The triangles of frames that have none, such as PC2's.
std::vector<Triangle> read_triangles(const KeyTable& keys, const CaseContext& context) {
  if (!keys.has("mesh")) return {};
  return read_mesh_file(mesh_file(keys, context.folder, "object")).soup.triangles;
}

MeshSequence read_frames(const KeyTable& keys, const CaseContext& context, Repair repair,
                         double& scale) {
  const std::string where = keys.where("frames");
  const std::string path = path_of(keys, "frames", context.folder);
  if (!is_override(where)) reject_links_outside(path, context.folder, where);
  const SequenceSource source{path, keys.has("interval") ? positive(keys, "interval") : 0,
                              read_triangles(keys, context), long(context.limits.frames),
                              repair == Repair::winding ? Inside::winding : Inside::normals};
  MeshSequence animation = with_error_location(where, [&] { return read_mesh_sequence(source); });
  if (keys.has("seams"))
    close_seams_in_motion(animation.positions, animation.triangles, positive(keys, "seams"), path);
  scale = fit_factor(keys, animation.positions.front());
  for (PerParticle3& x : animation.positions) x *= scale;
  if (repair == Repair::winding)
    animation.triangles =
        outward_patches({animation.positions.front(), animation.triangles, {}}).triangles;
  return animation;
}

BodyDeformation read_deformation(const KeyTable& keys) {
  const auto kind = choice<DeformationKind>(keys, "kind",
                                            {{"bend", DeformationKind::bend},
                                             {"twist", DeformationKind::twist},
                                             {"breathe", DeformationKind::breathe}});
  const double unit = kind == DeformationKind::breathe ? 1 : radians_per_degree;
  return {kind, unit * keys.number("amplitude"), positive(keys, "period")};
}

/// Times 0, interval, ... up to the last one that the case needs.
std::vector<double> read_times(const KeyTable& keys, const CaseContext& context) {
  const double interval = positive_or(keys, "interval", 1.0 / 30);
  const double until = positive_or(keys, "until", context.end);
  const double count = std::ceil(until / interval * (1 - 1e-9));
  if (!(count < context.limits.frames))
    throw InputError(keys.where("interval") + ": more than " +
                     std::to_string(long(context.limits.frames)) +
                     " level sets; a longer 'interval' or an earlier 'until' gives fewer");
  std::vector<double> times;
  for (long k = 0; k <= long(count); ++k) times.push_back(double(k) * interval);
  return times;
}

void transform_positions(const Pose& place, PerParticle3& x) {
  for (Eigen::Index i = 0; i < x.cols(); ++i) x.col(i) = to_world(place, x.col(i));
}

/// The body in its place, carried through its deformations.
MeshSequence read_deformed(const KeyTable& keys, const Pose& place, const CaseContext& context,
                           Repair repair, double& scale) {
  TriangleSoup soup = read_soup(keys, context, scale);
  TriangleMesh mesh = repair == Repair::winding
                          ? TriangleMesh{soup.rest, outward_patches(soup).triangles, {}, {}}
                          : make_closed_mesh(std::move(soup));
  transform_positions(place, mesh.rest);
  std::vector<BodyDeformation> parts;
  for (const auto& part : keys.tables("deform")) parts.push_back(read_deformation(*part));
  MeshSequence sequence = deformed_mesh(
      mesh, deformation_of(std::move(parts), bounds_of(mesh.rest)), read_times(keys, context));
  if (repair == Repair::winding) sequence.inside = Inside::winding;
  return sequence;
}

}  // namespace

bool is_deforming(const KeyTable& keys) { return keys.has("frames") || keys.has("deform"); }

BodyShape read_mesh_body(const KeyTable& keys, const CaseContext& context) {
  enum class Field { grid, octree, exact };
  double scale = 1;
  TriangleSoup soup = read_soup(keys, context, scale);
  const auto field = choice<Field>(
      keys, "field", {{"grid", Field::grid}, {"octree", Field::octree}, {"exact", Field::exact}});
  const Repair repair = read_repair(keys);
  const double accuracy = read_accuracy(keys, field != Field::exact, repair);
  // known to all kinds of field, so that one --set can switch between them
  const int cells = int(count_or(keys, "cells", 64));
  ObjectSurface surface{soup.rest, soup.triangles};
  if (repair == Repair::refuse) make_closed_mesh(soup);  // to refuse a mesh that is not closed
  if (field == Field::grid) {
    const GridMethod method{cells, 4, 3, MarchingOrder::second};
    return {GridSolid{}, std::move(surface),
            recipe_of(keys, GridRecipe{std::move(soup), method, repair}, accuracy), scale};
  }
  if (field == Field::exact && repair != Repair::refuse)
    throw InputError(keys.where("repair") +
                     ": 'repair' needs field = \"grid\" or \"octree\": the exact distance has no "
                     "sign where triangles are missing or cross");
  if (field == Field::octree) {
    const OctreeSettings settings =
        read_octree(keys, bounds_of(soup.rest), read_cell(keys, soup.rest));
    OctreeRecipe recipe{soup.rest, soup.triangles, settings};
    if (repair == Repair::winding) {
      recipe.triangles = outward_patches(soup).triangles;
      recipe.inside = Inside::winding;
    }
    return {OctreeSolid{}, std::move(surface), recipe_of(keys, std::move(recipe), accuracy), scale};
  }
  return {MeshSolid{}, std::move(surface), recipe_of(keys, ExactRecipe{soup.rest, soup.triangles}),
          scale};
}

DeformingShape read_deforming_body(const KeyTable& keys, const Pose& place,
                                   const CaseContext& context) {
  enum class Field { octree };
  choice<Field>(keys, "field", {{"octree", Field::octree}});
  const auto between = choice<BetweenFrames>(
      keys, "interpolation",
      {{"carried", BetweenFrames::carried}, {"blended", BetweenFrames::blended}});
  const Repair repair = read_repair(keys);
  const bool is_read = keys.has("frames");
  if (is_read && keys.has("deform"))
    throw InputError(keys.where("deform") +
                     ": 'frames' are an animation; they do not go with [[object.deform]]");
  double scale = 1;
  auto animation = is_read ? read_frames(keys, context, repair, scale)
                           : read_deformed(keys, place, context, repair, scale);
  if (is_read)
    for (PerParticle3& x : animation.positions) transform_positions(place, x);
  Bounds bounds;
  for (size_t k = 0; k < animation.times.size(); ++k) {
    if (repair == Repair::refuse)
      reject_open_frame(animation, k, keys.where(is_read ? "frames" : "deform"),
                        is_read ? "mend it, or set repair = \"winding\""
                                : "give a smaller amplitude, or set repair = \"winding\"");
    bounds.extend(bounds_of(animation.positions[k]));
  }
  const OctreeSettings settings =
      read_octree(keys, bounds, read_cell(keys, animation.positions.front()));
  const auto shared = std::make_shared<const MeshSequence>(std::move(animation));
  return {shared, recipe_of(keys, AnimationRecipe{shared, settings, between}), scale};
}

}  // namespace foldproof
