#include "pipeline/formats/mesh_obj.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "pipeline/config/config_units.hpp"
#include "pipeline/formats/line_words.hpp"
#include "pipeline/formats/polygon.hpp"
#include "pipeline/host/bounds.hpp"

namespace selvedge {
namespace {

struct Corner {
  int vertex = 0, texture = -1, normal = -1;  // rows; -1: none
};

struct Face {
  std::size_t begin = 0, end = 0;  // of its corners, among all
  int line = 0;
  int part = -1, material = -1;
};

// Numbers for different values, in the order in which they are first asked for.
template <class Value>
struct Numbered {
  std::map<Value, int> numbers;

  int operator()(const Value& value) {
    return numbers.try_emplace(value, static_cast<int>(numbers.size())).first->second;
  }
  std::vector<Value> values() const {
    std::vector<Value> all(numbers.size());
    for (const auto& [value, number] : numbers) all[static_cast<std::size_t>(number)] = value;
    return all;
  }
};

struct Parser {
  std::string name;
  int line = 0;
  std::vector<double> x, uv;
  std::vector<std::array<double, 3>> normals;
  std::vector<Corner> corners;
  std::vector<Face> faces;
  std::map<std::string, int> unknown;  // unknown first words of lines, and how often
  std::vector<std::string> open_groups;
  std::vector<std::pair<std::string, std::vector<int>>> groups;
  std::map<std::string, std::size_t> group_index;
  LookPart part;
  int material = -1;
  Numbered<LookPart> parts;
  Numbered<std::string> materials;
  std::vector<std::string> material_files;

  [[noreturn]] void fail(const std::string& what, const std::string& cure) const {
    throw Error(what, fmt::format("{}:{}", name, line), cure);
  }
  int vertex_count() const { return static_cast<int>(x.size() / 3); }
  int uv_count() const { return static_cast<int>(uv.size() / 2); }
};

void read_coordinates(Parser& p, const std::vector<std::string_view>& words, std::size_t count,
                      std::vector<double>& into) {
  for (std::size_t k = 1; k <= count; ++k) {
    const std::optional<double> value = k < words.size() ? read_number(words[k]) : std::nullopt;
    if (!value && k < words.size()) p.fail(fmt::format("`{}` is not a number", words[k]), "give plain numbers");
    if (!value) p.fail(fmt::format("has {} coordinates", words.size() - 1), fmt::format("give {}", count));
    if (!std::isfinite(*value))
      p.fail(fmt::format("has a coordinate that is not finite ({})", words[k]), "repair the file where it was made");
    if (std::abs(*value) > farthest_coordinate)
      p.fail(fmt::format("has the absurd coordinate {}; {:g} is the largest", words[k], farthest_coordinate),
             "repair the file where it was made");
    into.push_back(*value);
  }
}

// The row of an index in the file, which counts from 1, or from the end if negative. Rows that are not read yet are
// checked at the end.
int read_index(const Parser& p, std::string_view word, int count) {
  int index = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), index);
  if (problem != std::errc() || end != word.data() + word.size())
    p.fail(fmt::format("`{}` is not an index", word), "faces are written `f 1 2 3`, `f 1/1 2/2 3/3` or `f 1//1 ...`");
  if (index == 0 || (index < 0 && count + index < 0))
    p.fail(fmt::format("index {} is out of range, {} so far", index, count), "indices count from 1, or from -1 back");
  return index > 0 ? index - 1 : count + index;
}

// As read_index, but -1 for what is no index: normals only shade, and files with wrong ones are read all the same.
int normal_index(const Parser& p, std::string_view word) {
  int index = 0;
  std::from_chars(word.data(), word.data() + word.size(), index);
  return index > 0 ? index - 1 : index < 0 ? std::max(static_cast<int>(p.normals.size()) + index, -1) : -1;
}

// The normal of a vn line, zeros where it is none.
std::array<double, 3> read_normal(const std::vector<std::string_view>& words) {
  std::array<double, 3> normal{};
  for (std::size_t k = 0; k < 3 && k + 1 < words.size(); ++k) normal[k] = read_number(words[k + 1]).value_or(0);
  return std::ranges::all_of(normal, [](double c) { return std::isfinite(c); }) ? normal : std::array<double, 3>{};
}

Corner read_corner(const Parser& p, std::string_view word) {
  const std::size_t slash = word.find('/');
  Corner corner{read_index(p, word.substr(0, slash), p.vertex_count())};
  if (slash == std::string_view::npos) return corner;
  const std::string_view rest = word.substr(slash + 1), texture = rest.substr(0, rest.find('/'));
  if (!texture.empty()) corner.texture = read_index(p, texture, p.uv_count());
  if (texture.size() < rest.size()) corner.normal = normal_index(p, rest.substr(texture.size() + 1));
  return corner;
}

