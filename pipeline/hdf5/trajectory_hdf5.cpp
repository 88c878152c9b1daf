#include "pipeline/hdf5/trajectory_hdf5.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "collision/geometry/error.hpp"
#include "collision/geometry/path_beside.hpp"
#include "physics/scene/contact_forces.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"
#include "pipeline/hdf5/look_hdf5.hpp"
#include "pipeline/hdf5/trajectory_row.hpp"
#include "pipeline/host/version.hpp"

namespace selvedge {
namespace {

constexpr hsize_t report_chunk = 64, bad_chunk = 4096;

void write_constants(const h5::File& file, const TrajectoryInfo& info) {
  file.write_text("format", "selvedge trajectory 1");
  file.write_text("program_version", info.program_version);
  file.write_text("config", info.config);
  file.write_text("stepper", info.stepper);
  file.write_constant("fps", H5T_NATIVE_DOUBLE, {1}, &info.fps);
  file.write_text("self", info.self_audited ? "audited" : "not audited");

  const h5::Handle cloth = file.make_group("cloth");
  file.write_texts("cloth/names", info.cloth_names);
  h5::write_integers(file, "cloth/first_vertex", info.cloth_first_vertex);
  h5::write_integers(file, "cloth/first_triangle", info.cloth_first_triangle);
  h5::write_triangles(file, "cloth/triangles", info.triangles);
  h5::write_points(file, "cloth/rest", info.rest);
  // RestTriangle is column-major 2 x 3, so that a triangle's corners are stored in order: rows of 3 x (u, v).
  static_assert(sizeof(RestTriangle) == 6 * sizeof(double));
  file.write_constant("cloth/rest_triangles", H5T_NATIVE_DOUBLE, {info.rest_triangle.size(), 3, 2},
                      info.rest_triangle.data());
  h5::write_integers(file, "cloth/pins", info.pins);
  const h5::Handle looks = info.looks.empty() ? h5::Handle() : file.make_group("cloth/looks");
  for (std::size_t c = 0; c < info.looks.size(); ++c)
    h5::write_look(file, "cloth/looks/" + std::to_string(c), info.looks[c]);

  const h5::Handle codes = file.make_group("codes");
  for (const BoundField<Frame>& field : frame_fields())
    if (field.type == ColumnType::word) file.write_texts("codes/" + field.name, field.words);
}

}  // namespace

TrajectoryInfo trajectory_info(const Scene& scene, const std::string& config, const std::string& stepper, double fps) {
  TrajectoryInfo info;
  info.program_version = program_version();
  info.config = config;
  info.stepper = stepper;
  info.fps = fps;
  info.self_audited = scene.contact.self;
  for (const Cloth& cloth : scene.cloths) {
    info.cloth_names.push_back(cloth.name);
    info.cloth_first_vertex.push_back(cloth.first_vertex);
    info.cloth_first_triangle.push_back(cloth.first_triangle);
  }
  info.cloth_first_vertex.push_back(scene.surface.vertex_count);
  info.cloth_first_triangle.push_back(static_cast<int>(scene.surface.triangles.rows()));
  info.triangles = scene.surface.triangles;
  info.rest = scene.rest;
  info.rest_triangle = scene.rest_triangle;
  info.pins = scene.pins;
  for (const Obstacle& obstacle : scene.obstacles)
    info.obstacles.push_back(
        {obstacle.name, obstacle.surface.triangles, obstacle.surface.vertex_count, obstacle.moving});
  return info;
}

struct TrajectoryWriter::Impl {
  h5::File file;
  TrajectoryInfo info;
  h5::Handle row_type = row_memory_type(), by_type = h5::text_type(by_name_bytes);
  h5::Handle complete, closed, report, by, x, bad, switched_off;
  h5::Handle contact_normal, contact_friction, contact_pressure;  // missing unless asked for
  std::vector<h5::Handle> obstacles;
  std::vector<PointsF> still;  // positions of each obstacle in the first frame; empty once it has moved
  std::vector<std::string> by_names;
  std::int64_t frames = 0, bad_length = 0;

