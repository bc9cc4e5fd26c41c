#include "verification/results_file.h"

#include <fmt/format.h>
#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <utility>

namespace foldproof {

namespace {

/// Owns an HDF5 identifier.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) throw std::runtime_error("HDF5: cannot make " + what);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void succeed(herr_t result, const std::string& what) {
  if (result < 0) throw std::runtime_error("HDF5: cannot write " + what);
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "a text type");
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

/// '/' parts the names of groups in HDF5; in a name it becomes a division slash, which looks the same.
std::string without_slash(const std::string& name) {
  std::string result;
  for (const char c : name) result += c == '/' ? std::string("\u2215") : std::string(1, c);
  return result;
}

Handle group(hid_t parent, const std::string& name) {
  return {H5Gcreate2(parent, without_slash(name).c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
          name};
}

Handle space_of(std::vector<hsize_t> shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose, "a space"};
  return {H5Screate_simple(int(shape.size()), shape.data(), nullptr), H5Sclose, "a space"};
}

void write_attribute(hid_t object, const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                     const void* data) {
  const Handle space = space_of(shape);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         name);
  succeed(H5Awrite(attribute, type, data), name);
}

void attribute(hid_t object, const std::string& name, const std::string& value) {
  const char* text = value.c_str();
  write_attribute(object, name, text_type(), {}, &text);
}
void attribute(hid_t object, const std::string& name, double value) {
  write_attribute(object, name, H5T_NATIVE_DOUBLE, {}, &value);
}
void attribute(hid_t object, const std::string& name, int value) {
  write_attribute(object, name, H5T_NATIVE_INT, {}, &value);
}
void attribute(hid_t object, const std::string& name, const std::vector<std::string>& values) {
  if (values.empty()) return;  // HDF5 1.10 has no empty simple attribute of texts; absent means none
  std::vector<const char*> texts;
  for (const std::string& value : values) texts.push_back(value.c_str());
  write_attribute(object, name, text_type(), {texts.size()}, texts.data());
}

Handle write_dataset(hid_t parent, const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                     const void* data) {
  const Handle space = space_of(shape);
  Handle set(
      H5Dcreate2(parent, without_slash(name).c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose, name);
  if (data) succeed(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), name);
  return set;
}

Handle dataset(hid_t parent, const std::string& name, const std::vector<double>& values) {
  return write_dataset(parent, name, H5T_NATIVE_DOUBLE, {values.size()},
                       values.empty() ? nullptr : values.data());
}
Handle dataset(hid_t parent, const std::string& name, const std::vector<std::string>& values) {
  std::vector<const char*> texts;
  for (const std::string& value : values) texts.push_back(value.c_str());
  return write_dataset(parent, name, text_type(), {texts.size()}, texts.empty() ? nullptr : texts.data());
}

// ---- provenance, findings, studies

void write_provenance(hid_t file, const Provenance& p) {
  attribute(file, "schema", 1);
  attribute(file, "program", std::string("foldproof"));
  attribute(file, "version", p.version);
  attribute(file, "commit", p.commit);
  attribute(file, "tree", p.tree);
  attribute(file, "compiler", p.compiler);
  attribute(file, "flags", p.flags);
  attribute(file, "build_type", p.build_type);
  attribute(file, "cpu", p.cpu);
  attribute(file, "cores", p.cores);
  attribute(file, "date", p.date);
  attribute(file, "command", p.command);
}

void write_columns(hid_t parent, const std::vector<Column>& columns) {
  int order = 0;
  for (const Column& column : columns) {
    const Handle set =
        std::visit([&](const auto& values) { return dataset(parent, column.name, values); }, column.values);
    attribute(set, "order", order++);
    attribute(set, "unit", column.unit);
  }
}

