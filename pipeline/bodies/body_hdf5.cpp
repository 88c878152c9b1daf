#include "pipeline/bodies/body_hdf5.hpp"

#include "pipeline/bodies/skin_hdf5.hpp"

namespace selvedge {
namespace {

const h5::FileForm form{"selvedge body 1", "body", "docs/bodies.md"};

}  // namespace

void write_body(const std::filesystem::path& path, const BodyModel& body) {
  check_body(body, path.string());
  h5::write_form(path, form, [&](const h5::File& file) {
    file.write_text("name", body.name);
    h5::write_skin(file, body.skin);
    file.write_texts("joints", body.joints);
    h5::write_integers(file, "parents", body.parents);
    h5::write_sparse(file, "regressor", body.regressor);
  });
}

BodyModel read_body(const std::filesystem::path& path) {
  const h5::Fields fields(path, form);
  BodyModel body;
  body.name = fields.has("name") ? fields.text("name") : path.stem().string();
  body.joints = fields.texts("joints");
  body.parents = fields.integers("parents");
  const auto joints = static_cast<Eigen::Index>(body.parents.size());
  body.skin = h5::read_skin(fields, joints);
  body.regressor = fields.sparse("regressor", joints, body.skin.rest.rows());
  check_body(body, path.string());
  return body;
}

}  // namespace selvedge
