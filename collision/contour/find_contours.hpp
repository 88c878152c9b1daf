#pragma once

#include <span>
#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/contour/segments.hpp"

namespace selvedge {

// Lists open contours first, then closed ones, each in the order of their first segments. Each side of each contour is
// judged by itself (Grigorev et al. 2024, section 4.2): inside is the part with fewer vertices. Where both ends are
// loop vertices, the two sides form one closed curve, which is judged as one; both sides get its result.
std::vector<Contour> find_contours(std::span<const SheetView> sheets, const Segments& segments);

// The contours alone: leaves `cuts`, `inside` and `nested` of their sides unset.
std::vector<Contour> trace_contours(std::span<const SheetView> sheets, const Segments& segments);

// The paper's rule for the vertices of sheets[0]: 1 where a correspondence must not repel. That is so inside a contour
// that cuts its sheet and is not nested in another, and in the triangles of a contour that does not cut its sheet.
std::vector<char> unrepelled_vertices(std::span<const SheetView> sheets, std::span<const Contour> contours);

}  // namespace selvedge
