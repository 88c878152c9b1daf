#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/view/view.hpp"

namespace selvedge {

// Positions on the 65,535 levels of their own bounding box: x = origin + step * level. Level 65535 means not finite.
struct QuantisedPoints {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), step = Eigen::Vector3d::Zero();
  std::vector<std::uint16_t> levels;  // 3 per vertex
};
QuantisedPoints quantise(const PointsF& x);

// Inverse of each rest triangle's edge Gram matrix as (h00, h01, h11) [1/m2]: the page's principal stretches are the
// square roots of the eigenvalues of H G with G the Gram matrix of the edges in space. Zero for a degenerate triangle.
std::vector<float> inverse_rest_metric(const std::vector<RestTriangle>& rest);

std::string base64(std::string_view bytes);

// Frames whose geometry is embedded: 0, k, 2k, ... and the last, with the smallest k for which the text fits the limit.
std::vector<int> drawn_frames(int frame_count, std::size_t bytes_a_frame, std::size_t limit);

// The page's data as script elements: for each run its arrays in base64, then all numbers as one JSON object.
std::string view_data(const std::vector<ViewRun>& runs, std::size_t limit);

}  // namespace selvedge
