// Frames of a folder and of caches: which files are frames, and what is refused.
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>

#include "reference/level_set/deforming.h"
#include "reference/mesh/mesh_frames.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/complaint.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

std::string triangle(int x) {
  return "v " + std::to_string(x) + " 0 0\nv 9 0 0\nv 0 1 0\nf 1 2 3\n";
}

const std::string ply_points =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
    "property float z\nend_header\n7 0 0\n1 2 3\n";

/// A folder of these files, each with another x of its first vertex: 0, 1, ...
struct Folder {
  explicit Folder(const std::vector<std::string>& names) {
    for (int k = 0; k < int(names.size()); ++k) scratch.write(names[std::size_t(k)], triangle(k));
  }
  std::vector<int> read(const std::string& preferred = "", const std::string& remedy = "") const {
    std::vector<int> order;
    for (const MeshFrame& frame : read_mesh_frames({scratch.file("."), preferred, remedy}))
      order.push_back(int(frame.x(0, 0)));
    return order;
  }
  std::string said(const std::string& remedy = "") const {
    return complaint([&] { read("", remedy); });
  }
  ScratchFolder scratch;
};

template <class Number>
std::string bytes_of(Number value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

/// Two samples of two points, x = 0, 1, 2, ...
std::string pc2(float rate = 2, std::int32_t version = 1) {
  std::string bytes("POINTCACHE2\0", 12);
  bytes += bytes_of(version) + bytes_of<std::int32_t>(2) + bytes_of(3.f) + bytes_of(rate);
  bytes += bytes_of<std::int32_t>(2);
  for (int k = 0; k < 12; ++k) bytes += bytes_of(float(k));
  return bytes;
}

const std::string usda = R"(#usda 1.0
(
    "a comment with ) and }"
    metersPerUnit = 1
    startTimeCode = 1
    timeCodesPerSecond = 25
    upAxis = "Y"
)
def Xform "root" (kind = "component")
{
    def Scope "empty" {}
    def Mesh "cloth" (prepend apiSchemas = ["A"])
    {
        float3[] extent = [(0, 0, 0), (1, 1, 1)] (doc = "{")
        rel proxy
        int[] faceVertexCounts = [4, 3]
        int[] faceVertexIndices = [0, 1, 2, 3, 2, 1, 0]  # turned over
        point3f[] points.timeSamples = {
            1: [(0, 0.5, 1), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
            2.5: [(7, -1e-3, 1), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
        }
        double3 xformOp:translate = (0, -0, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }
}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string said_of_usda(const std::string& from, const std::string& to) {
  return complaint([&] { read_usda_text(replaced(usda, from, to), "t.usda"); });
}

}  // namespace

TEST_CASE("frames of a folder: numbers order them, endings are of any case") {
  using Order = std::vector<int>;
  CHECK(Folder({"a_10.obj", "a_9.OBJ", "._a_8.obj", "a_0011.Obj", "notes.txt"}).read() ==
        Order{1, 0, 3});
  CHECK(Folder({"run2.0001_low.obj", "run2.0000_low.obj"}).read() == Order{1, 0});
  CHECK(Folder({"my.0.obj", "my-object-0.0.obj"}).read("my") == Order{0});
  CHECK(Folder({"alone.obj"}).read() == Order{0});
  CHECK(Folder({"b_0.obj", "b_2.obj"}).read("", "mend it") == Order{0, 1});
}

TEST_CASE("frames of a folder: a stray file is named, and gaps and doubles are refused") {
  CHECK_THAT(Folder({"my.obj", "my_0000.obj", "my_0001.obj"}).said(),
             Contains("my.obj: has no number, beside frames my*.obj"));
  CHECK_THAT(complaint([] {
               Folder({"my.obj", "my_0.obj", "b.obj"}).read("my");
             }),
             Contains("my.obj: has no number"));
  CHECK_THAT(Folder({"a_1.obj", "b_1.obj"}).said(), Contains("2 sequences"));
  CHECK_THAT(Folder({"a_1.obj", "a_01.obj"}).said(), Contains("same number"));
  const Folder gap({"a_1.obj", "a_2.obj", "a_4.obj"});
  CHECK_THAT(gap.said("mend it"), Contains("a_4.obj: frame 3 is missing before it; mend it"));
  CHECK(gap.said() == "");
  CHECK_THAT(complaint([&] {
               read_mesh_sequence({gap.scratch.file("."), 0.1});
             }),
             Contains("frame 3 is missing"));
}

TEST_CASE("frames of points: a PLY file without faces has no triangles") {
  const ScratchFolder folder;
  folder.write("SCAN.PLY", ply_points);
  const std::vector<MeshFrame> frames = read_mesh_frames({folder.file(".")});
  CHECK(frames.at(0).triangles.empty());
  CHECK(frames[0].x.col(1) == Vector3(1, 2, 3));
}

TEST_CASE("PC2: samples have the numbers of the header, and a wrong file is refused") {
  const std::vector<MeshFrame> frames = read_pc2_bytes(pc2(), "t.pc2");
  CHECK(frames.size() == 2);
  CHECK(frames[0].number == 3);
  CHECK(frames[1].number == 5);
  CHECK(frames[1].x.col(1) == Vector3(9, 10, 11));
  CHECK_FALSE(frames[0].time);
  const auto said = [](const std::string& bytes) {
    return complaint([&] { read_pc2_bytes(bytes, "t.pc2"); });
  };
  CHECK_THAT(said(pc2().substr(0, 70)), Contains("t.pc2: ends before sample 1"));
  CHECK_THAT(said(pc2(0)), Contains("sample rate"));
  CHECK_THAT(said(pc2(2, 2)), Contains("version 2"));
  CHECK_THAT(said("POINTCACHE"), Contains("does not begin with POINTCACHE2"));
  CHECK_THAT(said(pc2().substr(0, 76) + bytes_of(std::nanf(""))), Contains("sample 1: "));
}

TEST_CASE("PC2: a body takes its triangles from a mesh, and times from the interval") {
  const ScratchFolder folder;
  const std::string file = folder.write("b.PC2", pc2());
  const MeshSequence body = read_mesh_sequence({file, 0.1, {{0, 1, 1}}, 1000, Inside::winding});
  CHECK(body.times == std::vector<double>{0, 0.2});
  CHECK(body.triangles.size() == 1);
  CHECK_THAT(complaint([&] { read_mesh_sequence({file, 0.1}); }), Contains("by 'mesh'"));
  CHECK_THAT(complaint([&] {
               read_mesh_sequence({file, 0.1, {{0, 1, 2}}});
             }),
             Contains("fewer vertices"));
}

TEST_CASE("USD: a mesh with time samples, its units, axis and times") {
  const std::vector<MeshFrame> frames = read_usda_text(usda, "t.usda");
  CHECK(frames.size() == 2);
  CHECK(frames[0].x.col(0) == Vector3(0, 0.5, 1));
  CHECK(frames[1].x.col(0) == Vector3(7, -1e-3, 1));
  CHECK(frames[1].time == 1.5 / 25);
  CHECK(frames[1].number == 2.5);
  CHECK(frames[0].triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {2, 1, 0}});
  const auto turned = read_usda_text(replaced(usda, "\"Y\"", "\"Z\""), "t.usda");
  CHECK(turned[0].x.col(0) == Vector3(0, 1, -0.5));
  const auto centimetres = read_usda_text(replaced(usda, "metersPerUnit = 1", ""), "t.usda");
  CHECK(centimetres[0].x(1, 0) == Approx(0.005));
}

TEST_CASE("USD: what moves, lacks or breaks the mesh is named") {
  CHECK_THAT(said_of_usda("(0, -0, 0)", "(0, 2, 0)"), Contains("xformOp:translate moves the mesh"));
  CHECK_THAT(said_of_usda("def Scope \"empty\" {}", "double3 xformOp:scale = (1, 1, 2)"),
             Contains("xformOp:scale moves"));
  CHECK_THAT(said_of_usda("Scope", "Mesh"), Contains("2 meshes"));
  CHECK_THAT(said_of_usda(".timeSamples", ""), Contains("lacks points.timeSamples"));
  CHECK_THAT(said_of_usda("[4, 3]", "[4, 4]"), Contains("do not fit"));
  CHECK_THAT(said_of_usda("2, 1, 0]", "2, 1, 4]"), Contains("no point from 0 to 3"));
  CHECK_THAT(said_of_usda("(7, -1e-3, 1), ", ""), Contains("sample 1: another number of points"));
  CHECK_THAT(said_of_usda("(7,", "(nan,"), Contains("no finite number"));
  CHECK_THAT(said_of_usda("#usda 1.0", "PXR-USDC"), Contains("#usda 1.0"));
  CHECK_THAT(complaint([] { read_usda_text(usda.substr(0, usda.find("2.5:")), "t.usda"); }),
             Contains("ends within a value"));
}
