// Expectations of a case: the [expect] table of its file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reference/scene/scene.h"
#include "verification/cases/measurement.h"

namespace foldproof {

/// One entry of [expect]: `key = { at_most = bound, why = "..." }`, or at_least for a lower bound.
/// Keys, units and what is measured: verification/cases/quantities.h.
struct Expectation {
  std::string key;
  double bound;                // in the quantity's unit
  std::string why;             // the reason for the bound
  std::string not_asked = {};  // why it does not apply to this run; "" if it does
};

/// One entry of [ablation]: `"part" = "why"`. A part that is present although nothing that
/// `foldproof ablate` measures needs it, or absent although its presence would show; parts are
/// named as in convergence/any_case/ablation.h.
struct DeclaredPart {
  std::string part, why;
};

/// A scene and its expectations.
struct Case {
  Scene scene;
  std::vector<Expectation> expectations;
  std::vector<DeclaredPart> declared = {};
  // of [ablation]: overrides "a.b=number" that make it coarser
  std::vector<std::string> coarser_mesh = {};
  double ablated_until = 0;  // of [ablation]: duration of the ablated runs [s]; 0: the full run
  std::vector<Measurement> quantities = {};  // of [[quantity]]
};

/// Reads the case file's scene and its tables [expect], [ablation] and [[quantity]], from one tree
/// of keys. Throws InputError "file:line: ..." for what read_scene refuses, an unknown quantity,
/// one that is meaningless for the scene, and an entry without bound or reason.
///   overrides   "a.b=c", applied in order; expect.KEY.at_most=... is one, too. Where one puts
///               another mesh or shape in the place of the file's, bounds of the file on quantities
///               of Scope::this_shape are not asked; those that an override states are
Case read_case(const std::string& path, const std::vector<std::string>& overrides = {});

/// Adds the default expectations of every shipped case: that it runs to its end; if the forces have
/// an energy and nothing is driven, that the energy balances; that the run is reproducible; where
/// there are objects, that whole triangles stay outside up to the depth that face_bound.h derives;
/// and that the cloth crosses itself in no frame, unless tangle_does_not_grow is stated.
Case with_usual_expectations(Case input_case);

/// The expectation of that key; nullptr: none.
const Expectation* find_expectation(std::string_view key, const std::vector<Expectation>& all);

/// Whether some prescribed particle moves.
bool is_driven(const Scene& scene);

/// The name of the finding: "case.<scene>.<key>", with hyphens.
std::string finding_name(const Scene& scene, const Expectation& expectation);

}  // namespace foldproof
