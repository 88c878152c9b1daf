#include "pipeline/formats/gltf_tinygltf.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/gltf_drawn_tinygltf.hpp"
#include "pipeline/formats/gltf_numbers_tinygltf.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/host/json_text.hpp"
#include "pipeline/host/library_message.hpp"
#include "pipeline/host/read_file.hpp"

namespace selvedge {
namespace {

using Numbers = GltfNumbers;

// A hexadecimal digit's value; -1 for anything else.
int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// The path that a relative URI stands for.
std::string percent_decoded(const std::string& uri) {
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escape = uri[i] == '%' && i + 2 < uri.size() && hex_value(uri[i + 1]) >= 0 && hex_value(uri[i + 2]) >= 0;
    path += escape ? static_cast<char>(16 * hex_value(uri[i + 1]) + hex_value(uri[i + 2])) : uri[i];
    if (escape) i += 2;
  }
  return path;
}

// The JSON of a glTF file, which is the first chunk of a binary one.
std::string_view json_of(std::string_view bytes) {
  constexpr std::size_t header = 20;
  if (!bytes.starts_with("glTF") || bytes.size() < header) return bytes;
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof length);
  return bytes.substr(header, length);
}

// A text file whose buffers within it are as the package reads them: of one media type, without white space.
std::string with_plain_data(std::string bytes) {
  constexpr std::string_view coded = ";base64,";
  Json json = parse_json_or_discard(bytes);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return bytes;
  bool changed = false;
  for (auto& buffer : json["buffers"]) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const std::string uri = buffer["uri"];
    const std::size_t begin = uri.find(coded);
    if (!uri.starts_with("data:") || begin == std::string::npos) continue;
    std::string plain = uri.substr(begin + coded.size());
    std::erase_if(plain, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; });
    plain = "data:application/octet-stream;base64," + plain;
    changed = changed || plain != uri;
    buffer["uri"] = std::move(plain);
  }
  return changed ? json_line(json) : bytes;
}

// Whether a file that asks for this extension has the same surface and motion without it.
bool leaves_shape(const std::string& extension) {
  constexpr std::array<std::string_view, 6> parts = {
      "KHR_mesh_quantization", "_materials_", "_texture_", "_lights_", "_xmp", "VRMC_"};
  return std::ranges::any_of(parts, [&](std::string_view part) { return extension.find(part) != std::string::npos; });
}

// The files that a glTF file may open: its buffers, below its own folder, by the names that the package asks for. All
// other files, such as images, count as missing.
class BufferFiles {
 public:
  BufferFiles(const std::filesystem::path& file, std::string_view bytes) {
    const Json json = parse_json_or_discard(std::string(json_of(bytes)));
    if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return;
    for (std::size_t i = 0; i < json["buffers"].size(); ++i) {
      const auto& buffer = json["buffers"][i];
      if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
      const std::string uri = buffer["uri"];
      if (uri.starts_with("data:")) continue;
      std::string asked = uri;
      std::ranges::replace(asked, '+', ' ');  // as the package decodes URIs
      files_[percent_decoded(asked)] =
          path_below(file.parent_path(), percent_decoded(uri), file.string() + ": buffer " + std::to_string(i));
    }
  }

  tinygltf::FsCallbacks callbacks() {
    tinygltf::FsCallbacks calls{};
    calls.FileExists = [](const std::string& name, void* self) { return of(self).contains(name); };
    calls.ExpandFilePath = [](const std::string& name, void*) { return name; };
    calls.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string*, const std::string& name, void* self) {
      const std::string text = read_file(of(self).at(name), "buffer");
      bytes->assign(text.begin(), text.end());
      return true;
    };
    calls.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
      return false;
    };
    calls.user_data = this;
    return calls;
  }

 private:
  using Files = std::map<std::string, std::filesystem::path>;
  static const Files& of(void* self) { return static_cast<BufferFiles*>(self)->files_; }
  Files files_;
};

