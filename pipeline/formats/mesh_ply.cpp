#include "pipeline/formats/mesh_ply.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/config/config_units.hpp"
#include "pipeline/formats/polygon.hpp"
#include "pipeline/host/bounds.hpp"

namespace selvedge {
namespace {

enum class Encoding { ascii, little, big };

template <class T>
double as(const std::array<unsigned char, 8>& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return static_cast<double>(value);
}

struct Type {
  std::string_view name, other_name;
  std::size_t size;
  double (*value)(const std::array<unsigned char, 8>& bytes);
  bool whole = true;  // an integer
};

constexpr std::array types = {
    Type{"char", "int8", 1, as<std::int8_t>},      Type{"uchar", "uint8", 1, as<std::uint8_t>},
    Type{"short", "int16", 2, as<std::int16_t>},   Type{"ushort", "uint16", 2, as<std::uint16_t>},
    Type{"int", "int32", 4, as<std::int32_t>},     Type{"uint", "uint32", 4, as<std::uint32_t>},
    Type{"float", "float32", 4, as<float>, false}, Type{"double", "float64", 8, as<double>, false}};

struct Property {
  std::string name;
  const Type* type = nullptr;
  const Type* count = nullptr;  // of a list, else null
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
  int find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view wanted : names)
      for (std::size_t i = 0; i < properties.size(); ++i)
        if (properties[i].name == wanted) return static_cast<int>(i);
    return -1;
  }
};

// Reads the file in order; messages name the line, or in binary data the element.
struct Reader {
  std::string name;
  std::string_view text;
  std::size_t at = 0;
  int line = 0;
  char line_end = '\n';  // or a carriage return, in files of old Macs
  Encoding encoding = Encoding::ascii;
  std::string place;  // in binary data

  [[noreturn]] void fail(const std::string& what, const std::string& cure = "repair the file or write it anew") const {
    throw Error(what, place.empty() ? fmt::format("{}:{}", name, line) : name + ", " + place, cure);
  }
  std::size_t left() const { return text.size() - at; }
};

std::string_view next_line(Reader& r) {
  if (r.left() == 0) r.fail("ends too early");
  const std::size_t end = std::min(r.text.find(r.line_end, r.at), r.text.size());
  std::string_view line = r.text.substr(r.at, end - r.at);
  r.at = std::min(end + 1, r.text.size());
  ++r.line;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < line.size();) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t", i), line.size());
    i = std::min(line.find_first_of(" \t", begin), line.size());
    if (i > begin) words.emplace_back(line.substr(begin, i - begin));
  }
  return words;
}

const Type* type_of(const Reader& r, const std::string& word) {
  for (const Type& type : types)
    if (type.name == word || type.other_name == word) return &type;
  r.fail("`" + word + "` is not a PLY type", "types: char uchar short ushort int uint float double, int8 ... float64");
}

void read_format(Reader& r, const std::vector<std::string>& words) {
  if (words.size() < 2) r.fail("`format` without a name");
  if (words[1] == "ascii")
    r.encoding = Encoding::ascii;
  else if (words[1] == "binary_little_endian")
    r.encoding = Encoding::little;
  else if (words[1] == "binary_big_endian")
    r.encoding = Encoding::big;
  else
    r.fail("format `" + words[1] + "` is not known", "ascii, binary_little_endian or binary_big_endian");
}

void read_property(const Reader& r, const std::vector<std::string>& words, std::vector<Element>& elements) {
  const bool list = words.size() > 1 && words[1] == "list";
  if (words.size() != (list ? 5 : 3) || elements.empty()) r.fail("is not a property of an element");
  Property property{words.back(), type_of(r, words[words.size() - 2]), list ? type_of(r, words[2]) : nullptr};
  if (list && !property.count->whole) r.fail("a list counts in integers");
  elements.back().properties.push_back(property);
}

