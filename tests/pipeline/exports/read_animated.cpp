#include "tests/pipeline/exports/read_animated.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/pipeline/files.hpp"

namespace selvedge::read_animated {
namespace {

using nlohmann::json;

template <class Value>
Value value_at(const std::string& bytes, std::size_t at, bool big_endian = false) {
  std::string raw = bytes.substr(at, sizeof(Value));
  if (raw.size() != sizeof(Value)) throw std::runtime_error("the file ends too early");
  if (big_endian) std::reverse(raw.begin(), raw.end());
  Value value;
  std::memcpy(&value, raw.data(), sizeof value);
  return value;
}

Surface cache(const std::string& bytes, std::size_t at, int points, std::vector<double> times, bool big_endian) {
  Surface surface{{}, std::move(times), {}, {}, {}, {}, {}, {}, {}};
  for (std::size_t i = 0; i < surface.times.size(); ++i) {
    surface.x.emplace_back(points, 3);
    for (int k = 0; k < 3 * points; ++k, at += 4) surface.x.back().data()[k] = value_at<float>(bytes, at, big_endian);
  }
  if (at != bytes.size()) throw std::runtime_error("bytes beyond the last frame");
  return surface;
}

// A glTF file in parts.
struct Gltf {
  json tables;
  std::string bytes;

  // Rows of an accessor as numbers, normalised ones as fractions.
  Eigen::MatrixXd rows(int number) const {
    const json& a = tables["accessors"][number];
    const json& view = tables["bufferViews"][a["bufferView"].get<int>()];
    const int type = a["componentType"], width = a["type"] == "VEC3" ? 3 : a["type"] == "VEC2" ? 2 : 1;
    const std::map<int, std::size_t> sizes = {{5120, 1}, {5121, 1}, {5122, 2}, {5123, 2}, {5125, 4}, {5126, 4}};
    const std::size_t size = sizes.at(type), stride = view.value("byteStride", size * width);
    const std::size_t begin = view["byteOffset"].get<std::size_t>() + a.value("byteOffset", std::size_t{0});
    const std::size_t count = a["count"],
                      end = view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>();
    if (begin % size != 0 || stride % (view.contains("byteStride") ? 4 : 1) != 0) throw std::runtime_error("alignment");
    if (begin + (count - 1) * stride + size * width > end || end > bytes.size())
      throw std::runtime_error("beyond its view");
    Eigen::MatrixXd values(count, width);
    for (std::size_t i = 0; i < count; ++i)
      for (int k = 0; k < width; ++k) {
        const std::size_t at = begin + i * stride + k * size;
        double value = 0;
        if (type == 5121) value = value_at<std::uint8_t>(bytes, at);
        if (type == 5122) value = value_at<std::int16_t>(bytes, at);
        if (type == 5123) value = value_at<std::uint16_t>(bytes, at);
        if (type == 5125) value = value_at<std::uint32_t>(bytes, at);
        if (type == 5126) value = value_at<float>(bytes, at);
        if (a.value("normalized", false)) value /= type == 5121 ? 255 : type == 5123 ? 65535 : 32767;
        values(i, k) = value;
      }
    if (a.contains("min"))
      for (int k = 0; k < width; ++k)
        if (values.col(k).minCoeff() != a["min"][k].get<double>() ||
            values.col(k).maxCoeff() != a["max"][k].get<double>())
          throw std::runtime_error("min or max is not that of the values");
    return values;
  }
};

Gltf open_glb(const std::filesystem::path& path) {
  const std::string all = fake::whole(path);
  if (all.substr(0, 4) != "glTF" || value_at<std::uint32_t>(all, 4) != 2) throw std::runtime_error("no glTF 2");
  if (value_at<std::uint32_t>(all, 8) != all.size()) throw std::runtime_error("the length is not the file's");
  const std::size_t text = value_at<std::uint32_t>(all, 12), bytes = value_at<std::uint32_t>(all, 20 + text);
  if (all.substr(16, 4) != "JSON" || text % 4 != 0 || bytes % 4 != 0) throw std::runtime_error("chunks");
  Gltf gltf{json::parse(all.substr(20, text)), all.substr(28 + text, bytes)};
  if (gltf.tables["buffers"][0]["byteLength"] != gltf.bytes.size()) throw std::runtime_error("the buffer's length");
  return gltf;
}

// The triangles of all primitives, which share their vertices; materials and parts by their names.
void read_primitives(const Gltf& gltf, const json& mesh, Surface& surface) {
  std::vector<int> corners;
  for (const json& primitive : mesh["primitives"]) {
    if (primitive["attributes"] != mesh["primitives"][0]["attributes"]) throw std::runtime_error("other vertices");
    const Eigen::MatrixXd own = gltf.rows(primitive["indices"]);
    const std::string material = gltf.tables["materials"][primitive["material"].get<int>()]["name"];
    const std::string part = primitive.value("extras", json::object()).value("groups", "");
    for (Eigen::Index i = 0; i < own.rows(); ++i) {
      if (i % 3 == 0) surface.materials[material].push_back(static_cast<int>(corners.size() / 3));
      if (i % 3 == 0 && !part.empty()) surface.parts[part].push_back(static_cast<int>(corners.size() / 3));
      corners.push_back(static_cast<int>(own(i, 0)));
    }
  }
  surface.triangles = Eigen::Map<Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
  const json& attributes = mesh["primitives"][0]["attributes"];
  if (!attributes.contains("TEXCOORD_0")) return;
  surface.uv = gltf.rows(attributes["TEXCOORD_0"]);
  surface.uv.col(1) = 1 - surface.uv.col(1).array();
}

PointsF placed(const json& node, const Eigen::MatrixXd& local) {
  PointsF x(local.rows(), 3);
  for (int k = 0; k < 3; ++k)
    x.col(k) =
        (local.col(k).array() * node["scale"][k].get<double>() + node["translation"][k].get<double>()).cast<float>();
  return x;
}

// The numbers of a bracketed list of USD, however deep.
std::vector<double> numbers(const std::string& text) {
  std::vector<double> found;
  for (const char* at = text.c_str(); *at != 0;) {
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end == at)
      ++at;
    else
      found.push_back(value), at = end;
  }
  return found;
}

PointsF points_of(const std::string& text) {
  const std::vector<double> values = numbers(text);
  PointsF x(values.size() / 3, 3);
  for (std::size_t i = 0; i < values.size(); ++i) x.data()[i] = static_cast<float>(values[i]);
  return x;
}

}  // namespace

