// foldproof material: a fabric's numbers as another engine takes them, and an engine's as a fabric.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <regex>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/pattern.h"
#include "reference/mesh/rigidity_map.h"
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

double sheet_area(const TriangleMesh& mesh) { return rest_areas(mesh).sum(); }

/// The rigidities along x and y of a flat sheet whose hinges all take `number` for the product
/// [N m]. A hinge of rigidity B stores B w angle^2: as ke = 4 B in reference/mesh/rigidity_map.h.
std::array<double, 2> rigidity_with(double number, const Product& product, const Values& values,
                                    const TriangleMesh& mesh) {
  RestPlane plane;
  if (!is_flat(mesh, plane)) return {none_measured, none_measured};
  const std::vector<FlatElement> elements = flat_hinges(mesh, plane);
  const std::vector<std::array<EdgeSide, 2>> sides = edge_sides(mesh);
  Rigidity sum;
  for (size_t h = 0; h < elements.size(); ++h) {
    const auto& [one, other] = sides[size_t(mesh.hinges[h].edge)];
    Values of_hinge = values;
    of_hinge.erase("rigidity");
    of_hinge["length"] = one.length, of_hinge["area"] = (one.area + other.area) / 2;
    if (!solve(product, number, of_hinge)) return {none_measured, none_measured};
    sum.R += 4 * of_hinge["rigidity"] * elements[h].energy / sheet_area(mesh);
  }
  return {sum.along(0), sum.along(std::numbers::pi / 2)};
}

bool is_of_hinges(const Product& product) {
  return product.powers.contains("rigidity") && product.powers.contains("area");
}

std::string remark(const Engine& engine, const std::string& text) {
  return engine.comment + " " + text + engine.end_of_comment + "\n";
}

/// For engines or helpers that give all hinges one number: the one for this mesh, and what it does.
void print_for_mesh(const Engine& engine, const Values& values, const std::string& file) {
  const TriangleMesh mesh = flat_panels(read_mesh(file));
  for (const EngineNumber& number : engine.numbers) {
    if (!is_of_hinges(number.value)) continue;
    const double wanted = values.at("rigidity"), trial = 1;
    const auto [along_x, along_y] = rigidity_with(trial, number.value, values, mesh);
    if (!is_measured(along_x))
      throw InputError(file + ": the sheet is not flat, nor has a pattern");
    const double one = std::pow(wanted / along_x, number.value.powers.at("rigidity"));
    fmt::print("{}", remark(engine, fmt::format("one {} for all hinges of {}: {:.6g} {} bends as "
                                                "{:.4g} N m along x, {:.4g} along y",
                                                number.name, file, one, number.unit, wanted,
                                                wanted * along_y / along_x)));
  }
}

/// The snippet's text with its {names} replaced.
std::string filled(const Engine& engine, const std::map<std::string, std::string>& texts) {
  std::string text;
  for (size_t at = 0; at < engine.snippet.size();) {
    const size_t open = engine.snippet.find('{', at), close = engine.snippet.find('}', open);
    const std::string name =
        close == std::string::npos ? "" : engine.snippet.substr(open + 1, close - open - 1);
    if (!name.empty() && texts.contains(name)) {
      text += engine.snippet.substr(at, open - at) + texts.at(name);
      at = close + 1;
    } else {
      const size_t end = open == std::string::npos ? open : open + 1 - at;
      text += engine.snippet.substr(at, end);
      at = open == std::string::npos ? engine.snippet.size() : open + 1;
    }
  }
  return text;
}

/// Inside a comment of a file, a comment cannot start.
std::string assumed_in(const Engine& engine) {
  return engine.end_of_comment.empty() ? engine.comment + " assumed" : "assumed";
}

