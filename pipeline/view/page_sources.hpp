#pragma once

#include <string_view>

namespace selvedge {

// The page's own sources in pipeline/view; embed.cmake embeds them in the program.
struct PageSources {
  std::string_view html, style, script;
};
PageSources page_sources();

}  // namespace selvedge
