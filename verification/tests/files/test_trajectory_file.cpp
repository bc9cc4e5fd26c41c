// A simulation's file, read by the library itself; and simulations read back from their files,
// which other programs may have written.
#include <catch2/catch.hpp>
#include <numeric>

#include "reference/types.h"
#include "verification/files/hdf5_file.h"
#include "verification/files/stored_run_file.h"
#include "verification/files/trajectory_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/hdf5_listing.h"
#include "verification/tests/files/small_files.h"

namespace foldproof {

namespace {

using Numbers = std::vector<double>;
using Catch::StartsWith;

/// first, first + 1, ...: as numbers, as positions of particles, and as the library lists them.
Numbers ramp(size_t count, double first = 1) {
  Numbers values(count);
  std::iota(values.begin(), values.end(), first);
  return values;
}
PerParticle3 counted(int particles, double first) {
  return Eigen::Map<const PerParticle3>(ramp(3 * size_t(particles), first).data(), 3, particles);
}
std::string counted_text(const Lengths& shape, double first) {
  hsize_t count = 1;
  for (const hsize_t length : shape) count *= length;
  return array_text(shape, ramp(count, first));
}

Scene bare_scene() {
  PerParticle3 rest = counted(4, 70);
  rest(2, 0) = rest(1, 3) = 0;
  Scene scene = scene_at_rest(make_triangle_mesh(rest, {{0, 1, 2}, {1, 3, 2}}), 0.4);
  scene.name = "a case";
  scene.title = "A title";
  scene.about = "About it";
  scene.integrator = "B";
  return scene;
}

const Eigen::Quaterniond turn = Eigen::Quaterniond(5, -3, 7, 2).normalized();

/// Moves from (1, 2, 3) to (5, -2, 9) between 0 s and 2 s, always turned alike.
RigidMotion drifting() { return make_keyframes({{0, {turn, {1, 2, 3}}}, {2, {turn, {5, -2, 9}}}}); }

/// A ball that drifts, a surface that deforms, and patches of a surface and of cloth.
Scene full_scene() {
  Scene scene = bare_scene();
  scene.gravity = Vector3(0.5, -9.75, 0.25);
  SceneObject ball, body;
  ball.object = {"a ball", RigidObject{Sphere{0.5}, {}, drifting()}, 0.375};
  ball.shape = "a sphere";
  ball.vertices = counted(5, 10);
  ball.triangles = {{0, 1, 2}, {1, 4, 3}, {2, 3, 4}};
  body.object = {"a body", DeformingObject{}, 0.625};
  body.shape = "a mesh";
  body.vertices = counted(3, 20);
  body.triangles = {{2, 0, 1}};
  body.animation = std::make_shared<const MeshSequence>(
      MeshSequence{{{2, 0, 1}}, {0, 2}, {counted(3, 20), counted(3, 38)}});
  scene.objects = {ball, body};
  StickyPatch of_surface, of_cloth;
  of_surface.name = "a palm";
  of_surface.triangles = {{0, 1, 2}, {2, 1, 3}};
  of_surface.place = [](double) { return counted(4, 0); };
  of_surface.particles = {3, 1, 2};
  of_cloth.name = "a seam";
  of_cloth.triangles = {{1, 3, 2}};
  of_cloth.particles = {0};
  scene.sticky = {of_surface, of_cloth};
  return scene;
}

/// A file of a scene, and what the library finds in it.
struct Trajectory {
  ScratchFolder scratch;
  std::string path = scratch.file("a&b.h5"), partial = path + ".partial";
  Scene scene;
  System system = make_system(PerParticle{{0.25, 0.5, 0.75, 1.5}});
  std::vector<Object> solids = {
      {"drifts", RigidObject{Sphere{0.5}, {}, drifting()}},
      {"rests", RigidObject{Sphere{1.25}, {turn, {104, 2, 200}}, Motion{}}}};
  std::unique_ptr<TrajectoryFile> file;

