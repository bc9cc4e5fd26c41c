#include "verification/files/trajectory_file.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "reference/mesh/pattern.h"
#include "verification/files/findings_file.h"
#include "verification/files/hdf5_file.h"
#include "verification/files/verdicts_file.h"
#include "verification/files/atomic_file.h"

namespace foldproof {

namespace {

void write_mesh(const Hdf5& file, const Scene& scene, const System& system) {
  const Hdf5 mesh = file.group("mesh");
  const Shape::value_type particles = scene.mesh.particles(),
                          triangles = scene.mesh.triangles.size();
  mesh.array("triangles", {triangles, 3}, scene.mesh.triangles.data()->data());
  mesh.array("rest_positions", {particles, 3}, scene.mesh.rest.data()).attribute("unit", "m");
  mesh.array("mass", {particles}, system.mass.data()).attribute("unit", "kg");
  std::vector<unsigned char> held;
  for (Eigen::Index i = 0; i < system.inverse_mass.size(); ++i)
    held.push_back(system.inverse_mass[i] == 0);
  mesh.array("held", {particles}, held.data());
}

/// Dataset /mesh/pattern: the corners of each triangle in its panel, M x 3 x 2.
void write_pattern(const Hdf5& mesh, const Scene& scene) {
  static_assert(sizeof(FlatTriangle) == 6 * sizeof(double));
  const PatternFacts facts = facts_of_pattern(scene.mesh, scene.x);
  const Hdf5 pattern = mesh.array("pattern", {scene.mesh.pattern.size(), 3, 2},
                                  scene.mesh.pattern.front().front().data());
  pattern.attribute("unit", "m");
  pattern.attribute("panels", facts.panels);
  pattern.attribute("seams", facts.seams);
  pattern.attribute("ease", facts.ease);
}

/// Groups /fabrics/<k>, and /mesh/fabric if there are several: what the cloth is made of.
void write_fabrics(const Hdf5& file, const Hdf5& mesh, const Scene& scene) {
  std::vector<ClothFabric> all = scene.fabrics.fabrics;
  if (all.empty())
    all = {{"cloth", scene.density, scene.stretch.value_or(StretchMaterial{}),
            scene.bending.value_or(BendingMaterial{}),
            scene.membrane.value_or(MembraneMaterial{})}};
  else
    mesh.array("fabric", {scene.fabrics.of_triangle.size()}, scene.fabrics.of_triangle.data());
  const Hdf5 fabrics = file.group("fabrics");
  for (size_t k = 0; k < all.size(); ++k) {
    const Hdf5 group = fabrics.group(std::to_string(k));
    group.attribute("name", all[k].name);
    group.attribute("density", all[k].density);
    if (scene.stretch) group.attribute("stretch", all[k].stretch.stiffness);
    if (scene.bending) group.attribute("bending", all[k].bending.stiffness);
    if (!scene.membrane) continue;
    group.attribute("warp", all[k].membrane.warp);
    group.attribute("weft", all[k].membrane.weft);
    group.attribute("shear", all[k].membrane.shear);
    group.attribute("direction", all[k].membrane.direction);
  }
}

/// What a garment has beyond the paper's cloth; nothing for a scene without these parts.
void write_garment(const Hdf5& file, const Scene& scene) {
  const Hdf5 mesh = file.open_group("mesh");
  if (!scene.mesh.pattern.empty()) write_pattern(mesh, scene);
  if (!scene.mesh.pattern.empty() || !scene.fabrics.empty() || scene.membrane)
    write_fabrics(file, mesh, scene);
  if (scene.air) {
    const Hdf5 air = file.group("air");
    air.attribute("density", scene.air->density);
    air.array("wind", {3}, scene.air->wind.data()).attribute("unit", "m/s");
  }
}

/// Groups /objects/<k>: the surface at rest, and in every frame its pose, or its
/// vertices if it deforms.
struct ObjectRows {
  const SceneObject* part;
  std::vector<GrowingDataset> rows;  // rotation and translation, or positions
};

std::vector<ObjectRows> write_objects(const Hdf5& file, const Scene& scene) {
  std::vector<ObjectRows> rows;
  if (scene.objects.empty()) return rows;
  const Hdf5 objects = file.group("objects");
  for (const SceneObject& part : scene.objects) {
    const Hdf5 group = objects.group(std::to_string(rows.size()));
    group.attribute("name", part.object.name);
    group.attribute("shape", part.shape);
    group.attribute("friction", part.object.friction);
    group.array("triangles", {part.triangles.size(), 3}, part.triangles.data()->data());
    group.array("vertices", {Shape::value_type(part.vertices.cols()), 3}, part.vertices.data())
        .attribute("unit", "m");
    rows.push_back({&part, {}});
    if (part.animation) {
      rows.back().rows.emplace_back(group, "positions", "m",
                                    Shape{Shape::value_type(part.vertices.cols()), 3});
    } else {
      rows.back().rows.emplace_back(group, "rotation", "1", Shape{4});
      rows.back().rows.emplace_back(group, "translation", "m", Shape{3});
    }
  }
  return rows;
}

/// rotation: w, x, y, z of the quaternion that turns the vertices before they are moved.
void add_place(double t, ObjectRows& object) {
  if (object.part->animation) {
    object.rows[0].add(surface_at(*object.part, t).data());
    return;
  }
  const Pose pose = pose_at(std::get<RigidObject>(object.part->object.body).motion, t);
  const Eigen::Quaterniond& q = pose.rotation;
  const double rotation[] = {q.w(), q.x(), q.y(), q.z()};
  object.rows[0].add(rotation);
  object.rows[1].add(pose.translation.data());
}

/// Group /sticky: the patches, and the bonds of all frames one after the other. A frame has as many
/// as bond_counts says.
struct BondRows {
  GrowingDataset counts, bonds, places;