std::vector<Element> read_header(Reader& r) {
  std::vector<Element> elements;
  if (next_line(r) != "ply") r.fail("is not a PLY file", "its first line must be `ply`");
  for (bool format = false;;) {
    const std::vector<std::string> words = words_of(next_line(r));
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") {
      if (!format) r.fail("the header has no `format`");
      return elements;
    }
    if (words[0] == "format") {
      read_format(r, words);
      format = true;
    } else if (words[0] == "element") {
      const std::optional<double> count = words.size() == 3 ? read_number(words[2]) : std::nullopt;
      if (!count || !(*count >= 0) || *count > 2e9 || *count != std::floor(*count))
        r.fail("is not an element and its count");
      elements.push_back({words[1], static_cast<std::size_t>(*count), {}});
    } else if (words[0] == "property") {
      read_property(r, words, elements);
    } else {
      r.fail("`" + words[0] + "` is not known in a PLY header");
    }
  }
}

double read_binary(Reader& r, const Type& type) {
  if (r.left() < type.size) r.fail("ends too early");
  std::array<unsigned char, 8> bytes{};
  std::memcpy(bytes.data(), r.text.data() + r.at, type.size);
  r.at += type.size;
  const bool native = (r.encoding == Encoding::little) == (std::endian::native == std::endian::little);
  if (!native) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.size));
  return type.value(bytes);
}

double read_ascii(Reader& r) {
  std::size_t begin = r.at;
  while (begin < r.text.size() && std::strchr(" \t\r\n", r.text[begin])) r.line += r.text[begin++] == r.line_end;
  const std::size_t end = std::min(r.text.find_first_of(" \t\r\n", begin), r.text.size());
  if (end == begin) r.fail("ends too early");
  const std::string_view word = r.text.substr(begin, end - begin);
  const std::optional<double> value = read_number(word);
  if (!value) r.fail(fmt::format("`{}` is not a number", word.substr(0, 40)));
  r.at = end;
  return *value;
}

double read_value(Reader& r, const Type& type) {
  return r.encoding == Encoding::ascii ? read_ascii(r) : read_binary(r, type);
}

// One row of an element: the value of each plain property, and the list of property `list`.
void read_row(Reader& r, const Element& element, int list, std::vector<double>& values, std::vector<double>& items) {
  values.assign(element.properties.size(), 0);
  items.clear();
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const Property& property = element.properties[p];
    if (!property.count) {
      values[p] = read_value(r, *property.type);
      continue;
    }
    const double count = read_value(r, *property.count);
    if (!(count >= 0) || count > static_cast<double>(r.left()) || count != std::floor(count))
      r.fail(fmt::format("a list of {} items does not fit into the file", count));
    for (double i = 0; i < count; ++i) {
      const double item = read_value(r, *property.type);
      if (static_cast<int>(p) == list) items.push_back(item);
    }
  }
}

void check_size(const Reader& r, const Element& element) {
  std::size_t least = 0;  // least bytes per row; in text a digit and a space per value
  for (const Property& p : element.properties)
    least += r.encoding == Encoding::ascii ? 2 : (p.count ? p.count->size : p.type->size);
  if (element.count > 0 && (least == 0 || element.count > (r.left() + 1) / least))
    r.fail(fmt::format("{} {} elements do not fit into the file", element.count, element.name),
           "the file was cut, or its header is wrong");
}

void read_vertices(Reader& r, const Element& element, Mesh& mesh) {
  const std::array<int, 3> axis{element.find({"x"}), element.find({"y"}), element.find({"z"})};
  const int u = element.find({"s", "u", "texture_u"}), v = element.find({"t", "v", "texture_v"});
  if (*std::min_element(axis.begin(), axis.end()) < 0) r.fail("the vertices have no x, y and z");
  for (const int p : axis)
    if (element.properties[p].count) r.fail("a coordinate is a list");
  mesh.x.resize(static_cast<Eigen::Index>(element.count), 3);
  if (u >= 0 && v >= 0) mesh.uv.resize(mesh.x.rows(), 2);
  std::vector<double> values, items;
  for (Eigen::Index i = 0; i < mesh.x.rows(); ++i) {
    if (r.encoding != Encoding::ascii) r.place = fmt::format("vertex {}", i);
    read_row(r, element, -1, values, items);
    for (int k = 0; k < 3; ++k) mesh.x(i, k) = values[axis[k]];
    if (mesh.uv.rows() > 0) mesh.uv.row(i) << values[u], values[v];
    if (!mesh.x.row(i).allFinite() || (mesh.uv.rows() > 0 && !mesh.uv.row(i).allFinite()))
      r.fail(fmt::format("vertex {} is not finite", i), "repair the file where it was made");
    if (mesh.x.row(i).cwiseAbs().maxCoeff() > farthest_coordinate ||
        (mesh.uv.rows() > 0 && mesh.uv.row(i).cwiseAbs().maxCoeff() > farthest_coordinate))
      r.fail(fmt::format("vertex {} has an absurd coordinate: {}; {:g} is the largest", i, fmt::join(values, " "),
                         farthest_coordinate),
             "repair the file where it was made");
  }
}

