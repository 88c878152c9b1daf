#pragma once

#include <string>

namespace selvedge {

// The head of an HTML page that needs no other file, with the title as its heading.
std::string page_head(const std::string& title);

// A section with plain text.
std::string page_text(const std::string& heading, const std::string& text);

// The plot as an element of a page; nothing for no plot.
std::string page_figure(const std::string& svg);

}  // namespace selvedge
