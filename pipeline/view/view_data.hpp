#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/view/view.hpp"

namespace selvedge {

// Inverse of each rest triangle's edge Gram matrix as (h00, h01, h11) [1/m2]: the page's principal stretches are the
// square roots of the eigenvalues of H G with G the Gram matrix of the edges in space. Zero for a degenerate triangle.
std::vector<float> inverse_rest_metric(const std::vector<RestTriangle>& rest);

std::string base64(std::string_view bytes);

// Frames whose geometry is embedded: 0, k, 2k, ... and the last.
std::vector<int> drawn_frames(int frame_count, int stride);

// The page's data as script elements: arrays in base64, each once, then all numbers as one JSON object.
std::string view_data(const std::vector<ViewRun>& runs, std::size_t limit);

}  // namespace selvedge
