#pragma once

#include <vector>

#include "collision/untangle/separation.hpp"

namespace selvedge {

// In this file `let_through` has 1 for vertices of the cloth (sheets[0]) that contact with obstacles ignores; empty:
// none.

// Removes the contours of the cloth with obstacles that run through a triangle with such a vertex, and touching pairs
// with such triangles. Contours of the cloth with itself stay.
void drop_let_through(std::span<const SheetView> sheets, const std::vector<char>& let_through, Segments&);

// Removes demands against obstacles on such vertices.
void drop_let_through(const std::vector<char>& let_through, std::vector<Separation>&);

}  // namespace selvedge
