#include <fmt/format.h>

#include <cmath>

#include "collision/geometry/error.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/json_file.hpp"
#include "pipeline/host/read_file.hpp"
#include "pipeline/patterns/pattern.hpp"
#include "pipeline/patterns/pattern_check.hpp"

namespace selvedge {
namespace {

const std::string form_cure = "docs/patterns.md says what a pattern file holds";

// Replaces NaN and Infinity, which Python writes but JSON lacks, by null, so that an error can say where they are.
std::string without_nan(const std::string& text) {
  std::string result;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"' && (i == 0 || text[i - 1] != '\\')) quoted = !quoted;
    bool replaced = false;
    for (const char* word : {"-Infinity", "Infinity", "NaN"})
      if (const std::string_view w = word; !quoted && !replaced && text.compare(i, w.size(), w) == 0) {
        result += "null";
        i += w.size() - 1;
        replaced = true;
      }
    if (!replaced) result += text[i];
  }
  return result;
}

struct PatternReader {
  const std::string& file;
  double unit = std::numeric_limits<double>::quiet_NaN();  // metres
  bool relative_curves = true;

  [[noreturn]] void fail(const std::string& where, const std::string& what, const std::string& cure = form_cure) const {
    throw Error(what, file + ": " + where, cure);
  }

  const Json& member(const Json& object, const std::string& key, const std::string& where) const {
    if (!object.is_object()) fail(where, "is not an object");
    const auto found = object.find(key);
    if (found == object.end()) fail(where, "has no `" + key + "`");
    return *found;
  }

  double number(const Json& value, const std::string& where, const std::string& what) const {
    if (value.is_null()) fail(where, what + " is not finite", "export the pattern again");
    if (!value.is_number()) fail(where, what + " is not a number");
    const double x = value.get<double>();
    if (!std::isfinite(x)) fail(where, what + " is not finite", "export the pattern again");
    return x;
  }

  std::vector<double> numbers(const Json& list, std::size_t count, const std::string& where,
                              const std::string& what) const {
    if (!list.is_array() || list.size() != count) fail(where, fmt::format("{} is not a list of {}", what, count));
    std::vector<double> values;
    for (const Json& value : list) values.push_back(number(value, where, what));
    return values;
  }

  Vec2 place(const Json& list, const std::string& where, const std::string& what) const {
    const std::vector<double> xy = numbers(list, 2, where, what);
    return {xy[0], xy[1]};
  }

  std::string text(const Json& object, const char* key, const std::string& where) const {
    const auto found = object.find(key);
    if (found == object.end() || found->is_null()) return {};
    if (!found->is_string()) fail(where, "`" + std::string(key) + "` is not a text");
    return found->get<std::string>();
  }

  int index(const Json& value, std::size_t count, const std::string& where, const std::string& what) const {
    if (!value.is_number_integer() || value.get<double>() < 0 || value.get<double>() >= static_cast<double>(count))
      fail(where, fmt::format("{} {} does not exist", what, json_line(value)),
           fmt::format("there are {}, counted from 0", count));
    return value.get<int>();
  }

  Vec2 control(const Json& list, const Vec2& from, const Vec2& to, const std::string& where) const {
    const Vec2 at = place(list, where, "a curvature point"), along = to - from;
    return relative_curves ? Vec2(from + at.x() * along + at.y() * Vec2(-along.y(), along.x())) : Vec2(unit * at);
  }

  // A list of two numbers is the control point of a quadratic curve: the form of older files.
  void read_curvature(const Json& curvature, const Panel& panel, PanelEdge& edge, const std::string& where) const {
    const Vec2 from = panel.corners[edge.ends[0]], to = panel.corners[edge.ends[1]];
    if (curvature.is_array()) {
      edge.form = EdgeForm::quadratic;
      edge.controls = {control(curvature, from, to, where)};
      return;
    }
    const std::string form = text(curvature, "type", where);
    const Json& params = member(curvature, "params", where);
    if (form == "quadratic" || form == "cubic") {
      edge.form = form == "cubic" ? EdgeForm::cubic : EdgeForm::quadratic;
      const std::size_t count = form == "cubic" ? 2 : 1;
      if (!params.is_array() || params.size() != count)
        fail(where, fmt::format("a {} curve has {} points, not {}", form, count, params.size()));
      for (const Json& point : params) edge.controls.push_back(control(point, from, to, where));
    } else if (form == "circle") {
      const std::vector<double> values = numbers(params, 3, where, "radius, large arc and side");
      edge.form = EdgeForm::circle;
      edge.radius = unit * values[0];
      edge.large_arc = values[1] != 0;
      edge.counterclockwise = values[2] != 0;
    } else {
      fail(where, "has the unknown curvature `" + form + "`",
           "known: quadratic, cubic, circle" + suggestion(form, {"quadratic", "cubic", "circle"}));
    }
  }

  // R = Rz Ry Rx with angles in degrees, as in Maya.
  Mat3 rotation(const std::vector<double>& degrees) const {
    constexpr double rad = 3.14159265358979323846 / 180;
    return (Eigen::AngleAxisd(degrees[2] * rad, Vec3::UnitZ()) * Eigen::AngleAxisd(degrees[1] * rad, Vec3::UnitY()) *
            Eigen::AngleAxisd(degrees[0] * rad, Vec3::UnitX()))
        .toRotationMatrix();
  }

