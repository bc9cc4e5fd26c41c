// foldproof material: a fabric's numbers as another engine takes them, and an engine's as a fabric.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/pattern.h"
#include "reference/scene/fabrics.h"
#include "reference/scene/key_file.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/engine_table.h"

namespace foldproof {

namespace {

constexpr double assumed_shear = 50;  // N/m; six measured woven fabrics have 41 to 126

struct MaterialOptions : Options {
  std::string fabrics, engine, mesh;
  std::vector<long> pair = {};         // substeps, iterations
  std::vector<std::string> from = {};  // engine, file
};

bool is_measured(double value) { return std::isfinite(value); }

std::string engines_file() { return data_folder() + "/cases/engines.toml"; }

// From a fabric to an engine ------------------------------------------------------------------

/// Quantities that an engine's numbers are products of; Y = 8/3 G in all engines.
Values values_of(const Fabric& fabric, const Engine& engine) {
  const double shear = is_measured(fabric.shear) ? fabric.shear : assumed_shear;
  Values values{{"density", fabric.density},
                {"rigidity", fabric.rigidity[0]},
                {"shear", shear},
                {"young", 8 * shear / 3}};
  add_poisson(values, engine.poisson);
  return values;
}

bool is_of_hinges(const Product& product) {
  return product.powers.contains("rigidity") && product.powers.contains("area");
}

/// Its area, and the mean edge and triangle of its hinges.
Values shape_of(const std::string& file) {
  if (file.empty()) return {};
  const TriangleMesh mesh = flat_panels(read_mesh(file));
  Values mean{{"sheet", rest_areas(mesh).sum()}, {"vertices", double(mesh.particles())}};
  const std::vector<std::array<EdgeSide, 2>> sides = edge_sides(mesh);
  for (const Hinge& hinge : mesh.hinges) {
    const auto& [one, other] = sides[size_t(hinge.edge)];
    mean["length"] += one.length / double(mesh.hinges.size());
    mean["area"] += (one.area + other.area) / 2 / double(mesh.hinges.size());
  }
  return mean;
}

void print_remark(const Engine& engine, const std::string& text) {
  fmt::print("{} {}{}\n", engine.comment, text, engine.comment_end);
}

Values united(Values one, const Values& other) {
  one.insert(other.begin(), other.end());
  return one;
}

/// The snippet's text with its {names} replaced.
std::string filled(const Engine& engine, const std::map<std::string, std::string>& texts) {
  std::string text = engine.snippet;
  for (const auto& [name, value] : texts) {
    const std::string mark = "{" + name + "}";
    for (size_t at = 0; (at = text.find(mark, at)) != std::string::npos; at += value.size())
      text.replace(at, mark.size(), value);
  }
  return text;
}

/// Inside a comment of a file, a comment cannot start.
std::string assumed_in(const Engine& engine) {
  return engine.comment_end.empty() ? engine.comment + " assumed" : "assumed";
}

/// As comments: the fabric, the engine, what the snippet leaves out.
void print_head(const Fabric& fabric, const Engine& engine) {
  std::vector<std::string> lines{fmt::format("{}: {}; {:g} kg/m^2, B = {:.4g} N m", fabric.name,
                                             fabric.words, fabric.density, fabric.rigidity[0]),
                                 "source: " + fabric.source, "for " + engine.words};
  if (fabric.rigidity[0] != fabric.rigidity[1])
    lines.push_back(fmt::format("left out: B = {:.4g} N m along the fabric's second direction",
                                fabric.rigidity[1]));
  for (const std::string& what : engine.cannot) lines.push_back("cannot represent: " + what);
  for (const std::string& line : lines) print_remark(engine, line);
}

int print_material(const MaterialOptions& options, const Fabric& fabric) {
  Engine engine = engine_named(read_engines(engines_file()), options.engine);
  if (!options.pair.empty() && engine.pair.empty())
    throw InputError(engine.name + " has no substeps and iterations: leave out --pair");
  if (!options.pair.empty()) engine.pair = options.pair;
  Values values = values_of(fabric, engine), mesh = shape_of(options.mesh);
  if (mesh.empty() && !engine.comment_end.empty()) mesh["sheet"] = 1;  // a file has no code
  for (const auto& [name, value] : mesh)
    if (name == "sheet" || name == "vertices") values[name] = value;
  print_head(fabric, engine);
  std::map<std::string, std::string> texts{
      {"substeps", engine.pair.empty() ? "" : std::to_string(engine.pair[0])},
      {"iterations", engine.pair.empty() ? "" : std::to_string(engine.pair[1])},
      {"pair", options.pair.empty() ? assumed_in(engine) : "as typed"},
      {"why", is_measured(fabric.shear) ? "from the measured shear" : assumed_in(engine)},
      {"density", fmt::format("{:g}", fabric.density)},
      {"mass_of", options.mesh.empty() ? "kg, of 1 m^2: times the area of your sheet"
                                       : "kg, of " + options.mesh}};
  for (const auto& [name, unit, product] : engine.numbers) {
    texts[name] = code_of(product, values);
    if (is_measured(value_of(product, values))) values.emplace(name, value_of(product, values));
    if (is_of_hinges(product) && mesh.contains("area"))
      print_remark(engine, fmt::format("one {} for all hinges of {}: {} {}", name, options.mesh,
                                       code_of(product, united(values, mesh)), unit));
    if (engine.snippet.empty())
      print_remark(engine, fmt::format("{} = {} [{}]", name, texts[name], unit));
  }
  fmt::print("{}", filled(engine, texts));
  return all_hold;
}

// From an engine to a fabric -------------------------------------------------------------------

/// What a file says of a number: its value, and whether code or a remark follows that gives it the
/// mesh's lengths and areas.
struct Found {
  double value;
  bool is_coefficient;
};

std::optional<Found> find_number(const std::string& text, const std::string& name) {
  const std::regex pattern(
      "(?:^|[^\\w-])" + name +
      "[\"']?\\s*[=:,]\\s*[\"']?([-+]?(?:\\d+\\.?\\d*|\\.\\d+)(?:[eE][-+]?\\d+)?)"
      "([^\\n,]*(?:\\n[^\\n]*of 1 m\\^2)?)");
  std::smatch match;
  if (!std::regex_search(text, match, pattern)) return std::nullopt;
  const std::string rest = match[2];
  return Found{std::stod(match[1]), rest.find(" length") != std::string::npos ||
                                        rest.find("of 1 m^2") != std::string::npos};
}

bool is_poisson(const Product& product) { return product.powers.contains("poisson"); }

/// An engine's `young` may be another quantity than the fabric's.
bool is_of_fabric(const std::string& name) {
  return name == "density" || name == "rigidity" || name == "shear" || name == "young";
}

/// Density, rigidity, shear and Young's modulus, as far as the engine's numbers give them.
Values neutral_values(const Engine& engine, const std::string& text, const Values& mesh,
                      std::string& read) {
  Values values = mesh;
  add_poisson(values, engine.poisson);
  for (const EngineNumber& number : engine.numbers)
    if (const auto found = find_number(text, number.name); found && is_poisson(number.value))
      add_poisson(values, found->value);
  std::vector<std::pair<Product, double>> left{{engine.relation, 1}};
  for (const EngineNumber& number : engine.numbers) {
    const std::optional<Found> found = find_number(text, number.name);
    if (!found || is_poisson(number.value)) continue;
    read += (read.empty() ? "" : ", ") + fmt::format("{} = {:g}", number.name, found->value);
    if (!is_of_fabric(number.name)) values[number.name] = found->value;
    Product product = number.value;
    if (found->is_coefficient)
      for (const char* shape : {"length", "area", "sheet"}) product.powers.erase(shape);
    left.emplace_back(product, found->value);
  }
  for (size_t round = 0; round < engine.numbers.size() + 1; ++round)
    for (const auto& [product, number] : left) solve(product, number, values);
  return values;
}

void print_fabric(const std::string& name, const std::string& numbers, const MaterialOptions& of,
                  const std::string& read) {
  fmt::print(
      "[[fabric]]\nname = \"{}\"\nwords = \"read from an engine's file\"\n{}source = \"{}\"\n"
      "place = \"{}\"\nmethod = \"foldproof material --from {}\"\nmissing = [\"scatter\", "
      "\"friction\", \"how the numbers were found\"]\n",
      name, numbers, of.from[1], read, of.from[0]);
}

/// ARCSim's material: density [kg/m^2], stretching [N/m] and bending [J] of its hinges, rows for 0,
/// 45 and 90 degrees, columns for curvatures.
int from_arcsim(const std::string& name, const std::string& text, const MaterialOptions& options) {
  const auto all = nlohmann::json::parse(text, nullptr, false);
  try {
    const double density = all.at("density"), first = all.at("bending").at(0).at(0),
                 second = all.at("bending").at(2).at(0), shear = all.at("stretching").at(0).at(3);
    print_fabric(name,
                 fmt::format("density = {:.6g}\nhinge_stiffness = {{ first = {:.8g}, second = "
                             "{:.8g} }}\nshear = {:.6g}\n",
                             density, first, second, shear),
                 options, "density; bending, rows 1 and 3, column 1; stretching, row 1, column 4");
  } catch (const nlohmann::json::exception&) {
    throw InputError(
        options.from[1] +
        ": an ARCSim material has density, bending (3 rows) and stretching (4 columns)");
  }
  return all_hold;
}

int print_neutral(const MaterialOptions& options) {
  const std::string& file = options.from[1];
  const std::string text = read_text(file), name = options.names.empty()
                                                       ? std::filesystem::path(file).stem().string()
                                                       : options.names[0];
  if (options.from[0] == "arcsim") return from_arcsim(name, text, options);
  const Engine engine = engine_named(read_engines(engines_file()), options.from[0]);
  std::string read;
  Values values = neutral_values(engine, text, shape_of(options.mesh), read);
  for (const char* needed : {"density", "rigidity"})
    if (!values.contains(needed))
      throw InputError(fmt::format("{}: no {} follows from its numbers of {}: {}{}", file, needed,
                                   engine.name, read.empty() ? "none was found" : read,
                                   options.mesh.empty() ? "; some need --mesh FILE" : ""));
  std::string numbers =
      fmt::format("density = {:.6g}\nrigidity = {{ first = {:.6g}, second = {:.6g} }}\n",
                  values["density"], values["rigidity"], values["rigidity"]);
  if (values.contains("shear")) numbers += fmt::format("shear = {:.6g}\n", values["shear"]);
  print_fabric(name, numbers, options, read);
  return all_hold;
}

int material(const MaterialOptions& options) {
  if (!options.from.empty()) return print_neutral(options);
  if (options.names.size() != 1 || options.engine.empty())
    throw InputError("material needs FABRIC --engine NAME, or --from ENGINE FILE");
  const std::string file =
      options.fabrics.empty() ? data_folder() + "/cases/fabrics.toml" : options.fabrics;
  const std::string& wanted = options.names[0];
  if (!wanted.ends_with(".toml"))
    return print_material(options, fabric_named(read_fabrics(file), wanted, file));
  return print_material(options, read_fabrics(wanted).front());
}

constexpr const char* below_material =
    R"(Prints a snippet that gives cloth the fabric's weight and rigidity in the engine's own names,
and comments on what it cannot represent. What no source measured is marked "assumed". B is that
of a sheet bent to a cylinder, as `judge calibration` measures it; stretch follows from the shear
by Y = 8/3 G. verification/subjects/ENGINES.md says what each number means and how it was checked.

Examples:
  foldproof material denim --engine newton-vbd > denim.py
  foldproof material mine --from arcsim 11oz-black-denim.json >> fabrics.toml

Exit codes:
  0    printed
  2    bad input)";

}  // namespace

void add_material_command(CLI::App& app, Program& program) {
  auto [command, options] = add_command(
      app, program,
      {"material", "A fabric in an engine's own numbers, or an engine's numbers as a fabric",
       below_material},
      material);
  command->add_option("FABRIC", options.names, "A fabric's name, or its file NAME.toml");
  add_value(command, "--engine NAME", options.engine,
            "newton-vbd, newton-style3d, mujoco, jolt, blender, ppf, ...");
  add_value(command, "--mesh FILE", options.mesh, "Your cloth: its area, and one number for it");
  add_value(command, "--pair S,I", options.pair, "Substeps and iterations that you use",
            whole_number(1, 1000000))
      ->delimiter(',')
      ->expected(2);
  add_value(command, "--from ENGINE FILE", options.from,
            "Read that engine's numbers (arcsim, newton-vbd, newton-style3d, mujoco, ppf)")
      ->expected(2);
  add_value(command, "--fabrics FILE", options.fabrics,
            "Instead of the shipped cases/fabrics.toml");
}

}  // namespace foldproof
