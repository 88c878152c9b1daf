#include <fmt/format.h>

#include <cmath>
#include <set>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body.hpp"

namespace selvedge {
namespace {

struct Checker {
  std::string file;

  [[noreturn]] void fail(const std::string& field, const std::string& what, const std::string& cure) const {
    throw Error(what, file + ": " + field, cure);
  }

  template <class Matrix>
  void size(const std::string& field, const Matrix& matrix, Eigen::Index rows, Eigen::Index cols) const {
    if (matrix.rows() != rows || matrix.cols() != cols)
      fail(field, fmt::format("is {} x {}, not {} x {}", matrix.rows(), matrix.cols(), rows, cols),
           "are all fields of one and the same file?");
  }

  void finite(const std::string& field, const Eigen::Ref<const Eigen::MatrixXd>& matrix, int first_by) const {
    if (matrix.allFinite()) return;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      if (!matrix.row(i).allFinite())
        fail(field, fmt::format("is not finite at vertex {}", i / first_by), "repair the file where it was made");
  }

  void finite(const std::string& field, const SkinWeights& matrix) const {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      for (SkinWeights::InnerIterator entry(matrix, i); entry; ++entry)
        if (!std::isfinite(entry.value()))
          fail(field, fmt::format("is not finite in row {}", i), "repair the file where it was made");
  }
};

void check_triangles(const Checker& check, const BodyFields& names, const SkinnedSurface& skin) {
  if (skin.triangles.rows() == 0) check.fail(names.triangles, "is empty", "give the triangles");
  for (Eigen::Index t = 0; t < skin.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      if (skin.triangles(t, k) == skin.triangles(t, (k + 1) % 3))
        check.fail(names.triangles, fmt::format("has vertex {} twice in triangle {}", skin.triangles(t, k), t),
                   "leave degenerate triangles out");
      if (skin.triangles(t, k) < 0 || skin.triangles(t, k) >= skin.rest.rows())
        check.fail(
            names.triangles,
            fmt::format("names vertex {} in triangle {}, there are {}", skin.triangles(t, k), t, skin.rest.rows()),
            "vertices count from 0");
    }
}

double row_sum(const SkinWeights& matrix, Eigen::Index row) {
  double sum = 0;
  for (SkinWeights::InnerIterator entry(matrix, row); entry; ++entry) sum += entry.value();
  return sum;
}

void check_weights(const Checker& check, const BodyFields& names, const SkinWeights& weights) {
  check.finite(names.weights, weights);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    const double sum = row_sum(weights, v);
    if (std::abs(sum - 1) > 1e-3)
      check.fail(names.weights, fmt::format("sums to {} at vertex {}", sum, v), "each vertex's weights must sum to 1");
  }
}

// A joint is a weighted mean of vertices. If the weights do not sum to 1, it does not follow a body that is moved.
void check_regressor(const Checker& check, const BodyFields& names, const SkinWeights& regressor) {
  for (Eigen::Index j = 0; j < regressor.rows(); ++j) {
    if (!SkinWeights::InnerIterator(regressor, j))
      check.fail(names.regressor, fmt::format("has no entry for joint {}", j), "each joint must depend on some vertex");
    if (const double sum = row_sum(regressor, j); std::abs(sum - 1) > 1e-2)
      check.fail(names.regressor, fmt::format("sums to {:.4g} for joint {}", sum, j),
                 "a joint is a mean of vertices, whose weights must sum to 1");
  }
}

void check_joints(const Checker& check, const BodyFields& names, const BodyModel& body) {
  if (body.joints.size() != body.parents.size())
    check.fail(names.joints, fmt::format("has {} names for {} joints", body.joints.size(), body.parents.size()),
               "give each joint a name");
  std::set<std::string> seen;
  for (const std::string& joint : body.joints)
    if (joint.empty() || !seen.insert(joint).second)
      check.fail(names.joints, fmt::format("has the name `{}` twice or an empty one", joint),
                 "motions need their names");
  for (std::size_t j = 0; j < body.parents.size(); ++j)
    if (j == 0 ? body.parents[j] != -1 : body.parents[j] < 0 || body.parents[j] >= static_cast<int>(j))
      check.fail(names.parents, fmt::format("has the parent {} for joint {}", body.parents[j], j),
                 "the root comes first, with parent -1; every other joint's parent comes before it");
}

}  // namespace

void check_skin(const SkinnedSurface& skin, Eigen::Index joints, const std::string& file, const BodyFields& names) {
  const Checker check{file};
  const Eigen::Index vertices = skin.rest.rows();
  if (vertices == 0) check.fail(names.rest, "is empty", "give the vertices");
  check.size(names.weights, skin.weights, vertices, joints);
  check.size(names.shape_directions, skin.shape_directions, 3 * vertices, skin.shape_directions.cols());
  if (skin.pose_directions.cols() > 0)
    check.size(names.pose_directions, skin.pose_directions, 3 * vertices, 9 * (joints - 1));
  check.finite(names.rest, skin.rest, 1);
  check.finite(names.shape_directions, skin.shape_directions, 3);
  check.finite(names.pose_directions, skin.pose_directions, 3);
  check_triangles(check, names, skin);
  check_weights(check, names, skin.weights);
}

void check_body(const BodyModel& body, const std::string& file, const BodyFields& names) {
  const Checker check{file};
  const Eigen::Index joints = static_cast<Eigen::Index>(body.parents.size());
  if (joints == 0) check.fail(names.parents, "is empty", "give the body's joints, at least a root");
  check_skin(body.skin, joints, file, names);
  check.size(names.regressor, body.regressor, joints, body.skin.rest.rows());
  check_joints(check, names, body);
  check.finite(names.regressor, body.regressor);
  check_regressor(check, names, body.regressor);
}

}  // namespace selvedge