void write_record(hid_t parent, const Record& record, int order) {
  const Handle here = group(parent, record.name);
  const Verdict& verdict = record.finding.verdict;
  attribute(here, "order", order);
  attribute(here, "kind", record.kind);
  attribute(here, "study", record.study);
  attribute(here, "claim", record.claim);
  attribute(here, "source", record.source);
  attribute(here, "measured", verdict.measured);
  attribute(here, "bound", verdict.bound);
  attribute(here, "uncertainty", verdict.uncertainty);
  attribute(here, "unit", verdict.unit);
  attribute(here, "why_bound", verdict.why_bound);
  attribute(here, "outcome", record.outcome);
  attribute(here, "note", record.finding.note);
  attribute(here, "seconds", record.seconds);
  attribute(here, "faults", record.faults);
  if (!record.better.empty()) attribute(here, "better", record.better);
  if (!record.finding.evidence.empty()) write_columns(group(here, "evidence"), record.finding.evidence);
}

std::string scale_name(Scale scale) { return scale == Scale::log ? "log" : "linear"; }

void write_curve(hid_t parent, const Curve& curve, int order) {
  const Handle here = group(parent, fmt::format("curve-{:02}", order));
  attribute(here, "order", order);
  attribute(here, "label", curve.label);
  attribute(here, "floor", curve.floor);
  dataset(here, "x", curve.x);
  dataset(here, "y", curve.y);
  if (!curve.pair_orders.empty()) dataset(here, "pair_orders", curve.pair_orders);
}

void write_figure(hid_t parent, const Figure& figure, int order) {
  const Handle here = group(parent, figure.name);
  attribute(here, "order", order);
  attribute(here, "title", figure.title);
  attribute(here, "x_label", figure.x.label);
  attribute(here, "x_unit", figure.x.unit);
  attribute(here, "x_scale", scale_name(figure.x.scale));
  attribute(here, "y_label", figure.y.label);
  attribute(here, "y_unit", figure.y.unit);
  attribute(here, "y_scale", scale_name(figure.y.scale));
  attribute(here, "slope", figure.slope);
  attribute(here, "caption", figure.caption);
  const Handle curves = group(here, "curves");
  for (size_t k = 0; k < figure.curves.size(); ++k) write_curve(curves, figure.curves[k], int(k));
}

void write_study(hid_t parent, const StudyRecord& study, int order) {
  const Handle here = group(parent, study.name);
  attribute(here, "order", order);
  attribute(here, "claim", study.claim);
  attribute(here, "source", study.source);
  attribute(here, "about", study.about);
  attribute(here, "seconds", study.seconds);
  const Handle figures = group(here, "figures");
  for (size_t k = 0; k < study.figures.size(); ++k) write_figure(figures, study.figures[k], int(k));
  const Handle tables = group(here, "tables");
  for (size_t k = 0; k < study.tables.size(); ++k) {
    const Handle table = group(tables, study.tables[k].name);
    attribute(table, "order", int(k));
    attribute(table, "title", study.tables[k].title);
    write_columns(table, study.tables[k].columns);
  }
}

void write_cases(hid_t file, const std::vector<CaseRecord>& cases) {
  const Handle parent = group(file, "cases");
  int order = 0;
  for (const CaseRecord& record : cases) {
    const Handle here = group(parent, record.name);
    attribute(here, "order", order++);
    attribute(here, "file", record.file);
    attribute(here, "title", record.title);
    attribute(here, "about", record.about);
    attribute(here, "seconds", record.seconds);
    attribute(here, "stopped", record.stopped);
  }
}

void write_faults(hid_t file, const std::vector<Fault>& faults) {
  std::vector<std::string> name, path, find, replace, law, caught_by, outcome;
  for (const Fault& fault : faults) {
    name.push_back(fault.name);
    path.push_back(fault.file);
    find.push_back(fault.find);
    replace.push_back(fault.replace);
    law.push_back(fault.law);
    caught_by.push_back(fmt::format("{}", fmt::join(fault.caught_by, ", ")));
    outcome.push_back(fault.outcome);
  }
  write_columns(group(file, "faults"), {{"name", "", name},
                                        {"file", "", path},
                                        {"find", "", find},
                                        {"replace", "", replace},
                                        {"law", "", law},
                                        {"caught_by", "", caught_by},
                                        {"outcome", "", outcome}});
}

Handle create_file(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file < 0) throw std::runtime_error(path + ": cannot be written; is the folder there and writable?");
  return {file, H5Fclose, path};
}

}  // namespace

