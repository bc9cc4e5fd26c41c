// A simulation's file, read by the library itself: each number in its place, with its unit.
#include <catch2/catch.hpp>

#include "verification/files/hdf5_file.h"
#include "verification/files/trajectory_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/raw_hdf5.h"
#include "verification/tests/files/trajectory_specimen.h"

namespace foldproof {

namespace {

using Catch::Equals;
using Lengths = std::vector<hsize_t>;

Diagnostics diagnostics_specimen(double first) {
  Diagnostics d;
  double next = first;
  for_each_value(
      d, [&](auto& number) { number = std::remove_reference_t<decltype(number)>(next += 3); });
  d.seconds = first + 0.5;
  return d;
}

/// How often a text stands in another.
int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

/// The root attribute of the number of frames that a file of a run with this schedule has.
double frames_wanted(double end, double interval) {
  const ScratchFolder scratch;
  Scene scene = bare_scene();
  scene.schedule.end = end;
  scene.schedule.frame_interval = interval;
  TrajectoryFile(scratch.file("a.h5"), scene, system_specimen(), {}, {}).finish("", 0, {});
  return RawFile(scratch.file("a.h5")).number("/", "frames_wanted");
}

}  // namespace

TEST_CASE("trajectory: the root tells of the case and of the run, and where its meshes lie") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const System system = system_specimen();
  for (const bool is_read : {false, true}) {
    Scene scene = full_scene();
    scene.text = is_read ? "the text" : "";
    scene.folder = "some/folder";
    Provenance provenance;
    provenance.version = "9.8";
    provenance.cores = 77;
    Record record;
    record.name = "a finding";
    TrajectoryFile file(path, scene, system, {}, provenance);
    file.finish("the reason", 12.75, {record});
    const RawFile raw(path);
    CHECK(raw.text("/", "case_name") == "a case");
    CHECK(raw.text("/", "title") == "A title");
    CHECK(raw.text("/", "about") == "About it");
    CHECK(raw.text("/", "case_text") == scene.text);
    CHECK(raw.text("/", "case_folder") ==
          (is_read ? std::filesystem::current_path().string() + "/some/folder" : ""));
    CHECK(raw.text("/", "integrator") == "B");
    CHECK(raw.texts("/", "built") == describe_parts(scene, system));
    CHECK(raw.text("/", "version") == "9.8");
    CHECK(raw.number("/", "cores") == 77);
    CHECK(raw.text("/", "stopped") == "the reason");
    CHECK(raw.number("/", "seconds") == 12.75);
    CHECK(raw.has("findings/a finding"));
    CHECK(raw.numbers("gravity") == Numbers{0.5, -9.75, 0.25});
    CHECK(raw.text("gravity", "unit") == "m/s^2");
  }
}

TEST_CASE("trajectory: frames are wanted at the start, each whole interval, and the end") {
  CHECK(frames_wanted(1, 0.3) == 5);
  CHECK(frames_wanted(1.1, 0.1) == 12);  // 1.1/0.1 is rounded to more than 11
  CHECK(frames_wanted(0.3, 0.1) == 4);   // and this to less than 3
  CHECK(frames_wanted(3 + 1e-7, 1) == 5);
  CHECK(frames_wanted(7, 3.5) == 3);
}

TEST_CASE("trajectory: the mesh has triangles, rest positions, masses and marks of what is held") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const Scene scene = bare_scene();
  TrajectoryFile(path, scene, system_specimen(), {}, {}).finish("", 0, {});
  const RawFile raw(path);
  CHECK(raw.shape("mesh/triangles") == Lengths{2, 3});
  CHECK(raw.numbers("mesh/triangles") == Numbers{0, 1, 2, 1, 3, 2});
  CHECK(raw.shape("mesh/rest_positions") == Lengths{4, 3});
  CHECK(raw.numbers("mesh/rest_positions") == numbers_of(scene.mesh.rest));
  CHECK(raw.text("mesh/rest_positions", "unit") == "m");
  CHECK(raw.numbers("mesh/mass") == Numbers{0.25, 0.5, 0.75, 1.5});
  CHECK(raw.text("mesh/mass", "unit") == "kg");
  CHECK(raw.numbers("mesh/held") == Numbers{0, 0, 1, 0});
  for (const char* absent : {"objects", "sticky", "gravity", "frames/object_distance"})
    CHECK_FALSE(raw.has(absent));
}