// The file as parsed by the package. The package does not check it: indices and sizes are checked at their use.
class Document {
 public:
  explicit Document(const std::filesystem::path& file) : file_(file) {
    const std::string bytes = with_plain_data(read_file(file, "glTF"));
    refuse_too_many(static_cast<double>(bytes.size()), std::numeric_limits<int>::max(), "bytes", file.string(),
                    "export less of it");
    BufferFiles buffers(file, bytes);
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader([](auto...) { return true; }, nullptr);  // images are not needed
    loader.SetFsCallbacks(buffers.callbacks());
    std::string error, warning;
    bool good = false;
    const auto size = static_cast<unsigned>(bytes.size());
    try {
      good = bytes.starts_with("glTF")
                 ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                               reinterpret_cast<const unsigned char*>(bytes.data()), size)
                 : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, "");
    } catch (const Error&) {
      throw;
    } catch (const std::exception& problem) {
      error = problem.what();
    }
    error = library_message(error);
    std::ranges::replace(error, '\n', ' ');
    if (!good)
      throw Error("is no glTF 2.0 that can be read" + (error.empty() ? "" : " (" + error + ")"), file.string(),
                  "export it anew, as .glb");
    for (const std::string& extension : model.extensionsRequired)
      if (!leaves_shape(extension))
        fail("extensionsRequired", "asks for " + extension, "export without it, uncompressed");
  }

  [[noreturn]] void fail(const std::string& part, const std::string& what, const std::string& cure) const {
    throw Error(what, file_.string() + ": " + part, cure);
  }

  template <class Entry>
  const Entry& entry(const std::vector<Entry>& list, int index, const std::string& part) const {
    return gltf_entry(list, index, file_.string() + ": " + part);
  }

  Numbers numbers(int accessor, int columns, const std::string& part) const {
    return gltf_numbers(model, accessor, columns, file_.string() + ": " + part);
  }

  std::string name() const { return file_.filename().string(); }

  tinygltf::Model model;

 private:
  std::filesystem::path file_;
};

std::string name_or(const std::string& name, const char* noun, std::size_t number) {
  return name.empty() ? noun + std::to_string(number) : name;
}

// Sets translation, rotation and scale from a column-major matrix.
void set_by_matrix(const Document& file, const std::vector<double>& m, const std::string& part, GltfNode& node) {
  const Eigen::Matrix4d all = Eigen::Map<const Eigen::Matrix4d>(m.data());
  Mat3 linear = all.topLeftCorner<3, 3>();
  node.translation = all.topRightCorner<3, 1>();
  node.scale = linear.colwise().norm().transpose();
  if (linear.determinant() < 0) node.scale[0] = -node.scale[0];
  linear = linear * node.scale.cwiseInverse().asDiagonal();
  if (!(linear * linear.transpose()).isIdentity(1e-3))
    file.fail(part, "is sheared or flattened by its matrix", "apply its transforms where it was made");
  node.rotation = Eigen::Quaterniond(linear).normalized();
}

GltfNode node_of(const Document& file, std::size_t number) {
  const tinygltf::Node& given = file.model.nodes[number];
  GltfNode node;
  node.name = name_or(given.name, "node", number);
  const std::string part = "node `" + node.name + "`";
  const auto sized = [&](const std::vector<double>& values, std::size_t size) {
    if (!values.empty() && values.size() != size) file.fail(part, "has a transform of another size", "export it anew");
    if (!std::ranges::all_of(values, [](double v) { return std::isfinite(v); }))
      file.fail(part, "is not finite", "repair it where it was made");
    return !values.empty();
  };
  if (sized(given.matrix, 16)) set_by_matrix(file, given.matrix, part, node);
  if (sized(given.translation, 3)) node.translation = Eigen::Map<const Vec3>(given.translation.data());
  if (sized(given.scale, 3)) node.scale = Eigen::Map<const Vec3>(given.scale.data());
  if (sized(given.rotation, 4))
    node.rotation = Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(given.rotation.data()));
  if (!(node.rotation.norm() > 1e-6)) file.fail(part, "has a rotation of length 0", "export it anew");
  node.rotation.normalize();
  return node;
}

// Reads the nodes, parents first. Returns the index of each of the file's nodes among them.
std::vector<int> read_nodes(const Document& file, std::vector<GltfNode>& nodes) {
  const std::vector<tinygltf::Node>& given = file.model.nodes;
  std::vector<int> parent(given.size(), -1), place(given.size(), -1), order;
  for (std::size_t i = 0; i < given.size(); ++i)
    for (const int child : given[i].children) {
      file.entry(given, child, "node " + std::to_string(i) + ", children");
      if (parent[child] >= 0) file.fail("node " + std::to_string(child), "has two parents", "export it anew");
      parent[child] = static_cast<int>(i);
    }
  for (std::size_t i = 0; i < given.size(); ++i)
    if (parent[i] < 0) order.push_back(static_cast<int>(i));
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto i = static_cast<std::size_t>(order[k]);
    place[i] = static_cast<int>(k);
    nodes.push_back(node_of(file, i));
    nodes.back().parent = parent[i] < 0 ? -1 : place[parent[i]];
    order.insert(order.end(), given[i].children.begin(), given[i].children.end());
  }
  if (order.size() != given.size()) file.fail("nodes", "are in a circle", "export it anew");
  return place;
}

