#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/geometry/error.hpp"
#include "physics/scene/contact_forces.hpp"
#include "pipeline/hdf5/look_hdf5.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/hdf5/trajectory_row.hpp"

namespace selvedge {
namespace {

[[noreturn]] void throw_damaged(const h5::File& file, const std::string& what) {
  throw Error(what, file.path().string(), "the file is damaged or not a trajectory of this program; write it again");
}

constexpr hsize_t most_rows = std::numeric_limits<std::int32_t>::max();

// Rows of a dataset whose dimensions after the first must be `row_shape`.
hsize_t rows_of(const h5::File& file, const std::string& name, const std::vector<hsize_t>& row_shape,
                bool growing = false) {
  const std::vector<hsize_t> shape = file.shape_of(name, row_shape.size() + 1, growing);
  if (!std::equal(shape.begin() + 1, shape.end(), row_shape.begin()) || shape[0] > most_rows)
    throw_damaged(file, name + " has an unexpected shape");
  return shape[0];
}

Triangles read_triangles(const h5::File& file, const std::string& name, int vertex_count) {
  const hsize_t count = rows_of(file, name, {3});
  Triangles triangles(static_cast<Eigen::Index>(count), 3);
  file.read_all(name, H5T_NATIVE_INT32, {count, 3}, triangles.data());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const auto corners = triangles.row(t);
    if (corners.minCoeff() < 0 || corners.maxCoeff() >= vertex_count)
      throw_damaged(file, name + " names a vertex that is not there");
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
      throw_damaged(file, name + " has a triangle with a vertex twice");
  }
  return triangles;
}

std::vector<int> read_ints(const h5::File& file, const std::string& name) {
  std::vector<int> values(rows_of(file, name, {}));
  file.read_all(name, H5T_NATIVE_INT32, {values.size()}, values.data());
  return values;
}

// The first index of each cloth, and the end of the last one.
std::vector<int> read_begins(const h5::File& file, const std::string& name, std::size_t cloths, Eigen::Index end) {
  const std::vector<int> begins = read_ints(file, name);
  if (begins.size() != cloths + 1 || begins.front() != 0 || begins.back() != end ||
      !std::is_sorted(begins.begin(), begins.end()))
    throw_damaged(file, name + " does not run from 0 to " + std::to_string(end) + ", one number a cloth");
  return begins;
}

std::int64_t read_number(const h5::File& file, const std::string& name) {
  std::int64_t number = 0;
  file.read_all(name, H5T_NATIVE_INT64, {1}, &number);
  return number;
}

void read_cloth(const h5::File& file, TrajectoryInfo& info) {
  info.cloth_names = file.read_texts("cloth/names");
  const hsize_t vertices = rows_of(file, "cloth/rest", {3});
  info.rest.resize(static_cast<Eigen::Index>(vertices), 3);
  file.read_all("cloth/rest", H5T_NATIVE_DOUBLE, {vertices, 3}, info.rest.data());
  info.triangles = read_triangles(file, "cloth/triangles", static_cast<int>(info.rest.rows()));
  info.cloth_first_vertex = read_begins(file, "cloth/first_vertex", info.cloth_names.size(), info.rest.rows());
  info.cloth_first_triangle = read_begins(file, "cloth/first_triangle", info.cloth_names.size(), info.triangles.rows());
  info.rest_triangle.resize(rows_of(file, "cloth/rest_triangles", {3, 2}));
  if (info.rest_triangle.size() != static_cast<std::size_t>(info.triangles.rows()))
    throw_damaged(file, "cloth/rest_triangles has an unexpected shape");
  file.read_all("cloth/rest_triangles", H5T_NATIVE_DOUBLE, {info.rest_triangle.size(), 3, 2},
                info.rest_triangle.data());
  info.pins = read_ints(file, "cloth/pins");
  for (const int pin : info.pins)
    if (pin < 0 || pin >= info.rest.rows()) throw_damaged(file, "cloth/pins names a vertex that is not there");
}

TrajectoryInfo::Body read_body(const h5::File& file, const std::string& name, hsize_t frames) {
  constexpr hsize_t many = 1u << 20;  // with more vertices, checks that they are stored in the file
  TrajectoryInfo::Body body;
  body.name = file.read_text(name + "/name");
  body.moving = file.read_text(name + "/motion") == "moving";
  const std::vector<hsize_t> shape = file.shape_of(name + "/x", 3, true);
  if (shape[2] != 3 || shape[1] > most_rows || (shape[1] > many && shape[0] == 0))
    throw_damaged(file, name + "/x has an unexpected shape");
  if (shape[1] > many) file.shape_of(name + "/x", 3);
  body.vertex_count = static_cast<int>(shape[1]);
  body.moving = body.moving || shape[0] >= std::max<hsize_t>(frames, 2);
  body.triangles = read_triangles(file, name + "/triangles", body.vertex_count);
  return body;
}

TrajectoryInfo read_info(const h5::File& file, hsize_t frames) {
  if (!file.has("format") || file.read_text("format") != "selvedge trajectory 1")
    throw_damaged(file, "this HDF5 file is not a trajectory of this program");
  TrajectoryInfo info;
  info.program_version = file.read_text("program_version");
  info.config = file.read_text("config");
  info.stepper = file.read_text("stepper");
  file.read_all("fps", H5T_NATIVE_DOUBLE, {1}, &info.fps);
  if (!(info.fps > 0) || !std::isfinite(info.fps)) throw_damaged(file, "fps is " + std::to_string(info.fps));
  info.self_audited = file.read_text("self") == "audited";
  read_cloth(file, info);
  for (int k = 0; file.has("obstacles/" + std::to_string(k)); ++k)
    info.obstacles.push_back(read_body(file, "obstacles/" + std::to_string(k), frames));
  return info;
}

}  // namespace

