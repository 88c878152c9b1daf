#include "collision/geometry/error.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/view/page_sources.hpp"
#include "pipeline/view/view.hpp"
#include "pipeline/view/view_data.hpp"

namespace selvedge {
namespace {

std::string embedded_or_in(const std::filesystem::path& folder, const char* file, std::string_view embedded) {
  std::string text = folder.empty() ? std::string(embedded) : whole_file(folder / file);
  if (text.empty())
    throw Error("three.js is absent, and the page is drawn with it",
                folder.empty() ? "this program was built without it" : (folder / file).string(),
                "install the package libjs-three (apt install libjs-three), or configure with "
                "-DSELVEDGE_THREE_DIR=FOLDER; then build anew");
  return text;
}

// Replaces {{name}} in the template by the part with that name. Inserted text is not searched again.
std::string fill(std::string_view page, const std::vector<std::pair<std::string_view, std::string_view>>& parts) {
  std::string html;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t open = page.find("{{", at);
    html += page.substr(at, open - at);
    if (open == std::string_view::npos) break;
    const std::size_t close = page.find("}}", open);
    const std::string_view name = page.substr(open + 2, close - open - 2);
    for (const auto& [key, text] : parts)
      if (key == name) html += text;
    at = close + 2;
  }
  return html;
}

}  // namespace

std::string view_page(const std::vector<ViewRun>& runs, const ViewOptions& options) {
  if (runs.empty()) throw Error("no run to show", "view", "name at least one trajectory");
  for (const ViewRun& run : runs)
    if (run.frame_count <= 0) throw Error("the run has no full frame", run.name, "wait for its first frame");
  const PageSources page = page_sources();
  const std::string three = embedded_or_in(options.three, "three.min.js", page.three);
  const std::string orbit = embedded_or_in(options.three, "examples/js/controls/OrbitControls.js", page.orbit);
  const std::string data = view_data(runs, options.limit);
  return fill(page.html,
              {{"style", page.style}, {"three", three}, {"orbit", orbit}, {"data", data}, {"script", page.script}});
}

}  // namespace selvedge
