#pragma once

#include <string>
#include <vector>

#include "pipeline/plots/plot_axis.hpp"
#include "pipeline/plots/plot_labels.hpp"

namespace selvedge {

// What plots of all kinds have: one size, one style, lines at ticks, names of axes, a legend.

inline constexpr double plot_width = 620, plot_height = 380;         // [px], without the legend
inline constexpr PlotArea plot_area{70, 30, 604, plot_height - 46};  // where values are drawn

// The colour of the k-th curve: eight that are told apart without telling red from green (Okabe and Ito 2008, without
// yellow, and with grey), then the same again.
const char* plot_colour(std::size_t k);

// Lines across the plot at ticks of x, or of y.
std::string x_lines(const std::vector<PlotTick>&);
std::string y_lines(const std::vector<PlotTick>&);

// An element's text where the pointer rests.
std::string hover_text(const std::string&);

// The whole drawing: title, names of axes, `inner`, and a legend of curves by colour in as many rows as it takes.
std::string framed_plot(const std::string& title, const std::string& x_name, const std::string& y_name,
                        const std::string& inner, const std::vector<std::string>& legend);

}  // namespace selvedge