void print_head(const Fabric& fabric, const Engine& engine) {
  const auto line = [&](const std::string& text) { fmt::print("{}", remark(engine, text)); };
  line(fmt::format("{}: {}; {:g} kg/m^2, B = {:.4g} N m", fabric.name, fabric.words, fabric.density,
                   fabric.rigidity[0]));
  line("source: " + fabric.source);
  line("for " + engine.words);
  if (fabric.rigidity[0] != fabric.rigidity[1])
    line(fmt::format("left out: B = {:.4g} N m along the fabric's second direction",
                     fabric.rigidity[1]));
  for (const std::string& what : engine.cannot) line("cannot represent: " + what);
}

int print_material(const MaterialOptions& options, const Fabric& fabric) {
  Engine engine = engine_named(read_engines(data_folder() + "/cases/engines.toml"), options.engine);
  if (!options.pair.empty()) engine.substeps = options.pair[0], engine.iterations = options.pair[1];
  Values values = values_of(fabric, engine);
  std::map<std::string, std::string> texts{
      {"substeps", std::to_string(engine.substeps)},
      {"iterations", std::to_string(engine.iterations)},
      {"pair", options.pair.empty() ? assumed_in(engine) : "as typed"},
      {"why", is_measured(fabric.shear) ? "from the measured shear" : assumed_in(engine)},
      {"density", fmt::format("{:g}", fabric.density)},
      {"mass_of", "kg, of 1 m^2: times the area of your sheet"}};
  if (!options.mesh.empty()) {
    const TriangleMesh mesh = flat_panels(read_mesh(options.mesh));
    values["sheet"] = sheet_area(mesh), values["vertices"] = double(mesh.particles());
    texts["mass_of"] = "kg, of " + options.mesh;
  } else if (engine.comment == "<!--") {
    values["sheet"] = 1;  // a file has no code
  }
  for (const EngineNumber& number : engine.numbers) {
    texts[number.name] = code_of(number.value, values);
    if (const double value = value_of(number.value, values); is_measured(value))
      values.emplace(number.name, value);
  }
  print_head(fabric, engine);
  if (!options.mesh.empty()) print_for_mesh(engine, values, options.mesh);
  if (engine.snippet.empty())
    for (const EngineNumber& number : engine.numbers)
      fmt::print("{}", remark(engine, fmt::format("{} = {} [{}]", number.name, texts[number.name],
                                                  number.unit)));
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

/// Mean of the mesh's hinges, and of the sheet.
Values shape_of(const std::string& file) {
  if (file.empty()) return {};
  const TriangleMesh mesh = flat_panels(read_mesh(file));
  Values mean{{"sheet", sheet_area(mesh)}, {"vertices", double(mesh.particles())}};
  const std::vector<std::array<EdgeSide, 2>> sides = edge_sides(mesh);
  for (const Hinge& hinge : mesh.hinges) {
    const auto& [one, other] = sides[size_t(hinge.edge)];
    mean["length"] += one.length / double(mesh.hinges.size());
    mean["area"] += (one.area + other.area) / 2 / double(mesh.hinges.size());
  }
  return mean;
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
  const std::string text = read_text(options.from[1]);
  const std::string name = options.names.empty()
                               ? std::filesystem::path(options.from[1]).stem().string()
                               : options.names[0];
  if (options.from[0] == "arcsim") return from_arcsim(name, text, options);
  const Engine engine =
      engine_named(read_engines(data_folder() + "/cases/engines.toml"), options.from[0]);
  std::string read, names;
  Values values = neutral_values(engine, text, shape_of(options.mesh), read);
  for (const EngineNumber& number : engine.numbers)
    names += (names.empty() ? "" : ", ") + number.name;
  for (const char* needed : {"density", "rigidity"})
    if (!values.contains(needed))
      throw InputError(fmt::format("{}: no {} follows from {} (found: {}){}", options.from[1],
                                   needed, names, read.empty() ? "nothing" : read,
                                   options.mesh.empty() ? "; some need --mesh FILE" : ""));
  print_fabric(
      name,
      fmt::format("density = {:.6g}\nrigidity = {{ first = {:.6g}, second = {:.6g} }}\n{}",
                  values["density"], values["rigidity"], values["rigidity"],
                  values.contains("shear") ? fmt::format("shear = {:.6g}\n", values["shear"]) : ""),
      options, read);
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
