// level-set-cache: level sets computed once, for many runs; and files that must not be trusted.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>

#include "convergence/study.h"
#include "verification/files/deforming_content.h"
#include "verification/files/grid_content.h"
#include "reference/dynamics/simulate.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/mesh/mesh_file.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"
#include "verification/files/hdf5_file.h"
#include "verification/files/level_set_cache_file.h"
#include "verification/files/level_set_folder.h"
#include "verification/processor_time.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

TriangleSoup ball(int subdivisions) {
  const TriangleMesh mesh = make_icosphere(0.21, subdivisions);
  return {mesh.rest, mesh.triangles, {}};
}

/// A cloth that falls on three bodies: a grid, an octree, and one that breathes.
std::string case_text(const ScratchFolder& folder) {
  write_obj(folder.file("ball.obj"), ball(2).rest, ball(2).triangles);
  const std::string mesh = "[[object]]\nmesh = \"ball.obj\"\ncells = 12\n";
  return "[cloth]\nshape = \"sheet\"\npattern = \"alternating\"\nwidth = 0.9\nheight = "
         "0.7\ncolumns = 9\nrows = 7\n"
         "density = 0.2\nturn = { axis = [1, 0, 0], angle = -90 }\nmove = [-0.4, 0.22, "
         "0.3]\n[gravity]\n"
         "[stretch]\nstiffness = 20.0\n[time]\nend = 0.15\n" +
         mesh + "move = [0.2, 0.0, 0.0]\n" + mesh +
         "field = \"octree\"\nmove = [-0.2, 0.0, 0.0]\n" + mesh +
         "interval = 0.05\n[[object.deform]]\nkind = \"breathe\"\namplitude = 0.4\nperiod = 0.3\n";
}

State end_of_run(const std::string& text, const std::string& path,
                 const LevelSetProvider& provider) {
  const Scene scene = read_scene_text(text, path);
  const BuiltScene built = build(scene, provider);
  return simulate(built.system, integrator_named(scene.integrator), built.start, scene.schedule, {})
      .last;
}

/// Something that makes a good file unfit for what is asked next.
struct Spoiling {
  std::string name, reason;  // the reason that must be given
  std::function<void(const std::string& path)> file = [](const std::string&) {};
  std::function<void(MeshSequence&, OctreeSettings&)> request = [](MeshSequence&, OctreeSettings&) {
  };
};

void cut_to(const std::string& path, double share) {
  std::filesystem::resize_file(path,
                               std::uintmax_t(share * double(std::filesystem::file_size(path))));
}

void cut_at_half(const std::string& path) { cut_to(path, 0.5); }

void write_a_text(const std::string& path) { std::ofstream(path) << "level sets\n"; }

void write_another_file(const std::string& path) {
  Hdf5::create_file(path).attribute("version", 1);
}

/// Turns a bit in a value of a file, at this part of its length.
void turn_bit(const std::string& path, double part) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const auto place = std::streamoff(part * double(std::filesystem::file_size(path)));
  file.seekg(place);
  const char byte = char(file.get());
  file.seekp(place);
  file.put(char(byte ^ 4));
}

bool is_same(const Grid& a, const Grid& b) { return content_key(a) == content_key(b); }

NamedFinding runs_with_cached_level_sets_agree() {
  const ScratchFolder folder;
  const std::string text = case_text(folder), path = folder.file("case.toml");
  int loaded = 0;
  const auto listen = [&](const std::string& line) {
    loaded += line.find("loaded") != std::string::npos;
  };
  const State without = end_of_run(text, path, computing_provider());
  const State first = end_of_run(text, path, caching_provider(folder.file("kept"), listen));
  const int early = loaded;
  const State second = end_of_run(text, path, caching_provider(folder.file("kept"), listen));
  const auto differs = [&](const State& s) {
    return s.x == without.x && s.v == without.v ? 0.0 : 1.0;
  };
  return {
      "level-set-cache.runs-are-bitwise-equal",
      "A run whose bodies come from stored level sets ends as one that computes them, bit for bit.",
      {{differs(first) + differs(second) + std::abs(early) + std::abs(loaded - early - 3), 0, 0,
        "1",
        "values are stored in full: no bit may differ, and the second run loads all three bodies"},
       Table("run that writes differs [1]; run that loads differs [1]; bodies loaded by the second "
             "run [1]")
           .with_row(differs(first), differs(second), double(loaded - early)),
       "a grid, an octree and a body that deforms under a falling cloth"}};
}