  BondRows(const Hdf5& group, const Scene& scene)
      : counts(group, "bond_counts", "1", {}),
        bonds(group, "bonds", "1", {3}),           // patch, triangle of it, particle
        places(group, "places", "1, 1, m", {3}) {  // weights of the corners b and c, height
    for (size_t k = 0; k < scene.sticky.size(); ++k) {
      const StickyPatch& patch = scene.sticky[k];
      const Hdf5 of_patch = group.group(std::to_string(k));
      of_patch.attribute("name", patch.name);
      of_patch.attribute("is_cloth", patch.place ? 0 : 1);
      of_patch.array("triangles", {patch.triangles.size(), 3}, patch.triangles.data()->data());
      of_patch.array("particles", {patch.particles.size()}, patch.particles.data());
    }
  }

  void add(const State& s) {
    const double count = double(s.bonds.size());
    counts.add(&count);
    for (const Bond& bond : s.bonds) {
      const double row[] = {double(bond.patch), double(bond.triangle), double(bond.particle)};
      bonds.add(row);
      places.add(bond.place.data());
    }
  }
};

constexpr const char* xdmf_head = R"(<?xml version="1.0" ?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="cloth" GridType="Collection" CollectionType="Temporal">
)";

constexpr const char* xdmf_frame = R"(      <Grid Name="frame {frame}" GridType="Uniform">
        <Time Value="{time:.17g}"/>
        <Topology TopologyType="Triangle" NumberOfElements="{triangles}">
          <DataItem Dimensions="{triangles} 3" NumberType="Int" Precision="4" Format="HDF">{file}:/mesh/triangles</DataItem>
        </Topology>
        <Geometry GeometryType="XYZ">
          <DataItem ItemType="HyperSlab" Dimensions="{particles} 3">
            <DataItem Dimensions="3 3" Format="XML">{frame} 0 0 1 1 1 1 {particles} 3</DataItem>
            <DataItem Dimensions="{frames} {particles} 3" NumberType="Float" Precision="8" Format="HDF">{file}:/frames/positions</DataItem>
          </DataItem>
        </Geometry>
        <Attribute Name="velocity" AttributeType="Vector" Center="Node">
          <DataItem ItemType="HyperSlab" Dimensions="{particles} 3">
            <DataItem Dimensions="3 3" Format="XML">{frame} 0 0 1 1 1 1 {particles} 3</DataItem>
            <DataItem Dimensions="{frames} {particles} 3" NumberType="Float" Precision="8" Format="HDF">{file}:/frames/velocities</DataItem>
          </DataItem>
        </Attribute>
      </Grid>
)";

}  // namespace