TEST_CASE("trajectory: frames and rows of diagnostics lie in it with their units") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const Diagnostics one = diagnostics_specimen(100), two = diagnostics_specimen(1000);
  {
    TrajectoryFile file(path, bare_scene(), system_specimen(), {}, {});
    file.add_frame(state_at(0.5, 1));
    file.add_diagnostics(one);
    file.add_frame(state_at(1.5, 2));
    file.add_diagnostics(two);
    file.finish("", 0, {});
  }
  const RawFile raw(path);
  CHECK(raw.numbers("frames/time") == Numbers{0.5, 1.5});
  CHECK(raw.text("frames/time", "unit") == "s");
  for (const std::string name : {"positions", "velocities"}) {
    const double sign = name == "positions" ? 1 : -1;
    Numbers expected = numbers_of(rising(4, sign));
    const Numbers second = numbers_of(rising(4, 2 * sign));
    expected.insert(expected.end(), second.begin(), second.end());
    CHECK(raw.shape("frames/" + name) == Lengths{2, 4, 3});
    CHECK(raw.numbers("frames/" + name) == expected);
    CHECK(raw.text("frames/" + name, "unit") == (name == "positions" ? "m" : "m/s"));
  }
  const auto check = [&](const std::string& name, const char* unit, double first, double second) {
    INFO(name);
    CHECK(raw.numbers("diagnostics/" + name) == Numbers{first, second});
    CHECK(raw.text("diagnostics/" + name, "unit") == unit);
  };
  check("time", "s", one.time, two.time);
  check("step", "s", one.step, two.step);
  check("kinetic_energy", "J", one.energy.kinetic, two.energy.kinetic);
  check("stretch_energy", "J", one.energy.stretch, two.energy.stretch);
  check("bending_energy", "J", one.energy.bending, two.energy.bending);
  check("gravity_energy", "J", one.energy.gravity, two.energy.gravity);
  check("custom_energy", "J", one.energy.custom, two.energy.custom);
  check("sticking_energy", "J", one.energy.sticking, two.energy.sticking);
  check("damping_work", "J", one.damping_work, two.damping_work);
  check("cg_iterations", "1", double(one.work.cg_iterations), double(two.work.cg_iterations));
  check("cg_residual", "1", one.work.worst_residual, two.work.worst_residual);
  check("step_over_elastic_limit", "1", one.step_over_elastic_limit, two.step_over_elastic_limit);
  check("object_contacts", "1", double(one.work.object_contacts), double(two.work.object_contacts));
  check("strain_left", "1", one.work.strain_left, two.work.strain_left);
  check("close_pairs", "1", double(one.work.close_pairs), double(two.work.close_pairs));
  check("crossings", "1", double(one.work.crossings), double(two.work.crossings));
  check("zone_particles", "1", double(one.work.zone_particles), double(two.work.zone_particles));
  check("bonds", "1", double(one.work.bonds), double(two.work.bonds));
  check("seconds", "s", 100.5, 1000.5);
  const Vector3 p[] = {one.linear_momentum, two.linear_momentum},
                l[] = {one.angular_momentum, two.angular_momentum};
  CHECK(raw.shape("diagnostics/linear_momentum") == Lengths{2, 3});
  CHECK(raw.shape("diagnostics/angular_momentum") == Lengths{2, 3});
  CHECK(raw.numbers("diagnostics/linear_momentum") ==
        Numbers{p[0][0], p[0][1], p[0][2], p[1][0], p[1][1], p[1][2]});
  CHECK(raw.numbers("diagnostics/angular_momentum") ==
        Numbers{l[0][0], l[0][1], l[0][2], l[1][0], l[1][1], l[1][2]});
  CHECK(raw.text("diagnostics/linear_momentum", "unit") == "kg m/s");
  CHECK(raw.text("diagnostics/angular_momentum", "unit") == "kg m^2/s");
}

