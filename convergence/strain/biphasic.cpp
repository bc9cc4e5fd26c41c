// biphasic: a strip under a growing load, of weak springs with strain limits and of
// springs without.
#include <chrono>

#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"

namespace foldproof {

namespace {

constexpr double length = 0.5, density = 0.2;  // m, kg/m^2
constexpr double weak = 10;                    // Y [N/m]
constexpr double limit = 0.1;                  // extension [1]
// load at the clamp that stretches a spring there to the limit [N/m]
constexpr double locking = limit * weak;
constexpr double most = 4;             // largest load over that [1]
constexpr double damping_time = 0.03;  // kd/Y [s]
constexpr double duration = 3;         // s

/// The strip's end is pulled with an acceleration that grows from 0 to this, as a quarter of
/// a sine [m/s^2].
constexpr double fastest = most * locking / (density * length);
constexpr double frequency = 1 / (4 * duration);  // Hz

/// Load at the clamp that pulls the strip's mass along [N/m].
double load_at(double t) { return density * length * fastest * std::sin(2 * pi * frequency * t); }

/// Mean extension of a bar with strain load s/(length Y), s from its free end, until
/// that is the limit.
double bar_extension(double load, double young, double limit_of_strain) {
  const double full = limit_of_strain * young;
  if (load <= full) return load / (2 * young);
  return limit_of_strain * (1 - full / (2 * load));
}

struct Springs {
  std::string name;
  double young;  // N/m
  bool is_limited;
  int columns = 10;  // of the strip, which is a fifth as wide as long
};

/// Edges along the pull, so that the strip's modulus is Y, and only edges along it are stretched.
Scene strip(const Springs& springs) {
  Scene scene = scene_at_rest(
      make_sheet({SheetPattern::equilateral, length, 0, springs.columns, springs.columns / 5}),
      density);
  scene.stretch = StretchMaterial{springs.young, damping_time * springs.young, 1};
  if (springs.is_limited) {
    StrainLimits limits;
    limits.order = SweepOrder::alternating;
    limits.sweeps = 400;
    scene.strain_limits = limits;
  }
  Motion pull;
  const double turn = 2 * pi * frequency;  // 1/s
  pull.velocity = Vector3(-fastest / turn, 0, 0);
  pull.amplitude = Vector3(fastest / (turn * turn), 0, 0);
  pull.frequency = frequency;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    if (scene.x(0, i) < 1e-9) scene.prescribed.push_back({int(i), scene.x.col(i), pull});
  scene.schedule.end = duration;
  scene.schedule.frame_interval = duration / 80;
  return scene;
}

/// Results of a run.
struct PulledStrip {
  Springs springs;
  Table pulled{"load [N/m]; extension [1]; of the bar [1]"};  // frame by frame
  double steps = 0, sweeps = 0, seconds = 0, step_limit = 0, largest_strain = 0;
};

/// The pulled end's mean distance from the other, over the rest length, less 1.
double extension_of(const Scene& scene, const State& s) {
  double ends = 0, count = 0;  // m
  for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
    if (scene.mesh.rest(0, i) < length - 1e-9) continue;
    ends += s.x(0, i);
    ++count;
  }
  return (ends / count - s.x(0, scene.prescribed.front().particle)) / length - 1;
}

/// A run that stopped has no extensions.
Table without_extensions(const Table& pulled) {
  Table table = with_columns(pulled, {"load"});
  table.add({"extension", "1", std::vector<double>(pulled.rows(), nan)});
  table.add(pulled.column("of the bar"));
  return table;
}

PulledStrip pull_strip(const Springs& springs) {
  const Scene scene = strip(springs);
  const System system = build_system(scene);
  PulledStrip result{springs};
  result.step_limit = elastic_limit(system, start_state(scene));
  const auto frame = [&](const State& s) {
    for (const Edge& edge : scene.mesh.edges) {
      const double rest = (scene.mesh.rest.col(edge.b) - scene.mesh.rest.col(edge.a)).norm();
      update_worst(result.largest_strain, (s.x.col(edge.b) - s.x.col(edge.a)).norm() / rest - 1);
    }
    const double load = load_at(s.time);
    result.pulled.row(load, extension_of(scene, s),
                      bar_extension(load, springs.young, springs.is_limited ? limit : INFINITY));
  };
  const auto start = std::chrono::steady_clock::now();
  const RunResult run = simulate(system, integrator_named(scene.integrator), start_state(scene),
                                 scene.schedule, {frame, {}});
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.steps = double(run.steps);
  result.sweeps = double(run.work.strain_sweeps) / result.steps;
  if (run.stop) result.pulled = without_extensions(result.pulled);
  return result;
}

/// Slope of extension over load between two loads, by least squares [m/N].
double compliance(const PulledStrip& run, double low, double high) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  const std::vector<double>&loads = run.pulled.numbers("load"),
        &extensions = run.pulled.numbers("extension");
  for (size_t k = 0; k < run.pulled.rows(); ++k) {
    const double x = loads[k], y = extensions[k];
    if (!(x >= low && x <= high)) continue;
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// How much less the strip gives way once springs are at their limits.
double late_over_early(const PulledStrip& run) {
  return compliance(run, 3 * locking, most * locking) /
         compliance(run, 0.1 * locking, 0.9 * locking);
}

NamedFinding bar_finding(const PulledStrip& run) {
  Worst worst;
  const std::vector<double>&bar = run.pulled.numbers("of the bar"),
        &extensions = run.pulled.numbers("extension");
  for (size_t k = 0; k < bar.size(); ++k) worst.observe(std::abs(extensions[k] - bar[k]) / limit);
  const double wave = length / std::sqrt(weak / density);     // s
  const double growth = most * locking * 2 * pi * frequency;  // of the load, at most [N/m/s]
  const double lag = (wave + damping_time) * growth / (2 * weak) / limit;
  return {"biphasic.extension-matches-a-biphasic-bar",
          "A strip of weak springs with a limit of +10 % is extended by its load as a bar whose "
          "strain grows with the load to 10 % and no further.",
          {{worst.value(), lag, 0, "of the limit",
            "the strip lags behind its load by the time a wave takes along it plus the damping "
            "time; in that time a bar stretches by this much"},
           run.pulled}};
}

NamedFinding phases_finding(const PulledStrip& run) {
  return {"biphasic.gives-way-then-holds",
          "Beyond three times the load at which it begins to reach its limits, the strip gives way "
          "at most an eighth as much as it did before.",
          {{late_over_early(run), 0.125, 0, "1",
            "the compliance of a bar falls to (full load/load)^2 of its start: between 1/9 and "
            "1/16, 1/12 on average; the bound allows half as much again"},
           run.pulled,
           "measured is the slope of extension over load from 3 to 4 times that load, over the "
           "slope up to 0.9 times it"}};
}

NamedFinding one_phase_finding(const std::vector<PulledStrip>& runs) {
  Table measured{{"case", ""}, {"|slope late over early - 1|", "1"}};
  for (const PulledStrip& run : runs)
    if (!run.springs.is_limited) measured.row(run.springs.name, std::abs(late_over_early(run) - 1));
  return {"biphasic.springs-without-limits-have-one-phase",
          "Without limits a strip is as compliant at the end as at the start, to a quarter, with "
          "weak or stiff springs.",
          judge_worst(measured, 0.25,
                      "springs are linear, but the load grows in a finite time; a strip with "
                      "limits would be off by 11/12")};
}

NamedFinding steps_finding(const PulledStrip& limited, const PulledStrip& stiff) {
  const double ratio = stiff.steps / limited.steps;
  Table both(
      "springs; elastic limit [s]; steps [1]; sweeps a step [1]; seconds [s]; largest strain [1]");
  for (const PulledStrip& run : {limited, stiff})
    both.row(run.springs.name, run.step_limit, run.steps, run.sweeps, run.seconds,
             run.largest_strain);
  return {"biphasic.limits-allow-larger-steps",
          "Springs stiff enough to stay within 10 % under the largest load without a limit are "
          "four times as stiff, and take twice as many steps.",
          {{std::abs(ratio / std::sqrt(most) - 1), 0.05, 0, "1",
            "the elastic limit is inversely proportional to the square root of the stiffness; "
            "steps are rounded to fit frames"},
           both}};
}

Figure figure_of(const std::vector<PulledStrip>& runs) {
  Figure figure{"curve",
                "Extension of a strip under a growing load",
                {"load at the clamp", "N/m"},
                {"mean extension", "1"},
                "A strip pulled by one end, ever faster. The bar: its strain is proportional to "
                "the load beyond each point, up to the limit."};
  for (const PulledStrip& run : runs)
    figure.curves.push_back(curve_of(run.springs.name, run.pulled, "load", "extension"));
  figure.curves.push_back(curve_of("bar with a limit", runs.front().pulled, "load", "of the bar"));
  return figure;
}

Table table_of(const std::vector<PulledStrip>& runs) {
  Table table(
      "springs; columns [1]; elastic limit [ms]; steps [1]; sweeps a step [1]; seconds [s]; "
      "largest strain [1]");
  for (const PulledStrip& run : runs)
    table.row(run.springs.name, run.springs.columns, 1e3 * run.step_limit, run.steps, run.sweeps,
              run.seconds, run.largest_strain);
  return {"runs", "What the same load costs", table};
}

StudyResult run_biphasic(const Subject&, Tier tier, const Progress& progress) {
  std::vector<Springs> all = {
      {"weak, limits", weak, true}, {"weak", weak, false}, {"stiff", most * weak, false}};
  if (tier == Tier::full)
    for (const int columns : {20, 40}) {
      all.push_back({"weak, limits", weak, true, columns});
      all.push_back({"stiff", most * weak, false, columns});
    }
  std::vector<PulledStrip> runs;
  for (const Springs& springs : all) {
    runs.push_back(pull_strip(springs));
    progress(double(runs.size()) / double(all.size()));
  }
  return {{bar_finding(runs[0]), phases_finding(runs[0]), one_phase_finding({runs[1], runs[2]}),
           steps_finding(runs[0], runs[2])},
          {figure_of({runs[0], runs[1], runs[2]})},
          {},
          {table_of(runs)}};
}

}  // namespace

Study biphasic_study() {
  return {"biphasic",
          "Weak springs with limits give way to a load at first and then at most an eighth as "
          "much; springs without limits that stretch as little take twice as many steps.",
          {"gives-way-then-holds", "limits-allow-larger-steps"},
          "BMF03 section 3, after Provot 1995",
          "A weightless strip is pulled by one end with an acceleration that grows from zero; the "
          "load at its clamp is its mass times the acceleration. The largest load is four times "
          "the load that stretches a spring by 10 %, the limit. Three strips: weak springs with "
          "limits, the same without, and springs four times as stiff, which the largest load "
          "stretches by 10 %. If both ends were pulled beyond the limits, there would be no "
          "solution and no force to measure: hence the free end.",
          run_biphasic};
}

}  // namespace foldproof
