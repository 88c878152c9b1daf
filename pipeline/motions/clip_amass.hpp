#pragma once

#include <filesystem>

#include "pipeline/motions/clip.hpp"

// Motions of the AMASS archive (Mahmood et al. 2019) and other files of the same form, .npz:
// SMPL+H: poses (frames x 156), trans, betas, mocap_framerate;
// SMPL-X: root_orient, pose_body, pose_hand, pose_jaw, pose_eye, trans, betas, mocap_frame_rate.
// poses of 72 (SMPL) and 165 (SMPL-X) columns are read too, and betas with a row per frame.
namespace selvedge {

// The first coefficients of betas, at most `most`. Of betas with a row per frame it takes the first row, and warns if
// the others differ, because a body keeps its shape.
Eigen::VectorXd read_amass_shape(const std::filesystem::path&, std::vector<std::string>& warnings, int most = 10);

// The motion at the file's frame rate, by the names of `smpl_joint_names`, with the shape as above. Files are Z up:
// (x, y, z) becomes (x, z, -y), for which the root's joint of the shaped body in the zero pose is needed (`pelvis`, the
// first row of `joint_positions`), because bodies turn about it. Warns if the file's length (mocap_time_length) is not
// that of the frames, and of rotations that only degrees could mean. Throws Error with file and field.
Clip read_amass(const std::filesystem::path&, const Vec3& pelvis, std::vector<std::string>& warnings, int shapes = 10);

}  // namespace selvedge
