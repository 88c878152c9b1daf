#pragma once

#include "pipeline/config/config.hpp"

namespace selvedge {

// The table of a scene file.
const Section& scene_section();
// The table of a material file: what a scene may say of a material by value.
const Section& material_file_section();
// Every section of a scene file in the order of docs/scene.md, the scene itself first.
std::vector<const Section*> scene_sections();
// All of them as Markdown: the second half of docs/scene.md.
std::string scene_reference();

}  // namespace selvedge
