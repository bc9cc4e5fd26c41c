#include "verification/cases/judged_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "verification/cases/judge.h"

namespace foldproof {

namespace {

// Expectations that laws of frames judge; of the end of a run, of which the last frame is enough;
// of bonds, which frames do not have.
constexpr std::array judged_by_laws = {"runs_to_its_end", "never_crosses_itself", "stays_outside",
                                       "stays_within_strain_limits"};
constexpr std::array seen_at_the_end = {
    "comes_to_rest",     "ends_untangled", "lies_inside",   "keeps_its_height",   "collapses_to",
    "keeps_most_angles", "crumples_by",    "forms_creases", "wrinkles_stay_short"};
constexpr std::array of_bonds = {"sticks", "lets_go", "keeps_hold"};

bool is_among(std::span<const char* const> keys, std::string_view key) {
  return std::ranges::find(keys, key) != keys.end();
}

/// Why an expectation is not asked of frames; "" if it is.
std::string why_not_asked(const Expectation& expectation, Matching matching) {
  if (!expectation.not_asked.empty()) return expectation.not_asked;
  if (matching == Matching::surface)
    return "the frames have another mesh than the case: vertex i must be particle i";
  if (is_among(of_bonds, expectation.key)) return "frames do not show what sticks to what";
  if (find_quantity(expectation.key)->of_run && !is_among(seen_at_the_end, expectation.key))
    return "frames do not show the steps of a run";
  return "";
}

/// By how much rounding of the files may change a quantity, in its unit: a vertex moves by up to e,
/// an edge changes by up to 2 e, a hinge turns by up to 2 e over the heights of its triangles.
double rounding_of(const Quantity& quantity, const FrameMotion& motion) {
  const TriangleMesh& mesh = motion.of.scene.mesh;
  const double e = std::sqrt(3.0) * motion.rounding();
  const std::string_view unit = quantity.unit;
  if (unit == "m") return 2 * e;  // a depth in a level set rises by up to 2 along its normal
  if (unit == "1") return 2 * e / rest_lengths(mesh).minCoeff();
  if (unit == "pairs") return crossings_by_rounding(motion);
  if (unit == "degrees") return 8 * e / smallest_height(mesh.triangles, mesh.rest) * 180 / pi;
  return 0;
}

void allow_for_rounding(Expectation& expectation, const FrameMotion& motion) {
  const Quantity& quantity = *find_quantity(expectation.key);
  if (quantity.of_run || !expectation.not_asked.empty()) return;
  const double rounding = rounding_of(quantity, motion);
  expectation.bound += quantity.sense == Sense::at_most ? rounding : -rounding;
  if (rounding > 0) expectation.why += "; rounding of files of six digits is allowed for";
}

Case asked_of_frames(const FrameMotion& motion) {
  Case asked = motion.of;
  std::erase_if(asked.expectations, [](const Expectation& expectation) {
    return is_among(judged_by_laws, expectation.key);
  });
  for (Expectation& expectation : asked.expectations) {
    expectation.not_asked = why_not_asked(expectation, motion.matching);
    allow_for_rounding(expectation, motion);
  }
  return asked;
}

/// Judges one law; where it does not apply, its note says what it needs: no subject was asked.
Record judge_law(const FrameLaw& law, const FrameMotion& motion) {
  Record record;
  record.name = law.name, record.kind = "check";
  record.claim = law.claim, record.source = law.source;
  std::string missing;
  record = judge(std::move(record), [&] {
    try {
      return law.run(motion);
    } catch (const NotOffered& needed) {
      missing = needed.operation;
      throw;
    }
  });
  if (record.outcome == Outcome::not_applicable) record.finding.note = "needs " + missing;
  return record;
}

std::vector<Record> judge_laws(const FrameMotion& motion) {
  std::vector<Record> records;
  for (const FrameLaw& law : frame_laws()) records.push_back(judge_law(law, motion));
  return records;
}

/// Energies alone: of momenta no expectation of frames is asked, and none could hold.
Diagnostics diagnostics_of(const FrameMotion& motion, const State& state) {
  Diagnostics row;
  row.energy = energies(motion.built.system, state);
  row.linear_momentum = row.angular_momentum = Vector3::Constant(nan);
  return row;
}

std::vector<Record> judge_expectations(const FrameMotion& motion) {
  const Case asked = asked_of_frames(motion);
  CaseJudge case_judge(asked, motion.built.objects, {});
  RunResult result;
  for (const State& state : motion.states) {
    case_judge.record(state);
    case_judge.record(diagnostics_of(motion, state));
    result.last = state;
  }
  return case_judge.records(result);
}

// ---- evidence

/// The mean over the cloth, by mass [m/s]; NaN of another mesh.
double mean_speed(const FrameMotion& motion, std::size_t k) {
  if (motion.matching == Matching::surface) return nan;
  const PerParticle mass = masses_of(motion.of.scene);
  return motion.states[k].v.colwise().norm().dot(mass.transpose()) / mass.sum();
}

/// The largest of the mesh's edges; NaN of another mesh.
struct Strains {
  double extension = nan, compression = nan;
};

Strains largest_strains(const FrameMotion& motion, const PerParticle3& x) {
  if (motion.matching == Matching::surface) return {};
  Strains largest{0, 0};
  for (const double strain : strains_of(motion.of.scene, x)) {
    largest.extension = std::max(largest.extension, strain);
    largest.compression = std::max(largest.compression, -strain);
  }
  return largest;
}

Table numbers_table(const FrameMotion& motion) {
  Table rows(
      "time [s]; crossing pairs [1]; depth in objects [m]; largest extension [1]; largest "
      "compression [1]; lowest vertex [m]; mean height [m]; mean speed [m/s]");
  for (std::size_t k = 0; k < motion.frames.size(); ++k) {
    const TimedMesh& frame = motion.frames[k];
    const Strains strains = largest_strains(motion, frame.x);
    const Eigen::RowVectorXd heights = up_in(motion.of.scene).transpose() * frame.x;
    rows.row(frame.time, crossings_in(frame),
             motion.built.objects.empty() ? 0 : depth_in(motion, frame), strains.extension,
             strains.compression, heights.minCoeff(), heights.mean(), mean_speed(motion, k));
  }
  return {"frames", "The cloth, frame by frame", rows};
}

Table folds_table(const FrameMotion& motion) {
  Table rows{{"fold angle", ""}, {"share of the hinges' length", "1"}};
  const FoldSpectrum folds = fold_spectrum(motion.of.scene.mesh, motion.frames.back().x);
  for (std::size_t b = 0; b < folds.size(); ++b) rows.row(name_of_fold_band(b), folds[b]);
  return {"folds", "Folds of the last frame", rows};
}

ComparisonEvidence evidence_of(const FrameMotion& motion) {
  ComparisonEvidence evidence{{numbers_table(motion)}, {}};
  const Table numbers = evidence.tables[0];
  const auto curve = [&](const char* label, const char* column) {
    return curve_of(label, numbers, "time", column);
  };
  evidence.figures.push_back(over_time(
      "heights", "How the cloth falls and drapes", {"height", "m", Scale::linear},
      "Against gravity.",
      {curve("lowest vertex", "lowest vertex"), curve("mean of the vertices", "mean height")}));
  if (motion.matching == Matching::surface) return evidence;
  evidence.tables.push_back(folds_table(motion));
  evidence.figures.push_back(over_time("strains", "Strain of the edges",
                                       {"strain of edges", "1", Scale::linear},
                                       "Length over rest length, less 1.",
                                       {curve("largest extension", "largest extension"),
                                        curve("largest compression", "largest compression")}));
  evidence.figures.push_back(over_time(
      "speeds", "Does it come to rest?", {"mean speed", "m/s", Scale::linear},
      "By differences of the neighbouring frames.", {curve("mean, by mass", "mean speed")}));
  return evidence;
}

}  // namespace

FramesJudgement judge_frames(const Case& of, const BuiltScene& built,
                             std::span<const TimedMesh> frames) {
  const FrameMotion motion = motion_of(of, built, frames);
  FramesJudgement judged{motion.matching, judge_laws(motion), evidence_of(motion)};
  for (Record& record : judge_expectations(motion)) judged.records.push_back(std::move(record));
  return judged;
}

}  // namespace foldproof
