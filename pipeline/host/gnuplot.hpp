#pragma once

#include <filesystem>
#include <string>

namespace selvedge {

bool gnuplot_is_there();
inline const char* const no_gnuplot = "no plots: gnuplot is not there (package gnuplot-nox)";

// Writes NAME.gnuplot into the folder and makes NAME.svg from it, of `size` pixels. `body` holds axes, data in
// here-documents and the plot command, so that a plot is one file that can be made again. False where gnuplot fails.
// Throws Error where the file cannot be written.
bool make_plot(const std::filesystem::path& folder, const std::string& name, const std::string& body,
               const std::string& size = "480,320");

}  // namespace selvedge
