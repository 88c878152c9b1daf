#pragma once

#include <string>

namespace selvedge {

// A JSON array of flat objects with the same keys as a CSV table, titles first. Texts are quoted; lists of texts are
// one text, joined by semicolons.
std::string csv_of_json(const std::string& array);

}  // namespace selvedge
