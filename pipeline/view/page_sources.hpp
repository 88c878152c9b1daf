#pragma once

#include <string_view>

namespace selvedge {

// The page's own sources in pipeline/view, and those of three.js, which are empty where it was absent when the program
// was built; embed.cmake embeds them in the program.
struct PageSources {
  std::string_view html, style, script, three, orbit;
};
PageSources page_sources();

}  // namespace selvedge
