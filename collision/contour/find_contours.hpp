#pragma once

#include <span>
#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/contour/segments.hpp"

namespace selvedge {

// Open contours first, each kind in the order of its first segment. Inside is judged one side and contour at a time
// (Grigorev et al. 2024, section 4.2): the smaller part, counted in vertices. The two traces between loop vertices at
// both ends are judged as the one closed curve that they are, and both get its result.
std::vector<Contour> find_contours(std::span<const SheetView> sheets, const Segments& segments);

// The contours alone: what they cut off and what is nested is not judged.
std::vector<Contour> trace_contours(std::span<const SheetView> sheets, const Segments& segments);

// The paper's rule for the vertices of sheets[0]: 1 where a correspondence must not repel, because the vertex is inside
// a contour that cuts its sheet and is not nested in another, or in a triangle of one that does not cut it.
std::vector<char> unrepelled_vertices(std::span<const SheetView> sheets, std::span<const Contour> contours);

}  // namespace selvedge
