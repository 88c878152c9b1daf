#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"
#include "tests/pipeline/fake_npz.hpp"

namespace selvedge::fake {

template <class T>
std::string dense(const std::vector<std::size_t>& shape, const Eigen::MatrixXd& matrix) {
  std::vector<T> values;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(static_cast<T>(matrix(i, j)));
  return npy(shape, values);
}

// The fields of the published files in their published shapes. Additional fields of the models are there too, some of
// them pickled, as in the originals.
template <class Real, class Whole>
NpzEntries published(const BodyModel& body) {
  const auto n = static_cast<std::size_t>(body.skin.rest.rows()), joints = body.parents.size();
  constexpr std::uint32_t root = 4294967295U;  // its parent
  std::vector<Whole> f, kintree;
  for (Eigen::Index k = 0; k < body.skin.triangles.size(); ++k)
    f.push_back(static_cast<Whole>(body.skin.triangles.data()[k]));
  for (const int parent : body.parents) kintree.push_back(static_cast<Whole>(parent < 0 ? root : unsigned(parent)));
  for (std::size_t j = 0; j < joints; ++j) kintree.push_back(static_cast<Whole>(j));
  const auto columns = static_cast<std::size_t>(body.skin.shape_directions.cols());
  const std::string pickled = npy_of("'|O'", false, "()", "\x80\x03}q.");
  return {{"v_template", dense<Real>({n, 3}, body.skin.rest)},
          {"f", npy(std::vector<std::size_t>{f.size() / 3, 3}, f)},
          {"shapedirs", dense<Real>({n, 3, columns}, body.skin.shape_directions)},
          {"posedirs", dense<Real>({n, 3, 9 * (joints - 1)}, body.skin.pose_directions)},
          {"J_regressor", dense<Real>({joints, n}, body.regressor)},
          {"weights", dense<Real>({n, joints}, body.skin.weights)},
          {"kintree_table", npy(std::vector<std::size_t>{2, joints}, kintree)},
          {"J", dense<Real>({joints, 3}, body.regressor * body.skin.rest)},
          {"bs_type", npy_of("'<U7'", false, "()", std::string(28, 'a'))},
          {"bs_style", pickled},
          {"joint2num", pickled},
          {"part2num", pickled},
          {"hands_meanl", dense<Real>({45}, Eigen::MatrixXd::Zero(45, 1))}};
}

}  // namespace selvedge::fake
