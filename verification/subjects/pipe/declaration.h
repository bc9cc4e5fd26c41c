// A solver's description of itself, and what else the header of an answer may say.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "reference/types.h"
#include "verification/subjects/pipe/child_process.h"

namespace foldproof {

constexpr int protocol_version = 2;  // 1 is served, too

/// What a solver can be tuned by. Finer is more of substeps, iterations and contact stiffness, and
/// less of a tolerance; `step` is the steps of a frame, which every solver has.
enum class TunableKind { substeps, iterations, tolerance, relaxation, contact_stiffness, step };

struct Tunable {
  std::string name;
  TunableKind kind = TunableKind::substeps;
  double least = 1, most = 1, value = 1;  // value: in use, unless a scene sets another
  bool is_proportional = false;           // a step costs in proportion to it
};

/// The solver's description of itself: its answer to `start`.
struct Declaration {
  int protocol = protocol_version;
  std::string name, version;
  int level = 0;           // 0 to 3
  bool is_single = false;  // precision f4 instead of f8
  std::string scheme;      // its integrator, in its own words
  int order = 0;           // claimed, of the global error
  std::vector<std::string> capabilities;
  double solve_tolerance = 0;        // relative residual of its linear systems; 0: solves none
  bool has_consistent_mass = false;  // "mass_matrix": "consistent"
  double substep = 0;                // its longest internal step [s]; 0: that of the call
  bool is_deterministic = true;      // the same input gives the same bits
  double contact_offset = 0;         // at which it keeps cloth from obstacles [m]
  std::vector<Tunable> tunables = {};

  /// Throws std::logic_error for a word that no solver can offer.
  bool offers(const std::string& capability) const;
  double rounding() const;  // the distance from 1 to the next number of its precision
};

/// The names of all capabilities; those of protocol 1 come first.
std::span<const char* const> known_capabilities();

/// Of the answer to `start`. Throws SolverFailure "header" for what no protocol has.
Declaration read_declaration(const nlohmann::json& header);

/// A field of a header. Throw SolverFailure "header" naming the field if it is of another kind.
std::string text_of(const nlohmann::json& header, const char* key);
double number_of(const nlohmann::json& header, const char* key, double if_missing);

/// Counters in the order of for_each_counter; zeros where the answer counts otherwise.
Work work_of(const nlohmann::json& header);

}  // namespace foldproof