  Impl(const std::filesystem::path& path, TrajectoryInfo constant)
      : file(h5::File::create(path)), info(std::move(constant)), still(info.obstacles.size()) {}

  void make_datasets();
  int code_of(const std::string& by_name);
  void set(const h5::Handle& flag, std::int64_t value);
  void append_obstacle(std::size_t k, const PointsF& at);
  void append_contact_forces(const StepReport&);
  void append(const Frame&);
  void close();
};

void TrajectoryWriter::Impl::make_datasets() {
  write_constants(file, info);
  info.rest_triangle = {};  // is in the file, and no frame needs it
  const std::int64_t zero = 0;
  file.write_constant("frames_complete", H5T_NATIVE_INT64, {1}, &zero);
  file.write_constant("closed", H5T_NATIVE_INT64, {1}, &zero);
  complete = file.open_dataset("frames_complete");
  closed = file.open_dataset("closed");
  by = file.make_growing("codes/by", by_type.id(), {}, 16);

  const h5::Handle frames_group = file.make_group("frames");
  report = file.make_growing("frames/report", row_file_type().id(), {}, report_chunk);
  x = file.make_growing("frames/x", H5T_NATIVE_FLOAT, {static_cast<hsize_t>(info.rest.rows()), 3}, 1);
  bad = file.make_growing("frames/bad_triangles", H5T_NATIVE_INT32, {}, bad_chunk);
  if (info.contact_forces) {
    const auto vertices = static_cast<hsize_t>(info.rest.rows());
    contact_normal = file.make_growing("frames/contact_normal", H5T_NATIVE_FLOAT, {vertices, 3}, 1);
    contact_friction = file.make_growing("frames/contact_friction", H5T_NATIVE_FLOAT, {vertices, 3}, 1);
    contact_pressure = file.make_growing("frames/contact_pressure", H5T_NATIVE_FLOAT, {vertices}, 1);
  }
  if (!info.obstacles.empty())
    switched_off = file.make_growing("frames/switched_off", H5T_NATIVE_INT32, {info.obstacles.size()}, report_chunk);

  const h5::Handle obstacles_group = file.make_group("obstacles");
  for (std::size_t k = 0; k < info.obstacles.size(); ++k) {
    const TrajectoryInfo::Body& body = info.obstacles[k];
    const std::string name = "obstacles/" + std::to_string(k);
    const h5::Handle group = file.make_group(name);
    file.write_text(name + "/name", body.name);
    file.write_text(name + "/motion", body.moving ? "moving" : "still");
    h5::write_triangles(file, name + "/triangles", body.triangles);
    obstacles.push_back(
        file.make_growing(name + "/x", H5T_NATIVE_FLOAT, {static_cast<hsize_t>(body.vertex_count), 3}, 1));
  }
}

int TrajectoryWriter::Impl::code_of(const std::string& by_name) {
  const auto known = std::find(by_names.begin(), by_names.end(), by_name);
  if (known != by_names.end()) return static_cast<int>(known - by_names.begin());
  std::string padded = by_name;
  padded.resize(by_name_bytes, '\0');
  file.write_rows(by.id(), by_type.id(), by_names.size(), 1, padded.data());
  by_names.push_back(by_name);
  return static_cast<int>(by_names.size()) - 1;
}

void TrajectoryWriter::Impl::set(const h5::Handle& flag, std::int64_t value) {
  file.write_rows(flag.id(), H5T_NATIVE_INT64, 0, 1, &value);
  file.flush();
}

// The file gets its name only once it is open for SWMR, so that a file with that name can always be opened.
TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& path, TrajectoryInfo info) {
  const std::filesystem::path beside = path_beside(path);
  try {
    impl_ = std::make_unique<Impl>(beside, std::move(info));
    impl_->make_datasets();
    impl_->file.start_swmr();
    impl_->file.flush();
    impl_->file.move_to(path);
  } catch (...) {
    if (impl_) impl_->file.abandon();
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw;
  }
}

