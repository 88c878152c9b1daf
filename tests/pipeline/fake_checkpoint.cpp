#include "tests/pipeline/fake_checkpoint.hpp"

#include <bit>
#include <cmath>
#include <fstream>
#include <functional>

namespace selvedge::fake {
namespace {

using Shape = std::vector<std::int64_t>;

std::int64_t count_of(const Shape& shape) {
  std::int64_t count = 1;
  for (const std::int64_t extent : shape) count *= extent;
  return count;
}

std::string little_endian(std::uint64_t value, int bytes) {
  std::string text;
  for (int k = 0; k < bytes; ++k) text += static_cast<char>(value >> (8 * k) & 0xFF);
  return text;
}

std::string bytes_of(const std::vector<float>& numbers) {
  std::string bytes;
  for (const float number : numbers) bytes += little_endian(std::bit_cast<std::uint32_t>(number), 4);
  return bytes;
}

// Lists the tensors of a network in the order in which torch registers its modules.
class TensorList {
 public:
  std::vector<CheckpointTensor> tensors;
  explicit TensorList(int width) : width_(width) {}

  void one(const std::string& name, const Shape& shape) { tensors.push_back({"model." + name, shape, {}}); }

  void layers(const std::string& prefix, int inputs, int outputs) {
    const int sizes[] = {inputs, width_, width_, outputs};
    for (int layer = 0; layer < 3; ++layer) {
      const std::string name = "_learned_model." + prefix + ".layers." + std::to_string(2 * layer);
      one(name + ".weight", {sizes[layer + 1], sizes[layer]});
      one(name + ".bias", {sizes[layer + 1]});
    }
  }
  void normed(const std::string& prefix, int inputs) {
    layers(prefix + ".0", inputs, width_);
    one("_learned_model." + prefix + ".1.weight", {width_});
    one("_learned_model." + prefix + ".1.bias", {width_});
  }
  void encoders(int node_inputs, const std::vector<std::pair<std::string, int>>& edges) {
    normed("node_encoder", node_inputs);
    layers("decoder", width_, 3);
    for (const auto& [name, inputs] : edges) normed("edgeset_encoders." + name, inputs);
  }
  void step(const std::string& prefix, const std::vector<std::string>& edges) {
    for (const std::string& edge : edges) normed(prefix + ".edge_processor_dict." + edge, 3 * width_);
    normed(prefix + ".node_processor_dict.node", width_ * (1 + static_cast<int>(edges.size())));
  }
  void normaliser(const std::string& name, int columns) {
    const std::string prefix = "_" + name + "_normalizer._";
    one(prefix + "acc_count", {1});
    one(prefix + "num_accumulations", {1});
    one(prefix + "acc_sum", {1, columns});
    one(prefix + "acc_sum_squared", {1, columns});
  }

