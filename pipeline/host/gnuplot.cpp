#include "pipeline/host/gnuplot.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "pipeline/host/write_file.hpp"

namespace selvedge {

bool gnuplot_is_there() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

bool make_plot(const std::filesystem::path& folder, const std::string& name, const std::string& body,
               const std::string& size) {
  write_file(folder / (name + ".gnuplot"),
             fmt::format("set terminal svg size {} font 'sans,11'\nset grid\nset key left top\nset output '{}.svg'\n{}",
                         size, name, body));
  std::error_code ignored;
  std::filesystem::remove(folder / (name + ".svg"), ignored);  // gnuplot would follow a link
  const std::string command = fmt::format("cd '{}' && gnuplot {}.gnuplot", folder.string(), name);
  return std::system(command.c_str()) == 0;
}

}  // namespace selvedge