NamedFinding unfit_grids_are_rejected() {
  const ScratchFolder folder;
  std::vector<std::string> said;
  const LevelSetProvider provider =
      caching_provider(folder.file("kept"), [&](const std::string& line) { said.push_back(line); });
  const GridMethod method{14, 4, 3, MarchingOrder::second};
  const auto file_of = [&](const TriangleSoup& soup) {
    return folder.file("kept/" + input_key(soup, method, Repair::refuse) + ".h5");
  };
  const auto make = [&](const TriangleSoup& soup) {
    return provider.make_level_set(soup, method, Repair::refuse);
  };
  const auto good = make(ball(2));
  make(ball(1));
  Table answers("file; refused or replaced wrongly [1]; said");
  const auto take_another = [&](const std::string& path) {
    std::filesystem::copy_file(file_of(ball(1)), path,
                               std::filesystem::copy_options::overwrite_existing);
  };
  for (const Spoiling& spoiling :
       {Spoiling{"cut at half", "whole HDF5 file", cut_at_half},
        {"a text", "whole HDF5 file", write_a_text},
        {"another HDF5 file", "cannot read", write_another_file},
        {"the grid of another mesh", "another mesh", take_another},
        {"a bit turned", "", [](const std::string& path) { turn_bit(path, 0.5); }}}) {
    spoiling.file(file_of(ball(2)));
    said.clear();
    const bool is_rebuilt = is_same(*make(ball(2)), *good);
    const std::string reason = said.empty() ? "" : said.front();
    const bool is_rejected = reason.find("refused") != std::string::npos &&
                             reason.find(spoiling.reason) != std::string::npos;
    const bool is_good_again = is_same(*make(ball(2)), *good) && !said.empty() &&
                               said.back().find("loaded") != std::string::npos;
    answers.row(spoiling.name,
                (is_rebuilt ? 0 : 1) + (is_rejected ? 0 : 1) + (is_good_again ? 0 : 1),
                reason.substr(0, reason.find('/')) +
                    reason.substr(std::min(reason.size(), reason.rfind('/'))));
  }
  return {"level-set-cache.invalid-grids-are-rejected",
          "A stored grid that is truncated, damaged, of another format or of another mesh is "
          "refused with the reason, and replaced.",
          judge_worst(answers, "refused or replaced wrongly", 0,
                      "each must be refused and said so, and the new file be good")};
}

/// A ball that bends, in three frames.
MeshSequence animation(int subdivisions) {
  const auto bent = [](const Vector3& X, double t) -> Vector3 {
    return X + t * Vector3(0.3 * X.y() * X.y(), 1.1 * X.x() * X.x(), 0.4 * X.z());
  };
  return deformed_mesh(make_icosphere(0.21, subdivisions), bent, {0, 0.3, 0.7});
}

OctreeSettings settings(int depth) {
  return {Vector3::Constant(-0.5), 1, depth, 3, 1e-3, 0.04, 0.3, 0, HangingNodes::constrained};
}

struct Kept {
  std::shared_ptr<const DeformingBody> body;
  bool was_loaded = false;
  // why the file that was there was not taken; empty if none was, or it was taken
  std::string why_rejected;
};

/// The body as a program gets it that keeps level sets in the folder.
Kept kept(const std::string& folder, const MeshSequence& sequence, const OctreeSettings& how) {
  Kept result;
  const auto listen = [&](const std::string& line) {
    result.was_loaded |= line.starts_with("level sets loaded");
    if (const size_t at = line.find("refused: "); at != std::string::npos)
      result.why_rejected = line.substr(at);
  };
  result.body =
      caching_provider(folder, listen).make_deforming_body(sequence, how, BetweenFrames::carried);
  return result;
}

/// Where it is kept.
std::string file_of(const std::string& folder, const MeshSequence& sequence,
                    const OctreeSettings& how) {
  return (std::filesystem::path(folder) / (input_key(sequence, how) + ".h5")).string();
}

/// Answers that differ in a bit, at points and times of all kinds.
constexpr int questions = 4000;
double different_answers(const DeformingBody& a, const DeformingBody& b) {
  double different = 0;
  for (int i = 0; i < questions; ++i) {
    const Vector3 p(std::sin(1.3 * i), std::sin(2.9 * i + 1), std::sin(4.7 * i + 2));
    const double t = 0.8 * std::abs(std::sin(0.7 * i)) - 0.05;
    const DeformingPoint x = deforming_at(a, 0.6 * p, t), y = deforming_at(b, 0.6 * p, t);
    different += !(x.phi == y.phi && x.normal == y.normal && x.velocity == y.velocity);
  }
  return different;
}