 private:
  int width_;
};

std::string dotted(const std::string& prefix, int number) { return prefix + std::to_string(number); }

void list_hood(TensorList& list) {
  list.encoders(24, {{"mesh", 12}, {"world", 9}, {"coarse0", 12}, {"coarse1", 12}, {"coarse2", 12}});
  const std::vector<std::vector<std::string>> levels = {{"world_edge", "mesh_edge", "coarse_edge0"},
                                                        {"world_edge", "coarse_edge0", "coarse_edge1"},
                                                        {"world_edge", "coarse_edge1"}};
  for (const int level : {0, 1, 2, 3, 4})
    for (const int step : {0, 1, 2})
      list.step(dotted(dotted("levels.", level) + ".", step), levels[level < 3 ? level : 4 - level]);
}

void list_hood_cvpr(TensorList& list) {
  list.encoders(24, {{"mesh", 12}, {"world", 9}, {"coarse", 12}});
  const std::vector<std::vector<std::string>> levels = {{"mesh_edge", "coarse_edge0", "world_edge"},
                                                        {"coarse_edge0", "coarse_edge1", "world_edge"},
                                                        {"coarse_edge1", "world_edge"}};
  for (const int level : {0, 1, 2, 3, 4})
    for (const int step : {0, 1, 2})
      list.step(dotted(dotted("processor_steps", level + 1) + ".", step), levels[level < 3 ? level : 4 - level]);
}

void list_fine(TensorList& list, int width, int steps) {
  list.encoders(20, {{"mesh", 12}, {"world", 9}});
  for (int step = 0; step < steps; ++step)
    for (const std::string part : {"node", "mesh_edge", "world_edge"})
      list.normed(dotted("processor_steps.", step) + "." + part + "_processor", 3 * width);
}

void list_contourcraft(TensorList& list) {
  list.encoders(24, {{"mesh", 9},
                     {"repulsion", 20},
                     {"attraction", 20},
                     {"body", 13},
                     {"coarse0", 9},
                     {"coarse1", 9},
                     {"coarse2", 9},
                     {"coarse3", 9}});
  for (int step = 0; step < 15; ++step)
    list.step(dotted("levels.0.", step),
              {"body_edge", "repulsion_edge", "attraction_edge", "mesh_edge", "coarse_edge3"});
}

void list_tables(TensorList& list, const std::string& kind) {
  const bool contour = kind == "contourcraft", fine = kind.starts_with("fine");
  list.normaliser("output", 3);
  list.normaliser("node", contour ? 20 : fine ? 17 : 21);
  list.normaliser("mesh_edge", contour ? 5 : 9);
  list.normaliser("world_edge", contour ? 16 : 9);
  if (contour) list.normaliser("coarse_edge", 5), list.normaliser("body_edge", 12);
  list.one("nodetype_embedding.weight", {contour ? 4 : 9, 9});
  if (contour) list.one("edgetype_embedding.weight", {4, 4});
  if (!fine) list.one("vertexlevel_embedding.weight", {contour ? 5 : 4, 4});
}

// 1,000 rows of mean c + 1 and deviation 2 in column c.
std::vector<float> sums(const CheckpointTensor& tensor) {
  std::vector<float> numbers;
  for (std::int64_t c = 0; c < count_of(tensor.shape); ++c) {
    const auto mean = static_cast<float>(c + 1);
    if (tensor.name.ends_with("_acc_count")) numbers.push_back(1000);
    if (tensor.name.ends_with("_num_accumulations")) numbers.push_back(10);
    if (tensor.name.ends_with("_acc_sum")) numbers.push_back(1000 * mean);
    if (tensor.name.ends_with("_acc_sum_squared")) numbers.push_back(1000 * (mean * mean + 4));
  }
  return numbers;
}

float formula_weight(const CheckpointTensor& tensor, float u) {
  const std::string& name = tensor.name;
  if (name.ends_with(".1.weight") && tensor.shape.size() == 1) return 1.f + 0.25f * u;
  if (name.ends_with(".1.bias")) return 0.125f * u;
  if (name.ends_with("_embedding.weight")) return 1.5f * u;
  if (name.ends_with(".weight")) return u * static_cast<float>(1.5 / std::sqrt(static_cast<double>(tensor.shape[1])));
  return 0.25f * u;
}

// Columns of the embeddings that make features (nearly) constant.
void flatten_columns(CheckpointTensor& tensor, std::uint64_t seed) {
  const auto set = [&](std::int64_t column, const std::function<double(std::uint64_t)>& value) {
    for (std::int64_t row = 0; row < tensor.shape[0]; ++row)
      tensor.numbers[row * tensor.shape[1] + column] = static_cast<float>(value(row));
  };
  if (tensor.name == "model.nodetype_embedding.weight") {
    set(5, [&](std::uint64_t row) { return 0.7 + 1e-4 * double(formula_number(seed + 7, row)); });
    set(7, [](std::uint64_t) { return 0.3; });
  }
  if (tensor.name == "model.vertexlevel_embedding.weight") set(2, [](std::uint64_t) { return 0.25; });
  if (tensor.name == "model.edgetype_embedding.weight")
    set(1, [&](std::uint64_t row) { return 0.4 + 1e-4 * double(formula_number(seed + 8, row)); });
}

void write_tensors(PickleText& pickle, const std::vector<CheckpointTensor>& tensors, int first_key) {
  pickle.raw("(");
  for (std::size_t k = 0; k < tensors.size(); ++k) {
    Shape stride(tensors[k].shape.size(), 1);
    for (std::size_t d = stride.size(); d-- > 1;) stride[d - 1] = stride[d] * tensors[k].shape[d];
    const auto count = static_cast<std::int64_t>(tensors[k].numbers.size());
    pickle.text(tensors[k].name)
        .tensor(std::to_string(first_key + static_cast<int>(k)), count, 0, tensors[k].shape, stride);
  }
  pickle.raw("u");
}

// The settings use every kind of plain value that a configuration has.
void write_settings(PickleText& pickle) {
  pickle.text("config").raw("}(").text("device").text("cuda:0").text("lr").number(5e-5).text("frozen").raw("\x88");
  pickle.text("none").raw("N").text("steps").raw("](").integer(1).integer(-70000).integer(70000).raw("\x8a\x05");
  pickle.raw(little_endian(std::uint64_t{1} << 36, 5)).raw("eu");
  pickle.text("optimizer").raw("}(").text("state").raw("}").integer(0).raw("}");
  pickle.text("step").integer(56000).raw("ss").text("param_groups").raw("]}(").text("lr").number(5e-5);
  pickle.text("betas").number(0.9).number(0.999).raw("\x86u").raw("au");
  pickle.text("scheduler").raw("}(").text("lr_lambdas").raw("]Na").text("last").integer(300).raw("u");
}

std::uint32_t zip_checksum(const std::string& bytes) {
  static const std::vector<std::uint32_t> table = [] {
    std::vector<std::uint32_t> made(256);
    for (std::uint32_t k = 0; k < 256; ++k) {
      made[k] = k;
      for (int bit = 0; bit < 8; ++bit) made[k] = made[k] >> 1 ^ (made[k] & 1 ? 0xEDB88320U : 0U);
    }
    return made;
  }();
  std::uint32_t sum = ~0U;
  for (const char byte : bytes) sum = sum >> 8 ^ table[(sum ^ static_cast<unsigned char>(byte)) & 0xFF];
  return ~sum;
}

}  // namespace

std::vector<std::string> published_kinds() { return {"hood", "hood_cvpr", "fine15", "fine48", "contourcraft"}; }

float formula_number(std::uint64_t seed, std::uint64_t k) {
  constexpr std::uint64_t golden = 0x9E3779B97F4A7C15u;
  std::uint64_t z = ((seed << 32) + k) * golden + golden;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
  z = (z ^ z >> 27) * 0x94D049BB133111EBu;
  z ^= z >> 31;
  return static_cast<float>(z >> 40) / 8388608.f - 1.f;
}

std::vector<CheckpointTensor> published_shapes(const std::string& kind, int width) {
  TensorList list(width);
  if (kind == "hood") list_hood(list);
  if (kind == "hood_cvpr") list_hood_cvpr(list);
  if (kind.starts_with("fine")) list_fine(list, width, std::stoi(kind.substr(4)));
  if (kind == "contourcraft") list_contourcraft(list);
  list_tables(list, kind);
  return list.tensors;
}

std::vector<CheckpointTensor> published_tensors(const std::string& kind, int width, std::uint64_t seed) {
  std::vector<CheckpointTensor> tensors = published_shapes(kind, width);
  std::uint64_t k = 0;
  for (CheckpointTensor& tensor : tensors) {
    if (tensor.name.find("_normalizer") != std::string::npos) {
      tensor.numbers = sums(tensor);
      continue;
    }
    for (std::int64_t n = count_of(tensor.shape); n > 0; --n)
      tensor.numbers.push_back(formula_weight(tensor, formula_number(seed, k++)));
    flatten_columns(tensor, seed - static_cast<std::uint64_t>(width));
  }
  return tensors;
}

PickleText& PickleText::remembered(const std::string& key, const std::string& opcodes) {
  const auto [known, fresh] = memo_.emplace(key, static_cast<int>(memo_.size()));
  const int slot = known->second;
  if (!fresh) return raw(slot < 256 ? "h" + little_endian(slot, 1) : "j" + little_endian(slot, 4));
  return raw(opcodes).raw(slot < 256 ? "q" + little_endian(slot, 1) : "r" + little_endian(slot, 4));
}

PickleText& PickleText::text(const std::string& text) {
  return remembered("text " + text, "X" + little_endian(text.size(), 4) + text);
}

PickleText& PickleText::global(const std::string& module, const std::string& name) {
  return remembered("global " + module + name, "c" + module + "\n" + name + "\n");
}

PickleText& PickleText::integer(std::int64_t value) {
  if (value >= 0 && value < 0x100) return raw("K" + little_endian(value, 1));
  if (value >= 0 && value < 0x10000) return raw("M" + little_endian(value, 2));
  return raw("J" + little_endian(static_cast<std::uint64_t>(value), 4));
}

PickleText& PickleText::number(double value) {
  const std::string little = little_endian(std::bit_cast<std::uint64_t>(value), 8);
  return raw("G" + std::string(little.rbegin(), little.rend()));
}

PickleText& PickleText::tuple(const Shape& values) {
  if (values.empty()) return raw(")");
  if (values.size() > 3) raw("(");
  for (const std::int64_t value : values) integer(value);
  return raw(values.size() == 1 ? "\x85" : values.size() == 2 ? "\x86" : values.size() == 3 ? "\x87" : "t");
}

PickleText& PickleText::storage(const std::string& key, std::int64_t count) {
  raw("(").text("storage").global("torch", "FloatStorage").text(key).text("cuda:0").integer(count);
  return raw("tQ");
}

PickleText& PickleText::tensor(const std::string& key, std::int64_t count, std::int64_t offset, const Shape& shape,
                               const Shape& stride) {
  global("torch._utils", "_rebuild_tensor_v2").raw("(").storage(key, count).integer(offset);
  return tuple(shape).tuple(stride).raw("\x89").ordered_dict().raw("tR");
}

std::string stored_zip(const Entries& entries, bool wide) {
  std::string file, directory;
  for (const auto& [name, content] : entries) {
    const std::string common = std::string("\0\0\0\0\0\0\0\0", 8) + little_endian(zip_checksum(content), 4) +
                               little_endian(content.size(), 4) + little_endian(content.size(), 4) +
                               little_endian(name.size(), 2);
    directory +=
        "PK\1\2" + std::string(4, '\0') + common + std::string(12, '\0') + little_endian(file.size(), 4) + name;
    file += "PK\3\4" + std::string(2, '\0') + common + std::string(2, '\0') + name + content;
  }
  const std::uint64_t at = file.size(), count = entries.size();
  file += directory;
  if (wide) {
    const std::uint64_t record = file.size();
    file += "PK\6\6" + little_endian(44, 8) + std::string(12, '\0') + little_endian(count, 8) +
            little_endian(count, 8) + little_endian(directory.size(), 8) + little_endian(at, 8);
    file += "PK\6\7" + std::string(4, '\0') + little_endian(record, 8) + little_endian(1, 4);
  }
  const std::uint64_t said = wide ? 0xFFFF : count, place = wide ? 0xFFFFFFFF : 0;
  return file + "PK\5\6" + std::string(4, '\0') + little_endian(said, 2) + little_endian(said, 2) +
         little_endian(wide ? place : directory.size(), 4) + little_endian(wide ? place : at, 4) + std::string(2, '\0');
}

Entries checkpoint_entries(const std::vector<CheckpointTensor>& tensors, const CheckpointExtras& extras,
                           const std::string& stem) {
  std::vector<CheckpointTensor> all = tensors;
  PickleText pickle;
  pickle.raw("}(").text("training_module").ordered_dict();
  write_tensors(pickle, tensors, 0);
  pickle.raw("}").text("_metadata").ordered_dict().raw("sb");
  if (extras.settings) write_settings(pickle);
  if (extras.material_stack) {
    const std::vector<CheckpointTensor> materials = {{"lame_mu_input", {1}, {0.5f}}, {"v_mass", {2}, {1e-4f, 2e-4f}}};
    pickle.text("material_stack").ordered_dict();
    write_tensors(pickle, materials, static_cast<int>(tensors.size()));
    all.insert(all.end(), materials.begin(), materials.end());
  }
  Entries entries = {{stem + "/data.pkl", pickle.raw("u").finished()}};
  for (std::size_t k = 0; k < all.size(); ++k)
    entries.emplace_back(stem + "/data/" + std::to_string(k), bytes_of(all[k].numbers));
  entries.emplace_back(stem + "/version", "3\n");
  return entries;
}

std::filesystem::path write_checkpoint(const std::filesystem::path& path, const std::vector<CheckpointTensor>& tensors,
                                       const CheckpointExtras& extras) {
  std::ofstream(path, std::ios::binary) << stored_zip(checkpoint_entries(tensors, extras));
  return path;
}

}  // namespace selvedge::fake
