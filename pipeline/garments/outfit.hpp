#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/garments/garment.hpp"

namespace selvedge {

// Garments made by code that are worn over each other, from the body outward.
struct Outfit {
  std::string name;
  std::vector<std::string> garments;
  double edge = 0;        // of the full form [m]
  double small_edge = 0;  // of the form for quick runs [m]
  bool validation = false;
};

// The use of garments and outfits. Those for validation are never trained on.
struct Wardrobe {
  std::vector<std::string> training, validation;  // garments
  std::vector<Outfit> outfits;
};

// configs/outfits.yaml. Throws Error with file and line, also for unknown and repeated names, garments without a split,
// and outfits with garments of the other split.
Wardrobe read_wardrobe(const std::filesystem::path&);

// The garments of an outfit at an edge length, each over those before it, cached in the folder as by kept_garment.
std::vector<Garment> kept_outfit(const std::filesystem::path& folder, const Outfit&, const BodyModel& mannequin,
                                 double edge);
// The same without gaps, each as if it were worn alone, so that they intersect at the start.
std::vector<Garment> kept_layers(const std::filesystem::path& folder, const Outfit&, const BodyModel& mannequin,
                                 double edge);

}  // namespace selvedge