void read_faces(Reader& r, const Element& element, Mesh& mesh) {
  const int list = element.find({"vertex_indices", "vertex_index"});
  if (list < 0 || !element.properties[list].count) r.fail("the faces have no list `vertex_indices`");
  std::vector<double> values, items;
  for (std::size_t f = 0; f < element.count; ++f) {
    if (r.encoding != Encoding::ascii) r.place = fmt::format("face {}", f);
    read_row(r, element, list, values, items);
    if (items.size() < 3) r.fail(fmt::format("face {} has {} corners", f, items.size()), "give at least 3");
    for (const double item : items)
      if (!(item >= 0) || item > 2e9 || item != std::floor(item))
        r.fail(fmt::format("face {} has the vertex index {}", f, item));
    mesh.corner_begin.push_back(static_cast<int>(mesh.corners.size()));
    for (const double item : items) mesh.corners.push_back(static_cast<int>(item));
  }
}

// Faces may come before vertices in the file, so that they are checked and cut once all is read.
void cut_ply_faces(const std::string& name, Mesh& mesh) {
  const auto beyond = std::ranges::find_if(mesh.corners, [&](int v) { return v >= mesh.x.rows(); });
  if (beyond != mesh.corners.end()) {
    const auto next = std::ranges::upper_bound(mesh.corner_begin, beyond - mesh.corners.begin());
    throw Error(fmt::format("vertex {} does not exist, the file has {}", *beyond, mesh.x.rows()),
                fmt::format("{}, face {}", name, next - mesh.corner_begin.begin() - 1),
                "repair the face, or look for a missing piece of the file");
  }
  const Triangles cut = cut_polygons(mesh.x, mesh.corners, mesh.corner_begin);
  mesh.triangles = cut.unaryExpr([&](int k) { return mesh.corners[k]; });
}

template <class T>
void put(std::string& text, T value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  text.append(bytes.data(), bytes.size());
}

}  // namespace

Mesh parse_ply(std::string_view text, const std::string& name) {
  Reader r;
  r.name = name;
  r.text = text;
  const std::size_t end = text.find('\r');  // data may follow the header: its first line decides
  if (end < text.find('\n') && text.substr(end, 2) != "\r\n") r.line_end = '\r';
  const std::vector<Element> elements = read_header(r);
  ++r.line;  // values of a text file begin here
  Mesh mesh;
  for (const Element& element : elements) {
    check_size(r, element);
    if (element.name == "vertex") {
      if (mesh.x.rows() > 0) r.fail("has two elements `vertex`", "leave one of them in the header, with its rows");
      read_vertices(r, element, mesh);
    } else if (element.name == "face") {
      read_faces(r, element, mesh);
    } else {
      std::vector<double> values, items;
      for (std::size_t i = 0; i < element.count; ++i) read_row(r, element, -1, values, items);
    }
  }
  cut_ply_faces(name, mesh);
  if (mesh.uv.rows() > 0) mesh.uv_triangles = mesh.triangles;
  return mesh;
}

std::string ply_text(const Points& x, const Triangles& triangles) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      x.rows(), triangles.rows());
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    for (int k = 0; k < 3; ++k) put(text, x(v, k));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    put(text, static_cast<std::uint8_t>(3));
    for (int k = 0; k < 3; ++k) put(text, static_cast<std::int32_t>(triangles(t, k)));
  }
  return text;
}

}  // namespace selvedge