// Adds the joints of a skin that the scene does not have yet. Returns the number of each of the skin's joints there.
std::vector<int> add_skin(const Document& file, int number, const std::vector<int>& place, GltfScene& scene) {
  const tinygltf::Skin& skin = file.entry(file.model.skins, number, "skins");
  if (skin.joints.empty()) file.fail("skin, joints", "is empty", "export it anew");
  std::vector<Eigen::Matrix4d> bind(skin.joints.size(), Eigen::Matrix4d::Identity());
  if (skin.inverseBindMatrices >= 0) {
    const Numbers all = file.numbers(skin.inverseBindMatrices, 16, "skin, inverseBindMatrices");
    if (all.rows() < std::ssize(bind)) file.fail("skin, inverseBindMatrices", "are too few", "export it anew");
    for (std::size_t j = 0; j < bind.size(); ++j)
      bind[j] = Eigen::Map<const Eigen::Matrix4d>(all.row(static_cast<Eigen::Index>(j)).data());
  }
  std::vector<int> numbers;
  for (std::size_t j = 0; j < bind.size(); ++j) {
    const int node = file.entry(place, skin.joints[j], "skin, joints");
    numbers.push_back(static_cast<int>(std::ranges::find(scene.joints, node) - scene.joints.begin()));
    const auto at = static_cast<std::size_t>(numbers.back());
    if (at == scene.joints.size()) {
      scene.joints.push_back(node);
      scene.inverse_bind.push_back(bind[j]);
    } else if (!scene.inverse_bind[at].isApprox(bind[j], 1e-4)) {
      file.fail("skins", "bind the joint `" + scene.nodes[static_cast<std::size_t>(node)].name + "` in different poses",
                "choose meshes of one skin, or export the body alone, with one armature");
    }
  }
  return numbers;
}

// Adds joints and weights of vertices, in sets of four.
void add_weights(const Document& file, const tinygltf::Primitive& primitive, const std::string& part, int first,
                 int count, const std::vector<int>& joints, std::vector<Eigen::Triplet<double>>& all) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(count);
  for (int set = 0;; ++set) {
    const auto number = primitive.attributes.find("JOINTS_" + std::to_string(set)),
               weight = primitive.attributes.find("WEIGHTS_" + std::to_string(set));
    if (number == primitive.attributes.end() || weight == primitive.attributes.end()) break;
    const Numbers joint = file.numbers(number->second, 4, part + ", " + number->first);
    const Numbers w = file.numbers(weight->second, 4, part + ", " + weight->first);
    if (joint.rows() != count || w.rows() != count)
      file.fail(part + ", " + weight->first, "has not as many rows as there are vertices", "export it anew");
    for (int v = 0; v < count; ++v)
      for (int k = 0; k < 4; ++k) {
        if (w(v, k) <= 0) continue;
        if (!(joint(v, k) >= 0 && joint(v, k) < static_cast<double>(joints.size())))
          file.fail(part + ", " + number->first, "names a joint beyond the skin's " + std::to_string(joints.size()),
                    "export it anew");
        all.emplace_back(first + v, joints[static_cast<std::size_t>(joint(v, k))], w(v, k));
        sum[v] += w(v, k);
      }
  }
  for (int v = 0; v < count; ++v)
    if (!(sum[v] > 0)) file.fail(part, "has no weights at vertex " + std::to_string(v), "weight every vertex");
}

