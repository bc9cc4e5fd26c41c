// foldproof inspect: what a mesh is good for as a body.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reference/bodies/mesh_inspection.h"
#include "reference/mesh/obj.h"
#include "scripts/program/commands.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/inspect_cloth.h"
#include "scripts/program/json_text.h"

namespace foldproof {

namespace {

std::string point(const Vector3& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x(), p.y(), p.z());
}

void print(const std::string& file, const MeshInspection& found) {
  const bool is_solid = found.rejection.empty();
  fmt::print("{}: {} vertices, {} triangles\n", file, found.vertices, found.triangles);
  fmt::print("bounds: {} to {}, largest extent {:.4g} m\n", point(found.bounds.min()),
             point(found.bounds.max()), found.bounds.sizes().maxCoeff());
  if (is_solid)
    fmt::print("a solid: closed, oriented, without intersections; pieces {}, volume {:.6g} m^3\n",
               found.pieces, found.volume);
  else
    fmt::print("no solid: {}\n", found.rejection);
  if (!found.repair_failure.empty()) fmt::print("no repair: {}\n", found.repair_failure);
  if (found.nodes > 0)
    fmt::print(
        "second opinion: at {} of {} nodes rays contradict the {} about inside and outside; at {} "
        "the rays disagree with each other\n",
        found.against_sign, found.nodes, is_solid ? "normals" : "winding numbers",
        found.among_rays);
}

nlohmann::json to_json(const std::string& file, const MeshInspection& found) {
  const Vector3 low = found.bounds.min(), high = found.bounds.max();
  return {{"file", file},
          {"vertices", found.vertices},
          {"triangles", found.triangles},
          {"low", {low.x(), low.y(), low.z()}},
          {"high", {high.x(), high.y(), high.z()}},
          {"refusal", found.rejection},
          {"pieces", found.pieces},
          {"volume", found.volume},
          {"no_repair", found.repair_failure},
          {"nodes", found.nodes},
          {"against_sign", found.against_sign},
          {"among_rays", found.among_rays}};
}

}  // namespace

int inspect(const Options& options) {
  require_input(options.file, mesh_kind);
  if (options.as_cloth) return inspect_cloth(options);
  const MeshInspection found = inspect_mesh(read_obj_soup(options.file), options.cells);
  if (options.json)
    fmt::print("{}\n", json_text(to_json(options.file, found)));
  else
    print(options.file, found);
  return found.rejection.empty() && found.against_sign == 0 ? all_hold : some_fail;
}

}  // namespace foldproof