Surface pc2(const std::filesystem::path& path) {
  const std::string bytes = fake::whole(path);
  std::vector<double> times;
  for (int i = 0; i < value_at<std::int32_t>(bytes, 28); ++i) times.push_back(i);
  return cache(bytes, 32, value_at<std::int32_t>(bytes, 16), times, false);
}

Surface mdd(const std::filesystem::path& path) {
  const std::string bytes = fake::whole(path);
  const int frames = value_at<std::int32_t>(bytes, 0, true);
  std::vector<double> times;
  for (int i = 0; i < frames; ++i) times.push_back(value_at<float>(bytes, 8 + 4 * i, true));
  return cache(bytes, 8 + 4 * frames, value_at<std::int32_t>(bytes, 4, true), times, true);
}

std::map<std::string, Surface> glb(const std::filesystem::path& path) {
  const Gltf gltf = open_glb(path);
  std::map<std::string, Surface> found;
  const json& nodes = gltf.tables["nodes"];
  for (const json& number : gltf.tables["scenes"][0]["nodes"]) {
    const json& node = nodes[number.get<int>()];
    const json& mesh = gltf.tables["meshes"][node["mesh"].get<int>()];
    const json& primitive = mesh["primitives"][0];
    Surface& surface = found[node["name"].get<std::string>()];
    const Eigen::MatrixXd base = gltf.rows(primitive["attributes"]["POSITION"]);
    read_primitives(gltf, mesh, surface);
    const auto normals = [&](std::size_t target) -> PointsF {
      Eigen::MatrixXd sum = gltf.rows(primitive["attributes"]["NORMAL"]);
      if (primitive.contains("targets")) sum += gltf.rows(primitive["targets"][target]["NORMAL"]);
      return sum.cast<float>();
    };
    const auto shaped = [&](const std::function<double(std::size_t)>& weight) {
      Eigen::MatrixXd x = base;
      for (std::size_t k = 0; primitive.contains("targets") && k < primitive["targets"].size(); ++k)
        if (weight(k) != 0) x += weight(k) * gltf.rows(primitive["targets"][k]["POSITION"]);
      return placed(node, x);
    };
    // As it is without animation, which is to be frame 0; then as it is animated.
    const PointsF still = shaped([&](std::size_t k) { return mesh["weights"][k].get<double>(); });
    surface.times = {0};
    surface.x = {still};
    if (primitive["attributes"].contains("NORMAL"))
      for (std::size_t k = 0; k < (primitive.contains("targets") ? primitive["targets"].size() : 1); ++k)
        surface.normals.push_back(normals(k));
    for (const json& animation : gltf.tables.value("animations", json::array()))
      for (const json& channel : animation["channels"]) {
        if (channel["target"]["node"] != number || channel["target"]["path"] != "weights") continue;
        const json& sampler = animation["samplers"][channel["sampler"].get<int>()];
        const Eigen::MatrixXd times = gltf.rows(sampler["input"]), weights = gltf.rows(sampler["output"]);
        const std::size_t targets = primitive["targets"].size();
        surface.times.clear();
        surface.x.clear();
        for (Eigen::Index i = 0; i < times.rows(); ++i) {
          surface.times.push_back(times(i, 0));
          surface.x.push_back(shaped([&](std::size_t k) { return weights(i * targets + k, 0); }));
        }
        if (surface.x[0] != still) throw std::runtime_error("without animation it is not frame 0");
      }
  }
  return found;
}

