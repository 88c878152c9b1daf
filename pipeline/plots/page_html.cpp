#include "pipeline/plots/page_html.hpp"

#include <fmt/format.h>

#include "pipeline/host/html_text.hpp"

namespace selvedge {

std::string page_head(const std::string& title) {
  return fmt::format(
      "<!doctype html><html lang='en'><meta charset='utf-8'><meta name='viewport' content='width=device-width'>"
      "<title>{0}</title><style>body{{font:15px/1.45 system-ui,sans-serif;margin:2em auto;max-width:1320px;"
      "padding:0 1em;color:#222}}h1{{font-size:1.5em}}h2{{font-size:1.2em}}"
      "figure{{display:inline-block;margin:0 1em 1em 0;max-width:100%}}"
      "pre{{background:#f6f6f6;padding:.6em;overflow-x:auto;font-size:12.5px}}</style><h1>{0}</h1>\n",
      html_text(title));
}

std::string page_text(const std::string& heading, const std::string& text) {
  return "<h2>" + html_text(heading) + "</h2><pre>" + html_text(text) + "</pre>\n";
}

std::string page_figure(const std::string& svg) { return svg.empty() ? svg : "<figure>" + svg + "</figure>\n"; }

}  // namespace selvedge
