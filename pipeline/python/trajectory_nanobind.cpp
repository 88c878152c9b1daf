#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "collision/geometry/error.hpp"
#include "physics/scene/contact_forces.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/python/arrays_nanobind.hpp"
#include "pipeline/python/bindings_nanobind.hpp"
#include "pipeline/python/fields_nanobind.hpp"

namespace selvedge {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

// Frames x vertices x 3, or 1 of numbers, made by Python.
using FloatFrames = nb::ndarray<float, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using FloatRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

nb::dict contents(const std::filesystem::path& file) {
  const TrajectoryReader reader(trajectory_file(file));
  const TrajectoryInfo& info = reader.info();
  nb::dict result;
  result["frame_count"] = reader.frame_count();
  result["contact_forces"] = info.contact_forces;
  result["fps"] = info.fps;
  result["triangles"] = copy_of(info.triangles);
  result["rest"] = copy_of(info.rest);
  result["pins"] = copy_of(info.pins);
  nb::list cloths, obstacles;
  for (std::size_t c = 0; c < info.cloth_names.size(); ++c)
    cloths.append(nb::make_tuple(info.cloth_names[c], info.cloth_first_vertex[c], info.cloth_first_vertex[c + 1]));
  for (const TrajectoryInfo::Body& body : info.obstacles) {
    nb::dict one;
    one["name"] = body.name;
    one["triangles"] = copy_of(body.triangles);
    one["vertex_count"] = body.vertex_count;
    one["moving"] = body.moving;
    obstacles.append(one);
  }
  result["cloths"] = cloths;
  result["obstacles"] = obstacles;
  return result;
}

// The array's k-th frame, which must have room for these rows.
void put(const FloatRows& rows, std::size_t k, const FloatFrames& frames) {
  if (k >= frames.shape(0) || static_cast<Eigen::Index>(frames.shape(1)) != rows.rows() ||
      static_cast<Eigen::Index>(frames.shape(2)) != rows.cols())
    throw Error("has no room for a frame", "trajectory_frames", "give frames x vertices x 3");
  Eigen::Map<FloatRows>(frames.data() + k * frames.shape(1) * frames.shape(2), rows.rows(), rows.cols()) = rows;
}

// Into three arrays: of normal forces, friction, pressure.
void put(const ContactForces& forces, std::size_t k, const std::vector<FloatFrames>& arrays) {
  if (arrays.size() != 3) throw Error("has no room for contact forces", "trajectory_frames", "give three arrays");
  put(forces.normal.cast<float>(), k, arrays[0]);
  put(forces.friction.cast<float>(), k, arrays[1]);
  put(forces.pressure.cast<float>(), k, arrays[2]);
}

nb::list fill_frames(const std::filesystem::path& file, const std::vector<int>& numbers, const FloatFrames& x,
                     const std::vector<FloatFrames>& obstacles, const std::vector<FloatFrames>& forces) {
  const TrajectoryReader reader(trajectory_file(file));
  nb::list reports;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    const Frame frame = reader.frame(numbers[k]);
    put(frame.x, k, x);
    for (std::size_t o = 0; o < obstacles.size() && o < frame.obstacles.size(); ++o)
      if (k < obstacles[o].shape(0)) put(frame.obstacles[o], k, obstacles[o]);  // a still one has one
    if (!forces.empty() && frame.report.contact_forces) put(*frame.report.contact_forces, k, forces);
    reports.append(dict_of(frame_fields(), frame));
  }
  return reports;
}

}  // namespace

void bind_trajectories(nb::module_& module) {
  module.def("trajectory_contents", &contents, "file"_a,
             "What selvedge.read_trajectory says of a run before its frames are read.");
  module.def(
      "trajectory_frames", &fill_frames, "file"_a, "numbers"_a, "x"_a, "obstacles"_a, "forces"_a,
      "Reads frames of a run into arrays, frames x vertices x 3 of float32: of all cloths, and of each obstacle, "
      "where one frame is enough of a still one. forces: empty, or the arrays of normal forces, of friction and, "
      "frames x vertices x 1, of pressure. Returns the frames' reports.");
}

}  // namespace selvedge