void rename_when_whole(const std::string& from, const std::string& to) {
  const int descriptor = open(from.c_str(), O_RDONLY);
  const bool synced = descriptor >= 0 && fsync(descriptor) == 0;
  if (descriptor >= 0) close(descriptor);
  if (!synced || std::rename(from.c_str(), to.c_str()) != 0)
    throw std::runtime_error(to + ": cannot be written");
}

void write_run(const std::string& path, const RunRecord& run) {
  const std::string partial = path + ".partial";
  {
    const Handle file = create_file(partial);
    write_provenance(file, run.provenance);
    attribute(file, "tier", run.tier);
    attribute(file, "seed", 1);
    attribute(file, "subject", run.subject);
    attribute(file, "subject_version", run.subject_version);
    attribute(file, "seconds", run.seconds);
    const Handle findings = group(file, "findings");
    for (size_t k = 0; k < run.records.size(); ++k) write_record(findings, run.records[k], int(k));
    const Handle studies = group(file, "studies");
    for (size_t k = 0; k < run.studies.size(); ++k) write_study(studies, run.studies[k], int(k));
    write_cases(file, run.cases);
    if (!run.faults.empty()) write_faults(file, run.faults);
  }
  rename_when_whole(partial, path);
}

// ---- trajectories

namespace {

/// A dataset that grows along its first dimension.
class Series {
 public:
  Series(hid_t parent, const std::string& name, const std::string& unit, std::vector<hsize_t> row)
      : row_(std::move(row)), set_(created(parent, name, row_)), name_(name) {
    attribute(set_, "unit", unit);
  }

  void add(const double* values) {
    std::vector<hsize_t> size = row_, start(row_.size() + 1, 0), count = row_;
    size.insert(size.begin(), length_ + 1);
    count.insert(count.begin(), 1);
    start[0] = length_++;
    succeed(H5Dset_extent(set_, size.data()), name_);
    const Handle file_space(H5Dget_space(set_), H5Sclose, name_);
    H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    const Handle memory = space_of(count);
    succeed(H5Dwrite(set_, H5T_NATIVE_DOUBLE, memory, file_space, H5P_DEFAULT, values), name_);
  }

  hsize_t length() const { return length_; }

 private:
  static Handle created(hid_t parent, const std::string& name, const std::vector<hsize_t>& row) {
    std::vector<hsize_t> start = row, most = row, chunk = row;
    start.insert(start.begin(), 0);
    most.insert(most.begin(), H5S_UNLIMITED);
    const bool is_small = row.empty() || (row.size() == 1 && row[0] == 3);
    chunk.insert(chunk.begin(), is_small ? 1024 : 1);
    const Handle space(H5Screate_simple(int(start.size()), start.data(), most.data()), H5Sclose, name);
    const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
    H5Pset_chunk(layout, int(chunk.size()), chunk.data());
    return {H5Dcreate2(parent, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, layout, H5P_DEFAULT),
            H5Dclose, name};
  }

  std::vector<hsize_t> row_;
  Handle set_;
  std::string name_;
  hsize_t length_ = 0;
};

void write_mesh(hid_t file, const Scene& scene, const System& system) {
  const Handle mesh = group(file, "mesh");
  const hsize_t particles = hsize_t(scene.mesh.particles()), triangles = scene.mesh.triangles.size();
  write_dataset(mesh, "triangles", H5T_NATIVE_INT, {triangles, 3}, scene.mesh.triangles.data());
  const Handle rest =
      write_dataset(mesh, "rest_positions", H5T_NATIVE_DOUBLE, {particles, 3}, scene.mesh.rest.data());
  attribute(rest, "unit", std::string("m"));
  const Handle mass = write_dataset(mesh, "mass", H5T_NATIVE_DOUBLE, {particles}, system.mass.data());
  attribute(mass, "unit", std::string("kg"));
  std::vector<unsigned char> held;
  for (Eigen::Index i = 0; i < system.inverse_mass.size(); ++i) held.push_back(system.inverse_mass[i] == 0);
  write_dataset(mesh, "held", H5T_NATIVE_UCHAR, {particles}, held.data());
}

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
  hsize_t particles, triangles;
  Handle file, frames, diagnostics;
  Series time, positions, velocities;
  std::vector<Series> rows;  // scalars, in the order of `scalars` below
  Series linear, angular;
  std::vector<double> frame_times;

