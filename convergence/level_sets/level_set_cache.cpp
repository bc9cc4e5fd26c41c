// level-set-cache: level sets computed once, for many runs; and files that must not be trusted.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>

#include "convergence/level_sets/cached_level_sets.h"
#include "convergence/study.h"
#include "reference/bodies/deforming_content.h"
#include "reference/level_set/mesh_distance.h"
#include "reference/mesh/shapes.h"
#include "verification/processor_time.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/files/hdf5_file.h"
#include "verification/files/level_set_folder.h"
#include "verification/files/level_set_cache_file.h"

namespace foldproof {

namespace {

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
  return {"level-set-cache.loading-is-cheap",
          "Loading reads a tenth of the numbers that computing reads, or less.",
          {{loading / computing, 0.1, 0, "1",
            "a tenth: with it ten runs cost about one computation more than the first"},
           Table{{"searches by computing", "1"},
                 {"numbers a search reads", "1"},
                 {"displacements by computing", "1"},
                 {"searches by loading", "1"},
                 {"numbers in the file", "1"},
                 {"computing", "s"},
                 {"loading", "s"}}
               .with_row(costs.searches, each, costs.displacements, costs.re_searches, in_file,
                         costs.build, costs.load),
           "counted: every number of the file, against twelve for each displacement of a node and, "
           "for each search for a nearest point, the shortest way down the tree of boxes, so that "
           "computing reads more than this; processor times, of loading the least of five, stand "
           "beside it and are not judged"}};
}

/// Something that makes a good file unfit for what is asked next.
struct Spoiling {
  std::string name, reason;  // the reason that must be given
  std::function<void(const std::string& path)> file;
  std::function<void(MeshSequence&, OctreeSettings&)> request;
};

void keep_file(const std::string&) {}
void keep_request(MeshSequence&, OctreeSettings&) {}

void cut_to(const std::string& path, double share) {
  std::filesystem::resize_file(path,
                               std::uintmax_t(share * double(std::filesystem::file_size(path))));
}

/// Turns a bit in a value of a file.
void turn_bit(const std::string& path, std::uintmax_t from_end) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const auto place = std::streamoff(std::filesystem::file_size(path) - from_end);
  file.seekg(place);
  const char byte = char(file.get());
  file.seekp(place);
  file.put(char(byte ^ 4));
}

/// A body without sense, written with the keys that belong to it.
void write_unsound(const std::string& path) {
  DeformingBody body = make_deforming_body(animation(2), settings(4), BetweenFrames::carried);
  body.frames[1].field.branches[3].children += 1;
  write_level_sets(path, body, input_key(animation(2), settings(4)));
}

std::vector<Spoiling> spoilings() {
  return {
      {"not there", "", [](const std::string& path) { std::filesystem::remove(path); },
       keep_request},
      {"cut at half", "whole HDF5 file", [](const std::string& path) { cut_to(path, 0.5); },
       keep_request},
      {"cut at its last byte", "whole HDF5 file",
       [](const std::string& path) { cut_to(path, 1 - 1e-7); }, keep_request},
      {"empty", "whole HDF5 file", [](const std::string& path) { cut_to(path, 0); }, keep_request},
      {"a text", "whole HDF5 file",
       [](const std::string& path) { std::ofstream(path) << "level sets\n"; }, keep_request},
      {"another HDF5 file", "cannot read",
       [](const std::string& path) { Hdf5::create_file(path).attribute("version", 1); },
       keep_request},
      {"a bit turned", "",
       [](const std::string& path) { turn_bit(path, std::filesystem::file_size(path) / 3); },
       keep_request},
      {"branches that do not fit", "branches", write_unsound, keep_request},
      {"a vertex moved by a rounding", "computed from another", keep_file,
       [](MeshSequence& s, OctreeSettings&) {
         s.positions[1](2, 7) = std::nextafter(s.positions[1](2, 7), 1.0);
       }},
      {"a triangle turned", "computed from another", keep_file,
       [](MeshSequence& s, OctreeSettings&) {
         s.triangles[5] = {s.triangles[5][1], s.triangles[5][2], s.triangles[5][0]};
       }},
      {"another time", "computed from another", keep_file,
       [](MeshSequence& s, OctreeSettings&) { s.times[1] = 0.31; }},
      {"another tolerance", "computed from another", keep_file,
       [](MeshSequence&, OctreeSettings& how) { how.tolerance = 1.01e-3; }}};
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
  Table answers{{"file", ""}, {"refused or replaced wrongly", "1"}, {"reason", ""}};
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
  result.findings.push_back(loaded_is_the_same(costs));
  result.findings.push_back(loading_is_cheap(costs));
  progress(0.2);
  result.findings.push_back(unfit_files_are_rejected());
  progress(0.7);
  result.findings.push_back(runs_with_cached_level_sets_agree());
  result.findings.push_back(unfit_grids_are_rejected());
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
