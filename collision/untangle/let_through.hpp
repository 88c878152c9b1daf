#pragma once

#include <vector>

#include "collision/untangle/separation.hpp"

namespace selvedge {

// `let_through`, here and below: 1 for vertices of the cloth (sheets[0]) that obstacles neither meet nor hold; empty:
// none.

// Drops every contour of the cloth with an obstacle that runs through a triangle at such a vertex, and pairs there that
// touch. Contours of the cloth with itself stay.
void drop_let_through(std::span<const SheetView> sheets, const std::vector<char>& let_through, Segments&);

// Drops what is asked of such a vertex against an obstacle.
void drop_let_through(const std::vector<char>& let_through, std::vector<Separation>&);

}  // namespace selvedge
