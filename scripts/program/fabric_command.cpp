// foldproof fabric: measured fabrics side by side, and one's own numbers as one of them.

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "reference/scene/fabrics.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/json_text.h"

namespace foldproof {

namespace {

constexpr double g = 9.80665;              // m/s^2
constexpr double gram_force_cm = 98.0665;  // uN m in a gf cm^2/cm, of KES-F

struct FabricOptions : Options {
  std::string fabrics;                      // file; empty: the shipped one
  double weight = 0;                        // g/m^2
  std::vector<double> bending_length = {};  // mm, as FAST-2 and BS 3356 give it
  std::vector<double> kes = {};             // gf cm^2/cm
  double drape = 0;                         // %
};

/// (B/(density g))^(1/3): the bending length of BS 3356 [m].
double bending_length(double rigidity, double density) {
  return std::cbrt(rigidity / (density * g));
}

std::string number_or_dash(double value, int digits) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, digits);
}

void print(const std::vector<Fabric>& fabrics) {
  fmt::print("{:<17} {:>6} {:>13} {:>11} {:>6} {:>6}  {}\n", "fabric", "g/m^2", "B [uN m]",
             "c [mm]", "G", "drape", "source");
  for (const Fabric& of : fabrics) {
    const auto [first, second] = of.rigidity;
    fmt::print("{:<17} {:>6.0f} {:>6.2f} {:>6.2f} {:>5.1f} {:>5.1f} {:>6} {:>6}  {}\n", of.name,
               1e3 * of.density, 1e6 * first, 1e6 * second, 1e3 * bending_length(first, of.density),
               1e3 * bending_length(second, of.density), number_or_dash(of.shear, 0),
               number_or_dash(100 * of.drape, 1), of.source.substr(0, of.source.find(',')));
  }
  fmt::print(
      "B: flexural rigidity along the first and the second direction; c: bending length of each, "
      "(B/(weight g))^(1/3);\nG: rigidity in shear [N/m]; drape: the laboratory's coefficient "
      "[%]; -: not in the source\n");
}

void print_card(const Fabric& of) {
  fmt::print("\n{}: {}\n  source   {}\n  place    {}\n  method   {}\n", of.name, of.words,
             of.source, of.place, of.method);
  if (!of.missing.empty()) fmt::print("  missing  {}\n", fmt::join(of.missing, ", "));
}

nlohmann::json to_json(const std::vector<Fabric>& fabrics) {
  using nlohmann::json;
  const auto known = [](double value) { return std::isnan(value) ? json() : json(value); };
  json all = json::array();
  for (const Fabric& of : fabrics)
    all.push_back({{"name", of.name},
                   {"words", of.words},
                   {"density", of.density},
                   {"rigidity", of.rigidity},
                   {"scatter", known(of.scatter)},
                   {"thickness", known(of.thickness)},
                   {"shear", known(of.shear)},
                   {"drape", known(of.drape)},
                   {"source", of.source},
                   {"place", of.place},
                   {"method", of.method},
                   {"missing", of.missing}});
  return all;
}

/// B of the typed numbers along two directions [N m]; one number stands for both.
std::array<double, 2> typed_rigidity(const FabricOptions& options) {
  const std::vector<double>& typed = options.kes.empty() ? options.bending_length : options.kes;
  std::array<double, 2> rigidity;
  for (size_t k = 0; k < 2; ++k) {
    const double value = typed[std::min(k, typed.size() - 1)];
    rigidity[k] = options.kes.empty() ? 1e-3 * options.weight * g * std::pow(1e-3 * value, 3)
                                      : 1e-6 * gram_force_cm * value;
  }
  return rigidity;
}

/// One's own numbers as a [[fabric]] of a file.
int print_own(const FabricOptions& options) {
  if (options.names.size() != 1) throw InputError("--weight needs one NAME for the fabric");
  if (options.kes.empty() == options.bending_length.empty())
    throw InputError("--weight needs one of --bending-length and --kes");
  const auto [first, second] = typed_rigidity(options);
  fmt::print("[[fabric]]\nname = \"{}\"\nwords = \"own measurement\"\ndensity = {:.6g}\n",
             options.names[0], 1e-3 * options.weight);
  fmt::print("rigidity = {{ first = {:.4g}, second = {:.4g} }}\n", first, second);
  if (options.drape > 0) fmt::print("drape = {:.4g}\n", options.drape / 100);
  fmt::print(
      "source = \"own laboratory\"\nplace = \"typed: {}\"\nmethod = \"{}\"\nmissing = "
      "[\"scatter\", \"friction\"]\n",
      fmt::join(options.kes.empty() ? options.bending_length : options.kes, ", "),
      options.kes.empty() ? "cantilever (FAST-2, BS 3356), bending length in mm"
                          : "KES-F pure bending, in gf cm^2/cm");
  return all_hold;
}

int show_fabrics(const FabricOptions& options) {
  if (options.weight > 0) return print_own(options);
  const std::string file =
      options.fabrics.empty() ? data_folder() + "/cases/fabrics.toml" : options.fabrics;
  const std::vector<Fabric> all = read_fabrics(file);
  std::vector<Fabric> shown;
  for (const std::string& name : options.names) shown.push_back(fabric_named(all, name, file));
  if (options.names.empty()) shown = all;
  if (options.json) {
    fmt::print("{}\n", json_text(to_json(shown)));
    return all_hold;
  }
  print(shown);
  if (!options.names.empty()) std::ranges::for_each(shown, print_card);
  return all_hold;
}

constexpr const char* below_fabric =
    R"(Without NAME: all of cases/fabrics.toml. A case takes one by name: [cloth] fabric = "denim".
With --weight: your own numbers as a fabric; append the text to a copy of fabrics.toml beside your
case. One number of --bending-length or --kes stands for both directions.

Examples:
  foldproof fabric denim cotton-twill
  foldproof fabric mine --weight 180 --bending-length 19,16 --drape 61 >> fabrics.toml

Exit codes:
  0    shown
  2    bad input)";

}  // namespace

void add_fabric_command(CLI::App& app, Program& program) {
  auto [fabric, options] = add_command(
      app, program,
      {"fabric", "Measured fabrics side by side; your laboratory's numbers as one", below_fabric},
      show_fabrics);
  fabric->add_option("NAME", options.names, "Fabrics, or the name of your own");
  add_value(fabric, "--fabrics FILE", options.fabrics, "Instead of the shipped cases/fabrics.toml");
  add_value(fabric, "--weight G", options.weight, "Of your own fabric [g/m^2]", positive_number());
  add_value(fabric, "--bending-length C", options.bending_length,
            "Warp,weft by a cantilever (FAST-2, BS 3356) [mm]", positive_number())
      ->delimiter(',');
  add_value(fabric, "--kes B", options.kes, "Warp,weft by KES-F [gf cm^2/cm]", positive_number())
      ->delimiter(',');
  add_value(fabric, "--drape D", options.drape, "Measured drape coefficient [%]",
            positive_number());
  add_json(fabric, options);
}

}  // namespace foldproof