// The positions with the morph targets that the file itself turns on.
Numbers positions_of(const Document& file, const tinygltf::Primitive& primitive, const std::vector<double>& morphs,
                     const std::string& part) {
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) file.fail(part, "has no positions", "export it anew");
  Numbers x = file.numbers(position->second, 3, part + ", POSITION");
  for (std::size_t t = 0; t < std::min(morphs.size(), primitive.targets.size()); ++t) {
    const auto moved = primitive.targets[t].find("POSITION");
    if (morphs[t] == 0 || moved == primitive.targets[t].end()) continue;
    const std::string target = part + ", target " + std::to_string(t);
    const Numbers by = file.numbers(moved->second, 3, target);
    if (by.rows() != x.rows()) file.fail(target, "has not as many rows as there are vertices", "export it anew");
    x += morphs[t] * by;
  }
  if (!x.allFinite()) file.fail(part, "is not finite with the weights of its morph targets", "export it anew");
  return x;
}

void add_primitive(const Document& file, const tinygltf::Primitive& primitive, const std::vector<double>& morphs,
                   const std::string& part, const std::vector<int>& joints,
                   std::vector<Eigen::Triplet<double>>& weights, Mesh& mesh) {
  if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1)
    file.fail(part, "is not made of triangles", "export triangles");
  const Numbers x = positions_of(file, primitive, morphs, part);
  const int first = static_cast<int>(mesh.x.rows()), count = static_cast<int>(x.rows());
  mesh.x.conservativeResize(first + count, 3);
  mesh.x.bottomRows(count) = x;
  Numbers corners;
  if (primitive.indices >= 0)
    corners = file.numbers(primitive.indices, 1, part + ", indices");
  else
    corners = Eigen::VectorXd::LinSpaced(count, 0, count - 1);
  if (corners.rows() % 3 != 0) file.fail(part + ", indices", "are not whole triangles", "export it anew");
  if (corners.rows() > 0 && !(corners.minCoeff() >= 0 && corners.maxCoeff() < count))
    file.fail(part + ", indices", "name a vertex beyond the " + std::to_string(count), "export it anew");
  const Eigen::Index before = mesh.triangles.rows();
  mesh.triangles.conservativeResize(before + corners.rows() / 3, 3);
  for (Eigen::Index i = 0; i < corners.rows(); ++i)
    mesh.triangles(before + i / 3, i % 3) = first + static_cast<int>(corners(i, 0));
  add_weights(file, primitive, part, first, count, joints, weights);
}

// The weights of a mesh's morph targets where it is used; empty: all are 0.
const std::vector<double>& morph_weights(const tinygltf::Node& node, const tinygltf::Mesh& mesh) {
  return node.weights.empty() ? mesh.weights : node.weights;
}

// Adds the chosen meshes that skins deform, each as a group with its name, and the joints of these skins. Hidden ones
// are taken only by name. `parts` gets the number of each vertex's primitive. Returns the names of all meshes that
// skins deform.
std::vector<std::string> add_meshes(const Document& file, const std::vector<int>& place, const NameChoice& choice,
                                    GltfScene& scene, std::vector<Eigen::Triplet<double>>& weights,
                                    std::vector<int>& parts) {
  std::vector<std::string> names;
  std::map<int, std::vector<int>> joints;  // of each skin
  const GltfDrawn nodes = drawn_nodes(file.model);
  for (std::size_t i = 0; i < file.model.nodes.size(); ++i) {
    const tinygltf::Node& node = file.model.nodes[i];
    if (node.mesh < 0 || (node.skin < 0 && !nodes.rigid[i])) continue;
    const tinygltf::Mesh& mesh = file.entry(file.model.meshes, node.mesh, "node `" + node.name + "`");
    const auto name = name_or(mesh.name.empty() ? node.name : mesh.name, "mesh", static_cast<std::size_t>(node.mesh));
    if (node.skin >= 0) names.push_back(name);
    if (!choice.takes(name)) continue;
    if (node.skin < 0 || (!nodes.drawn[i] && choice.only.empty())) {
      scene.mesh.warnings.push_back(
          fmt::format("{}: mesh `{}` is left out: {}", file.name(), name,
                      node.skin < 0 ? "it hangs on a joint and has no skin; give it one if cloth is to meet it"
                                    : "the file does not show it; `selvedge body --mesh` takes it all the same"));
      continue;
    }
    if (!joints.contains(node.skin)) joints[node.skin] = add_skin(file, node.skin, place, scene);
    const auto first = static_cast<int>(scene.mesh.x.rows());
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      add_primitive(file, mesh.primitives[p], morph_weights(node, mesh),
                    fmt::format("mesh `{}`, primitive {}", name, p), joints[node.skin], weights, scene.mesh);
      parts.resize(static_cast<std::size_t>(scene.mesh.x.rows()), parts.empty() ? 0 : parts.back() + 1);
    }
    std::vector<int>& group = group_named(scene.mesh.groups, name);
    for (int v = first; v < static_cast<int>(scene.mesh.x.rows()); ++v) group.push_back(v);
  }
  return names;
}

