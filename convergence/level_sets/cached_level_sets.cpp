// level-set-cache, as a case uses it: runs with and without a folder of level sets, and grids that
// must not be trusted.
#include "convergence/level_sets/cached_level_sets.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "reference/dynamics/simulate.h"
#include "reference/bodies/grid_content.h"
#include "reference/mesh/obj.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/files/hdf5_file.h"
#include "verification/files/level_set_folder.h"

namespace foldproof {

namespace {

TriangleSoup ball(int subdivisions) {
  const TriangleMesh mesh = make_icosphere(0.21, subdivisions);
  return {mesh.rest, mesh.triangles, {}};
}

/// A cloth that falls on three bodies: a grid, an octree, and one that breathes.
std::string case_text(const ScratchFolder& folder) {
  write_obj(folder.file("ball.obj"), ball(2).rest, ball(2).triangles);
  const std::string mesh = "[[object]]\nmesh = \"ball.obj\"\ncells = 12\n";
  return "[cloth]\nshape = \"sheet\"\npattern = \"alternating\"\nwidth = 0.9\nheight = "
         "0.7\ncolumns = 9\nrows = 7\n"
         "density = 0.2\nturn = { axis = [1, 0, 0], angle = -90 }\nmove = [-0.4, 0.22, "
         "0.3]\n[gravity]\n"
         "[stretch]\nstiffness = 20.0\n[time]\nend = 0.15\n" +
         mesh + "move = [0.2, 0.0, 0.0]\n" + mesh +
         "field = \"octree\"\nmove = [-0.2, 0.0, 0.0]\n" + mesh +
         "interval = 0.05\n[[object.deform]]\nkind = \"breathe\"\namplitude = 0.4\nperiod = 0.3\n";
}

State end_of_run(const std::string& text, const std::string& path,
                 const LevelSetProvider& provider) {
  const Scene scene = read_scene_text(text, path);
  const BuiltScene built = build(scene, provider);
  return simulate(built.system, integrator_named(scene.integrator), built.start, scene.schedule, {})
      .last;
}

/// Something that makes a good file of a grid unfit.
struct Spoiling {
  const char *name, *reason;  // the reason that must be given
  void (*file)(const std::string& path, const std::string& of_another);
};

const Spoiling spoilings[] = {
    {"cut at half", "whole HDF5 file",
     [](const std::string& path, const std::string&) {
       std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
     }},
    {"a text", "whole HDF5 file",
     [](const std::string& path, const std::string&) { std::ofstream(path) << "a grid\n"; }},
    {"another HDF5 file", "cannot read",
     [](const std::string& path, const std::string&) {
       Hdf5::create_file(path).attribute("version", 1);
     }},
    {"the grid of another mesh", "another mesh",
     [](const std::string& path, const std::string& of_another) {
       if (of_another != path)
         std::filesystem::copy_file(of_another, path,
                                    std::filesystem::copy_options::overwrite_existing);
     }},
    {"a bit turned", "", [](const std::string& path, const std::string&) {
       std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
       const auto place = std::streamoff(std::filesystem::file_size(path) / 2);
       file.seekg(place);
       const char byte = char(file.get());
       file.seekp(place);
       file.put(char(byte ^ 4));
     }}};

bool is_same(const Grid& a, const Grid& b) { return content_key(a) == content_key(b); }

}  // namespace

NamedFinding runs_with_cached_level_sets_agree() {
  const ScratchFolder folder;
  const std::string text = case_text(folder), path = folder.file("case.toml");
  int loaded = 0;
  const auto listen = [&](const std::string& line) {
    loaded += line.find("loaded") != std::string::npos;
  };
  const State without = end_of_run(text, path, computing_provider());
  const State first = end_of_run(text, path, caching_provider(folder.file("kept"), listen));
  const int early = loaded;
  const State second = end_of_run(text, path, caching_provider(folder.file("kept"), listen));
  const auto differs = [&](const State& s) {
    return s.x == without.x && s.v == without.v ? 0.0 : 1.0;
  };
  return {
      "level-set-cache.runs-are-bitwise-equal",
      "A run whose bodies come from stored level sets ends as one that computes them, bit for bit.",
      {{differs(first) + differs(second) + std::abs(early) + std::abs(loaded - early - 3), 0, 0,
        "1",
        "values are stored in full: no bit may differ, and the second run loads all three bodies"},
       Table{{"run that writes differs", "1"},
             {"run that loads differs", "1"},
             {"bodies loaded by the second run", "1"}}
           .with_row(differs(first), differs(second), double(loaded - early)),
       "a grid, an octree and a body that deforms under a falling cloth"}};
}

NamedFinding unfit_grids_are_rejected() {
  const ScratchFolder folder;
  std::vector<std::string> said;
  const LevelSetProvider provider =
      caching_provider(folder.file("kept"), [&](const std::string& line) { said.push_back(line); });
  const GridMethod method{14, 4, 3, MarchingOrder::second};
  const auto file_of = [&](const TriangleSoup& soup) {
    return folder.file("kept/" + input_key(soup, method, Repair::refuse) + ".h5");
  };
  const auto make = [&](const TriangleSoup& soup) {
    return provider.make_level_set(soup, method, Repair::refuse);
  };
  const auto good = make(ball(2));
  make(ball(1));
  Table answers{{"file", ""}, {"refused or replaced wrongly", "1"}, {"said", ""}};
  for (const Spoiling& spoiling : spoilings) {
    spoiling.file(file_of(ball(2)), file_of(ball(1)));
    said.clear();
    const bool is_rebuilt = is_same(*make(ball(2)), *good);
    const std::string reason = said.empty() ? "" : said.front();
    const bool is_rejected = reason.find("refused") != std::string::npos &&
                             reason.find(spoiling.reason) != std::string::npos;
    const bool is_good_again = is_same(*make(ball(2)), *good) && !said.empty() &&
                               said.back().find("loaded") != std::string::npos;
    answers.row(spoiling.name,
                (is_rebuilt ? 0 : 1) + (is_rejected ? 0 : 1) + (is_good_again ? 0 : 1),
                reason.substr(0, reason.find('/')) +
                    reason.substr(std::min(reason.size(), reason.rfind('/'))));
  }
  return {"level-set-cache.invalid-grids-are-rejected",
          "A stored grid that is truncated, damaged, of another format or of another mesh is "
          "refused with the reason, and replaced.",
          judge_worst(answers, "refused or replaced wrongly", 0,
                      "each must be refused and said so, and the new file be good")};
}

}  // namespace foldproof
