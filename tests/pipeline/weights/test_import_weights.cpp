#include "pipeline/weights/import_weights.hpp"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <sstream>

#include "collision/geometry/error.hpp"
#include "tests/pipeline/fake_checkpoint.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"

namespace selvedge::test_import_weights {

using fake::CheckpointTensor;

namespace {

std::filesystem::path parameter_lists() { return fake::open_data() / ".." / "reference" / "checkpoints"; }

std::string import_complaint(const std::filesystem::path& path) {
  return testing::refusal([&] { read_published_weights(path); });
}

using fake::has;

const CheckpointTensor& named(const std::vector<CheckpointTensor>& tensors, const std::string& name) {
  for (const CheckpointTensor& tensor : tensors)
    if (tensor.name == name) return tensor;
  throw std::runtime_error("no tensor " + name);
}

std::vector<float> numbers_of(const ImportedWeights& imported, const std::string& name) {
  NetworkWeights weights = imported.weights;
  for (const WeightArray& array : weight_arrays(imported.architecture, weights))
    if (array.name == name) return {array.data, array.data + std::size_t(array.rows) * array.columns};
  throw std::runtime_error("no array " + name);
}

using Pairs = std::vector<std::pair<std::string, std::string>>;  // of ours and of the checkpoint, without its prefix

Pairs known_pairs(const std::string& kind) {
  Pairs pairs = {{"node_encoder/layer0/weight", "node_encoder.0.layers.0.weight"},
                 {"node_encoder/norm/shift", "node_encoder.1.bias"},
                 {"decoder/layer2/bias", "decoder.layers.4.bias"},
                 {"encoders/mesh/layer1/weight", "edgeset_encoders.mesh.0.layers.2.weight"}};
  const auto add = [&](const std::string& ours, const std::string& theirs) { pairs.emplace_back(ours, theirs); };
  if (kind == "hood") {
    add("steps/000/edges/world_edge/layer0/weight", "levels.0.0.edge_processor_dict.world_edge.0.layers.0.weight");
    add("steps/007/edges/coarse_edge1/layer1/weight", "levels.2.1.edge_processor_dict.coarse_edge1.0.layers.2.weight");
    add("steps/014/node/norm/scale", "levels.4.2.node_processor_dict.node.1.weight");
    add("encoders/coarse2/layer0/bias", "edgeset_encoders.coarse2.0.layers.0.bias");
  }
  if (kind == "hood_cvpr") {
    add("steps/005/edges/coarse_edge0/layer2/bias",
        "processor_steps2.2.edge_processor_dict.coarse_edge0.0.layers.4.bias");
    add("steps/012/node/layer0/weight", "processor_steps5.0.node_processor_dict.node.0.layers.0.weight");
    add("encoders/coarse/layer0/weight", "edgeset_encoders.coarse.0.layers.0.weight");
  }
  if (kind.starts_with("fine")) {
    add("steps/014/edges/world_edge/layer0/weight", "processor_steps.14.world_edge_processor.0.layers.0.weight");
    add("steps/003/node/layer1/bias", "processor_steps.3.node_processor.0.layers.2.bias");
  }
  if (kind == "contourcraft") {
    add("steps/014/edges/attraction_edge/norm/scale", "levels.0.14.edge_processor_dict.attraction_edge.1.weight");
    add("steps/002/edges/body_edge/layer0/weight", "levels.0.2.edge_processor_dict.body_edge.0.layers.0.weight");
    add("steps/009/node/layer0/weight", "levels.0.9.node_processor_dict.node.0.layers.0.weight");
    add("encoders/repulsion/layer0/weight", "edgeset_encoders.repulsion.0.layers.0.weight");
  }
  return pairs;
}

// Some arrays have the numbers of the tensors that stand beside them in the list.
void check_pairs(const ImportedWeights& imported, const std::vector<CheckpointTensor>& tensors) {
  for (const auto& [ours, theirs] : known_pairs(imported.architecture.name)) {
    INFO(ours);
    CHECK(numbers_of(imported, ours) == named(tensors, "model._learned_model." + theirs).numbers);
  }
  CHECK(numbers_of(imported, "embeddings/node_type") == named(tensors, "model.nodetype_embedding.weight").numbers);
}

// While it lives, this process gets no more memory than it has and `bytes`.
class MemoryBound {
 public:
  explicit MemoryBound(std::uint64_t bytes) {
    getrlimit(RLIMIT_DATA, &before_);
    std::istringstream status(fake::whole("/proc/self/status"));
    std::string word;
    std::uint64_t kilobytes = 0;
    while (status >> word && word != "VmData:") continue;
    status >> kilobytes;
    rlimit bound = before_;
    bound.rlim_cur = std::min<rlim_t>(before_.rlim_cur, kilobytes * 1024 + bytes);
    setrlimit(RLIMIT_DATA, &bound);
  }
  ~MemoryBound() { setrlimit(RLIMIT_DATA, &before_); }

