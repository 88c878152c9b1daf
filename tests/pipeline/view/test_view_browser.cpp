#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "collision/geometry/error.hpp"
#include "physics/scene/contact_forces.hpp"
#include "pipeline/view/view.hpp"
#include "tests/pipeline/draping_run.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_view_browser {

using nlohmann::json;

namespace {

std::string find_chromium() {
  std::istringstream folders(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
      if (std::filesystem::exists(std::filesystem::path(folder) / name)) return fmt::format("{}/{}", folder, name);
  return {};
}

struct Shot {
  std::string dom, log, png;
};

// Opens page#options in a fresh headless browser; what it wrote, printed and saw. window: WIDTH,HEIGHT in pixels.
Shot open(const std::string& chromium, const std::filesystem::path& page, const std::string& options,
          const std::string& window = "640,480") {
  const std::filesystem::path folder = page.parent_path();
  const auto at = [&](const char* name) { return fmt::format("'{}'", (folder / name).string()); };
  std::filesystem::remove(folder / "shot.png");
  const std::string command = fmt::format(
      "timeout 120 '{}' --headless --no-sandbox --use-angle=swiftshader-webgl --disable-background-networking "
      "--disable-component-update --disable-sync --no-first-run --hide-scrollbars --window-size={} "
      "--enable-logging=stderr --user-data-dir={} --screenshot={} --dump-dom 'file://{}#{}' > {} 2> {}",
      chromium, window, at("profile"), at("shot.png"), page.string(), options, at("dom.html"), at("log.txt"));
  REQUIRE(std::system(command.c_str()) == 0);
  return {fake::whole(folder / "dom.html"), fake::whole(folder / "log.txt"), fake::whole(folder / "shot.png")};
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t at = text.rfind(begin);
  REQUIRE(at != std::string::npos);
  return text.substr(at + begin.size(), text.find(end, at + begin.size()) - at - begin.size());
}

void check_quiet(const Shot& shot) {
  INFO(shot.log);
  CHECK(shot.dom.find("data-errors=\"[]\"") != std::string::npos);
  CHECK(shot.dom.find("data-ready=\"1\"") != std::string::npos);
  CHECK(shot.log.find("Uncaught") == std::string::npos);
  CHECK(shot.log.find("ERROR:CONSOLE") == std::string::npos);
  CHECK(shot.log.find("THREE.") == std::string::npos);
}

json probed(const Shot& shot) { return json::parse(between(shot.dom, "id=\"probe\">", "</script>")); }

// A user's hands: every button and key, each followed by the frame that is then current.
constexpr const char* hands = R"(<script>
const seen = [];
const note = () => seen.push(window.selvedge.frame);
const key = (name, shiftKey) => { document.body.dispatchEvent(
    new KeyboardEvent("keydown", {key: name, shiftKey, bubbles: true})); note(); };
const click = (id) => { document.getElementById(id).click(); note(); };
["forward", "forward", "back", "strain", "wire", "marks", "plots", "theme", "reset"].forEach(click);
key("ArrowRight"); key("ArrowRight", true); key("ArrowLeft"); key("End"); key("Home"); key(" "); key(" ");
document.querySelector(".chart button").click();
window.selvedge.setFrame(24); note();
document.documentElement.dataset.hands = seen.join(" ");
</script></body>)";

std::string with_hands(std::string page) {
  const std::string end = "</body>";
  return page.replace(page.rfind(end), end.size(), hands);
}

}  // namespace

