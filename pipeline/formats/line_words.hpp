#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace selvedge {

// The words of a line of OBJ or MTL, and their joint form with single blanks from one of them on.
std::vector<std::string_view> split_words(std::string_view line);
std::string joined_from(const std::vector<std::string_view>& words, std::size_t first);

// A line of OBJ or MTL without its comment, which begins with a `#` that begins a word. So names may have a `#`:
// `Red#2`, and `Material #25`, since what begins with a number is no comment.
std::string_view without_comment(std::string_view line);

// The first line of a text, which is taken off it, without a carriage return at its end.
std::string_view take_line(std::string_view& text);

}  // namespace selvedge
