// foldproof crossings: does a cloth pass through itself? Of stored runs, and of meshes of
// any other program.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "scripts/program/command_line/options_of_commands.h"
#include "reference/mesh/mesh_file.h"
#include "reference/mesh/seams.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/json_text.h"
#include "scripts/program/progress.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/files/stored_run_file.h"

namespace foldproof {

namespace {

struct CrossingsOptions : Options {
  double seams = 0;  // distance within which vertices of meshes are joined [m]; 0: none
};

struct JudgedFrame {
  std::string file;
  std::size_t frame;
  double time;  // s
  std::vector<oracles::EdgeInTriangle> pairs;
  std::size_t repeated, without_area;  // faces that were left out
};

JudgedFrame judge_frame(const std::string& file, std::size_t frame, double time,
                        const PerParticle3& x, const std::vector<Triangle>& triangles) {
  if (!x.allFinite())
    throw InputError(fmt::format("{}: frame {} has positions that are not finite", file, frame));
  return {file, frame, time, oracles::exact_crossings(x, triangles), 0, 0};
}

bool begins_as_hdf5(const std::string& file) {
  std::string start(4, '\0');
  std::ifstream(file, std::ios::binary).read(start.data(), 4);
  return start == "\x89HDF";
}

/// Panels that are not sewn touch, which counts as crossing. Any soup is judged.
void warn_of_mesh(const TriangleSoup& all) {
  const TriangleSoup soup = without_unused_vertices(all);
  std::string words;
  try {
    words = open_seams_in_words(make_triangle_mesh(soup.rest, soup.triangles, soup.origin));
    if (!words.empty()) words = soup.origin.file + ": " + words;
  } catch (const InputError& error) {
    words = error.what();
  }
  if (!words.empty()) log_line("warning: " + words);
}

/// Judges the faces that make a surface, and counts the others.
JudgedFrame judge_surface(const std::string& file, const TriangleSoup& mesh) {
  std::vector<Triangle> sound;
  std::vector<int> numbers;  // of the sound ones
  std::set<Triangle> seen;   // corners in order
  std::size_t repeated = 0, without_area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle corners = mesh.triangles[t];
    std::ranges::sort(corners);
    if (!has_area(mesh.rest, corners)) {
      ++without_area;
    } else if (!seen.insert(corners).second) {
      ++repeated;
    } else {
      sound.push_back(mesh.triangles[t]);
      numbers.push_back(int(t));
    }
  }
  JudgedFrame frame = judge_frame(file, 0, 0, mesh.rest, sound);
  for (auto& [edge, triangle] : frame.pairs) triangle = numbers[std::size_t(triangle)];
  frame.repeated = repeated;
  frame.without_area = without_area;
  return frame;
}

void judge_file(const std::string& file, double seams, std::vector<JudgedFrame>& all) {
  const bool is_mesh = !begins_as_hdf5(file) && !has_ending(file, run_kind);
  require_input(file, is_mesh ? mesh_kind : run_kind);
  if (is_mesh) {
    TriangleSoup mesh = read_mesh_file(file).soup;
    if (seams > 0) mesh = close_seams(std::move(mesh), seams);
    warn_of_mesh(mesh);
    all.push_back(judge_surface(file, mesh));
    return;
  }
  const StoredFrames run = read_stored_frames(file);
  for (std::size_t k = 0; k < run.times.size(); ++k)
    all.push_back(judge_frame(file, k, run.times[k], run.frame(k), run.triangles));
}

void print(const std::vector<JudgedFrame>& all) {
  std::size_t crossed = 0;
  for (const JudgedFrame& frame : all) {
    if (frame.repeated + frame.without_area > 0)
      fmt::print("{}: left out: {} faces given twice, {} without area\n", frame.file,
                 frame.repeated, frame.without_area);
    if (frame.pairs.empty()) continue;
    ++crossed;
    const auto& [edge, triangle] = frame.pairs.front();
    fmt::print(
        "{}: frame {}, t = {:.6g} s: {} pairs; the first: edge from particle {} to {}, triangle "
        "{}\n",
        frame.file, frame.frame, frame.time, frame.pairs.size(), edge[0], edge[1], triangle);
  }
  fmt::print("{} frames, {} of them with crossings\n", all.size(), crossed);
}

nlohmann::json to_json(const std::vector<JudgedFrame>& all) {
  nlohmann::json frames = nlohmann::json::array();
  for (const JudgedFrame& frame : all) {
    nlohmann::json row = {{"file", frame.file},
                          {"frame", frame.frame},
                          {"time", frame.time},
                          {"pairs", frame.pairs.size()},
                          {"repeated_faces", frame.repeated},
                          {"faces_without_area", frame.without_area}};
    if (!frame.pairs.empty())
      row["first"] = {{"edge", frame.pairs.front().edge},
                      {"triangle", frame.pairs.front().triangle}};
    frames.push_back(std::move(row));
  }
  return frames;
}

int show_crossings(const CrossingsOptions& options) {
  std::vector<JudgedFrame> all;
  for (const std::string& file : options.names) judge_file(file, options.seams, all);
  if (options.json)
    fmt::print("{}\n", json_text(to_json(all)));
  else
    print(all);
  for (const JudgedFrame& frame : all)
    if (!frame.pairs.empty() || frame.repeated > 0) return some_fail;
  return all_hold;
}

constexpr const char* below_crossings =
    R"(Examples:
  foldproof crossings results/fast.h5
  foldproof crossings cases/skirt.obj cases/robe.ply

Exit codes:
  0    nothing crosses
  1    in some frame an edge crosses a triangle, or a face is given twice
  2    bad input)";

}  // namespace

void add_crossings_command(CLI::App& app, Program& program) {
  auto [crossings, options] =
      add_command(app, program,
                  {"crossings", "Does a cloth pass through itself in any frame? Decided exactly",
                   below_crossings},
                  show_crossings);
  add_input(crossings, "FILE", options.names,
            "Stored runs (.h5), or meshes (.obj, .ply), each a frame");
  add_seams(crossings, options.seams);
  add_json(crossings, options);
}

}  // namespace foldproof
