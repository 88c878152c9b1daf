#pragma once

#include <array>

#include "pipeline/bodies/body.hpp"
#include "pipeline/garments/garment.hpp"
#include "pipeline/training/random_stream.hpp"

namespace selvedge {

// Changes of a garment by code, each from 0 (unchanged) to 1: width 8 % round the trunk, length 12 % below the armpits,
// sleeve 20 % beyond the shoulders, neck 25 % of the opening's width.
using Style = std::array<double, 4>;

// Draws a pose with joints in fixed ranges times `range`, which suit garments on trunk and arms. `joints` are the
// body's names. Joints that SMPL lacks stay unrotated.
BodyPose draw_pose(RandomStream&, const std::vector<std::string>& joints, double range);
Eigen::VectorXd draw_body_shape(RandomStream&, Eigen::Index coefficients, double spread);
Style draw_style(RandomStream&, double spread);

// A garment's rest shape with the style. `rest` fits the body in the zero pose, and `joints` are its 24 SMPL joints.
Points styled(const Points& rest, const Points& joints, const Style&);

}  // namespace selvedge
