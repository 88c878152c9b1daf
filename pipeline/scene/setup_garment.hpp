#pragma once

#include <filesystem>
#include <memory>

#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/garments/footing.hpp"
#include "pipeline/garments/garment.hpp"
#include "pipeline/meshes/setup_body.hpp"

namespace selvedge {

// A garment of a scene and the body that wears it.
struct Wearing {
  Garment garment;
  std::shared_ptr<const Performance> by;
  SkinWeights skin = {};  // in what shares each vertex goes along where the body gives way; none: nowhere
  Footing footing = {};   // what each vertex is squeezed towards where parts of the body close on it; none: nothing is
};

// The garment of a cloth's section, or those of its outfit; `folder` is the scene file's, warnings are added.
std::vector<std::shared_ptr<const Wearing>> read_wearings(const Config& cloth, const std::filesystem::path& folder,
                                                          const Performances&, std::vector<std::string>& warnings);

// Its rest shape on the body, with its groups, before the body is placed.
Mesh rest_mesh(const Wearing&);

// As skinned, where the scene has it at a time [s], and how fast it moves there, by the clip's next frame.
Points worn_at(const Wearing&, double time);
Points worn_velocity(const Wearing&, double time);

// Some of its vertices moved along with what of the body has given way to itself, and squeezed between parts of the
// body that have come near each other: where pins are.
Points held_at(const Wearing&, const std::vector<int>& vertices, double time);

// Where cloth is drawn to: all as pins are, but not squeezed where it is all that the body wears. Layers need their
// share of the gap; one alone is untangled from the skin, and what hangs over a raised knee would be drawn under it.
Points drawn_at(const Wearing&, double time);

}  // namespace selvedge