  explicit Trajectory(const Scene& of) : scene(of) {
    if (scene.objects.empty()) solids.clear();
    prescribe(system, {2, Vector3(1, 2, 3), {}});
    file = std::make_unique<TrajectoryFile>(path, scene, system, solids, Provenance());
  }
  /// Frames at 0.5 s and 1.5 s, all numbers of which differ.
  void add_frames() {
    for (const int k : {0, 1}) {
      State s{0.5 + k, counted(4, 100 + 12 * k), counted(4, 200 + 12 * k)};
      if (k == 0) s.bonds = {{0, 1, 3, {0.125, 0.25, 0.5}}, {1, 7, 0, {3.5, 0.375, -0.75}}};
      file->add_frame(s);
      Diagnostics d;
      d.time = 1, d.step = 2, d.damping_work = 9, d.step_over_elastic_limit = 12;
      d.energy = {3, 4, 5, 6, 7, 8};
      d.linear_momentum = {20, 21, 22}, d.angular_momentum = {30, 31, 32};
      d.work.cg_iterations = 10, d.work.object_contacts = 13, d.work.close_pairs = 15;
      d.work.crossings = 16, d.work.zone_particles = 17, d.work.bonds = 18;
      d.work.worst_residual = 11, d.work.strain_left = 14;
      for_each_value(d, [&](auto& number) { number += 100 * k; });
      d.seconds = 50.5 + k;
      file->add_diagnostics(d);
    }
  }
  Listing finished() {
    Record record;
    record.name = "a finding";
    file->finish("the reason", 12.75, {record});
    return hdf5_listing(path);
  }
};

std::string difference_below(const std::string& group, Listing all, const Listing& expected) {
  std::erase_if(all, [&](const auto& entry) { return !entry.first.starts_with(group); });
  return difference_of(all, expected);
}

const Listing& full_listing() {
  static const Listing all = [] {
    Trajectory run(full_scene());
    run.add_frames();
    return run.finished();
  }();
  return all;
}

/// A sheet of 4 x 3 particles.
const std::string small_case =
    "[cloth]\nshape = \"sheet\"\nwidth = 0.75\nheight = 0.5\ncolumns = 3\nrows = 2\n"
    "density = 0.2\n# --set cloth.density=0.7\n[time]\nend = 0.7\n";

/// A stored simulation of two frames of 12 particles, the sheet of its case.
struct RunFile {
  ScratchFolder scratch;
  std::string path = scratch.file("run.h5"), text = small_case;
  std::vector<int> corners{3, 1, 4, 2, 0, 11};
  Numbers times{0.25, 0.75}, positions = ramp(72), velocities = ramp(72, 101);

