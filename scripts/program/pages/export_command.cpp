// foldproof export: the frames of a stored run as files for other programs.
#include "reference/types.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/pages/report_script.h"

namespace foldproof {

namespace {

struct ExportOptions : Options {
  std::string format;  // obj, ply, pc2, npz, usda or xdmf
  std::string like;    // an OBJ file of the cloth; "": none
};

int export_frames(const ExportOptions& options) {
  require_input(options.file, run_kind);
  if (!options.like.empty()) {
    if (options.format != "obj") throw InputError("--like needs --format obj");
    require_input(options.like, mesh_kind);
  }
  const OutFolder folder(options.out);
  std::vector<std::string> words{options.file, "--format", options.format, "--out", options.out};
  add_option(words, "--like", options.like);
  return run_report_script("files", "export.py", words);
}

constexpr const char* below_export =
    R"(Lengths are in metres, in world coordinates; each object has files of its own. obj and ply are one
file a frame; pc2, npz and usda (USD as text) hold all frames. `judge --frames`, `compare` and the
key `frames` of an [[object]] read all but xdmf back. obj and pc2 have no times: times.txt has them.
Needs the Debian packages python3-h5py and python3-numpy.

Examples:
  foldproof export results/grab.h5 --format usda --out blender
  foldproof export results/grab.h5 --format xdmf --out paraview

Exit codes:
  0    written
  2    bad input, or a package is missing)";

}  // namespace

void add_export_command(CLI::App& app, Program& program) {
  auto [files, options] = add_command(
      app, program,
      {"export", "Write the frames of a stored run as files for other programs", below_export},
      export_frames);
  add_input(files, "RUN.h5", options.file, "Run stored by `foldproof simulate`");
  files->add_option("--format", options.format, "obj, ply, pc2, npz, usda or xdmf")
      ->type_name("FORMAT")
      ->check(one_of({"obj", "ply", "pc2", "npz", "usda", "xdmf"}))
      ->required();
  files
      ->add_option("--like", options.like,
                   "OBJ file of the run's cloth: keeps its numbering, groups, polygons and vt")
      ->type_name("FILE.obj");
  add_folder(files, options, "Folder for the files")->required();
}

}  // namespace foldproof