TrajectoryWriter::~TrajectoryWriter() = default;

// A still obstacle is stored once. If cloth without room moves it, it is stored in every frame from then on, and also
// in the earlier ones, in order; readers take it as still until all are stored.
void TrajectoryWriter::Impl::append_obstacle(std::size_t k, const PointsF& at) {
  if (frames == 0 && !info.obstacles[k].moving) still[k] = at;
  if (frames > 0 && still[k].rows() > 0) {
    if (at == still[k]) return;
    for (std::int64_t f = 1; f < frames; ++f)
      file.write_rows(obstacles[k].id(), H5T_NATIVE_FLOAT, static_cast<hsize_t>(f), 1, still[k].data());
    still[k].resize(0, 3);
  }
  file.write_rows(obstacles[k].id(), H5T_NATIVE_FLOAT, static_cast<hsize_t>(frames), 1, at.data());
}

// The forces of a state that no solve has made, such as the initial one, are not a number.
void TrajectoryWriter::Impl::append_contact_forces(const StepReport& made) {
  const bool known = made.status == StepStatus::accepted && made.contact_forces;
  const ContactForces forces = known ? *made.contact_forces : unknown_contact_forces(info.rest.rows());
  const PointsF normal = forces.normal.cast<float>(), friction = forces.friction.cast<float>();
  const Eigen::VectorXf pressure = forces.pressure.cast<float>();
  file.write_rows(contact_normal.id(), H5T_NATIVE_FLOAT, frames, 1, normal.data());
  file.write_rows(contact_friction.id(), H5T_NATIVE_FLOAT, frames, 1, friction.data());
  file.write_rows(contact_pressure.id(), H5T_NATIVE_FLOAT, frames, 1, pressure.data());
}

// The count of full frames is raised after everything else has reached the file, since readers rely on it alone.
void TrajectoryWriter::Impl::append(const Frame& frame) {
  file.write_rows(x.id(), H5T_NATIVE_FLOAT, frames, 1, frame.x.data());
  for (std::size_t k = 0; k < obstacles.size(); ++k) append_obstacle(k, frame.obstacles[k]);
  if (info.contact_forces) append_contact_forces(frame.report);
  file.write_rows(bad.id(), H5T_NATIVE_INT32, bad_length, frame.bad_triangles.size(), frame.bad_triangles.data());
  std::vector<std::int32_t> off = frame.report.switched_off;
  off.resize(obstacles.size(), 0);
  if (!off.empty()) file.write_rows(switched_off.id(), H5T_NATIVE_INT32, frames, 1, off.data());
  const TrajectoryRow row = row_of(
      frame, [this](const std::string& name) { return code_of(name); }, bad_length);
  file.write_rows(report.id(), row_type.id(), frames, 1, row.cells.data());
  file.flush();
  bad_length += row.bad_count();
  set(complete, ++frames);
}

void TrajectoryWriter::Impl::close() {
  set(closed, 1);
  for (h5::Handle* handle : {&complete, &closed, &report, &by, &x, &bad, &switched_off, &contact_normal,
                             &contact_friction, &contact_pressure})
    handle->reset();
  obstacles.clear();
  file.close();
}

void TrajectoryWriter::append(const Frame& frame) {
  assert(frame.x.rows() == impl_->info.rest.rows() && frame.obstacles.size() == impl_->info.obstacles.size());
  try {
    impl_->append(frame);
  } catch (const Error&) {
    impl_->file.abandon();
    throw;
  }
}

void TrajectoryWriter::close() {
  if (impl_->file.id() < 0) return;
  try {
    impl_->close();
  } catch (const Error&) {
    impl_->file.abandon();
    throw;
  }
}

}  // namespace selvedge
