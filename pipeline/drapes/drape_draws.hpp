#pragma once

#include <array>

#include "pipeline/bodies/body.hpp"
#include "pipeline/garments/garment.hpp"
#include "pipeline/training/random_stream.hpp"

namespace selvedge {

// How a garment differs from the one by code, each from 0 (as it is) to 1: width 8 % round the trunk, length 12 % below
// the armpits, sleeve 20 % beyond the shoulders, neck 25 % of the opening's width.
using Style = std::array<double, 4>;
inline constexpr std::array style_names{"width", "length", "sleeve", "neck"};

// A pose of joints within fixed ranges, which suit what covers the trunk and the arms, times `range`. `joints` are the
// body's names; those that are not SMPL's stay unrotated.
BodyPose draw_pose(RandomStream&, const std::vector<std::string>& joints, double range);
Eigen::VectorXd draw_body_shape(RandomStream&, Eigen::Index coefficients, double spread);
Style draw_style(RandomStream&, double spread);

// A garment's rest shape on a body, worn in the zero pose, with the style. `joints` are the body's there, SMPL's 24.
Points styled(const Points& rest, const Points& joints, const Style&);

}  // namespace selvedge
