#include <fmt/format.h>

#include <cmath>

#include "pipeline/host/gnuplot.hpp"
#include "pipeline/validate/known_answers.hpp"
#include "pipeline/validate/validate.hpp"

namespace selvedge {
namespace {

// Lines "x measured" of a case's rows, x a parameter; with `curve` behind a blank pair of lines what is expected.
std::string points_of(const std::vector<ValidationRow>& rows, const std::string& name, const std::string& parameter) {
  std::string text;
  for (const ValidationRow& row : rows)
    if (row.name == name) text += fmt::format("{} {:.9g}\n", row.values.at(parameter), row.measured);
  return text;
}

std::string master_curve() {
  std::string text;
  for (double log = -1; log <= 2.0001; log += 0.05) {
    const double gamma = std::pow(10, log);
    const Cantilever c = elastica(gamma);
    text += fmt::format("{:.6g} {:.9g}\n", gamma, c.H / c.W);
  }
  return text;
}

std::string script(const std::string& axes, const std::string& measured, const std::string& expected) {
  std::string text = axes + "$measured << EOD\n" + measured + "EOD\n";
  if (!expected.empty()) text += "$expected << EOD\n" + expected + "EOD\n";
  text += expected.empty()
              ? "plot $measured with linespoints pt 7 title 'measured'\n"
              : "plot $expected with lines title 'expected', $measured with points pt 7 title 'measured'\n";
  return text;
}

}  // namespace

std::string plot_validation(const std::vector<ValidationRow>& rows, const std::filesystem::path& folder) {
  if (!gnuplot_is_there()) return no_gnuplot;
  std::string made;
  const auto plot = [&](const std::string& name, const std::string& parameter, const std::string& axes,
                        const std::string& expected) {
    const std::string measured = points_of(rows, name, parameter);
    if (measured.empty()) return;
    if (make_plot(folder, name, script(axes, measured, expected)))
      made += (made.empty() ? "plots: " : ", ") + (folder / (name + ".svg")).string();
  };
  plot("cantilever", "gamma", "set logscale xy\nset xlabel 'rho g L^3 / B'\nset ylabel 'H / W'\n", master_curve());
  plot("drape", "bending_length", "set xlabel 'bending length [cm]'\nset ylabel 'drape coefficient'\n", "");
  return made.empty() ? "no plots: no case that has one was run" : made;
}

}  // namespace selvedge
