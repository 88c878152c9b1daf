#pragma once

#include "learned/repulsion/repulsive_layer.hpp"
#include "tests/collision/solids.hpp"

namespace selvedge::fake {

// A ball-shaped garment with a lumpy body that sticks out in places, and exact distances from the body.
struct DressedBlob {
  testing::Solid body, garment;
  DistanceField field;
  Adjacency ring;  // of the garment
  AskDistance ask;

  DressedBlob(int body_rings, int garment_rings)
      : body(testing::blob(body_rings)), garment(testing::ball(garment_rings)), field(body.surface) {
    field.move_to(body.x);
    ring = adjacency_of(garment.surface.vertex_count, garment.surface.edges);
    ask = [this](const Points& at, std::vector<SignedDistance>& found) { found = field.ask(at); };
  }
  DressedBlob(const DressedBlob&) = delete;  // `ask` has its address
  DressedBlob& operator=(const DressedBlob&) = delete;
};

}  // namespace selvedge::fake
