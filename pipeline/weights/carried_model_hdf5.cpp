#include "pipeline/weights/carried_model_hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/kept_rows.hpp"

namespace selvedge {
namespace {

const h5::FileForm carried_form{"selvedge carried 1", "coefficients of the carried guess", "docs/comparison.md"};
constexpr double largest_coefficient = 1e6;

std::vector<std::string> term_names() { return {carried_term_names().begin(), carried_term_names().end()}; }

void check_coefficients(const h5::Fields& fields, const std::string& name, const std::vector<double>& values) {
  if (!std::ranges::all_of(values, [](double value) { return std::abs(value) <= largest_coefficient; }))
    fields.fail(name, "has a value that no fit gives");
}

}  // namespace

std::uint64_t mesh_hash(const Surface& surface) {
  return hash_of(bytes_of(surface.triangles), hash_of(std::to_string(surface.vertex_count)));
}

void write_taught_carried(const std::filesystem::path& path, const TaughtCarried& taught) {
  const CarriedModel& model = taught.model;
  h5::write_form(path, carried_form, [&](const h5::File& file) {
    file.write_texts("terms", term_names());
    file.write_texts("clips", taught.clips);
    file.write_text("mesh", fmt::format("{:016x}", taught.mesh));
    h5::write_integers(file, "vertices", {taught.vertices});
    h5::write_numbers(file, "scene", {model.scene.begin(), model.scene.end()});
    if (model.own.rows() == 0) return;
    const Eigen::Matrix<float, Eigen::Dynamic, carried_term_count, Eigen::RowMajor> own = model.own.cast<float>();
    file.write_constant("own", H5T_NATIVE_FLOAT, {static_cast<hsize_t>(own.size())}, own.data());
  });
}

TaughtCarried read_taught_carried(const std::filesystem::path& path) {
  const h5::Fields fields(path, carried_form);
  if (fields.texts("terms") != term_names()) fields.fail("terms", "are not those of this program");
  const std::vector<double> scene = fields.numbers("scene");
  const std::vector<int> vertices = fields.integers("vertices");
  if (scene.size() != carried_term_count) fields.fail("scene", "has not a number for each term");
  if (vertices.size() != 1 || vertices[0] < 1) fields.fail("vertices", "is no number of vertices");
  check_coefficients(fields, "scene", scene);
  TaughtCarried taught;
  taught.clips = fields.texts("clips");
  taught.mesh = std::strtoull(fields.text("mesh").c_str(), nullptr, 16);
  taught.vertices = vertices[0];
  taught.model.scene = Eigen::Map<const CarriedSet>(scene.data());
  if (!fields.has("own")) return taught;
  const std::vector<double> own = fields.numbers("own");
  if (own.size() != static_cast<std::size_t>(taught.vertices) * carried_term_count)
    fields.fail("own", "has not a set for each vertex");
  check_coefficients(fields, "own", own);
  taught.model.own = Eigen::Map<const decltype(taught.model.own)>(own.data(), taught.vertices, carried_term_count);
  return taught;
}

void check_fits(const TaughtCarried& taught, const Surface& surface, const std::filesystem::path& file) {
  if (taught.model.own.rows() == 0 || taught.mesh == mesh_hash(surface)) return;
  const std::string theirs = taught.vertices == surface.vertex_count
                                 ? "as many vertices and other triangles"
                                 : fmt::format("{} vertices, the scene has {}", taught.vertices, surface.vertex_count);
  throw Error("the coefficients of each vertex are of another cloth: it has " + theirs, file.string(),
              "teach this scene: `selvedge teach SCENE --own`; without --own one set serves all scenes");
}

}  // namespace selvedge
