#pragma once

#include <memory>

#include "physics/scene/scene_numbers.hpp"
#include "pipeline/config/options.hpp"
#include "pipeline/garments/garment_make.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/scene/kinds.hpp"
#include "pipeline/scene/run_options.hpp"
#include "pipeline/shapes/generate.hpp"

namespace selvedge {

// The table of a scene file.
const Section& scene_section();
// The same with kinds of steppers that a caller has added.
struct SceneTable {
  Section run, scene;
};
std::shared_ptr<const SceneTable> scene_table(const Kinds&);
// The table of a material file: what a scene may say of a material by value.
const Section& material_file_section();

// What a number of a scene may be, as physics has it.
template <class Struct>
Range range_of(double Struct::*member) {
  for (const NumberField<Struct>& field : number_fields<Struct>())
    if (field.member == member) return {field.low, field.high, field.low_in, field.high_in};
  return {};
}

// Sections that are bound to structs, in part or whole.
const Options<RunOptions>& run_options();
const Options<RunOptions>& output_options();
const Options<ConventionalOptions>& solver_options();  // of `icm` too, but for the integrator
const Options<ContactSettings>& contact_options();
const Options<Wind>& wind_options();
const Options<Spring>& spring_options();
const Options<Draping>& start_options();
const Options<TshirtShape>& tshirt_options();
const OptionRows<SheetOptions>& sheet_options();  // of every sheet by code but the T-shirt
const OptionRows<Material>& material_options();   // what may be said of a material by value

namespace table {

const Section& cloth_section();
const Section& garment_section();  // what a body of the scene wears
const Section& material_section();
std::vector<Key> sheet_keys();       // rectangle, disc, tube, ribbon, tshirt
std::vector<Key> selection_keys();   // vertices, box, group
const Section& selection_section();  // vertices of a named cloth
const Section& outcome_section();
const Section& obstacle_section();
const Section& body_section();
const Section& seam_section();

}  // namespace table
}  // namespace selvedge
