// order-verdicts: how often is what converge says of a method's order right, wrong, or withheld?

#include "convergence/any_case/converge.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr int cells = 3;
constexpr double side = 0.3, frame = 0.02;  // m, s
constexpr int first_levels = 4, most_levels = 7;

Scene sheet(double stiffness) {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::alternating, side, side, cells, cells}), 0.2);
  scene.gravity = Vector3(0, -9.80665, 0);
  scene.stretch = StretchMaterial{stiffness, 0.02, 1};
  add_flat_hinges(scene, 2e-4, 2e-6);
  return scene;
}

/// Hangs by its upper edge and is blown out of its plane.
Scene hanging_sheet(double stiffness, double blow) {
  Scene scene = sheet(stiffness);
  for (int i = 0; i < scene.mesh.particles(); ++i) {
    const Vector3 x = scene.mesh.rest.col(i);
    if (x.y() > side - 1e-9)
      scene.prescribed.push_back({i, x, {}});
    else
      scene.v.col(i) = blow * (1 - x.y() / side) * Vector3(0.3 * x.x() / side, 0, 1);
  }
  return scene;
}

Scene rough_sheet() {
  Scene scene = hanging_sheet(60, 0.3);
  for (const int i : free_particles(scene)) scene.v.col(i) += Random(unsigned(i)).vectors(1, 1);
  return scene;
}

/// Falls, level, on a ball off its middle.
Scene falling_on_a_ball() {
  constexpr double radius = 0.1;
  Scene scene = sheet(60);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 x = scene.mesh.rest.col(i);
    scene.x.col(i) = Vector3(x.x() - 0.46 * side, radius + 0.01, 0.47 * side - x.y());
  }
  SceneObject ball;
  ball.object = {"ball", RigidObject{Sphere{radius}, Pose{}, Motion{}}, 0.3};
  scene.objects = {ball};
  return scene;
}

struct KnownMotion {
  const char* name;
  bool is_smooth;  // contact leaves no method more than the first order
  Scene (*scene)();
};

constexpr KnownMotion motions[] = {{"hangs quietly", true, [] { return hanging_sheet(60, 0.3); }},
                                   {"hangs, stiff", true, [] { return hanging_sheet(6000, 0.3); }},
                                   {"starts at random", true, rough_sheet},
                                   {"falls on a ball", false, falling_on_a_ball}};

Case case_of(const KnownMotion& motion, const Integrator& method) {
  Case input_case{motion.scene(), {}};
  Scene& scene = input_case.scene;
  scene.name = motion.name;
  scene.integrator = std::string(method.name);
  scene.solver.tolerance = 1e-12;
  scene.solver.max_iterations = 2000;
  scene.schedule.end = 6 * frame;
  scene.schedule.frame_interval = frame;
  const double limit = elastic_limit(build_system(scene), start_state(scene));
  scene.schedule.step.fixed = frame / std::ceil(frame / (0.4 * limit));
  return input_case;
}

/// As converge runs it without --levels, but for the budget.
LadderAnswer answer_of(const KnownMotion& motion, const Integrator& method) {
  const LadderPlan plan{case_of(motion, method), first_levels, {}};
  std::vector<LevelRun> runs;
  while (int(runs.size()) < first_levels ||
         (int(runs.size()) < most_levels && may_settle(time_answer(plan, runs, method.order)))) {
    const int k = int(runs.size());
    const std::vector<double> ends = k > 0 ? runs[0].step_ends : std::vector<double>();
    runs.push_back(run_level(time_level(plan, k, ends), {}));
  }
  return time_answer(plan, runs, method.order);
}

const char* judged(OrderVerdict verdict, bool has_order) {
  if (verdict == OrderVerdict::cannot_tell) return "withheld";
  return (verdict == OrderVerdict::yes) == has_order ? "right" : "wrong";
}

double share_of(const Table& verdicts, const char* what, const char* motion = nullptr) {
  const std::vector<std::string> judgements = verdicts.texts("verdict is"),
                                 names = verdicts.texts("motion");
  double count = 0, all = 0;
  for (size_t k = 0; k < judgements.size(); ++k) {
    if (motion && names[k] != motion) continue;
    ++all;
    count += judgements[k] == what;
  }
  return count / all;
}

StudyResult run_order_verdicts(const Subject&, Tier, const Progress& progress) {
  Table verdicts(
      "motion [1]; method [1]; order known [1]; levels [1]; last order [1]; verdict [1]; verdict "
      "is [1]");
  const double all = double(std::size(motions) * integrators().size());
  for (const KnownMotion& motion : motions)
    for (const Integrator& method : integrators()) {
      const LadderAnswer answer = answer_of(motion, method);
      const OrderVerdict verdict = order_verdict(answer);
      const int known = motion.is_smooth ? method.order : 1;
      verdicts.row(motion.name, std::string(method.name), known, int(answer.sizes.size()),
                   answer.quantities.front().bar.orders.back(), std::string(name_of(verdict)),
                   std::string(judged(verdict, known == method.order)));
      progress(double(verdicts.rows()) / all);
    }
  StudyResult result;
  result.findings = {
      {"order-verdicts.few-are-wrong",
       "What converge says of a method's order is seldom wrong.",
       {{share_of(verdicts, "wrong"), 0.05, 0, "1",
         "chosen: a sentence that is read alone may mislead one reader in twenty"},
        verdicts,
        fmt::format("of {} motions {:.0f} % are judged rightly, {:.0f} % wrongly, {:.0f} % not",
                    all, 100 * share_of(verdicts, "right"), 100 * share_of(verdicts, "wrong"),
                    100 * share_of(verdicts, "withheld"))}},
      {"order-verdicts.quiet-motions-have-one",
       "Of a motion without contact or noise converge says whether the method has its order.",
       {{share_of(verdicts, "withheld", motions[0].name), 0.1, 0, "1",
         "chosen: where nothing disturbs the order, an answer is due"},
        verdicts,
        "of the motion that hangs quietly"}}};
  return result;
}

}  // namespace

Study order_verdicts_study() {
  return {"order-verdicts",
          "Whether a method has its order, as converge says it, is seldom wrong, and of quiet "
          "motions seldom withheld.",
          {"few-are-wrong", "quiet-motions-have-one"},
          "our test of converge",
          "Sheets whose motion is known to be smooth, quiet, stiff or rough, and one that falls on "
          "a ball, where contact leaves no method more than the first order, with every method. "
          "Levels are added until the orders have settled, as converge does.",
          run_order_verdicts};
}

}  // namespace foldproof