  void write() const {
    const Hdf5 file = Hdf5::create_file(path);
    file.attribute("case_folder", std::string("some/folder"));
    file.attribute("case_name", std::string("small"));
    file.attribute("case_text", text);
    file.attribute("title", std::string("A title of its own"));
    file.group("mesh").array("triangles", {corners.size()}, corners.data());
    const Hdf5 frames = file.group("frames");
    frames.dataset("time", times);
    frames.dataset("positions", positions);
    frames.dataset("velocities", velocities);
  }
  StoredRun read() const {
    write();
    return read_stored_run(path);
  }
};

}  // namespace

TEST_CASE("trajectory: frames are wanted at the start, each whole interval, and the end") {
  const auto frames_wanted = [](double end, double interval) {
    Scene scene = bare_scene();
    scene.schedule.end = end, scene.schedule.frame_interval = interval;
    return Trajectory(scene).finished().at("/@frames_wanted");
  };
  CHECK(frames_wanted(1, 0.3) == "5");
  CHECK(frames_wanted(1.1, 0.1) == "12");  // 1.1/0.1 is rounded to more than 11
  CHECK(frames_wanted(0.3, 0.1) == "4");   // and this to less than 3
  CHECK(frames_wanted(3 + 1e-7, 1) == "5");
}

TEST_CASE("trajectory: frames and rows of diagnostics lie in it with their units") {
  Listing diagnostics, frames, mesh;
  add_listed(diagnostics, "/diagnostics/", R"(
    time = [2] 1 | 101; time@unit = s; step = [2] 2 | 102; step@unit = s
    kinetic_energy = [2] 3 | 103; kinetic_energy@unit = J; stretch_energy = [2] 4 | 104
    stretch_energy@unit = J; bending_energy = [2] 5 | 105; bending_energy@unit = J
    gravity_energy = [2] 6 | 106; gravity_energy@unit = J; custom_energy = [2] 7 | 107
    custom_energy@unit = J; sticking_energy = [2] 8 | 108; sticking_energy@unit = J
    damping_work = [2] 9 | 109; damping_work@unit = J; cg_iterations = [2] 10 | 110
    cg_iterations@unit = 1; cg_residual = [2] 11 | 111; cg_residual@unit = 1
    step_over_elastic_limit = [2] 12 | 112; step_over_elastic_limit@unit = 1
    object_contacts = [2] 13 | 113; object_contacts@unit = 1; strain_left = [2] 14 | 114
    strain_left@unit = 1; close_pairs = [2] 15 | 115; close_pairs@unit = 1
    crossings = [2] 16 | 116; crossings@unit = 1; zone_particles = [2] 17 | 117
    zone_particles@unit = 1; bonds = [2] 18 | 118; bonds@unit = 1; seconds = [2] 50.5 | 51.5
    seconds@unit = s; linear_momentum = [2 x 3] 20 | 21 | 22 | 120 | 121 | 122
    linear_momentum@unit = kg m/s; angular_momentum = [2 x 3] 30 | 31 | 32 | 130 | 131 | 132
    angular_momentum@unit = kg m^2/s)");
  CHECK(difference_below("/diagnostics/", full_listing(), diagnostics) == "");
  add_listed(frames, "/frames/", R"(time = [2] 0.5 | 1.5; time@unit = s; positions@unit = m
    velocities@unit = m/s)");
  frames["/frames/positions"] = counted_text({2, 4, 3}, 100);
  frames["/frames/velocities"] = counted_text({2, 4, 3}, 200);
  Trajectory bare(bare_scene());
  bare.add_frames();
  const Listing all = bare.finished();
  CHECK(difference_below("/frames/", all, frames) == "");
  add_listed(mesh, "/mesh/", R"(triangles = [2 x 3] 0 | 1 | 2 | 1 | 3 | 2; mass@unit = kg
    mass = [4] 0.25 | 0.5 | 0.75 | 1.5; held = [4] 0 | 0 | 1 | 0; rest_positions@unit = m
    rest_positions = [4 x 3] 70 | 71 | 0 | 73 | 74 | 75 | 76 | 77 | 78 | 79 | 0 | 81)");
  CHECK(difference_below("/mesh/", all, mesh) == "");
  for (const char* absent : {"/objects/", "/sticky/", "/gravity", "/fabrics/", "/air/"})
    CHECK(!all.contains(absent));
}

TEST_CASE("trajectory: a garment has its panels, fabrics, membrane and air") {
  Scene scene = bare_scene();
  scene.mesh.pattern = {{{{0, 0}, {3, 0}, {0, 4}}}, {{{6, 0}, {9, 1}, {6, 3}}}};
  const MembraneMaterial membrane{.warp = 64, .weft = 32, .shear = 16, .direction = 0.5};
  scene.membrane = membrane;
  scene.fabrics = {{{"knit", 0.25}, {"denim", 0.5, {}, {}, membrane}}, {0, 1}};
  scene.air = Air{.density = 1.25, .wind = {2, 0, 3}};
  const Listing all = Trajectory(scene).finished();
  const auto of = [&](const char* name) { return all.at(name); };
  CHECK(of("/mesh/pattern") == "[2 x 3 x 2] 0 | 0 | 3 | 0 | 0 | 4 | 6 | 0 | 9 | 1 | 6 | 3");
  CHECK(of("/mesh/pattern@panels") + " " + of("/mesh/pattern@seams") == "2 5");
  CHECK(of("/mesh/pattern@ease") == "0.5");  // 5 m on 3 m
  CHECK(of("/mesh/fabric") == "[2] 0 | 1");
  CHECK(of("/fabrics/1/@name") + " " + of("/fabrics/1/@density") == "denim 0.5");
  CHECK(of("/fabrics/1/@warp") + " " + of("/fabrics/1/@direction") == "64 0.5");
  CHECK(of("/air/@density") + " " + of("/air/wind") == "1.25 [3] 2 | 0 | 3");
}

TEST_CASE("trajectory: objects have their surface, and their pose or vertices in each frame") {
  Listing expected;
  add_listed(expected, "/objects/", "0/; 1/");
  add_listed(expected, "/objects/0/", R"(@name = a ball; @shape = a sphere; @friction = 0.375
    triangles = [3 x 3] 0 | 1 | 2 | 1 | 4 | 3 | 2 | 3 | 4; vertices@unit = m; rotation@unit = 1
    translation = [2 x 3] 2 | 1 | 4.5 | 4 | -1 | 7.5; translation@unit = m)");
  add_listed(expected, "/objects/1/", R"(@name = a body; @shape = a mesh; @friction = 0.625
    triangles = [1 x 3] 2 | 0 | 1; vertices@unit = m; positions@unit = m)");
  expected["/objects/0/vertices"] = counted_text({5, 3}, 10);
  expected["/objects/1/vertices"] = counted_text({3, 3}, 20);
  expected["/objects/1/positions"] = counted_text({2, 3, 3}, 24.5);
  const Eigen::Quaterniond q = pose_at(drifting(), 0.5).rotation;
  CHECK(q.isApprox(turn));
  expected["/objects/0/rotation"] =
      array_text({2, 4}, Numbers{q.w(), q.x(), q.y(), q.z(), q.w(), q.x(), q.y(), q.z()});
  CHECK(difference_below("/objects/", full_listing(), expected) == "");
}

TEST_CASE("trajectory: each particle's distance is that to the nearest solid at the frame's time") {
  Trajectory run(full_scene());
  run.add_frames();
  CHECK(run.finished().at("/frames/object_distance@unit") == "m");
  const Numbers phi =
      Hdf5::open_file(run.path).open_group("frames").read_doubles("object_distance");
  for (int k = 0; k < 8; ++k) {
    const double time = k < 4 ? 0.5 : 1.5, first = 100 + 3 * k;
    const Vector3 x(first, first + 1, first + 2), centre(1 + 2 * time, 2 - 2 * time, 3 + 3 * time);
    CHECK(phi.at(std::size_t(k)) ==
          Approx(std::min((x - centre).norm() - 0.5, (x - Vector3(104, 2, 200)).norm() - 1.25)));
  }
}

TEST_CASE("trajectory: sticky patches are stored, and the bonds of all frames one after another") {
  Listing expected;
  add_listed(expected, "/sticky/", R"(bond_counts = [2] 2 | 0; bond_counts@unit = 1; 0/; 1/
    bonds = [2 x 3] 0 | 1 | 3 | 1 | 7 | 0; bonds@unit = 1; places@unit = 1, 1, m
    places = [2 x 3] 0.125 | 0.25 | 0.5 | 3.5 | 0.375 | -0.75
    0/@name = a palm; 0/@is_cloth = 0; 0/triangles = [2 x 3] 0 | 1 | 2 | 2 | 1 | 3
    0/particles = [3] 3 | 1 | 2; 1/@name = a seam; 1/@is_cloth = 1
    1/triangles = [1 x 3] 1 | 3 | 2; 1/particles = [1] 0)");
  CHECK(difference_below("/sticky/", full_listing(), expected) == "");
}

TEST_CASE("trajectory: until it is finished each frame lies in a partial file") {
  const State s{0.5, counted(4, 1), counted(4, 2)};
  Trajectory run(bare_scene());
  run.file->add_frame(s);
  std::filesystem::copy_file(run.partial, run.scratch.file("copy"));
  CHECK(hdf5_listing(run.scratch.file("copy")).at("/frames/time") == "[1] 0.5");
  CHECK_FALSE(std::filesystem::exists(run.path));
  run.finished();
  CHECK_FALSE(std::filesystem::exists(run.partial));
  const Trajectory full(bare_scene());
  const FileSizeLimit limit(900);
  CHECK_THROWS_WITH(full.file->add_frame(s), Catch::Contains(full.path));
}

TEST_CASE("trajectory: a file for ParaView names each frame of the arrays") {
  Trajectory run(bare_scene());
  for (const double time : {0.5, 1.0 / 3, 2.75})
    run.file->add_frame({time, counted(4, 1), counted(4, 2)});
  run.finished();
  const std::string text = bytes_of_file(run.scratch.file("a&b.xdmf"));
  const auto count = [&](const std::string& part) {
    int found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
      ++found;
    return found;
  };
  CHECK_THAT(text, Catch::StartsWith("<?xml version=\"1.0\" ?>\n<Xdmf Version=\"3.0\">\n"));
  CHECK_THAT(text, Catch::EndsWith("      </Grid>\n    </Grid>\n  </Domain>\n</Xdmf>\n"));
  int k = 0;
  for (const char* time : {"0.5", "0.33333333333333331", "2.75"}) {
    const std::string frame = std::to_string(k++);
    CHECK(count("<Grid Name=\"frame " + frame + "\" GridType=\"Uniform\">\n        <Time Value=\"" +
                time + "\"/>") == 1);
    CHECK(count(">" + frame + " 0 0 1 1 1 1 4 3</DataItem>") == 2);
  }
  const std::string array = R"(Dimensions="3 4 3" NumberType="Float" Precision="8" Format="HDF">)";
  const std::pair<std::string, int> parts[] = {
      {"<Grid Name=\"frame ", 3},
      {"TopologyType=\"Triangle\" NumberOfElements=\"2\"", 3},
      {"Dimensions=\"2 3\"", 3},
      {"Format=\"HDF\">a&amp;b.h5:/mesh/triangles<", 3},
      {"ItemType=\"HyperSlab\" Dimensions=\"4 3\"", 6},
      {array + "a&amp;b.h5:/frames/positions<", 3},
      {array + "a&amp;b.h5:/frames/velocities<", 3}};
  for (const auto& [part, times] : parts) CHECK(count(part) == times);
}

TEST_CASE("stored run: its case with the overrides at the end of its text, and frames are read") {
  RunFile file;
  const StoredRun run = file.read();
  CHECK((run.scene.name == "small" && run.scene.folder == "some/folder"));
  CHECK((run.scene.title == "A title of its own" && run.times == file.times));
  for (const size_t k : {0, 1}) {
    const State s = run.frame(k);
    CHECK((s.time == file.times[k] && s.x == counted(12, 1 + 36 * double(k))));
    CHECK(s.v == counted(12, 101 + 36 * double(k)));
  }
  const std::string density = "\n# --set cloth.density=", end = "\n# --set time.end=0.9";
  const auto check = [&](const std::string& overrides, double expected_density, double last) {
    file.text = small_case + overrides;
    const Scene scene = file.read().scene;
    CHECK((scene.density == expected_density && scene.schedule.end == last));
    CHECK(scene.text == file.text);
  };
  check("", 0.2, 0.7);
  check(density + "0.4" + density + "0.3" + end, 0.3, 0.9);
  check(density + "0.4\n# a comment" + end, 0.2, 0.9);
  check(density + "0.4\n", 0.2, 0.7);  // a line ends after it
  file.text = "[cloth]\nshape = \"no such\"\n";
  CHECK_THROWS_WITH(file.read(), Catch::StartsWith("some/folder/small.toml:"));
}

}  // namespace foldproof
