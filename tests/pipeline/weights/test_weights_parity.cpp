#include "pipeline/weights/weights_parity.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "pipeline/weights/import_weights.hpp"
#include "pipeline/weights/weights_info.hpp"
#include "tests/pipeline/fake_npz.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"

namespace selvedge::test_weights_parity {

namespace {

std::filesystem::path pack(const std::string& name) { return fake::open_data() / "parity" / name; }

bool pack_is_here() {
  if (std::filesystem::exists(pack("README.md"))) return true;
  WARN("skipped: no parity pack in " << pack(""));
  return false;
}

const std::map<std::string, std::vector<std::string>> steps_of_checkpoints = {
    {"hood_w16.pth", {"hood_step0", "hood_step1", "hood_step2", "hood_step_nobody_nopin", "hood_step_training"}},
    {"ccraft_w16.pth",
     {"ccraft_fold_init", "ccraft_fold_nobody", "ccraft_fold_step0", "ccraft_fold_step1", "ccraft_two_step0",
      "ccraft_fold_training"}}};

// Arrays of a step of two triangles without a body.
fake::NpzEntries small_step() {
  const std::vector<float> square = {0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1};
  fake::NpzEntries arrays;
  for (const std::string name : {"pos", "prev_pos", "target_pos", "rest_pos"})
    arrays["cloth_" + name] = fake::npy<float>({4, 3}, square);
  arrays["cloth_velocity"] = fake::npy<float>({4, 3}, std::vector<float>(12, 0));
  arrays["cloth_faces"] = fake::npy<std::int64_t>({2, 3}, {0, 1, 2, 1, 3, 2});
  arrays["cloth_vertex_type"] = fake::npy<std::int64_t>({4}, {0, 0, 0, 3});
  arrays["cloth_mass"] = fake::npy<float>({4}, {0.1f, 0.1f, 0.1f, 0.1f});
  for (const std::string name : {"timestep", "bending_coeff_input", "lame_mu_input", "lame_lambda_input"})
    arrays[name] = fake::npy<float>({}, {0.5f});
  arrays["pred_pos"] = fake::npy<float>({4, 3}, square);
  return arrays;
}

std::string dump_complaint(const fake::Folder& folder, const fake::NpzEntries& arrays) {
  return testing::refusal(
      [&] { read_parity_dump(fake::write_npz(folder.path / "step.npz", arrays), architecture_preset("hood")); });
}

using fake::has;

}  // namespace

TEST_CASE("weights parity: every recorded step, from the checkpoint to the next positions", "[weights_parity]") {
  if (!pack_is_here()) return;
  for (const auto& [checkpoint, steps] : steps_of_checkpoints) {
    const ImportedWeights imported = read_published_weights(pack(checkpoint));
    for (const std::string& step : steps) {
      const ParityReport report =
          weights_parity(imported.architecture, imported.weights,
                         read_parity_dump(pack(step + ".npz"), imported.architecture), &imported.sums);
      INFO(step << "\n" << parity_text(report));
      CHECK(is_clean(report));
      CHECK(report.rows.size() >= 9);  // at least three edge sets, levels, output, positions, velocities
      const auto json = nlohmann::json::parse(parity_json(report));
      CHECK(json["same"] == true);
      CHECK(json["quantities"].size() == report.rows.size());
    }
  }
}

TEST_CASE("weights parity: a changed weight or another step is seen", "[weights_parity]") {
  if (!pack_is_here()) return;
  ImportedWeights imported = read_published_weights(pack("hood_w16.pth"));
  const ParityDump dump = read_parity_dump(pack("hood_step1.npz"), imported.architecture);
  imported.weights.decoder.layers[2].bias[1] += 1e-4f;
  CHECK_FALSE(is_clean(weights_parity(imported.architecture, imported.weights, dump)));
  imported.weights.decoder.layers[2].bias[1] = std::numeric_limits<float>::quiet_NaN();
  const ParityReport report = weights_parity(imported.architecture, imported.weights, dump);
  CHECK_FALSE(is_clean(report));
  CHECK(nlohmann::json::parse(parity_json(report))["same"] == false);

  const ImportedWeights whole = read_published_weights(pack("hood_w16.pth"));
  ParityDump moved = read_parity_dump(pack("hood_step1.npz"), whole.architecture);
  moved.state.body.array() += 0.02;
  CHECK_FALSE(is_clean(weights_parity(whole.architecture, whole.weights, moved)));
}

TEST_CASE("weights parity: a step that gathers statistics needs the sums of a checkpoint", "[weights_parity]") {
  if (!pack_is_here()) return;
  ImportedWeights imported = read_published_weights(pack("hood_w16.pth"));
  const ParityDump dump = read_parity_dump(pack("hood_step_training.npz"), imported.architecture);
  CHECK(dump.gathered);
  CHECK_THROWS_WITH(weights_parity(imported.architecture, imported.weights, dump),
                    Catch::Contains("while statistics were gathered"));
  imported.sums.world_edge.sum[2] *= 1.01f;
  CHECK_FALSE(is_clean(weights_parity(imported.architecture, imported.weights, dump, &imported.sums)));
}

TEST_CASE("weights parity: dumps that are wrong are one error that names the array", "[weights_parity]") {
  const fake::Folder folder("parity_dump");
  CHECK(dump_complaint(folder, small_step()) == "");
  for (const auto& [name, bytes] : small_step()) {
    if (name == "pred_pos") continue;  // read later
    auto arrays = small_step();
    arrays.erase(name);
    CHECK(has(dump_complaint(folder, arrays), "step.npz: " + name + ": is missing"));
  }
  const auto with = [&](const std::string& name, const std::string& bytes) {
    auto arrays = small_step();
    arrays[name] = bytes;
    return dump_complaint(folder, arrays);
  };
  CHECK(has(with("cloth_velocity", fake::npy<float>({3, 3}, std::vector<float>(9, 0))), "instead of [4, 3]"));
  CHECK(has(with("cloth_pos", fake::npy<float>({12}, std::vector<float>(12, 0))), "cloth_pos: has the shape [12]"));
  CHECK(has(with("cloth_faces", fake::npy<std::int64_t>({1, 3}, {0, 1, 4})), "has 4, which is not in 0 to 3"));
  CHECK(has(with("cloth_faces", fake::npy<std::int64_t>({1, 3}, {0, -1, 2})), "has -1"));
  CHECK(has(with("cloth_faces", fake::npy<std::int64_t>({1, 3}, {0, 1, 1})), "one corner twice"));
  CHECK(has(with("cloth_faces", fake::npy<std::int64_t>({4}, {0, 1, 2, 3})), "no rows of three"));
  CHECK(has(with("cloth_vertex_type", fake::npy<std::int64_t>({3}, {0, 0, 0})), "has 3 values for 4 vertices"));
  CHECK(has(with("timestep", fake::npy<float>({2}, {1, 1})), "has 2 numbers, not 1"));
  CHECK(has(with("coarse0_edge_index", fake::npy<std::int64_t>({2, 1}, {0, 1})), "follows from no centre"));
  CHECK(has(with("body_pos", fake::npy<float>({1, 3}, {0, 0, 0})), "body_prev_pos: is missing"));
}

TEST_CASE("weights parity: a step of two triangles is taken", "[weights_parity]") {
  const fake::Folder folder("parity_small");
  Architecture hood = architecture_preset("hood");
  hood.width = 8;
  const NetworkWeights weights = random_weights(hood, 3);
  const auto path = fake::write_npz(folder.path / "step.npz", small_step());
  const ParityReport report = weights_parity(hood, weights, read_parity_dump(path, hood));
  CHECK(report.cloth_vertices == 4);
  CHECK(report.rows.size() == 1);
  CHECK_FALSE(is_clean(report));  // random weights do not leave the cloth where it is
}

TEST_CASE("weights: an imported checkpoint goes through its file unchanged, and info says what is in it",
          "[weights_parity]") {
  if (!pack_is_here()) return;
  const fake::Folder folder("weights_info");
  ImportedWeights imported = read_published_weights(pack("ccraft_w16.pth"));
  WeightFile file{imported.architecture, imported.weights, "", origin_of(imported), "1.2.3"};
  write_weight_file(folder.path / "w.h5", file);
  WeightFile read = read_weight_file(folder.path / "w.h5");
  const auto before = weight_arrays(file.architecture, file.weights),
             after = weight_arrays(read.architecture, read.weights);
  REQUIRE(before.size() == after.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    INFO(before[k].name);
    const std::size_t bytes = sizeof(float) * std::size_t(before[k].rows) * before[k].columns;
    CHECK(std::memcmp(before[k].data, after[k].data, bytes) == 0);
  }
  const WeightsInfo info = weights_info(read);
  CHECK(info.nonfinite == 0);
  CHECK(info.constant_columns >= 1);  // node column 14 of the pack
  const std::string text = weights_info_text(info);
  CHECK(has(text, "contourcraft"));
  CHECK(has(text, "15 of attraction_edge, body_edge, coarse_edge3, mesh_edge, repulsion_edge"));
  CHECK(has(text, "ccraft_w16.pth"));
  const auto json = nlohmann::json::parse(weights_info_json(info));
  CHECK(json["parameters"] == 141867);
  CHECK(json["width"] == 16);
  CHECK(json["origin"]["its parts"] == "training_module, config, optimizer, scheduler");
  file.weights.decoder.layers[0].bias[0] = std::numeric_limits<float>::infinity();
  CHECK(weights_info(file).nonfinite == 1);
}

}  // namespace selvedge::test_weights_parity
