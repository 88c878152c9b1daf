#include "pipeline/bodies/body_hdf5.hpp"

#include "pipeline/bodies/skin_hdf5.hpp"

namespace selvedge {
namespace {

const h5::FileForm form{"selvedge body 1", "body", "docs/bodies.md"};

// Writes for each vertex the first mesh that has it.
void write_meshes(const h5::File& file, const BodyModel& body) {
  std::vector<std::string> names;
  std::vector<int> mesh_of(static_cast<std::size_t>(body.skin.rest.rows()), -1);
  for (std::size_t m = body.meshes.size(); m-- > 0;)
    for (const int v : body.meshes[m].second) mesh_of[v] = static_cast<int>(m);
  for (const auto& [name, vertices] : body.meshes) names.push_back(name);
  file.write_texts("meshes", names);
  h5::write_integers(file, "mesh_of", mesh_of);
}

NamedVertices read_meshes(const h5::Fields& fields, Eigen::Index vertices) {
  NamedVertices meshes;
  for (const std::string& name : fields.texts("meshes")) meshes.emplace_back(name, std::vector<int>());
  const std::vector<int> mesh_of = fields.integers("mesh_of");
  if (static_cast<Eigen::Index>(mesh_of.size()) != vertices)
    fields.fail("mesh_of", "has not one number a vertex of `rest`");
  for (std::size_t v = 0; v < mesh_of.size(); ++v) {
    if (mesh_of[v] < -1 || mesh_of[v] >= static_cast<int>(meshes.size()))
      fields.fail("mesh_of", "names a mesh that is not there");
    if (mesh_of[v] >= 0) meshes[mesh_of[v]].second.push_back(static_cast<int>(v));
  }
  return meshes;
}

}  // namespace

void write_body(const std::filesystem::path& path, const BodyModel& body) {
  check_body(body, path.string());
  h5::write_form(path, form, [&](const h5::File& file) {
    file.write_text("name", body.name);
    h5::write_skin(file, body.skin);
    file.write_texts("joints", body.joints);
    h5::write_integers(file, "parents", body.parents);
    h5::write_sparse(file, "regressor", body.regressor);
    if (!body.meshes.empty()) write_meshes(file, body);
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
  if (fields.has("meshes")) body.meshes = read_meshes(fields, body.skin.rest.rows());
  check_body(body, path.string());
  return body;
}

}  // namespace selvedge