struct TrajectoryReader::Impl {
  h5::File file;
  TrajectoryInfo info;
  h5::Handle row_type = row_memory_type(), report, x, bad;
  h5::Handle switched_off;                                        // missing in older files
  h5::Handle contact_normal, contact_friction, contact_pressure;  // missing where nobody asked for them
  std::vector<h5::Handle> obstacles;
  std::vector<std::string> by_names;
  int frames = 0;
  bool closed = false;

  explicit Impl(const std::filesystem::path& path) : file(h5::File::open(path)) {}
  TrajectoryRow read_row(int index) const;
  h5::Handle open_frames(const std::string& name, const std::vector<hsize_t>& row_shape) const {
    if (rows_of(file, name, row_shape, true) < static_cast<hsize_t>(frames))
      throw_damaged(file, name + " has fewer rows than there are frames");
    return file.open_dataset(name);
  }
  ContactForces read_contact_forces(int row) const {
    const Eigen::Index vertices = info.rest.rows();
    Eigen::VectorXf pressure(vertices);
    file.read_rows(contact_pressure.id(), H5T_NATIVE_FLOAT, {static_cast<hsize_t>(vertices)}, static_cast<hsize_t>(row),
                   1, pressure.data());
    return {read_points(contact_normal, row, vertices).cast<double>(),
            read_points(contact_friction, row, vertices).cast<double>(), pressure.cast<double>()};
  }
  PointsF read_points(const h5::Handle& dataset, int row, Eigen::Index count) const {
    PointsF points(count, 3);
    file.read_rows(dataset.id(), H5T_NATIVE_FLOAT, {static_cast<hsize_t>(count), 3}, static_cast<hsize_t>(row), 1,
                   points.data());
    return points;
  }
};

std::filesystem::path trajectory_file(const std::filesystem::path& file_or_folder) {
  std::error_code ignored;
  return std::filesystem::is_directory(file_or_folder, ignored) ? file_or_folder / "run.h5" : file_or_folder;
}