struct TrajectoryFile::Content {
  std::string path;
  Shape::value_type particles, triangles;
  Hdf5 file, frames, diagnostics;
  GrowingDataset time, positions, velocities;
  std::vector<GrowingDataset> rows;  // scalars, in the order of `scalars` below
  GrowingDataset linear, angular;
  std::vector<ObjectRows> objects;
  std::span<const Object> solids;
  std::vector<GrowingDataset> distances;  // one if there are objects
  std::vector<BondRows> bonds;            // one if anything is sticky
  std::vector<double> frame_times;

  Content(const std::string& to, const Scene& scene, std::span<const Object> built)
      : path(to),
        particles(Shape::value_type(scene.mesh.particles())),
        triangles(scene.mesh.triangles.size()),
        file(Hdf5::create_file(to + ".partial")),
        frames(file.group("frames")),
        diagnostics(file.group("diagnostics")),
        time(frames, "time", "s", {}),
        positions(frames, "positions", "m", {particles, 3}),
        velocities(frames, "velocities", "m/s", {particles, 3}),
        linear(diagnostics, "linear_momentum", "kg m/s", {3}),
        angular(diagnostics, "angular_momentum", "kg m^2/s", {3}),
        objects(write_objects(file, scene)),
        solids(built) {
    if (!solids.empty()) distances.emplace_back(frames, "object_distance", "m", Shape{particles});
    if (!scene.sticky.empty()) bonds.emplace_back(file.group("sticky"), scene);
  }

  /// Signed distance of each particle to the union of the objects.
  void add_distances(const State& s) {
    PerParticle phi(s.x.cols());
    ObjectsOverSpan now(solids, {s.time, s.time, 0});
    for (Eigen::Index i = 0; i < s.x.cols(); ++i) phi[i] = nearest_of(now.at(s.x.col(i))).first.phi;
    for (GrowingDataset& rows : distances) rows.add(phi.data());
  }

  std::string xdmf() const {
    std::string text = xdmf_head;
    for (size_t k = 0; k < frame_times.size(); ++k)
      text +=
          fmt::format(fmt::runtime(xdmf_frame), fmt::arg("frame", k),
                      fmt::arg("time", frame_times[k]), fmt::arg("triangles", triangles),
                      fmt::arg("particles", particles), fmt::arg("frames", frame_times.size()),
                      fmt::arg("file", xml_text(std::filesystem::path(path).filename().string())));
    return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
  }
};

