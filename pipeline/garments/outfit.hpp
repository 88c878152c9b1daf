#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/garments/garment.hpp"

namespace selvedge {

// Garments by code that are worn over each other, the first one next to the body.
struct Outfit {
  std::string name;
  std::vector<std::string> garments;
  double edge = 0;        // of the full form [m]
  double small_edge = 0;  // of the form for quick runs [m]
  bool validation = false;
};

// Which garments and outfits are for what. What is for validation is never trained on.
struct Wardrobe {
  std::vector<std::string> training, validation;  // garments
  std::vector<Outfit> outfits;
};

// configs/outfits.yaml. Throws Error with file and line, also for names that are unknown or come twice, garments
// without a split, and outfits that have garments of the other split.
Wardrobe read_wardrobe(const std::filesystem::path&);

// The garments of an outfit at an edge length, each over those before it, kept in the folder as kept_garment does.
std::vector<Garment> kept_outfit(const std::filesystem::path& folder, const Outfit&, const BodyModel& mannequin,
                                 double edge);
// The same without the gap between them, each as if it were worn alone: they start in each other.
std::vector<Garment> kept_layers(const std::filesystem::path& folder, const Outfit&, const BodyModel& mannequin,
                                 double edge);

}  // namespace selvedge