std::map<std::string, Surface> usda(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::map<std::string, Surface> found;
  Surface* surface = nullptr;
  double codes_a_second = 0;
  bool samples = false, normal_samples = false;
  int depth = 0;
  std::string subset, material;  // names of the last ones that were opened
  std::vector<int> faces;        // of the subset
  std::vector<double> st;        // texture coordinates by row
  std::vector<int> normal_rows;  // of each corner
  const auto ints = [](const std::string& text) {
    const std::vector<double> values = numbers(text);
    return std::vector<int>(values.begin(), values.end());
  };
  const auto named = [](const std::string& line) {
    return line.substr(line.find('"') + 1, line.find('"', line.find('"') + 1) - line.find('"') - 1);
  };
  const auto after = [](const std::string& line) { return line.substr(line.find('=') + 1); };
  const auto starts = [](const std::string& line, const char* word) { return line.find(word) != std::string::npos; };
  const auto read_usd_look = [&](const std::string& line) {
    if (starts(line, "faceVertexCounts")) surface->counts = ints(after(line));
    if (starts(line, "primvars:st = ")) st = numbers(after(line));
    if (starts(line, "primvars:normals:indices")) normal_rows = ints(after(line));
    if (starts(line, "primvars:st:indices")) {
      const std::vector<int> rows = ints(after(line));
      surface->uv.resize(std::ssize(rows), 2);
      for (Eigen::Index k = 0; k < std::ssize(rows); ++k)
        surface->uv.row(k) << st.at(2 * rows[k]), st.at(2 * rows[k] + 1);
    }
    if (starts(line, "def GeomSubset")) subset = named(line), faces.clear();
    if (starts(line, "int[] indices = ")) faces = ints(after(line));
    if (starts(line, "familyName = \"parts\"")) subset = "part " + subset;
    if (starts(line, "int[] indices = ") && subset.starts_with("part ")) surface->parts[subset.substr(5)] = faces;
    if (!starts(line, "material:binding = ")) return;
    material = line.substr(line.rfind('/') + 1, line.rfind('>') - line.rfind('/') - 1);
    if (subset.empty())
      for (int f = 0; f < std::ssize(surface->counts); ++f) faces.push_back(f);
    surface->materials[material] = faces;
  };
  for (std::string line; std::getline(stream, line);) {
    for (const char c : line) depth += (c == '{' || c == '(' || c == '[') - (c == '}' || c == ')' || c == ']');
    if (line.find("timeCodesPerSecond") != std::string::npos) codes_a_second = numbers(after(line)).at(0);
    if (line.find("def Mesh \"") != std::string::npos) {
      surface = &found[named(line)];
      subset.clear();
      faces.clear();
    }
    if (surface) read_usd_look(line);
    if (line.find("int[] faceVertexIndices") != std::string::npos) {
      surface->corners = ints(after(line));
      const std::vector<double> corners = numbers(after(line));
      surface->triangles.resize(corners.size() / 3, 3);
      for (Eigen::Index i = 0; i < surface->triangles.size(); ++i)  // of polygons they mean nothing
        surface->triangles.data()[i] = static_cast<int>(corners[static_cast<std::size_t>(i)]);
    }
    if (line.find("point3f[] points = ") != std::string::npos) {
      surface->times.push_back(0);
      surface->x.push_back(points_of(after(line)));
    }
    if (normal_samples && line.find(": [") != std::string::npos) {
      const PointsF rows = points_of(line.substr(line.find(':') + 1));
      surface->normals.push_back(rows(normal_rows, Eigen::all));
    }
    if (samples && line.find(':') != std::string::npos) {
      surface->times.push_back(std::stod(line) / codes_a_second);
      surface->x.push_back(points_of(line.substr(line.find(':') + 1)));
    }
    if (line.find(".timeSamples") != std::string::npos) samples = line.find("point3f[] points") != std::string::npos;
    if (line.find("normals.timeSamples") != std::string::npos) normal_samples = true;
    if (line.find('}') != std::string::npos) samples = normal_samples = false;
  }
  if (depth != 0) throw std::runtime_error("a bracket is not closed");
  return found;
}

}  // namespace selvedge::read_animated