 private:
  rlimit before_{};
};

// A checkpoint with one thing wrong. Half of the changes are made inside of the pickle, under a new checksum.
std::string mutated(const fake::Entries& entries, std::mt19937& random) {
  const auto below = [&](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  fake::Entries changed = entries;
  std::string file = fake::stored_zip(entries);
  const bool inside = below(2) == 0;
  std::string& text = inside ? changed[0].second : file;
  const std::size_t at = below(text.size());
  switch (below(6)) {
    case 0:
      text.resize(at);
      break;
    case 1:
      text[at] = static_cast<char>(text[at] ^ 1 << below(8));
      break;
    case 2:
      text.replace(at, std::min<std::size_t>(4, text.size() - at), "\xff\xff\xff\x7f");
      break;
    case 3:
      text.erase(at, 1 + below(64));
      break;
    case 4:
      text.insert(at, text.substr(below(text.size()), 1 + below(4096)));
      break;
    default: {
      const std::size_t global = text.find("cc", at);
      const std::string evil = "cos\nsystem\n(X\2" + std::string(3, '\0') + "ls\x85R";
      text.insert(global == std::string::npos ? at : global, evil);
    }
  }
  return inside ? fake::stored_zip(changed) : file;
}

// Every mutation is an Error, or changed nothing that is read: then the network has the shapes of the whole one.
int refused_mutations(int count, unsigned seed) {
  const fake::Folder folder("mutated_checkpoints");
  std::mt19937 random(seed);
  int refused = 0;
  std::vector<fake::Entries> whole;
  for (const std::string kind : {"hood", "fine15", "contourcraft"})
    whole.push_back(fake::checkpoint_entries(fake::published_tensors(kind, 2, 1), {}, "x"));
  for (int k = 0; k < count; ++k) {
    const fake::Entries& entries = whole[k % whole.size()];
    const auto path = fake::write(folder, "x.pth", mutated(entries, random));
    try {
      const ImportedWeights read = read_published_weights(path);
      check_weights(read.architecture, read.weights, "x");
    } catch (const Error&) {
      ++refused;
    }
  }
  return refused;
}

}  // namespace

TEST_CASE("import: checkpoints of all published kinds become networks", "[import_weights]") {
  const fake::Folder folder("published");
  const std::map<std::string, std::pair<std::size_t, long long>> published = {{"hood", {528, 5'146'852}},
                                                                              {"hood_cvpr", {512, 5'076'964}},
                                                                              {"fine15", {407, 3'854'164}},
                                                                              {"fine48", {1199, 12'027'604}},
                                                                              {"contourcraft", {825, 8'517'451}}};
  for (const std::string& kind : fake::published_kinds()) {
    INFO(kind);
    const auto tensors = fake::published_tensors(kind, 4, 77);
    const auto path = fake::write_checkpoint(folder.path / (kind + ".pth"), tensors);
    const ImportedWeights imported = read_published_weights(path);
    CHECK(imported.architecture.name == kind);
    CHECK(imported.architecture.width == 4);
    CHECK(tensors.size() == published.at(kind).first);
    check_weights(imported.architecture, imported.weights, kind);
    check_pairs(imported, tensors);
    CHECK(imported.file == kind + ".pth");
    CHECK(imported.bytes == std::filesystem::file_size(path));
    CHECK(imported.parts == std::vector<std::string>{"training_module", "config", "optimizer", "scheduler"});
    long long numbers = 0;
    for (const CheckpointTensor& tensor : tensors) numbers += static_cast<long long>(tensor.numbers.size());
    CHECK(imported.numbers == numbers);
    Architecture full = imported.architecture;
    full.width = 128;
    CHECK(parameter_count(full) == published.at(kind).second);
    const Statistics& node = imported.weights.tables.node;
    for (std::size_t c = 0; c < node.mean.size(); ++c) {
      CHECK(node.mean[c] == Approx(c + 1));
      CHECK(node.deviation[c] == Approx(2));
    }
  }
}

TEST_CASE("import: the writer of the tests has the published names and shapes", "[import_weights]") {
  for (const std::string& kind : fake::published_kinds()) {
    const std::string list = fake::whole(parameter_lists() / ((kind == "hood" ? "hood_final" : kind) + ".params.txt"));
    if (list.empty()) {
      WARN("skipped: no lists of parameters in " << parameter_lists());
      return;
    }
    std::string ours;
    for (const CheckpointTensor& tensor : fake::published_shapes(kind, 128)) {
      ours += tensor.name + " [";
      for (std::size_t d = 0; d < tensor.shape.size(); ++d) ours += (d ? ", " : "") + std::to_string(tensor.shape[d]);
      ours += "]\n";
    }
    INFO(kind);
    CHECK(ours == list);
  }
}

TEST_CASE("import: the checkpoints of the parity pack have the numbers of its formula", "[import_weights]") {
  const std::map<std::string, std::string> packs = {{"hood", "hood_w16.pth"}, {"contourcraft", "ccraft_w16.pth"}};
  for (const auto& [kind, file] : packs) {
    const std::filesystem::path path = fake::open_data() / "parity" / file;
    if (!std::filesystem::exists(path)) {
      WARN("skipped: no " << path);
      return;
    }
    INFO(kind);
    const auto tensors = fake::published_tensors(kind, 16, (kind == "hood" ? 1000 : 2000) + 16);
    TorchArchive archive(path);
    const auto& module = std::get<PickleDict>(*find(archive.pickle(), archive.root(), "training_module"));
    REQUIRE(module.entries.size() == tensors.size());
    for (std::size_t k = 0; k < tensors.size(); ++k) {
      const auto& [key, value] = module.entries[k];
      CHECK(std::get<std::string>(archive.pickle().values[key]) == tensors[k].name);
      const auto& tensor = std::get<TorchTensor>(archive.pickle().values[value]);
      CHECK(tensor.shape == tensors[k].shape);
      if (tensors[k].name.find("_normalizer") != std::string::npos) continue;
      INFO(tensors[k].name);
      CHECK(archive.floats(tensor, tensors[k].name) == tensors[k].numbers);
    }
    const ImportedWeights imported = read_published_weights(path);
    CHECK(imported.architecture.name == kind);
    CHECK(imported.architecture.width == 16);
    check_pairs(imported, tensors);
    // Row 9 of the pack's README: rounding of each operation makes this deviation; with one rounding less it
    // is 1.62e-4.
    CHECK(imported.weights.tables.node.deviation[8] == Approx(1.73e-4).epsilon(0.003));
    CHECK(imported.weights.tables.node.deviation[14] == 1e-8f);
  }
}

TEST_CASE("import: a missing, extra or misshapen tensor is named", "[import_weights]") {
  const fake::Folder folder("misshapen");
  for (const std::string& kind : fake::published_kinds()) {
    const auto tensors = fake::published_tensors(kind, 2, 5);
    const auto complaint = [&](const std::vector<CheckpointTensor>& changed) {
      return import_complaint(fake::write_checkpoint(folder.path / "x.pth", changed));
    };
    for (std::size_t k = 0; k < tensors.size(); k += kind == "hood" ? 61 : 151) {
      INFO(kind << ": " << tensors[k].name);
      auto missing = tensors, turned = tensors, renamed = tensors;
      missing.erase(missing.begin() + static_cast<std::ptrdiff_t>(k));
      CHECK(has(complaint(missing), tensors[k].name + ": is missing"));
      turned[k].shape.push_back(1);
      const std::string about_shape = complaint(turned);
      CHECK(has(about_shape, tensors[k].name + ": has the shape ["));
      renamed[k].name += "_2";
      CHECK(has(complaint(renamed), tensors[k].name + ": is missing"));
    }
    auto extra = tensors;
    extra.push_back({"model._learned_model.x.weight", {1}, {0}});
    CHECK(has(complaint(extra), "model._learned_model.x.weight: has no place in a network of kind " + kind));
  }
}

TEST_CASE("import: files of another kind are one error", "[import_weights]") {
  const fake::Folder folder("foreign");
  const auto complaint = [&](const std::vector<CheckpointTensor>& tensors) {
    return import_complaint(fake::write_checkpoint(folder.path / "x.pth", tensors));
  };
  CHECK(has(complaint({{"conv1.weight", {2}, {1, 2}}}), "holds no network of HOOD or ContourCraft"));
  CHECK(has(complaint({}), "holds no network of HOOD or ContourCraft"));
  auto shorter = fake::published_tensors("fine15", 2, 1);
  std::erase_if(shorter, [](const CheckpointTensor& t) { return has(t.name, "processor_steps.14."); });
  CHECK(has(complaint(shorter), "has 14 processor_steps; fine15 has 15 and fine48 has 48"));

  // A width without the numbers for it: nothing is allocated for what is only claimed.
  auto wide = fake::published_tensors("contourcraft", 2, 1);
  for (CheckpointTensor& tensor : wide)
    if (tensor.name == "model._learned_model.decoder.layers.0.weight") tensor.shape = {4096, 0}, tensor.numbers.clear();
  CHECK(has(complaint(wide), "parameters; 64000000 are the most"));

  const fake::PickleText bare =
      fake::PickleText().raw("}(").text("model").ordered_dict().text("epoch").integer(3).raw("u");
  const auto path = fake::write(folder, "y.pth", fake::stored_zip({{"y/data.pkl", bare.finished()}}));
  CHECK(has(import_complaint(path), "has no dictionary training_module; at its top are: model, epoch"));
  const auto list = fake::write(folder, "z.pth", fake::stored_zip({{"z/data.pkl", "\x80\x02]."}}));
  CHECK(has(import_complaint(list), "has no dictionary training_module"));
}

TEST_CASE("import: a fine-tuned file may hold materials; bare ones have no settings", "[import_weights]") {
  const fake::Folder folder("tuned");
  const auto tensors = fake::published_tensors("contourcraft", 2, 5);
  const auto tuned = fake::write_checkpoint(folder.path / "tuned.pth", tensors, {true, true});
  CHECK(read_published_weights(tuned).parts.back() == "material_stack");
  const auto bare = fake::write_checkpoint(folder.path / "bare.pth", tensors, {false, false});
  CHECK(read_published_weights(bare).parts == std::vector<std::string>{"training_module"});
}

TEST_CASE("import: weights that are not finite are read as they are", "[import_weights]") {
  const fake::Folder folder("nan");
  auto tensors = fake::published_tensors("fine15", 2, 5);
  tensors[0].numbers[0] = std::numeric_limits<float>::quiet_NaN();
  const auto imported = read_published_weights(fake::write_checkpoint(folder.path / "n.pth", tensors));
  CHECK(std::isnan(numbers_of(imported, "node_encoder/layer0/weight")[0]));
}

TEST_CASE("import: 100 mutated checkpoints are errors within bounded memory", "[import_weights]") {
  const MemoryBound bound(std::uint64_t{2} << 30);
  const int refused = refused_mutations(100, 1);
  CHECK(refused > 80);
  CHECK(refused_mutations(100, 1) == refused);
}

TEST_CASE("import: 2,000 mutated checkpoints are errors within bounded memory", "[.long][import_weights]") {
  const MemoryBound bound(std::uint64_t{2} << 30);
  CHECK(refused_mutations(2000, 2) > 1600);
}

}  // namespace selvedge::test_import_weights
