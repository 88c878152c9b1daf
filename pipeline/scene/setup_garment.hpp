#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/formats/mesh.hpp"
#include "pipeline/garments/footing.hpp"
#include "pipeline/garments/garment.hpp"
#include "pipeline/obstacles/setup_body.hpp"

namespace selvedge {

// A garment of a scene and the body that wears it.
struct Wearing {
  Garment garment;
  std::shared_ptr<const Performance> by;
  SkinWeights skin = {};  // how each vertex follows displacements of soft tissue; empty: it does not
  Footing footing = {};   // where each vertex is squeezed to between parts of the body; empty: nowhere
};

// What a `garment` section by itself names, for a body that wears it: a garment, or those of an outfit. `folder` is the
// file's; warnings are added. Throws Error for files that are missing or do not fit the body.
std::vector<Garment> read_garments(const Config& garment, const std::filesystem::path& folder, const Performance&,
                                   std::vector<std::string>& warnings);

// The garment of a cloth's section, or those of its outfit; `folder` is the scene file's, warnings are added.
std::vector<std::shared_ptr<const Wearing>> read_wearings(const Config& cloth, const std::filesystem::path& folder,
                                                          const Performances&, std::vector<std::string>& warnings);

// The mesh as a garment of the body that the `cloth` section names. It lies where the body wears it in its zero pose.
// `pins`: vertices that stay with the body, ascending; absent: those that Dressing (garment_dressed.hpp) chooses.
// Throws Error for a mesh that is not on the body.
std::shared_ptr<const Wearing> wear_mesh(const Config& cloth, const std::string& name, const Mesh&,
                                         const std::optional<std::vector<int>>& pins, const Performances&);

// Its rest shape on the body, with its groups, before the body is placed.
Mesh rest_mesh(const Wearing&);

// The skinned positions at a time [s], as placed, and their velocities, from the next frame of the clip.
Points skinned_at(const Wearing&, double time);
Points skinned_velocity(const Wearing&, double time);

// Target positions of pins: skinned, moved with the soft tissue, and squeezed between parts of the body that have come
// near each other.
Points held_at(const Wearing&, const std::vector<int>& vertices, double time);

// The skinned targets at a time [s] (Drive::skinned_targets): as held_at, but not squeezed if this is the only
// garment on the body. Layers need their share of the gap. A single layer is untangled from the skin, and cloth that
// hangs over a raised knee would be drawn under it.
Points targets_at(const Wearing&, double time);

// Adds a warning if the garment of a file falls apart along seams that are not welded. `what`: which garment.
void warn_of_seams(const Config& garment, const std::string& what, const Points& rest, const Triangles&,
                   std::vector<std::string>& warnings);

}  // namespace selvedge