  Content(const std::string& to, const Scene& scene)
      : path(to),
        particles(hsize_t(scene.mesh.particles())),
        triangles(scene.mesh.triangles.size()),
        file(create_file(to + ".partial")),
        frames(group(file, "frames")),
        diagnostics(group(file, "diagnostics")),
        time(frames, "time", "s", {}),
        positions(frames, "positions", "m", {particles, 3}),
        velocities(frames, "velocities", "m/s", {particles, 3}),
        linear(diagnostics, "linear_momentum", "kg m/s", {3}),
        angular(diagnostics, "angular_momentum", "kg m^2/s", {3}) {}

  void write_xdmf() const {
    const std::filesystem::path target(path);
    const std::string name = std::filesystem::path(target).replace_extension(".xdmf").string();
    std::ofstream out(name + ".partial");
    out << xdmf_head;
    for (size_t k = 0; k < frame_times.size(); ++k)
      out << fmt::format(fmt::runtime(xdmf_frame), fmt::arg("frame", k), fmt::arg("time", frame_times[k]),
                         fmt::arg("triangles", triangles), fmt::arg("particles", particles),
                         fmt::arg("frames", frame_times.size()),
                         fmt::arg("file", target.filename().string()));
    out << "    </Grid>\n  </Domain>\n</Xdmf>\n";
    out.close();
    if (!out) throw std::runtime_error(name + ": cannot be written");
    rename_when_whole(name + ".partial", name);
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
    {"damping_work", "J", [](const Diagnostics& d) { return d.damping_work; }},
    {"cg_iterations", "1", [](const Diagnostics& d) { return double(d.cg_iterations); }},
    {"cg_residual", "1", [](const Diagnostics& d) { return d.cg_residual; }},
    {"step_over_elastic_limit", "1", [](const Diagnostics& d) { return d.step_over_elastic_limit; }},
    {"seconds", "s", [](const Diagnostics& d) { return d.seconds; }},
};

}  // namespace

TrajectoryFile::TrajectoryFile(const std::string& path, const Scene& scene, const System& system,
                               const Provenance& provenance)
    : content_(std::make_unique<Content>(path, scene)) {
  const hid_t file = content_->file;
  write_provenance(file, provenance);
  attribute(file, "case_name", scene.name);
  attribute(file, "title", scene.title);
  attribute(file, "about", scene.about);
  attribute(file, "case_text", scene.text);
  attribute(file, "integrator", scene.integrator);
  attribute(file, "built", built_parts(scene, system));
  attribute(file, "frames_wanted",
            int(std::lround(std::ceil(scene.schedule.end / scene.schedule.frame_interval - 1e-9))) + 1);
  write_mesh(file, scene, system);
  for (const Scalar& scalar : scalars)
    content_->rows.emplace_back(content_->diagnostics, scalar.name, scalar.unit, std::vector<hsize_t>{});
}

TrajectoryFile::~TrajectoryFile() = default;

void TrajectoryFile::add_frame(const State& s) {
  content_->time.add(&s.time);
  content_->positions.add(s.x.data());
  content_->velocities.add(s.v.data());
  content_->frame_times.push_back(s.time);
  H5Fflush(content_->file, H5F_SCOPE_LOCAL);
}

void TrajectoryFile::add_diagnostics(const Diagnostics& row) {
  for (size_t k = 0; k < std::size(scalars); ++k) {
    const double value = scalars[k].of(row);
    content_->rows[k].add(&value);
  }
  content_->linear.add(row.linear_momentum.data());
  content_->angular.add(row.angular_momentum.data());
}

void TrajectoryFile::finish(const std::string& stopped, double seconds) {
  attribute(content_->file, "stopped", stopped);
  attribute(content_->file, "seconds", seconds);
  const std::string path = content_->path;
  content_->write_xdmf();
  content_.reset();
  rename_when_whole(path + ".partial", path);
}

}  // namespace foldproof