struct Costs {
  // processor time; of loading the least of five [s]
  double build, load;
  double bytes;  // of the file
  // of the first request: searches for nearest points, and displacements of nodes that were
  // interpolated; of the last one: searches
  long searches, displacements, re_searches;
};

/// Searches for the nearest point of the mesh that this body's level sets took.
long searches_of(const DeformingBody& body) {
  long searches = 0;
  for (const DeformingFrame& frame : body.frames) searches += frame.searches;
  return searches;
}

/// Displacements of its nodes, to the next frame and from the one before.
long displacements_of(const DeformingBody& body) {
  constexpr long nodes_a_branch = 27;
  long displacements = 0;
  for (const DeformingFrame& frame : body.frames)
    displacements += nodes_a_branch * long(frame.to_next.size() + frame.from_previous.size());
  return displacements;
}

NamedFinding loaded_is_the_same(Costs& costs) {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("kept");
  double start = processor_seconds();
  const Kept built = kept(folder, animation(3), settings(6));
  costs.build = processor_seconds() - start;
  costs.bytes = double(std::filesystem::file_size(file_of(folder, animation(3), settings(6))));
  costs.load = INFINITY;
  Kept loaded;
  for (int i = 0; i < 5; ++i) {
    start = processor_seconds();
    loaded = kept(folder, animation(3), settings(6));
    costs.load = std::min(costs.load, processor_seconds() - start);
  }
  costs.searches = searches_of(*built.body);
  costs.displacements = displacements_of(*built.body);
  costs.re_searches = searches_of(*loaded.body);
  const double different = different_answers(*built.body, *loaded.body),
               wrong = (built.was_loaded ? 1 : 0) + (loaded.was_loaded ? 0 : 1) + different;
  return {"level-set-cache.loaded-fields-are-bitwise-equal",
          "Stored level sets are loaded, and answer bit for bit as the computed ones.",
          {{wrong, 0, 0, "1", "values are stored in full"},
           Table{{"points and times asked", "1"}, {"answers that differ", "1"}}.with_row(questions,
                                                                                         different),
           "measured is the number of answers that differ, and of requests wrongly answered by "
           "computing or by loading"}};
}

/// The least that any search for a nearest point reads: both children's boxes at each level of the
/// shortest way down the tree, six numbers each, and the triangles of the leaf, nine each.
double numbers_per_search(const BoxTree& tree, int node) {
  const BoxNode& here = tree.nodes[size_t(node)];
  if (here.right < 0) return 9 * here.count;
  return 12 + std::min(numbers_per_search(tree, node + 1), numbers_per_search(tree, here.right));
}

NamedFinding loading_is_cheap(const Costs& costs) {
  const MeshSequence sequence = animation(3);
  const BoxTree tree = make_mesh_distance(sequence.positions[0], sequence.triangles).tree;
  const double each = numbers_per_search(tree, 0), in_file = costs.bytes / sizeof(double);
  // a displacement is that of a triangle's three corners with their weights
  constexpr double numbers_a_displacement = 12;
  const double computing =
      each * double(costs.searches) + numbers_a_displacement * double(costs.displacements);
  const double loading = in_file + each * double(costs.re_searches);
  return {
      "level-set-cache.loading-is-cheap",
      "Loading reads a tenth of the numbers that computing reads, or less.",
      {{loading / computing, 0.1, 0, "1",
        "a tenth: with it ten runs cost about one computation more than the first"},
       Table("searches by computing [1]; numbers a search reads [1]; displacements by computing "
             "[1]; searches by loading [1]; numbers in the file [1]; computing [s]; loading [s]")
           .with_row(costs.searches, each, costs.displacements, costs.re_searches, in_file,
                     costs.build, costs.load),
       "counted: every number of the file, against twelve for each displacement of a node and, "
       "for each search for a nearest point, the shortest way down the tree of boxes, so that "
       "computing reads more than this; processor times, of loading the least of five, stand "
       "beside it and are not judged"}};
}

/// A body without sense, written with the keys that belong to it.
void write_unsound(const std::string& path) {
  DeformingBody body = make_deforming_body(animation(2), settings(4), BetweenFrames::carried);
  body.frames[1].field.branches[3].children += 1;
  write_level_sets(path, body, input_key(animation(2), settings(4)));
}

