// Scenes built from case files.
#include <numbers>

#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/stepper.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

/// The positions after 20 steps of a case.
PerParticle3 end_of(const Scene& scene) {
  const System system = build_system(scene);
  State s = start_state(scene);
  for (int n = 0; n < 20; ++n) s = step_once(scene.integrator, system, s, 0.003);
  return s.x;
}

Finding absent_finding() {
  Differences differences;
  const Scene nothing = trial_scene(""), falls = trial_scene("[gravity]\n");
  const Scene zeros =
      trial_scene("[gravity]\n[stretch]\nstiffness = 0\n[bending]\nstiffness = 0\n");
  const auto forces = [](const Scene& scene) { return double(build_system(scene).forces.size()); };
  differences.is_near("forces of a case without any", forces(nothing));
  differences.is_near("forces of a case with gravity, less 1", forces(falls) - 1);
  differences.is("that force is gravity",
                 std::holds_alternative<Gravity>(build_system(falls).forces[0]));
  differences.is_near("forces of a case with three, less 3", forces(zeros) - 3);
  differences.is_near("filters and led particles", double(build_system(zeros).filters.size() +
                                                          build_system(zeros).prescribed.size()));
  differences.is_near("parts named, less 2",
                      double(describe_parts(falls, build_system(falls)).size()) - 2);
  differences.is_near("positions with gravity alone and with zero stiffnesses",
                      largest_difference(end_of(falls), end_of(zeros)), extent(plain_positions()));
  differences.is_near("positions without force and at rest",
                      largest_difference(end_of(nothing), plain_positions()),
                      extent(plain_positions()));
  differences.is_near("default gravity", (*falls.gravity - Vector3(0, -9.80665, 0)).norm(),
                      9.80665);
  return differences.judged(
      0, "absent parts are not built; a stiffness of zero adds zeros, which change no digit");
}

Finding numbers_finding() {
  const Scene scene =
      read_scene_text("title = \"Trial\"\nabout = \"Words\"\n" + small_sheet +
                          "[gravity]\nacceleration = [0.3, -0.7, 1.1]\n[stretch]\nstiffness = "
                          "37.5\ndamping = 0.011\nrest_length_scale = 0.97\n"
                          "[bending]\nstiffness = 3.1e-4\ndamping = 2.3e-5\nweighting = "
                          "\"current\"\ndamping_factor = \"edge_squared_over_area\"\n"
                          "law = \"cubic\"\n[time]\nend = 0.31\nframes_per_second = 40\nintegrator "
                          "= \"B\"\nsafety = 0.43\nstrain_per_step = 0.07\n"
                          "max_steps = 53\n[solver]\ntolerance = 3e-7\nmax_iterations = "
                          "17\nrelative_to = \"initial_residual\"\n",
                      "folder/trial.toml");
  Differences differences;
  const auto is = [&](const std::string& what, bool right) { differences.is(what, right); };
  is("name, title, about",
     scene.name == "trial" && scene.title == "Trial" && scene.about == "Words");
  is("density", scene.density == 0.23);
  is("gravity", *scene.gravity == Vector3(0.3, -0.7, 1.1));
  is("stretch", scene.stretch->stiffness == 37.5 && scene.stretch->damping == 0.011 &&
                    scene.stretch->rest_length_scale == 0.97);
  is("bending", scene.bending->stiffness == 3.1e-4 && scene.bending->damping == 2.3e-5);
  is("weighting", scene.bending->weighting == Weighting::current);
  is("damping factor", scene.bending->damping_factor == DampingFactor::edge_squared_over_area);
  is("law", scene.bending->law == "cubic");
  is("time", scene.schedule.end == 0.31 && scene.schedule.frame_interval == 1.0 / 40 &&
                 scene.schedule.max_steps == 53);
  is("automatic step", scene.schedule.step.fixed == 0 && scene.schedule.step.safety == 0.43 &&
                           scene.schedule.step.strain_per_step == 0.07);
  is("fixed step", trial_scene("").schedule.step.fixed == 0.003);
  is("integrator", scene.integrator == "B" && trial_scene("").integrator == "A");
  is("solver", scene.solver.tolerance == 3e-7 && scene.solver.max_iterations == 17);
  is("scale of the residual", scene.solver.scale == ResidualScale::initial_residual &&
                                  trial_scene("").solver.scale == ResidualScale::momentum);
  is("solver of the system", build_system(scene).solver.tolerance == 3e-7);
  is("defaults of bending",
     trial_scene("[bending]\nstiffness = 1e-4\n").bending->weighting == Weighting::rest &&
         trial_scene("[bending]\nstiffness = 1e-4\n").bending->law == "sine");
  return differences.judged(0, "a number is read as it is written");
}

Finding overrides_finding() {
  const std::string tables =
      "[stretch]\nstiffness = 37.5\n[[hold]]\nparticles = [0]\n[[hold]]\nparticles = [3]\n";
  const auto with = [&](std::vector<std::string> overrides) {
    return trial_scene(tables, overrides);
  };
  Differences differences;
  const auto is = [&](const std::string& what, bool right) { differences.is(what, right); };
  const auto rejected = [&](const std::string& assignment, const std::string& mention) {
    return is_rejected([&] { with({assignment}); }, mention);
  };
  is("a number", with({"stretch.stiffness=53.25"}).stretch->stiffness == 53.25);
  is("the last one counts",
     with({"stretch.stiffness=53.25", "stretch.stiffness=7"}).stretch->stiffness == 7);
  is("a text without quotes", with({"time.integrator=C"}).integrator == "C");
  is("a missing table is made",
     *with({"gravity.acceleration=[1, 2, 4]"}).gravity == Vector3(1, 2, 4));
  const Scene picked = with({"hold.1.particles=[5, 7]"});
  is("an entry of a list", picked.prescribed.size() == 3 && picked.prescribed[0].particle == 0 &&
                               picked.prescribed[1].particle == 5 &&
                               picked.prescribed[2].particle == 7);
  is("it is written into the case's text",
     with({"stretch.stiffness=53.25"}).text.find("--set stretch.stiffness=53.25") !=
         std::string::npos);
  is("an unknown key is refused",
     rejected("stretch.stifness=53", "--set stretch.stifness=53: unknown key 'stifness'"));
  is("a wrong value is refused", rejected("stretch.stiffness=-3", "--set"));
  is("a missing '=' is refused", rejected("stretch.stiffness", "table.key=value"));
  is("a path through a value is refused",
     rejected("stretch.stiffness.x=3", "'stiffness' is not a table"));
  is("an entry that is not there is refused", rejected("hold.2.particles=[5]", "no hold.2"));
  return differences.judged(0, "an override acts as if it stood in the file, or is refused");
}

}  // namespace

std::vector<Check> scene_checks() {
  const std::string source = "good practice";
  return {
      {"scene.absent-parts-are-not-built",
       "What a case of the reference does not name is not built.", source, absent_finding},
      {"scene.numbers-are-as-written",
       "A scene of the reference holds the numbers that its case file says.", source,
       numbers_finding},
      {"scene.overrides-take-effect",
       "Overrides act on a case of the reference as if they stood in its file.", source,
       overrides_finding},
  };
}

}  // namespace foldproof
