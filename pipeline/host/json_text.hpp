#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace selvedge {

// JSON as the program reads and writes it: members keep their order. Texts are parsed and written here alone, because
// the library's templates for that take seconds to compile in every file that uses them.
using Json = nlohmann::ordered_json;

// Throws Json::parse_error where the text is no JSON.
Json parse_json(const std::string& text);

// The same; a value for which is_discarded() holds where the text is no JSON.
Json parse_json_or_discard(const std::string& text);

// On one line. What is no UTF-8 is replaced.
std::string json_line(const Json&);

// The same as a command's output and a file have it: indented, with a line's end.
std::string json_text(const Json&);

}  // namespace selvedge