TEST_CASE("view: the page draws in a browser, and the slider changes the drawing", "[view][browser]") {
  const std::string chromium = find_chromium();
  if (chromium.empty()) {
    WARN("skipped: no chromium on the path");
    return;
  }
  const fake::Folder folder("view_browser");
  const std::filesystem::path page = folder.path / "page.html", handled = folder.path / "handled.html";
  ViewRun marked = fake::draping_run("marked", 16, 30);
  marked.info.self_audited = false;
  marked.frame = [frame = marked.frame](int index) {
    Frame f = frame(index);
    if (index == 24) f.bad_triangles = {10, 11, 200, 201, 230, 231};
    f.obstacle_pairs = static_cast<int>(f.bad_triangles.size());
    f.report.doubts.not_converged = index == 24;
    f.report.unsolved = 0.00234;
    if (index == 25) f.x.row(7).setConstant(std::numeric_limits<float>::quiet_NaN());
    return f;
  };
  try {
    const std::string text = view_page({fake::draping_run("first", 20, 30), marked});
    std::ofstream(page) << text;
    std::ofstream(handled) << with_hands(text);
  } catch (const Error& absent) {
    WARN("skipped: " << absent.what());
    return;
  }

  const Shot early = open(chromium, page, "theme=light&marks=1&probe=0,12,23,24,25");
  check_quiet(early);
  const json drawn = probed(early);
  REQUIRE(drawn.size() == 5);
  for (const json& frame : drawn) {
    INFO(frame);
    CHECK(frame["shown"] == frame["asked"]);
    CHECK(frame["covered"] > 0.02);
    CHECK(frame["spread"] > 8.0);
  }
  for (std::size_t k = 1; k < drawn.size(); ++k) CHECK(drawn[k]["hash"] != drawn[k - 1]["hash"]);
  CHECK(drawn[2]["red"] == 0);
  CHECK(drawn[3]["red"] > 0);

  const Shot late = open(chromium, handled, "theme=light&frame=0");
  check_quiet(late);
  CHECK(late.dom.find("data-hands=\"1 2 1 1 1 1 1 1 1 2 12 11 29 0 0 0 24\"") != std::string::npos);
  CHECK(late.dom.find("data-theme=\"dark\"") != std::string::npos);
  CHECK(late.dom.find("data-frame=\"24\"") != std::string::npos);
  CHECK(late.dom.find(">self: not audited<") != std::string::npos);
  CHECK(late.dom.find("title=\"Solves ended so far at most") != std::string::npos);
  CHECK(late.dom.find(">not converged: 2.3 mm<") != std::string::npos);
  CHECK(late.dom.find(">6 intersecting pairs, 6 triangles marked<") != std::string::npos);
  // A page without a drawing is a PNG of about 20 kB.
  CHECK(early.png.size() > 40'000);
  CHECK(late.png.size() > 40'000);
  CHECK(early.png != late.png);
}

TEST_CASE("view: the page colours cloth by the pressure of each frame", "[view][browser]") {
  const std::string chromium = find_chromium();
  if (chromium.empty()) {
    WARN("skipped: no chromium on the path");
    return;
  }
  const fake::Folder folder("view_pressure");
  const std::filesystem::path page = folder.path / "page.html";
  ViewRun run = fake::draping_run("pressed", 20, 4);
  run.info.contact_forces = true;
  run.frame = [frame = run.frame](int index) {
    Frame f = frame(3);  // the same place in each frame, so that colours alone change
    f.time = frame(index).time;
    ContactForces forces = unknown_contact_forces(f.x.rows());
    if (index > 0) forces.pressure.setConstant(1000.0 * (index - 1));
    f.report.contact_forces = std::make_shared<const ContactForces>(forces);
    return f;
  };
  try {
    write_view_page({run}, page);
  } catch (const Error& absent) {
    WARN("skipped: " << absent.what());
    return;
  }
  const Shot plain = open(chromium, page, "theme=light&plots=0&probe=1,2,3"),
             coloured = open(chromium, page, "theme=light&plots=0&map=0&probe=0,1,2,3");
  check_quiet(plain);
  check_quiet(coloured);
  CHECK(coloured.dom.find("pressure [Pa]") != std::string::npos);
  const json same = probed(plain), colours = probed(coloured);
  CHECK(same[0]["hash"] == same[1]["hash"]);  // nothing moves
  for (std::size_t k = 1; k < colours.size(); ++k) CHECK(colours[k]["hash"] != colours[k - 1]["hash"]);
  CHECK(colours[1]["mean"].get<double>() < colours[3]["mean"].get<double>());  // more pressure is lighter
}

TEST_CASE("view: the figure fills a wide window and a narrow one, and stays in it", "[view][browser]") {
  const std::string chromium = find_chromium();
  if (chromium.empty()) {
    WARN("skipped: no chromium on the path");
    return;
  }
  const fake::Folder folder("view_widths");
  const std::filesystem::path page = folder.path / "page.html";
  try {
    write_view_page({fake::draping_run("sheet", 20, 30)}, page);
  } catch (const Error& absent) {
    WARN("skipped: " << absent.what());
    return;
  }
  for (const auto& [window, theme] : {std::pair("1440,900", "light"), std::pair("390,800", "dark")}) {
    const Shot shot = open(chromium, page, fmt::format("theme={}&probe=0,7,14,21,29", theme), window);
    INFO(window << " " << theme);
    check_quiet(shot);
    CHECK(shot.dom.find(fmt::format("data-theme=\"{}\"", theme)) != std::string::npos);
    double left = 1, right = 0, bottom = 1, top = 0;
    for (const json& frame : probed(shot)) {
      left = std::min(left, frame["box"]["left"].get<double>());
      right = std::max(right, frame["box"]["right"].get<double>());
      bottom = std::min(bottom, frame["box"]["bottom"].get<double>());
      top = std::max(top, frame["box"]["top"].get<double>());
    }
    INFO(left << " to " << right << " and " << bottom << " to " << top);
    CHECK(std::min(left, bottom) > 0);
    CHECK(std::max(right, top) < 1);
    CHECK(std::max(right - left, top - bottom) > 0.6);  // of the window, over these frames
  }
}

}  // namespace selvedge::test_view_browser
