// Invalid case files, and their error messages.
#include "reference/scene/scene.h"
#include "verification/specimens/check.h"

namespace foldproof {

namespace {

const std::string trial_case = R"(title = "Trial"
[cloth]
shape = "sheet"
pattern = "jittered"
width = 0.6
height = 0.43
columns = 5
rows = 4
jitter = 0.2
density = 0.23
move = [0.3, -0.2, 0.7]
turn = { axis = [1, 2, 3], angle = 37 }
[start]
stretch = 1.02
spin = [3, -7, 11]
[gravity]
acceleration = [0.1, -9.7, 0.3]
[stretch]
stiffness = 37.0
damping = 0.011
[bending]
stiffness = 3.1e-4
damping = 2.3e-5
rest_angle = 3.5
[[hold]]
particles = [0, 4]
[time]
end = 0.3
integrator = "B"
step = 0.003
max_steps = 100
[solver]
tolerance = 1e-8
max_iterations = 30
)";

/// One edit of the case above that must be refused.
struct Rejection {
  std::string find, replace;          // the last line of `replace` is the wrong one
  std::vector<std::string> mentions;  // must be in the message beside file and line
};

std::string edit(const Rejection& rejection) {
  std::string text = trial_case;
  const size_t place = text.find(rejection.find);
  if (place == std::string::npos)
    throw InputError("the trial case has no '" + rejection.find + "'");
  return text.replace(place, rejection.find.size(), rejection.replace);
}

/// "trial.toml:LINE: " of the wrong line.
std::string expected_place(const Rejection& rejection) {
  const std::string text = edit(rejection);
  const size_t end = trial_case.find(rejection.find) + rejection.replace.size();
  long line = 1;
  for (size_t k = 0; k < end; ++k) line += text[k] == '\n' ? 1 : 0;
  return "trial.toml:" + std::to_string(line) + ": ";
}

/// A part that the error message lacks; empty if there is none.
std::string missing(const Rejection& rejection, const std::string& message) {
  if (message.empty()) return "it was accepted";
  if (!message.starts_with(expected_place(rejection))) return expected_place(rejection);
  for (const std::string& word : rejection.mentions)
    if (message.find(word) == std::string::npos) return word;
  return "";
}

Finding rejected(const std::vector<Rejection>& rejections) {
  read_scene_text(trial_case, "trial.toml");  // the unedited case is valid
  double wrong = 0;
  Table answers("edit [1]; message [1]; lacking [1]");
  for (const Rejection& rejection : rejections) {
    const std::string message =
        rejection_message([&] { read_scene_text(edit(rejection), "trial.toml"); });
    const std::string lacking = missing(rejection, message);
    wrong += lacking.empty() ? 0 : 1;
    answers.row(rejection.replace, message, lacking);
  }
  return {{wrong, 0, 0, "cases",
           "each wrong case is refused with file and line, the key, and what is known or wanted"},
          answers};
}

/// Inserts a line after another one.
Rejection add_line(const std::string& after, const std::string& line,
                   std::vector<std::string> mentions) {
  return {after, after + "\n" + line, std::move(mentions)};
}

Finding unknown_finding() {
  return rejected({
      add_line("title = \"Trial\"", "titel = \"Trial\"",
               {"'titel'", "the file", "known here", "title"}),
      add_line("density = 0.23", "densty = 0.2", {"'densty'", "[cloth]", "density"}),
      {"angle = 37 }", "angle = 37, anle = 5 }", {"'anle'", "[cloth.turn]", "axis"}},
      add_line("stretch = 1.02", "strech = 1.1", {"'strech'", "[start]", "noise"}),
      add_line("[gravity]", "accelration = [0, 0, 1]",
               {"'accelration'", "[gravity]", "acceleration"}),
      add_line("damping = 0.011", "dampng = 0.2", {"'dampng'", "[stretch]", "rest_length_scale"}),
      add_line("damping = 2.3e-5", "stifness = 2.0", {"'stifness'", "[bending]", "damping_factor"}),
      add_line("particles = [0, 4]", "velocty = [0, 0, 1]", {"'velocty'", "[hold]", "velocity"}),
      add_line("end = 0.3", "ende = 3", {"'ende'", "[time]", "frames_per_second"}),
      {"[gravity]", "[gravity.wind]", {"'wind'", "[gravity]", "acceleration"}},
      add_line("tolerance = 1e-8", "tolerence = 1e-5", {"'tolerence'", "[solver]", "relative_to"}),
  });
}

Finding types_finding() {
  return rejected({
      {"title = \"Trial\"", "title = 3", {"'title'", "text"}},
      {"columns = 5", "columns = 5.0", {"'columns'", "[cloth]", "whole number"}},
      {"density = 0.23", "density = \"0.23\"", {"'density'", "finite number"}},
      {"density = 0.23", "density = inf", {"'density'", "finite number"}},
      {"move = [0.3, -0.2, 0.7]", "move = [0.3, -0.2]", {"'move'", "three numbers"}},
      {"acceleration = [0.1, -9.7, 0.3]",
       "acceleration = [0.1, nan, 0.3]",
       {"'acceleration'", "[gravity]", "three numbers"}},
      {"stiffness = 37.0", "stiffness = true", {"'stiffness'", "[stretch]", "finite number"}},
      {"particles = [0, 4]", "particles = [0, 4.5]", {"'particles'", "list of whole numbers"}},
      {"particles = [0, 4]", "particles = 4", {"'particles'", "list of whole numbers"}},
      {"integrator = \"B\"", "integrator = 2", {"'integrator'", "text"}},
      {"step = 0.003", "step = [0.003]", {"'step'", "[time]", "number"}},
      {"tolerance = 1e-8", "tolerance = 1979-05-27", {"'solver.tolerance'", "date"}},
      {"turn = { axis = [1, 2, 3], angle = 37 }", "turn = 37", {"'turn'", "table"}},
      {"density = 0.23", "density = 0.23 kg", {}},
  });
}

Finding values_finding() {
  return rejected({
      {"density = 0.23", "density = -0.23", {"'density'", "> 0"}},
      {"density = 0.23", "density = 0", {"'density'", "> 0"}},
      {"shape = \"sheet\"", "shape = \"shet\"", {"'shet'", "known", "sheet", "statue"}},
      {"pattern = \"jittered\"",
       "pattern = \"jitter\"",
       {"'jitter'", "known", "jittered", "criss_cross"}},
      {"shape = \"sheet\"\npattern = \"jittered\"\nwidth = 0.6\nheight = 0.43\ncolumns = 5\nrows = "
       "4\njitter = 0.2",
       "mesh = \"nowhere.obj\"",
       {"nowhere.obj", "no mesh file"}},
      {"particles = [0, 4]", "box = [[9, 9, 9], [10, 10, 10]]", {"no particle", "lies from ("}},
      {"axis = [1, 2, 3]", "axis = [0, 0, 0]", {"'axis'", "zero"}},
      {"particles = [0, 4]", "particles = [0, 4]\nfrom = -0.1", {"'from'", ">= 0"}},
      {"particles = [0, 4]",
       "particles = [0, 4]\nfrom = 0.2\nuntil = 0.2",
       {"'until'", "later than 'from'"}},
      {"stretch = 1.02", "stretch = 0", {"'stretch'", "> 0"}},
      {"stretch = 1.02", "noise = -0.01", {"'noise'", "negative"}},
      {"stiffness = 37.0", "stiffness = -37.0", {"'stiffness'", "negative"}},
      {"damping = 0.011", "damping = -0.011", {"'damping'", "negative"}},
      {"damping = 0.011", "rest_length_scale = 0", {"'rest_length_scale'", "> 0"}},
      {"stiffness = 3.1e-4", "stiffness = -3.1e-4", {"'stiffness'", "negative"}},
      {"damping = 2.3e-5", "damping = -2.3e-5", {"'damping'", "negative"}},
      {"damping = 2.3e-5", "weighting = \"now\"", {"'now'", "known", "rest", "current"}},
      {"damping = 2.3e-5",
       "damping_factor = \"area\"",
       {"'area'", "known", "edge_squared_over_area"}},
      {"damping = 2.3e-5", "law = \"square\"", {"'square'", "known", "sine", "cubic"}},
      {"rest_angle = 3.5", "rest_angle = 181", {"'rest_angle'", "[-180, 180]"}},
      {"rest_angle = 3.5", "rest_angle = \"curved\"", {"'curved'", "known", "rest_shape", "flat"}},
      {"particles = [0, 4]", "particles = [0, 400]", {"particle 400", "does not exist"}},
      {"particles = [0, 4]", "particles = [-1]", {"particle -1", "does not exist"}},
      {"particles = [0, 4]", "box = [[0, 0, 0]]", {"'box'", "two points"}},
      {"particles = [0, 4]", "top = 0", {"'top'", "> 0"}},
      {"end = 0.3", "end = -0.3", {"'end'", "> 0"}},
      {"end = 0.3", "end = 0.3\nframes_per_second = 0", {"'frames_per_second'", "> 0"}},
      {"integrator = \"B\"", "integrator = \"D\"", {"'D'", "known", "A, B, C"}},
      {"step = 0.003", "step = -0.003", {"'step'", "> 0"}},
      {"step = 0.003", "step = \"adaptive\"", {"'step'", "automatic"}},
      {"step = 0.003", "safety = 0", {"'safety'", "> 0"}},
      {"step = 0.003", "strain_per_step = 0", {"'strain_per_step'", "> 0"}},
      {"max_iterations = 30", "max_iterations = 0", {"'max_iterations'"}},
      {"tolerance = 1e-8", "tolerance = 0", {"'tolerance'", "> 0"}},
      {"tolerance = 1e-8",
       "relative_to = \"nothing\"",
       {"'nothing'", "known", "momentum", "initial_residual"}},
  });
}

}  // namespace

std::vector<Check> scene_rejection_checks() {
  const std::string source = "good practice";
  return {
      {"scene.unknown-keys-are-rejected",
       "A case of the reference with an unknown key is refused, with the file, the line and the "
       "keys known there.",
       source, unknown_finding},
      {"scene.wrong-types-are-rejected",
       "A case of the reference with a value of the wrong type is refused, with file, line and the "
       "type wanted.",
       source, types_finding},
      {"scene.out-of-range-values-are-rejected",
       "A case of the reference with a value out of its range is refused, with file, line and what "
       "is known.",
       source, values_finding},
  };
}

}  // namespace foldproof
