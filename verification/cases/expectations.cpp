#include "verification/cases/expectations.h"

#include <algorithm>

#include "reference/scene/key_file.h"
#include "verification/cases/face_bound.h"
#include "verification/cases/quantities.h"
#include "verification/cases/replaced_shape.h"

namespace foldproof {

namespace {

[[noreturn]] void reject_unknown(const std::string& where, const std::string& key) {
  std::string known;
  for (const Quantity& quantity : quantities())
    known += (known.empty() ? "" : ", ") + std::string(quantity.key);
  throw InputError(where + ": unknown quantity '" + key + "' in [expect]; known: " + known);
}

/// replaced: of replaced_shape.
Expectation read_entry(const KeyTable& expect, const std::string& key, const Scene& scene,
                       const std::string& replaced) {
  const std::string where = expect.where(key);
  const Quantity* quantity = find_quantity(key);
  if (!quantity) reject_unknown(where, key);
  const auto entry = expect.table(key);
  const char* bound = quantity->sense == Sense::at_most ? "at_most" : "at_least";
  const bool is_for_this_run =
      quantity->scope == Scope::any_cloth || is_override(entry->where(bound));
  const std::string not_asked = is_for_this_run ? "" : replaced;
  const std::string rejection =
      quantity->rejection && not_asked.empty() ? quantity->rejection(scene) : "";
  if (!rejection.empty())
    throw InputError(where + ": '" + key + "' cannot be expected: " + rejection);
  Expectation expectation{key, entry->number(bound), entry->text("why"), not_asked};
  if (quantity->sense == Sense::at_least && !(expectation.bound > 0))
    throw InputError(entry->where(bound) +
                     ": at_least must be > 0, for nothing falls short of less");
  if (entry->has("despite_error") && entry->text("despite_error").empty())
    throw InputError(entry->where("despite_error") +
                     ": 'despite_error' is empty; say why the bound is narrower than the error");
  if (expectation.why.empty())
    throw InputError(entry->where("why") + ": 'why' is empty; a bound carries its reason in words");
  return expectation;
}

DeclaredPart read_declared(const KeyTable& ablation, const std::string& part) {
  const DeclaredPart declared{part, ablation.text(part)};
  if (declared.why.empty())
    throw InputError(ablation.where(part) + ": say why this part is there, or left out, in words");
  return declared;
}

/// Overrides that change numbers: no mesh is named by them, which a case from anyone
/// must not reach so.
std::vector<std::string> read_coarser_mesh(const KeyTable& ablation) {
  const char* key = "coarser_mesh";
  if (!ablation.has(key)) return {};
  const std::vector<std::string> overrides =
      ablation.is_list(key) ? ablation.texts(key) : std::vector<std::string>{ablation.text(key)};
  if (overrides == std::vector<std::string>{""}) return {};
  for (const std::string& one : overrides) {
    const size_t value = one.find('=') + 1;
    if (value == 0 || value == one.size() ||
        one.find_first_not_of("0123456789.", value) != std::string::npos)
      throw InputError(ablation.where(key) + ": '" + one + "' is not table.key=number");
  }
  return overrides;
}

void read_ablation(const KeyTable& ablation, Case& input_case) {
  input_case.coarser_mesh = read_coarser_mesh(ablation);
  if (ablation.has("until")) {
    input_case.ablated_until = ablation.number("until");
    if (!(input_case.ablated_until > 0))
      throw InputError(ablation.where("until") + ": 'until' must be > 0 s");
  }
  for (const auto& [key, value] : ablation.entries)
    if (key != "coarser_mesh" && key != "until")
      input_case.declared.push_back(read_declared(ablation, key));
}

void add_unless_stated(const Expectation& usual, std::vector<Expectation>& all) {
  if (!find_expectation(usual.key, all)) all.push_back(usual);
}

}  // namespace

Case read_case(const std::string& path, const std::vector<std::string>& overrides) {
  const CaseKeys of = parse_case(path, overrides);
  Case result{scene_from(of), {}, {}};
  const std::string replaced = replaced_shape(of);
  if (const auto expect = of.keys->table("expect"))
    for (const auto& [key, value] : expect->entries)
      result.expectations.push_back(read_entry(*expect, key, result.scene, replaced));
  if (const auto ablation = of.keys->table("ablation")) read_ablation(*ablation, result);
  result.quantities = read_measurements(*of.keys, result.scene);
  of.keys->reject_unused();
  return result;
}

Case with_usual_expectations(Case input_case) {
  const Scene& scene = input_case.scene;
  add_unless_stated({"runs_to_its_end", 0, "a shipped case must not stop early"},
                    input_case.expectations);
  const bool has_energy = !scene.bending || scene.bending->weighting == Weighting::rest;
  if (has_energy && scene.objects.empty() && scene.sticky.empty() && !scene.strain_limits &&
      !scene.self_collision && !is_driven(scene))
    add_unless_stated(
        {"energy_is_accounted_for", 0.01,
         "empirical: at half the elastic limit the energy of the stiffest mode oscillates by "
         "(omega h)^2/8, an eighth; how little of the energy such modes carry is known only from "
         "runs, whose balance is off by 7e-11 to 8e-3 of the energy exchanged"},
        input_case.expectations);
  add_unless_stated(
      {"is_reproducible", 0, "the same numbers in the same order give the same bits on every run"},
      input_case.expectations);
  if (const auto faces = expected_faces_outside(scene, input_case.expectations))
    add_unless_stated(*faces, input_case.expectations);
  // it starts crossed
  if (find_expectation("tangle_does_not_grow", input_case.expectations)) return input_case;
  add_unless_stated(
      {"never_crosses_itself", 0,
       scene.self_collision ? "cloth that starts without crossings stays without them: repulsion "
                              "and impulses may fail, impact zones may not"
                            : "the scene has no self-collision and should need none; if the cloth "
                              "passes through itself, add [self_collision]"},
      input_case.expectations);
  return input_case;
}

const Expectation* find_expectation(std::string_view key, const std::vector<Expectation>& all) {
  const auto found = std::ranges::find(all, key, &Expectation::key);
  return found == all.end() ? nullptr : &*found;
}

bool is_driven(const Scene& scene) {
  for (const PrescribedParticle& p : scene.prescribed)
    if (p.motion.velocity.norm() > 0 || p.motion.amplitude.norm() > 0 ||
        p.motion.angular_velocity.norm() > 0)
      return true;
  return false;
}

std::string finding_name(const Scene& scene, const Expectation& expectation) {
  std::string name = "case." + scene.name + "." + expectation.key;
  std::replace(name.end() - std::ptrdiff_t(expectation.key.size()), name.end(), '_', '-');
  return name;
}

}  // namespace foldproof