std::optional<GltfPath> path_of(const std::string& name) {
  if (name == "translation") return GltfPath::translation;
  if (name == "rotation") return GltfPath::rotation;
  if (name == "scale") return GltfPath::scale;
  return {};  // weights of morph targets, and properties of extensions
}

// Whether a channel gives a mesh's morph targets other weights than the file does.
bool morphs_otherwise(const Document& file, const tinygltf::AnimationChannel& channel, int output,
                      const std::string& part) {
  const tinygltf::Node& node = file.entry(file.model.nodes, channel.target_node, part);
  if (node.mesh < 0 || node.skin < 0) return false;
  const std::vector<double>& still = morph_weights(node, file.entry(file.model.meshes, node.mesh, part));
  const Numbers values = file.numbers(output, 1, part + ", values");
  for (Eigen::Index k = 0; k < values.rows(); ++k) {
    const double weight = still.empty() ? 0 : still[static_cast<std::size_t>(k) % still.size()];
    if (std::abs(values(k, 0) - weight) > 1e-6) return true;
  }
  return false;
}

GltfAnimation animation_of(const Document& file, const std::vector<int>& place, std::size_t number) {
  const tinygltf::Animation& given = file.model.animations[number];
  GltfAnimation animation{name_or(given.name, "animation", number), {}, false};
  for (std::size_t c = 0; c < given.channels.size(); ++c) {
    const tinygltf::AnimationChannel& channel = given.channels[c];
    const std::optional<GltfPath> path = path_of(channel.target_path);
    const bool morphs = channel.target_path == "weights";
    if ((!path && !morphs) || channel.target_node < 0) continue;
    const std::string part = "animation `" + animation.name + "`, channel " + std::to_string(c);
    const tinygltf::AnimationSampler& sampler = file.entry(given.samplers, channel.sampler, part);
    if (morphs) {
      animation.morphs = animation.morphs || morphs_otherwise(file, channel, sampler.output, part);
      continue;
    }
    GltfTrack track{file.entry(place, channel.target_node, part), *path, GltfInterpolation::linear, {}, {}};
    if (sampler.interpolation == "STEP") track.interpolation = GltfInterpolation::step;
    if (sampler.interpolation == "CUBICSPLINE") track.interpolation = GltfInterpolation::cubic;
    track.times = file.numbers(sampler.input, 1, part + ", times");
    track.values = file.numbers(sampler.output, *path == GltfPath::rotation ? 4 : 3, part + ", values");
    const Eigen::Index rows = track.times.size() * (track.interpolation == GltfInterpolation::cubic ? 3 : 1);
    if (track.times.size() == 0 || track.values.rows() != rows)
      file.fail(part, fmt::format("has {} values for {} times", track.values.rows(), track.times.size()),
                "export it anew");
    for (Eigen::Index i = 1; i < track.times.size(); ++i)
      if (!(track.times[i] > track.times[i - 1])) file.fail(part + ", times", "do not ascend", "export it anew");
    animation.tracks.push_back(std::move(track));
  }
  return animation;
}

}  // namespace

GltfScene read_gltf(const std::filesystem::path& path, const NameChoice& choice) {
  if (!std::filesystem::exists(path)) throw Error("is not there", path.string(), "check the path");
  const Document file(path);
  GltfScene scene;
  const std::vector<int> place = read_nodes(file, scene.nodes);
  std::vector<Eigen::Triplet<double>> weights;
  std::vector<int> parts;
  const std::vector<std::string> names = add_meshes(file, place, choice, scene, weights, parts);
  if (names.empty())
    file.fail("skins", "is not used by any mesh", "export the body together with its armature and weights");
  choice.check(names, path.string());
  if (scene.mesh.triangles.rows() == 0) file.fail("meshes", "have no triangles", "export the body's surface");
  scene.weights = join_alike(weights, std::ssize(scene.joints), parts, scene.mesh, file.name());
  for (std::size_t a = 0; a < file.model.animations.size(); ++a)
    scene.animations.push_back(animation_of(file, place, a));
  return scene;
}

}  // namespace selvedge
