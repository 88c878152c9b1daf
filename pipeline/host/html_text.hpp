#pragma once

#include <string>

namespace selvedge {

// Any text as HTML, SVG or XML has it, in an element as well as in the quotes of an attribute.
std::string html_text(const std::string&);

// Any text as one part of a relative URL, for `href`. It needs no html_text.
std::string url_text(const std::string&);

}  // namespace selvedge
