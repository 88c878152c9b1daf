#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/garments/garment_hdf5.hpp"
#include "pipeline/garments/garment_make.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {

Garment kept_garment(const std::filesystem::path& folder, const std::string& name, const BodyModel& mannequin,
                     const GarmentOptions& options, std::span<const std::string> under) {
  std::string stem =
      fmt::format("{}-{}-{}-{:.9g}-{:.9g}", name, mannequin_recipe, garment_recipe, options.edge, options.gap);
  for (const std::string& inner : under) stem += "-" + inner;
  const std::filesystem::path file = folder / "garments" / (stem + ".h5");
  if (!folder.empty() && std::filesystem::exists(file)) {
    try {
      Garment garment = read_garment(file);
      if (garment.name == name && garment.made_for == mannequin.name) return garment;
    } catch (const Error&) {  // another kind of file, or a damaged one: made anew below
    }
  }
  Garment garment = make_garment(name, mannequin, options, under);
  if (!folder.empty()) write_cached(file, [&] { write_garment(file, garment); });
  return garment;
}

}  // namespace selvedge