void read_face(Parser& p, const std::vector<std::string_view>& words) {
  if (words.size() < 4) p.fail(fmt::format("a face has {} corners", words.size() - 1), "give at least 3");
  const std::size_t begin = p.corners.size();
  for (std::size_t k = 1; k < words.size(); ++k) p.corners.push_back(read_corner(p, words[k]));
  p.faces.push_back({begin, p.corners.size(), p.line, p.parts(p.part), p.material});
  for (const std::string& name : p.open_groups) {
    const auto [entry, fresh] = p.group_index.emplace(name, p.groups.size());
    if (fresh) p.groups.push_back({name, {}});
    for (std::size_t k = begin; k < p.corners.size(); ++k)
      p.groups[entry->second].second.push_back(p.corners[k].vertex);
  }
}

// Statements that are skipped: lines and points, texture maps, curves and surfaces, display.
constexpr std::array<std::string_view, 32> passed_over = {
    "vp",       "l",        "p",          "mg",        "usemap", "maplib", "cstype", "deg", "bmat", "step", "curv",
    "curv2",    "surf",     "parm",       "trim",      "hole",   "scrv",   "sp",     "end", "con",  "lod",  "bevel",
    "c_interp", "d_interp", "shadow_obj", "trace_obj", "ctech",  "stech",  "call",   "csh", "fo",   "bzp"};

// Counts an unknown first word. Throws Error if it is not plain text, as it may hide a known word.
void note_unknown(Parser& p, std::string_view word) {
  const bool printable = std::all_of(word.begin(), word.end(), [](char c) { return c > ' ' && c <= '~'; });
  if (!printable)
    p.fail("does not begin with a word of OBJ", "is it an OBJ file? Remove what stands before its first letter");
  constexpr std::size_t most_words = 100, most_length = 40;
  if (p.unknown.size() < most_words) ++p.unknown[std::string(word.substr(0, most_length))];
}

// The words of a line before its comment. Names may have a `#` in them.
std::vector<std::string_view> obj_words(std::string_view line) {
  constexpr std::array<std::string_view, 4> naming = {"o", "g", "usemtl", "mtllib"};
  std::vector<std::string_view> words = split_words(without_comment(line));
  const bool names = !words.empty() && std::ranges::find(naming, words[0]) != naming.end();
  return names ? words : split_words(line.substr(0, line.find('#')));
}

// The rest of an `o` line is one name, since there is one object at a time; each word of a `g` line is a name.
void read_part(Parser& p, const std::vector<std::string_view>& words) {
  const bool whole = words[0] == "o";
  const std::string said = joined_from(words, 1);
  (whole ? p.part.object : p.part.groups) = said;
  if (whole) p.part.groups.clear();
  std::vector<std::string>& open = p.open_groups;
  open.clear();
  if (!p.part.object.empty()) open.push_back(p.part.object);
  for (std::size_t k = 1; k < words.size() && !whole; ++k)
    if (std::find(open.begin(), open.end(), words[k]) == open.end()) open.emplace_back(words[k]);
}

void read_line(Parser& p, std::string_view text) {
  const std::vector<std::string_view> words = obj_words(text);
  if (words.empty()) return;
  if (words[0] == "v") {
    read_coordinates(p, words, 3, p.x);
  } else if (words[0] == "vt") {
    read_coordinates(p, words, 2, p.uv);
  } else if (words[0] == "vn") {
    p.normals.push_back(read_normal(words));
  } else if (words[0] == "f") {
    read_face(p, words);
  } else if (words[0] == "o" || words[0] == "g") {
    read_part(p, words);
  } else if (words[0] == "s") {
    p.part.smoothing = joined_from(words, 1);
  } else if (words[0] == "usemtl") {
    p.material = words.size() > 1 ? p.materials(joined_from(words, 1)) : -1;
  } else if (words[0] == "mtllib") {
    p.material_files.push_back(joined_from(words, 1));
  } else if (std::find(passed_over.begin(), passed_over.end(), words[0]) == passed_over.end()) {
    note_unknown(p, words[0]);
  }
}

// Reads all lines; a line that ends in a backslash continues in the next.
void read_lines(Parser& p, std::string_view text) {
  std::string continued;
  int number = 0;
  while (!text.empty()) {
    const std::string_view one = take_line(text);
    ++number;
    if (continued.empty()) p.line = number;
    if (!one.empty() && one.back() == '\\') {
      continued += std::string(one.substr(0, one.size() - 1)) + " ";
    } else if (continued.empty()) {
      read_line(p, one);
    } else {
      read_line(p, continued + std::string(one));
      continued.clear();
    }
  }
  if (!continued.empty()) read_line(p, continued);
}

void check_ranges(Parser& p) {
  for (const Face& face : p.faces) {
    p.line = face.line;
    for (std::size_t k = face.begin; k < face.end; ++k) {
      const Corner& corner = p.corners[k];
      if (corner.vertex >= p.vertex_count())
        p.fail(fmt::format("vertex {} does not exist, the file has {}", corner.vertex + 1, p.vertex_count()),
               "repair the face, or look for a missing piece of the file");
      if (corner.texture >= p.uv_count())
        p.fail(fmt::format("texture vertex {} does not exist, the file has {}", corner.texture + 1, p.uv_count()),
               "repair the face, or look for a missing piece of the file");
    }
  }
}