TrajectoryReader::TrajectoryReader(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw Error("there is no such file", path.string(), "check the path");
  impl_ = std::make_unique<Impl>(path);
  Impl& r = *impl_;
  // The count comes first: a file that is being written may grow while the rest is read.
  if (!r.file.has("frames_complete")) throw_damaged(r.file, "this HDF5 file is not a trajectory of this program");
  const std::int64_t frames = read_number(r.file, "frames_complete");
  r.closed = read_number(r.file, "closed") != 0;
  r.info = read_info(r.file, frames < 0 ? 0 : static_cast<hsize_t>(frames));
  r.by_names = r.file.read_texts("codes/by");
  const hsize_t stored = std::min(rows_of(r.file, "frames/x", {static_cast<hsize_t>(r.info.rest.rows()), 3}, true),
                                  rows_of(r.file, "frames/report", {}, true));
  if (frames < 0 || static_cast<hsize_t>(frames) > stored)
    throw_damaged(r.file, "counts " + std::to_string(frames) + " frames and has " + std::to_string(stored));
  rows_of(r.file, "frames/bad_triangles", {}, true);
  r.frames = static_cast<int>(frames);
  r.report = r.file.open_dataset("frames/report");
  r.x = r.file.open_dataset("frames/x");
  r.bad = r.file.open_dataset("frames/bad_triangles");
  if (r.file.has("frames/switched_off"))
    r.switched_off = r.open_frames("frames/switched_off", {r.info.obstacles.size()});
  r.info.contact_forces = r.file.has("frames/contact_normal");
  if (r.info.contact_forces) {
    const auto vertices = static_cast<hsize_t>(r.info.rest.rows());
    r.contact_normal = r.open_frames("frames/contact_normal", {vertices, 3});
    r.contact_friction = r.open_frames("frames/contact_friction", {vertices, 3});
    r.contact_pressure = r.open_frames("frames/contact_pressure", {vertices});
  }
  for (std::size_t k = 0; k < r.info.obstacles.size(); ++k)
    r.obstacles.push_back(r.file.open_dataset("obstacles/" + std::to_string(k) + "/x"));
}

TrajectoryReader::~TrajectoryReader() = default;

const TrajectoryInfo& TrajectoryReader::info() const { return impl_->info; }
std::vector<Look> TrajectoryReader::looks() const {
  const std::vector<int>& first = impl_->info.cloth_first_vertex;
  std::vector<Look> looks(impl_->info.cloth_names.size());
  for (std::size_t c = 0; c < looks.size() && impl_->file.has("cloth/looks"); ++c)
    looks[c] = h5::read_look(impl_->file, "cloth/looks/" + std::to_string(c), first[c + 1] - first[c]);
  return looks;
}

int TrajectoryReader::frame_count() const { return impl_->frames; }
bool TrajectoryReader::closed() const { return impl_->closed; }

TrajectoryRow TrajectoryReader::Impl::read_row(int index) const {
  if (index < 0 || index >= frames)
    throw Error("there is no frame " + std::to_string(index), file.path().string(),
                "it has " + std::to_string(frames) + " frames, counted from 0");
  TrajectoryRow row = empty_row();
  file.read_rows(report.id(), row_type.id(), {}, static_cast<hsize_t>(index), 1, row.cells.data());
  if (const auto name = unknown_word(row))
    throw_damaged(file, "frame " + std::to_string(index) + " has an unknown " + *name);
  return row;
}

double TrajectoryReader::time(int index) const {
  Frame frame;
  fill_from_row(impl_->read_row(index), impl_->by_names, frame);
  return frame.time;
}

Frame TrajectoryReader::frame(int index) const {
  const Impl& r = *impl_;
  const TrajectoryRow row = r.read_row(index);
  Frame frame;
  fill_from_row(row, r.by_names, frame);
  frame.x = r.read_points(r.x, index, r.info.rest.rows());
  for (std::size_t k = 0; k < r.obstacles.size(); ++k)
    frame.obstacles.push_back(
        r.read_points(r.obstacles[k], r.info.obstacles[k].moving ? index : 0, r.info.obstacles[k].vertex_count));
  if (r.switched_off.id() >= 0) {
    std::vector<int>& off = frame.report.switched_off;
    off.resize(r.obstacles.size());
    r.file.read_rows(r.switched_off.id(), H5T_NATIVE_INT32, {off.size()}, static_cast<hsize_t>(index), 1, off.data());
    if (std::ranges::all_of(off, [](int count) { return count == 0; })) off.clear();
  }
  if (r.info.contact_forces)
    frame.report.contact_forces = std::make_shared<const ContactForces>(r.read_contact_forces(index));
  if (row.bad_count() < 0 || row.bad_count() > r.info.triangles.rows() || row.bad_begin() < 0)
    throw_damaged(r.file, "frame " + std::to_string(index) + " marks more triangles than there are");
  frame.bad_triangles.resize(static_cast<std::size_t>(row.bad_count()));
  r.file.read_rows(r.bad.id(), H5T_NATIVE_INT32, {}, static_cast<hsize_t>(row.bad_begin()),
                   static_cast<hsize_t>(row.bad_count()), frame.bad_triangles.data());
  for (const int t : frame.bad_triangles)
    if (t < 0 || t >= r.info.triangles.rows())
      throw_damaged(r.file, "frame " + std::to_string(index) + " marks a triangle that is not there");
  return frame;
}

}  // namespace selvedge
