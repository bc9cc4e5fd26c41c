#include "verification/subjects/pipe/declaration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "verification/evidence.h"

namespace foldproof {

using nlohmann::json;

std::string text_of(const json& header, const char* key) {
  const json value = header.value(key, json());
  if (value.is_string()) return value.get<std::string>();
  throw SolverFailure("header", fmt::format("sent no text as '{}'", key));
}

double number_of(const json& header, const char* key, double if_missing) {
  const json value = header.value(key, json(if_missing));
  if (value.is_number() && std::isfinite(value.get<double>())) return value.get<double>();
  throw SolverFailure("header", fmt::format("sent no finite number as '{}'", key));
}

namespace {

int level_of(const std::string& text) {
  if (text.size() == 2 && text[0] == 'L' && text[1] >= '0' && text[1] <= '3') return text[1] - '0';
  throw SolverFailure("header", "declared no level L0 to L3");
}

bool declares_single(const std::string& precision) {
  if (precision == "f4" || precision == "f8") return precision == "f4";
  throw SolverFailure("header", "declared a precision that is neither f4 nor f8");
}

bool declares_consistent(const json& mass_matrix) {
  if (mass_matrix == "lumped" || mass_matrix == "consistent") return mass_matrix == "consistent";
  throw SolverFailure("header", "declared a mass_matrix that is neither lumped nor consistent");
}

/// Of a field that may be missing: not negative.
double length_of(const json& header, const char* key) {
  const double length = number_of(header, key, 0);
  if (length >= 0) return length;
  throw SolverFailure("header", fmt::format("declared a negative {}", key));
}

std::vector<std::string> texts_of(const json& header, const char* key) {
  std::vector<std::string> texts;
  const json list = header.value(key, json::array());
  if (!list.is_array()) throw SolverFailure("header", fmt::format("sent no list as '{}'", key));
  for (const json& entry : list) {
    if (!entry.is_string()) throw SolverFailure("header", fmt::format("sent no text in '{}'", key));
    texts.push_back(entry.get<std::string>());
  }
  return texts;
}

constexpr const char* all_capabilities[] = {"set_state",      "held",
                                            "masses",         "damping",
                                            "planes",         "boxes",
                                            "spheres",        "capsules",
                                            "self_collision", "history",
                                            "bodies",         "deforming_bodies",
                                            "moving_held",    "moving_obstacles",
                                            "materials",      "layer_friction",
                                            "strain_limits",  "air",
                                            "contact_forces", "material_friction",
                                            "membrane"};
constexpr size_t of_protocol_1 = 10;

/// A misspelt one would be believed, and its laws never asked.
std::vector<std::string> capabilities_of(const json& header, int protocol) {
  const std::vector<std::string> declared = texts_of(header, "capabilities");
  const std::span known =
      protocol == 1 ? known_capabilities().first(of_protocol_1) : known_capabilities();
  for (const std::string& one : declared)
    if (std::ranges::find(known, one) == known.end())
      throw SolverFailure(
          "header",
          fmt::format("declared '{}', which is no capability of protocol {}; known are {}", one,
                      protocol, fmt::join(known, ", ")));
  return declared;
}

constexpr const char* tunable_kinds[] = {"substeps",   "iterations",        "tolerance",
                                         "relaxation", "contact_stiffness", "step"};

Tunable tunable_of(const std::string& name, const json& declared) {
  const auto refuse = [&](const std::string& why) -> SolverFailure {
    return {"header", fmt::format("declared the tunable '{}' {}", name, why)};
  };
  if (!declared.is_object()) throw refuse("as no object");
  const auto kind = std::ranges::find(tunable_kinds, text_of(declared, "kind"));
  if (kind == std::end(tunable_kinds))
    throw refuse(fmt::format("of no kind of {}", fmt::join(tunable_kinds, ", ")));
  const json range = declared.value("range", json());
  if (!range.is_array() || range.size() != 2 || !range[0].is_number() || !range[1].is_number())
    throw refuse("without a range of two numbers");
  Tunable tunable{
      name,     TunableKind(kind - tunable_kinds), range[0],
      range[1], number_of(declared, "value", nan), declared.value("proportional", json()) == true};
  if (!(tunable.least > 0 && tunable.least <= tunable.value && tunable.value <= tunable.most))
    throw refuse("with a value outside its range, or a range that is not positive");
  return tunable;
}

std::vector<Tunable> tunables_of(const json& header) {
  const json all = header.value("tunables", json::object());
  if (!all.is_object()) throw SolverFailure("header", "sent no object as 'tunables'");
  std::vector<Tunable> tunables;
  for (const auto& [name, declared] : all.items()) tunables.push_back(tunable_of(name, declared));
  return tunables;
}

}  // namespace

Work work_of(const json& header) {
  const json counts = header.value("work", json());
  Work work;
  size_t due = 0;
  for_each_counter(work, [&](auto&) { ++due; });
  if (!counts.is_array() || counts.size() != due) return {};
  size_t k = 0;
  for_each_counter(work, [&](auto& count) {
    using Number = std::remove_reference_t<decltype(count)>;
    const json& sent = counts[k++];
    if (std::is_integral_v<Number> ? sent.is_number_integer() : sent.is_number())
      count = sent.get<Number>();
  });
  return work;
}

Declaration read_declaration(const json& header) {
  const json protocol = header.value("protocol", json());
  if (protocol != 1 && protocol != protocol_version)
    throw SolverFailure("header",
                        fmt::format("speaks neither protocol 1 nor {}", protocol_version));
  const json scheme = header.value("scheme", json::object());
  if (!scheme.is_object()) throw SolverFailure("header", "sent no object as 'scheme'");
  Declaration declared;
  declared.protocol = protocol;
  declared.name = text_of(header, "name");
  declared.version = text_of(header, "version");
  declared.level = level_of(text_of(header, "level"));
  declared.is_single = declares_single(text_of(header, "precision"));
  declared.scheme = text_of(scheme, "name");
  declared.order = int(std::clamp(number_of(scheme, "order", 0), 0.0, 9.0));
  declared.capabilities = capabilities_of(header, declared.protocol);
  declared.solve_tolerance = number_of(header, "solve_tolerance", 0);
  if (!(declared.solve_tolerance >= 0 && declared.solve_tolerance < 1))
    throw SolverFailure("header", "declared a solve_tolerance outside [0, 1)");
  declared.has_consistent_mass = declares_consistent(header.value("mass_matrix", json("lumped")));
  declared.substep = length_of(header, "substep");
  declared.contact_offset = length_of(header, "contact_offset");
  declared.tunables = tunables_of(header);
  const json deterministic = header.value("deterministic", json(true));
  if (!deterministic.is_boolean())
    throw SolverFailure("header", "declared neither true nor false as 'deterministic'");
  declared.is_deterministic = deterministic;
  return declared;
}

std::span<const char* const> known_capabilities() { return all_capabilities; }

bool Declaration::offers(const std::string& capability) const {
  if (std::ranges::find(known_capabilities(), capability) == known_capabilities().end())
    throw std::logic_error("a law needs '" + capability + "', which is no capability");
  return std::ranges::find(capabilities, capability) != capabilities.end();
}

double Declaration::rounding() const {
  return is_single ? double(std::numeric_limits<float>::epsilon()) : epsilon;
}

}  // namespace foldproof
