#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Names of the joints of SMPL (24), SMPL-H (52) and SMPL-X (55), in the order of their files; empty for another count.
std::vector<std::string> smpl_joint_names(int joints);

// A body model file of the SMPL family in .npz form: SMPL (Loper et al. 2015), SMPL-H (Romero et al. 2017), SMPL-X
// (Pavlakos et al. 2019), told apart by the number of joints. Reads v_template, f, shapedirs (the first `shapes`
// columns; SMPL-X's expression columns never), posedirs, J_regressor (dense, or as the parts _data, _indices, _indptr
// of a sparse matrix of scipy), weights and kintree_table; nothing else in the file is touched. Metres, Y is up.
// Weights are scaled to sums of exactly 1. Throws Error with file, field and cure for arrays that are missing, of a
// wrong shape or type, pickled, out of range or not finite.
BodyModel read_smpl(const std::filesystem::path&, int shapes = 10);

}  // namespace selvedge