  void read_edges(const Json& corners, const Json& edges, Panel& panel) const {
    const std::string where = "panel `" + panel.name + "`";
    if (!corners.is_array() || !edges.is_array()) fail(where, "has no list of vertices or of edges");
    if (edges.size() < 2) fail(where, "has fewer than two edges");
    std::vector<std::array<int, 2>> ends;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const std::string edge = fmt::format("{}, edge {}", where, e);
      const Json& list = member(edges[e], "endpoints", edge);
      if (!list.is_array() || list.size() != 2) fail(edge, "`endpoints` is not a list of 2");
      ends.push_back({index(list[0], corners.size(), edge, "vertex"), index(list[1], corners.size(), edge, "vertex")});
    }
    panel.corners.assign(corners.size(), Vec2::Zero());
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (const int v : ends[e])
        panel.corners[v] = unit * place(corners[v], fmt::format("{}, edge {}", where, e), fmt::format("vertex {}", v));
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const std::string at = fmt::format("{}, edge {}", where, e);
      PanelEdge edge;
      edge.ends = ends[e];
      edge.label = text(edges[e], "label", at);
      const auto curvature = edges[e].find("curvature");
      if (curvature != edges[e].end() && !curvature->is_null()) read_curvature(*curvature, panel, edge, at);
      panel.edges.push_back(edge);
    }
  }

  Panel read_panel(const std::string& name, const Json& json) const {
    const std::string where = "panel `" + name + "`";
    Panel panel;
    panel.name = name;
    panel.label = text(json, "label", where);
    const std::vector<double> shift = numbers(member(json, "translation", where), 3, where, "`translation`");
    panel.translation = unit * Vec3(shift[0], shift[1], shift[2]);
    panel.rotation = rotation(numbers(member(json, "rotation", where), 3, where, "`rotation`"));
    read_edges(member(json, "vertices", where), member(json, "edges", where), panel);
    return panel;
  }

  PanelSide read_side(const Json& json, const Pattern& pattern, const std::string& where) const {
    const std::string name = text(json, "panel", where);
    std::vector<std::string> known;
    for (const Panel& panel : pattern.panels) known.push_back(panel.name);
    const auto found = std::ranges::find(known, name);
    const Json& edge = member(json, "edge", where);
    if (found == known.end())
      fail(where, fmt::format("joins edge {} of the missing panel `{}`", json_line(edge), name),
           "panels: " + joined(known) + suggestion(name, known));
    const auto panel = static_cast<std::size_t>(found - known.begin());
    return {static_cast<int>(panel),
            index(edge, pattern.panels[panel].edges.size(), where, "panel `" + name + "`, edge")};
  }

  void read_seams(const Json& stitches, Pattern& pattern) const {
    if (!stitches.is_array()) fail("stitches", "is not a list");
    for (std::size_t s = 0; s < stitches.size(); ++s) {
      const std::string where = fmt::format("stitch {}", s);
      const Json& stitch = stitches[s];
      if (!stitch.is_array() || stitch.size() < 2 || stitch.size() > 3) fail(where, "does not join two edges");
      PatternSeam seam;
      for (std::size_t k = 0; k < 2; ++k) seam.sides[k] = read_side(stitch[k], pattern, where);
      seam.right_to_wrong =
          stitch.size() == 3 && stitch[2].is_string() && stitch[2].get<std::string>() == "right_wrong";
      pattern.seams.push_back(seam);
    }
  }

  Pattern read(const Json& json) {
    const Json& body = member(json, "pattern", "the file");
    if (const auto properties = json.find("properties"); properties != json.end() && properties->is_object()) {
      if (const auto units = properties->find("units_in_meter"); units != properties->end() && !units->is_null())
        unit = 1 / number(*units, "properties", "`units_in_meter`");
      relative_curves = text(*properties, "curvature_coords", "properties") != "absolute";
    }
    if (std::isnan(unit))
      fail("properties", "has no `units_in_meter`, so that the unit of its lengths is not known",
           "give it: 100 where they are in centimetres, 1 where they are in metres");
    if (!(unit > 0 && std::isfinite(unit))) fail("properties", "`units_in_meter` is not positive");
    Pattern pattern;
    const Json& panels = member(body, "panels", "pattern");
    if (!panels.is_object() || panels.empty()) fail("pattern", "has no panels");
    for (const auto& [name, panel] : panels.items()) pattern.panels.push_back(read_panel(name, panel));
    if (const auto stitches = body.find("stitches"); stitches != body.end()) read_seams(*stitches, pattern);
    check_pattern(pattern, file);
    return pattern;
  }
};

}  // namespace

Pattern pattern_of(const std::string& json, const std::string& file) {
  return PatternReader{file}.read(json_of_file(without_nan(json), file));
}

Pattern read_pattern(const std::filesystem::path& path) {
  Pattern pattern = pattern_of(read_text_file(path, "pattern"), path.string());
  pattern.name = path.stem().string();
  if (const auto end = pattern.name.rfind("_specification"); end != std::string::npos) pattern.name.resize(end);
  return pattern;
}

}  // namespace selvedge