TEST_CASE("trajectory: a file for ParaView names each frame of the arrays") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a&b.h5");
  {
    TrajectoryFile file(path, bare_scene(), system_specimen(), {}, {});
    for (const double time : {0.5, 1.0 / 3, 2.75}) file.add_frame(state_at(time, 1));
    file.finish("", 0, {});
  }
  const std::string text = bytes_of_file(scratch.file("a&b.xdmf"));
  CHECK_THAT(text,
             Catch::StartsWith("<?xml version=\"1.0\" ?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"));
  CHECK_THAT(text, Catch::EndsWith("      </Grid>\n    </Grid>\n  </Domain>\n</Xdmf>\n"));
  CHECK(count(text, "<Grid Name=\"frame ") == 3);
  CHECK(count(text, "CollectionType=\"Temporal\"") == 1);
  for (const auto& [frame, time] :
       {std::pair("0", "0.5"), {"1", "0.33333333333333331"}, {"2", "2.75"}}) {
    const std::string k = frame;
    CHECK(count(text, "<Grid Name=\"frame " + k +
                          "\" GridType=\"Uniform\">\n        <Time Value=\"" + time + "\"/>") == 1);
    CHECK(count(text, ">" + k + " 0 0 1 1 1 1 4 3</DataItem>") == 2);
  }
  CHECK(count(text, "TopologyType=\"Triangle\" NumberOfElements=\"2\"") == 3);
  CHECK(count(text, "Dimensions=\"2 3\"") == 3);
  CHECK(count(text, "Format=\"HDF\">a&amp;b.h5:/mesh/triangles<") == 3);
  CHECK(count(text, "ItemType=\"HyperSlab\" Dimensions=\"4 3\"") == 6);
  CHECK(count(text,
              "Dimensions=\"3 4 3\" NumberType=\"Float\" Precision=\"8\" "
              "Format=\"HDF\">a&amp;b.h5:/frames/positions<") == 3);
  CHECK(count(text, "Format=\"HDF\">a&amp;b.h5:/frames/velocities<") == 3);
}

TEST_CASE("trajectory: until it is finished each frame lies in a partial file") {
  const long before = H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL);
  const ScratchFolder scratch;
  const std::string path = scratch.write("a.h5", "older"), partial = path + ".partial";
  TrajectoryFile file(path, bare_scene(), system_specimen(), {}, {});
  for (const double time : {0.5, 1.5}) {
    file.add_frame(state_at(time, 1));
    std::filesystem::copy_file(partial, scratch.file("copy" + std::to_string(time)));
    const Hdf5 copy = Hdf5::open_file(scratch.file("copy" + std::to_string(time)));
    CHECK(copy.open_group("frames").read_doubles("time").back() == time);
  }
  CHECK(bytes_of_file(path) == "older");
  file.finish("", 0, {});
  CHECK(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL) == before);
  CHECK_FALSE(std::filesystem::exists(partial));
  CHECK(RawFile(path).numbers("frames/time") == Numbers{0.5, 1.5});
}

TEST_CASE("trajectory: a write that fails names the file") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  {
    TrajectoryFile file(path, bare_scene(), system_specimen(), {}, {});
    const FileSizeLimit limit(900);
    CHECK_THROWS_WITH(
        file.add_frame(state_at(0.5, 1)),
        Equals(path +
               ": cannot be written (HDF5: cannot write what was buffered); is the disk full?"));
    CHECK_THROWS_WITH(
        file.finish("", 0, {}),
        Equals(path +
               ": cannot be written (HDF5: cannot write what was buffered); is the disk full?"));
  }
  CHECK_FALSE(std::filesystem::exists(path));
  std::filesystem::create_directory(path);
  CHECK_THROWS_WITH(TrajectoryFile(path, bare_scene(), system_specimen(), {}, {}),
                    Equals(path + ": cannot be written: what is there is no file"));
  CHECK_FALSE(std::filesystem::exists(scratch.file("a.h5.partial.partial")));
}

}  // namespace foldproof
