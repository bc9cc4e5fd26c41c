// contact-answers: which part of self-collision answers contacts: repulsion, impulses
// or rigid zones?

#include "convergence/study.h"
#include "reference/dynamics/system.h"
#include "verification/specimens/layered_cloth.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

/// Two free sheets, one above the other: the upper one drifts, or is thrown, onto the lower one.
struct Landing {
  const char* words;
  double thickness;  // m
  double speed;      // downward at the start [m/s]
  double step;       // s
  double seconds;    // of motion
};

constexpr Landing landings[] = {
    {"drifting, thick, short steps", 0.004, 0.1, 0.001, 0.2},
    {"drifting, thick, long steps", 0.004, 0.1, 0.004, 0.2},
    {"drifting, thin, short steps", 0.001, 0.1, 0.001, 0.2},
    {"drifting, thin, long steps", 0.001, 0.1, 0.004, 0.2},
    {"thrown, thick, short steps", 0.004, 2, 0.001, 0.05},
    {"thrown, thick, long steps", 0.004, 2, 0.004, 0.05},
    {"thrown, thin, short steps", 0.001, 2, 0.001, 0.05},
    {"thrown, thin, long steps", 0.001, 2, 0.004, 0.05},
};

Scene landing_scene(const Landing& landing) {
  Scene scene =
      layered_scene({2, 1.5 * landing.thickness, 0, 0, {landing.thickness, 8, 0.3, 8, true}, 7});
  // so weak that every step is below the elastic limit: else instability makes contacts of its own
  scene.stretch = StretchMaterial{0.3, 3e-4, 1};
  const Eigen::Index of_a_sheet = scene.x.cols() / 2;
  scene.v.rightCols(of_a_sheet).row(2).array() -= landing.speed;
  return scene;
}

/// Answers counted over a landing, and what share of them repulsion gave.
struct Answers {
  double repulsions, impulses, zone_particles;
  double beyond_repulsion() const { return impulses / (repulsions + impulses); }  // [1]
};

Answers answers_of(const Subject& subject, const Landing& landing) {
  Stepper stepper(subject, landing_scene(landing), "C");
  stepper.run(stepper.start(), landing.step, int(std::lround(landing.seconds / landing.step)));
  const Work& work = stepper.work();
  return {double(work.close_pairs), double(work.crossings), double(work.zone_particles)};
}

StudyResult run_contact_answers(const Subject& subject, Tier, const Progress& progress) {
  Table table(
      "landing; thickness [m]; start speed [m/s]; step [s]; step over elastic limit [1]; "
      "repulsions [1]; impulses [1]; particles in zones [1]; share of impulses [1]");
  double calm = 0, largest = 0;
  for (const Landing& landing : landings) {
    const Answers answers = answers_of(subject, landing);
    const Scene scene = landing_scene(landing);
    const double limit = elastic_limit(build_system(scene), start_state(scene));
    const double share = answers.beyond_repulsion();
    table.row(landing.words, landing.thickness, landing.speed, landing.step, landing.step / limit,
              answers.repulsions, answers.impulses, answers.zone_particles, share);
    if (landing.speed * landing.step < landing.thickness) update_worst(calm, share);
    update_worst(largest, share);
    progress(double(table.rows()) / std::size(landings));
  }
  StudyResult result;
  result.findings = {
      {"contact-answers.repulsion-answers-calm-contact",
       "Where a sheet that lands on another moves by less than its thickness in a step, repulsion "
       "answers more than nine of ten contacts.",
       {{calm, 0.1, 0, "1", "nine of ten are a vast majority"}, table}},
      {"contact-answers.impulses-answer-fast-contact",
       "Somewhere among thin layers, long steps and thrown cloth, impulses answer more than half "
       "of the contacts.",
       {{0.5 / largest, 1, 0, "1", "beyond a half, repulsion is no longer the rule"}, table}}};
  result.tables = {{"answers", "Answers to contacts, by thickness, step and speed", table}};
  return result;
}

}  // namespace

Study contact_answers_study() {
  return {"contact-answers",
          "Where cloth moves by less than its thickness in a step, repulsion answers more than "
          "nine of ten contacts; where it moves by more, impulses may answer most.",
          {"repulsion-answers-calm-contact", "impulses-answer-fast-contact"},
          "Bridson, Fedkiw and Anderson (2002)",
          "Two small free sheets meet at a tenth of a metre per second or at two. Counted are "
          "pairs that repulsion parts, pairs that an impulse keeps from meeting, and particles in "
          "rigid zones, summed over all steps.",
          run_contact_answers};
}

}  // namespace foldproof