namespace {

struct Scalar {
  const char *name, *unit;
  double (*of)(const Diagnostics&);
};

constexpr Scalar scalars[] = {
    {"time", "s", [](const Diagnostics& d) { return d.time; }},
    {"step", "s", [](const Diagnostics& d) { return d.step; }},
    {"kinetic_energy", "J", [](const Diagnostics& d) { return d.energy.kinetic; }},
    {"stretch_energy", "J", [](const Diagnostics& d) { return d.energy.stretch; }},
    {"bending_energy", "J", [](const Diagnostics& d) { return d.energy.bending; }},
    {"gravity_energy", "J", [](const Diagnostics& d) { return d.energy.gravity; }},
    {"custom_energy", "J", [](const Diagnostics& d) { return d.energy.custom; }},
    {"sticking_energy", "J", [](const Diagnostics& d) { return d.energy.sticking; }},
    {"damping_work", "J", [](const Diagnostics& d) { return d.damping_work; }},
    {"cg_iterations", "1", [](const Diagnostics& d) { return double(d.work.cg_iterations); }},
    {"cg_residual", "1", [](const Diagnostics& d) { return d.work.worst_residual; }},
    {"step_over_elastic_limit", "1",
     [](const Diagnostics& d) { return d.step_over_elastic_limit; }},
    {"object_contacts", "1", [](const Diagnostics& d) { return double(d.work.object_contacts); }},
    {"strain_left", "1", [](const Diagnostics& d) { return d.work.strain_left; }},
    {"close_pairs", "1", [](const Diagnostics& d) { return double(d.work.close_pairs); }},
    {"crossings", "1", [](const Diagnostics& d) { return double(d.work.crossings); }},
    {"zone_particles", "1", [](const Diagnostics& d) { return double(d.work.zone_particles); }},
    {"bonds", "1", [](const Diagnostics& d) { return double(d.work.bonds); }},
    {"seconds", "s", [](const Diagnostics& d) { return d.seconds; }},
};

/// Writes; what cannot be written is told with the file's name.
template <class Write>
void named(const std::string& path, const Write& write) {
  try {
    write();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": cannot be written (" + error.what() +
                             "); is the disk full?");
  }
}

}  // namespace

TrajectoryFile::TrajectoryFile(const std::string& path, const Scene& scene, const System& system,
                               std::span<const Object> objects, const Provenance& provenance)
    : content_((require_replaceable(path), std::make_unique<Content>(path, scene, objects))) {
  const Hdf5& file = content_->file;
  write_provenance(file, provenance);
  file.attribute("case_name", scene.name);
  file.attribute("title", scene.title);
  file.attribute("about", scene.about);
  file.attribute("case_text", scene.text);
  const std::filesystem::path here = std::filesystem::current_path();
  file.attribute("case_folder", scene.text.empty() ? "" : (here / scene.folder).string());
  file.attribute("integrator", scene.integrator);
  file.attribute("built", describe_parts(scene, system));
  file.attribute(
      "frames_wanted",
      int(std::lround(std::ceil(scene.schedule.end / scene.schedule.frame_interval - 1e-9))) + 1);
  write_mesh(file, scene, system);
  write_garment(file, scene);
  if (scene.gravity) file.array("gravity", {3}, scene.gravity->data()).attribute("unit", "m/s^2");
  for (const Scalar& scalar : scalars)
    content_->rows.emplace_back(content_->diagnostics, scalar.name, scalar.unit, Shape{});
}

TrajectoryFile::~TrajectoryFile() = default;

void TrajectoryFile::add_frame(const State& s) {
  named(content_->path, [&] {
    content_->time.add(&s.time);
    content_->positions.add(s.x.data());
    content_->velocities.add(s.v.data());
    if (!content_->solids.empty()) content_->add_distances(s);
    for (ObjectRows& object : content_->objects) add_place(s.time, object);
    for (BondRows& bonds : content_->bonds) bonds.add(s);
    content_->frame_times.push_back(s.time);
    content_->file.flush();
  });
}

void TrajectoryFile::add_diagnostics(const Diagnostics& row) {
  named(content_->path, [&] {
    for (size_t k = 0; k < std::size(scalars); ++k) {
      const double value = scalars[k].of(row);
      content_->rows[k].add(&value);
    }
    content_->linear.add(row.linear_momentum.data());
    content_->angular.add(row.angular_momentum.data());
  });
}

void TrajectoryFile::finish(const std::string& stopped, double seconds,
                            const std::vector<Record>& findings) {
  const std::string path = content_->path, xdmf = content_->xdmf();
  named(path, [&] {
    content_->file.attribute("stopped", stopped);
    content_->file.attribute("seconds", seconds);
    write_findings(content_->file, findings);
    content_->file.flush();
    Hdf5 file = std::move(content_->file);
    content_.reset();  // what is open in the file is closed before it
    file.close();
  });
  durable_rename(path + ".partial", path);
  write_text(std::filesystem::path(path).replace_extension(".xdmf").string(), xdmf);
}

}  // namespace foldproof
