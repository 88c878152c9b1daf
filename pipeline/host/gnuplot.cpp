#include "pipeline/host/gnuplot.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

// One word of a shell, and of gnuplot where `escape` is a quote: names of folders and scenes may have quotes.
std::string quoted(const std::string& text, const std::string& escape) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? escape : std::string(1, c);
  return word + "'";
}

}  // namespace

bool gnuplot_is_there() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

bool make_plot(const std::filesystem::path& folder, const std::string& name, const std::string& body,
               const std::string& size) {
  write_file(folder / (name + ".gnuplot"),
             fmt::format("set terminal svg size {} font 'sans,11'\nset grid\nset key left top\nset output {}\n{}", size,
                         quoted(name + ".svg", "''"), body));
  std::error_code ignored;
  std::filesystem::remove(folder / (name + ".svg"), ignored);  // gnuplot would follow a link
  const std::string shell_quote = "'\\''";
  const std::string command = fmt::format("cd {} && gnuplot ./{}", quoted(folder.string(), shell_quote),
                                          quoted(name + ".gnuplot", shell_quote));
  return std::system(command.c_str()) == 0;
}

}  // namespace selvedge
