#include "collision/geometry/error.hpp"
#include "pipeline/formats/trajectory_hdf5.hpp"
#include "pipeline/formats/trajectory_row.hpp"

namespace selvedge {
namespace {

[[noreturn]] void throw_damaged(const h5::File& file, const std::string& what) {
  throw Error(what, file.path().string(), "the file is damaged or not a trajectory of this program; write it again");
}

// Shape of a dataset whose dimensions after the first must be `row_shape`.
hsize_t rows_of(const h5::File& file, const std::string& name, const std::vector<hsize_t>& row_shape) {
  std::vector<hsize_t> shape = file.shape(file.open_dataset(name).id());
  const hsize_t rows = shape.empty() ? 0 : shape.front();
  if (!shape.empty()) shape.erase(shape.begin());
  if (shape != row_shape) throw_damaged(file, name + " has an unexpected shape");
  return rows;
}

Triangles read_triangles(const h5::File& file, const std::string& name, int vertex_count) {
  Triangles triangles(static_cast<Eigen::Index>(rows_of(file, name, {3})), 3);
  if (triangles.size() > 0) file.read_all(name, H5T_NATIVE_INT32, triangles.data());
  if (triangles.size() > 0 && (triangles.minCoeff() < 0 || triangles.maxCoeff() >= vertex_count))
    throw_damaged(file, name + " names a vertex that is not there");
  return triangles;
}

std::vector<int> read_ints(const h5::File& file, const std::string& name) {
  std::vector<int> values(rows_of(file, name, {}));
  if (!values.empty()) file.read_all(name, H5T_NATIVE_INT32, values.data());
  return values;
}

std::int64_t read_number(const h5::File& file, const std::string& name) {
  std::int64_t number = 0;
  if (rows_of(file, name, {}) != 1) throw_damaged(file, name + " is not one number");
  file.read_all(name, H5T_NATIVE_INT64, &number);
  return number;
}

void read_cloth(const h5::File& file, TrajectoryInfo& info) {
  info.cloth_names = file.read_texts("cloth/names");
  info.cloth_first_vertex = read_ints(file, "cloth/first_vertex");
  info.cloth_first_triangle = read_ints(file, "cloth/first_triangle");
  info.rest.resize(static_cast<Eigen::Index>(rows_of(file, "cloth/rest", {3})), 3);
  file.read_all("cloth/rest", H5T_NATIVE_DOUBLE, info.rest.data());
  info.triangles = read_triangles(file, "cloth/triangles", static_cast<int>(info.rest.rows()));
  info.rest_triangle.resize(rows_of(file, "cloth/rest_triangles", {3, 2}));
  if (info.rest_triangle.size() != static_cast<std::size_t>(info.triangles.rows()))
    throw_damaged(file, "cloth/rest_triangles has an unexpected shape");
  if (!info.rest_triangle.empty()) file.read_all("cloth/rest_triangles", H5T_NATIVE_DOUBLE, info.rest_triangle.data());
  info.pins = read_ints(file, "cloth/pins");
}

TrajectoryInfo read_info(const h5::File& file) {
  if (!file.has("format") || file.read_text("format") != "selvedge trajectory 1")
    throw_damaged(file, "this HDF5 file is not a trajectory of this program");
  TrajectoryInfo info;
  info.program_version = file.read_text("program_version");
  info.config = file.read_text("config");
  info.stepper = file.read_text("stepper");
  file.read_all("fps", H5T_NATIVE_DOUBLE, &info.fps);
  info.self_audited = file.read_text("self") == "audited";
  read_cloth(file, info);
  for (int k = 0; file.has("obstacles/" + std::to_string(k)); ++k) {
    const std::string name = "obstacles/" + std::to_string(k);
    TrajectoryInfo::Body body;
    body.name = file.read_text(name + "/name");
    body.moving = file.read_text(name + "/motion") == "moving";
    const std::vector<hsize_t> shape = file.shape(file.open_dataset(name + "/x").id());
    if (shape.size() != 3 || shape[2] != 3) throw_damaged(file, name + "/x has an unexpected shape");
    body.vertex_count = static_cast<int>(shape[1]);
    body.triangles = read_triangles(file, name + "/triangles", body.vertex_count);
    info.obstacles.push_back(std::move(body));
  }
  return info;
}

}  // namespace

struct TrajectoryReader::Impl {
  h5::File file;
  TrajectoryInfo info;
  h5::Handle row_type = row_memory_type(), report, x, bad;
  std::vector<h5::Handle> obstacles;
  std::vector<std::string> by_names;
  int frames = 0;
  bool closed = false;

  explicit Impl(const std::filesystem::path& path) : file(h5::File::open(path)) {}
  PointsF read_points(const h5::Handle& dataset, int row, Eigen::Index count) const {
    PointsF points(count, 3);
    file.read_rows(dataset.id(), H5T_NATIVE_FLOAT, row, 1, points.data());
    return points;
  }
};

TrajectoryReader::TrajectoryReader(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw Error("there is no such file", path.string(), "check the path");
  impl_ = std::make_unique<Impl>(path);
  Impl& r = *impl_;
  // The count comes first: a file that is being written may grow while the rest is read.
  if (!r.file.has("frames_complete")) throw_damaged(r.file, "this HDF5 file is not a trajectory of this program");
  r.frames = static_cast<int>(read_number(r.file, "frames_complete"));
  r.closed = read_number(r.file, "closed") != 0;
  r.info = read_info(r.file);
  r.by_names = r.file.read_texts("codes/by");
  rows_of(r.file, "frames/x", {static_cast<hsize_t>(r.info.rest.rows()), 3});
  r.report = r.file.open_dataset("frames/report");
  r.x = r.file.open_dataset("frames/x");
  r.bad = r.file.open_dataset("frames/bad_triangles");
  for (std::size_t k = 0; k < r.info.obstacles.size(); ++k)
    r.obstacles.push_back(r.file.open_dataset("obstacles/" + std::to_string(k) + "/x"));
}

TrajectoryReader::~TrajectoryReader() = default;

const TrajectoryInfo& TrajectoryReader::info() const { return impl_->info; }
int TrajectoryReader::frame_count() const { return impl_->frames; }
bool TrajectoryReader::closed() const { return impl_->closed; }

Frame TrajectoryReader::frame(int index) const {
  const Impl& r = *impl_;
  if (index < 0 || index >= r.frames)
    throw Error("there is no frame " + std::to_string(index), r.file.path().string(),
                "it has " + std::to_string(r.frames) + " frames, counted from 0");
  Frame frame;
  TrajectoryRow row{};
  r.file.read_rows(r.report.id(), r.row_type.id(), index, 1, &row);
  fill_from_row(row, r.by_names, frame);
  frame.x = r.read_points(r.x, index, r.info.rest.rows());
  for (std::size_t k = 0; k < r.obstacles.size(); ++k)
    frame.obstacles.push_back(
        r.read_points(r.obstacles[k], r.info.obstacles[k].moving ? index : 0, r.info.obstacles[k].vertex_count));
  if (row.bad_count < 0 || row.bad_count > r.info.triangles.rows())
    throw_damaged(r.file, "frame " + std::to_string(index) + " marks more triangles than there are");
  frame.bad_triangles.resize(row.bad_count);
  r.file.read_rows(r.bad.id(), H5T_NATIVE_INT32, row.bad_begin, row.bad_count, frame.bad_triangles.data());
  return frame;
}

}  // namespace selvedge