void cut_faces(const Parser& p, Mesh& mesh) {
  for (const Face& face : p.faces) mesh.corner_begin.push_back(static_cast<int>(face.begin));
  for (const Corner& corner : p.corners) mesh.corners.push_back(corner.vertex);
  const Triangles cut = cut_polygons(mesh.x, mesh.corners, mesh.corner_begin);
  mesh.triangles = cut.unaryExpr([&](int k) { return p.corners[k].vertex; });
  if (p.uv_count() > 0) mesh.uv_triangles = cut.unaryExpr([&](int k) { return p.corners[k].texture; });
}

std::vector<int> normals_of_corners(const Parser& p, Mesh& mesh) {
  if (p.normals.empty()) return {};
  Numbered<std::array<double, 3>> numbered;  // files may repeat a normal for every vertex
  std::vector<int> of_corner;
  int missing = 0;
  for (const Corner& corner : p.corners) {
    const bool there = corner.normal >= 0 && corner.normal < std::ssize(p.normals);
    missing += corner.normal >= std::ssize(p.normals);
    of_corner.push_back(there ? numbered(p.normals[static_cast<std::size_t>(corner.normal)]) : -1);
  }
  if (missing > 0)
    mesh.warnings.push_back(fmt::format(
        "{}: {} not there", p.name,
        counted(missing, "corner of a face names a normal that is", "corners of faces name normals that are")));
  if (numbered.numbers.empty()) of_corner.clear();
  return of_corner;
}

// Empty where triangles say all.
Look look_of(const Parser& p, Mesh& mesh) {
  const std::vector<LookPart> parts = p.parts.values();
  const bool has_parts = parts.size() > 1 || (parts.size() == 1 && parts[0] != LookPart{});
  const bool has_uv = std::ranges::any_of(p.corners, [](const Corner& corner) { return corner.texture >= 0; });
  std::vector<int> normals = normals_of_corners(p, mesh);
  const bool plain = p.corners.size() == 3 * p.faces.size() && !has_uv && normals.empty() && !has_parts;
  if (plain && p.materials.numbers.empty()) return {};
  Look look = plain_look(static_cast<std::size_t>(p.vertex_count()), mesh.corners, mesh.corner_begin);
  if (has_uv) look.uv = mesh.uv;
  for (std::size_t k = 0; has_uv && k < p.corners.size(); ++k) look.corner_uv.push_back(p.corners[k].texture);
  look.corner_normal = std::move(normals);
  for (std::string& name : p.materials.values()) look.materials.push_back({std::move(name)});
  if (has_parts) look.parts = parts;
  for (const Face& face : p.faces) {
    if (!look.materials.empty()) look.face_material.push_back(face.material);
    if (has_parts) look.face_part.push_back(face.part);
  }
  return look;
}

}  // namespace

Mesh parse_obj(std::string_view text, const std::string& name) {
  Parser p;
  p.name = name;
  read_lines(p, text);
  check_ranges(p);
  Mesh mesh;
  mesh.x = Eigen::Map<const Points>(p.x.data(), p.vertex_count(), 3);
  mesh.uv = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>(p.uv.data(), p.uv_count(), 2);
  cut_faces(p, mesh);
  mesh.look = look_of(p, mesh);
  for (std::string& file : p.material_files) mesh.material_files.emplace_back("", std::move(file));
  mesh.groups = std::move(p.groups);
  for (auto& [group, vertices] : mesh.groups) {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
  for (const auto& [word, count] : p.unknown)
    mesh.warnings.push_back(fmt::format("{}: {} with the unknown word `{}` and {} left out", name,
                                        counted(count, "line begins", "lines begin"), word,
                                        by_number(count, "is", "are")));
  return mesh;
}

std::string moved_obj_text(std::string_view text, const Points& x) {
  std::string moved;
  Eigen::Index next = 0;
  bool continues = false, in_position = false;  // the line before ended in a backslash, and was of a position
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const bool follows = continues;
    std::string_view content = line;
    while (!content.empty() && content.back() == '\r') content.remove_suffix(1);
    continues = !content.empty() && content.back() == '\\';
    const std::vector<std::string_view> words = split_words(content.substr(0, content.find('#')));
    if (!follows) in_position = !words.empty() && words[0] == "v";
    if (!in_position) {
      moved += fmt::format("{}\n", line);
    } else if (!follows) {
      moved += fmt::format("v {} {} {}", x(next, 0), x(next, 1), x(next, 2));
      for (std::size_t k = 4; k < words.size() && !continues; ++k) moved += fmt::format(" {}", words[k]);
      moved += '\n';
      ++next;
    }
  }
  return moved;
}

std::string obj_text(const Points& x, const Triangles& triangles) {
  std::string text;
  for (Eigen::Index v = 0; v < x.rows(); ++v) text += fmt::format("v {} {} {}\n", x(v, 0), x(v, 1), x(v, 2));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    text += fmt::format("f {} {} {}\n", triangles(t, 0) + 1, triangles(t, 1) + 1, triangles(t, 2) + 1);
  return text;
}

}  // namespace selvedge
