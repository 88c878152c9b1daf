#pragma once

#include <string_view>

namespace selvedge {

// The page's own sources in pipeline/view, made part of the program by embed.cmake.
struct PageSources {
  std::string_view html, style, script;
};
PageSources page_sources();

}  // namespace selvedge
