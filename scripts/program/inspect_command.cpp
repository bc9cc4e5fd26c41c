// foldproof inspect: what a mesh is good for as a body.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scripts/program/command_line/options_of_commands.h"
#include "reference/bodies/mesh_inspection.h"
#include "reference/mesh/mesh_file.h"
#include "reference/mesh/seams.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/inspect_cloth.h"
#include "scripts/program/json_text.h"

namespace foldproof {

namespace {

struct InspectOptions : Options {
  bool as_cloth = false;  // rather than as a body
  int cells = 64;         // along the longest side
  double seams = 0;       // distance within which vertices are joined [m]; 0: none
};

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
  if (!found.thin_parts.empty()) fmt::print("too thin for the grid: {}\n", found.thin_parts);
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
          {"thin_parts", found.thin_parts},
          {"nodes", found.nodes},
          {"against_sign", found.against_sign},
          {"among_rays", found.among_rays}};
}

int inspect(const InspectOptions& options) {
  require_input(options.file, mesh_kind);
  TriangleSoup soup = read_mesh_file(options.file).soup;
  if (options.seams > 0) soup = close_seams(std::move(soup), options.seams);
  if (options.as_cloth) return inspect_cloth(options, std::move(soup));
  const MeshInspection found =
      inspect_mesh(without_unused_vertices(std::move(soup)), options.cells);
  if (options.json)
    fmt::print("{}\n", json_text(to_json(options.file, found)));
  else
    print(options.file, found);
  return found.rejection.empty() && found.against_sign == 0 ? all_hold : some_fail;
}

constexpr const char* below_inspect =
    R"(Examples:
  foldproof inspect cases/limb.ply --cells 100 --json
  foldproof inspect cases/skirt.obj --cloth            its rigidity by direction, its elastic limit

Exit codes:
  0    the mesh is a solid, and ray casting agrees on what is inside; or a cloth was inspected
  1    the mesh is not a solid, or ray casting disagrees
  2    bad input)";

}  // namespace

void add_inspect_command(CLI::App& app, Program& program) {
  auto [mesh, options] = add_command(
      app, program,
      {"inspect", "Is a mesh valid as a body? With --cloth: how stiff is it as a cloth?",
       below_inspect},
      inspect);
  add_input(mesh, "MESH", options.file, "An OBJ or PLY file");
  mesh->add_flag("--cloth", options.as_cloth,
                 "As a cloth: rigidity by direction, elastic limit, thinnest triangles");
  add_seams(mesh, options.seams);
  mesh->add_option("--cells", options.cells, "Grid cells along the longest side")
      ->type_name("N")
      ->check(whole_number(4, 1000))
      ->capture_default_str();
  add_json(mesh, options);
}

}  // namespace foldproof