std::vector<Spoiling> spoilings() {
  const std::string other = "computed from another";
  std::vector<Spoiling> all = {
      {"not there", "", [](const std::string& path) { std::filesystem::remove(path); }},
      {"cut at half", "whole HDF5 file", cut_at_half},
      {"cut at its last byte", "whole HDF5 file",
       [](const std::string& path) { cut_to(path, 1 - 1e-7); }},
      {"empty", "whole HDF5 file", [](const std::string& path) { cut_to(path, 0); }},
      {"a text", "whole HDF5 file", write_a_text},
      {"another HDF5 file", "cannot read", write_another_file},
      {"a bit turned", "", [](const std::string& path) { turn_bit(path, 2.0 / 3); }},
      {"branches that do not fit", "branches", write_unsound}};
  all.push_back({.name = "a vertex moved by a rounding",
                 .reason = other,
                 .request = [](MeshSequence& s, OctreeSettings&) {
                   s.positions[1](2, 7) = std::nextafter(s.positions[1](2, 7), 1.0);
                 }});
  all.push_back({.name = "a triangle turned",
                 .reason = other,
                 .request = [](MeshSequence& s, OctreeSettings&) {
                   s.triangles[5] = {s.triangles[5][1], s.triangles[5][2], s.triangles[5][0]};
                 }});
  all.push_back({.name = "another time",
                 .reason = other,
                 .request = [](MeshSequence& s, OctreeSettings&) { s.times[1] = 0.31; }});
  all.push_back({.name = "another tolerance",
                 .reason = other,
                 .request = [](MeshSequence&, OctreeSettings& how) { how.tolerance = 1.01e-3; }});
  return all;
}

/// Without the path of the file.
std::string reason_given(const std::string& why) {
  const size_t name_at = why.find(".h5");
  if (why.empty()) return "no file";
  return name_at == std::string::npos ? why : why.substr(name_at + 3);
}

NamedFinding unfit_files_are_rejected() {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("kept"),
                    good = file_of(folder, animation(2), settings(4)),
                    spoilt = scratch.file("spoilt");
  kept(folder, animation(2), settings(4));
  Table answers("file; refused or replaced wrongly [1]; reason");
  for (const Spoiling& spoiling : spoilings()) {
    MeshSequence sequence = animation(2);
    OctreeSettings how = settings(4);
    spoiling.request(sequence, how);
    std::filesystem::create_directories(spoilt);
    const std::string path = file_of(spoilt, sequence, how);
    std::filesystem::copy_file(good, path, std::filesystem::copy_options::overwrite_existing);
    spoiling.file(path);
    const bool is_there = std::filesystem::exists(path);
    const Kept rebuilt = kept(spoilt, sequence, how), again = kept(spoilt, sequence, how);
    const bool is_rejected = !rebuilt.was_loaded && rebuilt.why_rejected.empty() != is_there &&
                             rebuilt.why_rejected.find(spoiling.reason) != std::string::npos;
    answers.row(spoiling.name, (is_rejected ? 0 : 1) + (again.was_loaded ? 0 : 1),
                reason_given(rebuilt.why_rejected));
  }
  return {"level-set-cache.invalid-files-are-rejected",
          "A file that is truncated, damaged, of another format or computed from other input is "
          "refused with the reason, and replaced.",
          judge_worst(answers, "refused or replaced wrongly", 0,
                      "each must be refused, and the new file be good")};
}

StudyResult run_level_set_cache(const Subject&, Tier, const Progress& progress) {
  Costs costs{};
  StudyResult result;
  result.add({loaded_is_the_same(costs), loading_is_cheap(costs)});
  progress(0.2);
  result.findings.push_back(unfit_files_are_rejected());
  progress(0.7);
  result.add({runs_with_cached_level_sets_agree(), unfit_grids_are_rejected()});
  return result;
}

}  // namespace

Study level_set_cache_study() {
  return {"level-set-cache",
          "Level sets loaded from a file answer as computed ones do, bit for bit; loading reads a "
          "tenth of the numbers that computing reads, or less; invalid files are rejected.",
          {"loaded-fields-are-bitwise-equal", "runs-are-bitwise-equal", "loading-is-cheap",
           "invalid-files-are-rejected", "invalid-grids-are-rejected"},
          "BMF03 section 5.1",
          "A whole animation's level sets are stored in a file with the key of what they were "
          "computed from. How much does a second run still cost, and can it be fooled?",
          run_level_set_cache};
}

}  // namespace foldproof
