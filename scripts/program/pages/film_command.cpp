// foldproof film: a film of a stored run.
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/interruption.h"
#include "scripts/program/pages/report_script.h"

namespace foldproof {

namespace {

struct FilmOptions : Options {
  std::string field, size, fps;  // as reports/make_film.py takes them
};

int make_film(const FilmOptions& options) {
  require_input(options.file, run_kind);
  const InterruptionNotice notice("the film is not written", typed_again(options.words));
  std::vector<std::string> arguments = {options.file};
  add_option(arguments, "--out", options.out);
  add_option(arguments, "--field", options.field);
  add_option(arguments, "--size", options.size);
  add_option(arguments, "--fps", options.fps);
  return run_report_script("film", "make_film.py", arguments);
}

constexpr const char* below_film =
    R"(Needs the Debian packages ffmpeg, python3-h5py, python3-matplotlib and python3-pil.

Examples:
  foldproof film results/grab.h5
  foldproof film results/grab.h5 --field strain --size 640x360 --out strain.mp4

Exit codes:
  0    written; the paths are printed
  2    bad input, or a package is missing)";

}  // namespace

void add_film_command(CLI::App& app, Program& program) {
  auto [film, options] = add_command(
      app, program, {"film", "Make a film of a stored run (MP4 and GIF, by ffmpeg)", below_film},
      make_film);
  add_input(film, "RUN.h5", options.file, "Run stored by `foldproof simulate`");
  add_value(film, "--field FIELD", options.field,
            "Colour the cloth by strain [1], angle [rad], phi [m] or speed [m/s] (default: "
            "by its sides)",
            one_of({"strain", "angle", "phi", "speed"}));
  add_value(film, "--size WxH", options.size, "Width and height in pixels (default: 1280x720)",
            some_text("a size, such as 1280x720"));
  add_value(film, "--fps N", options.fps, "Pictures a second, 1 to 120 (default: 30)",
            whole_number(1, 120));
  add_out_if_typed(film, options, "FILE.mp4 or FILE.gif (default: both, beside RUN.h5)");
  film->get_option("--out")->type_name("FILE");
}

}  // namespace foldproof
