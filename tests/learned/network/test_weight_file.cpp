#include <hdf5.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "collision/geometry/error.hpp"
#include "learned/network/architecture_text.hpp"
#include "learned/network/weight_seal.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_weight_file {

namespace {

Architecture tiny() {
  Architecture a = architecture_preset("contourcraft");
  a.width = 4;
  a.steps.resize(2);
  a.steps[1].filters = {{"body_edge", {"coarse_edge0", "mesh_edge"}}, {"body_edge", {}}};
  return a;
}

WeightFile tiny_file() {
  const Architecture a = tiny();
  return {a, random_weights(a, 3), "iterations: 7\nrate: 1e-3\n", {{"source", "test"}, {"bytes", "12"}}, "0.1.0"};
}

bool same_bits(const Architecture& a, NetworkWeights one, NetworkWeights other) {
  const std::vector<WeightArray> left = weight_arrays(a, one), right = weight_arrays(a, other);
  REQUIRE(left.size() == right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    const auto bytes =
        sizeof(float) * static_cast<std::size_t>(left[i].rows) * static_cast<std::size_t>(left[i].columns);
    if (left[i].name != right[i].name || std::memcmp(left[i].data, right[i].data, bytes) != 0) return false;
  }
  return true;
}

// Replaces a dataset of the file, as another program would, and seals it.
void replace(const std::filesystem::path& path, const std::string& field, hid_t type, std::vector<hsize_t> shape,
             const void* data) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(file, field.c_str(), H5P_DEFAULT);
  if (type >= 0) {
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    const hid_t dataset = H5Dcreate2(file, field.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (data) H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    H5Dclose(dataset);
    H5Sclose(space);
  }
  H5Fclose(file);
  write_seal(path);
}

void replace_text(const std::filesystem::path& path, const std::string& field, const std::string& text) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, text.size());
  replace(path, field, type, {1}, text.data());
  H5Tclose(type);
}

std::string problem(const std::filesystem::path& path) {
  try {
    read_weight_file(path);
  } catch (const Error& error) {
    CHECK(!error.cure().empty());
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("architecture text: every preset is read back as it was", "[learned]") {
  for (const std::string& name : preset_names()) {
    const std::string text = architecture_text(architecture_preset(name));
    const Architecture back = parse_architecture(text, "text");
    CHECK(architecture_text(back) == text);
    CHECK(back.steps.size() == architecture_preset(name).steps.size());
    CHECK(back.features.body_radius == architecture_preset(name).features.body_radius);
  }
  const Architecture back = parse_architecture(architecture_text(tiny()), "text");
  REQUIRE(back.steps[1].filters.size() == 2);
  CHECK(back.steps[1].filters[0].near == std::vector<std::string>{"coarse_edge0", "mesh_edge"});
  CHECK(back.steps[1].filters[1].near.empty());
}

TEST_CASE("architecture text: fields that older texts lack are written only where they say something", "[learned]") {
  const std::string small = architecture_text(architecture_preset("small")),
                    student = architecture_text(architecture_preset("student"));
  for (const std::string line : {"features.base: carried\n", "features.guess_inputs: yes\n"}) {
    CHECK(small.find(line.substr(0, line.find(':'))) == std::string::npos);
    REQUIRE(student.find(line) != std::string::npos);
    std::string without = student;
    without.erase(without.find(line), line.size());
    CHECK(architecture_text(parse_architecture(without, "text")) == without);
  }
  CHECK(parse_architecture(student, "text").features.base == OutputBase::carried);
  CHECK(parse_architecture(small, "text").features.base == OutputBase::motion);
  std::string wrong = student;
  wrong.replace(wrong.find("base: carried"), 13, "base: thrown!");
  CHECK_THROWS_AS(parse_architecture(wrong, "text"), Error);
}

TEST_CASE("architecture text: a line that is wrong is an error that names it", "[learned]") {
  const std::string text = architecture_text(tiny());
  const auto changed = [&text](const std::string& from, const std::string& to) {
    std::string copy = text;
    REQUIRE(copy.find(from) != std::string::npos);
    copy.replace(copy.find(from), from.size(), to);
    try {
      parse_architecture(copy, "text");
    } catch (const Error& error) {
      return error.where();
    }
    return std::string("none");
  };
  CHECK(changed("width: 4", "width: four") == "text: width");
  CHECK(changed("width: 4", "width: 99999999999999999999") == "text: width");
  CHECK(changed("width: 4", "width: 4000000") == "text: width");
  CHECK(changed("width: 4\n", "") == "text: width");
  CHECK(changed("width: 4\n", "width: 4\nwidth: 4\n") == "text: width");
  CHECK(changed("width: 4\n", "width: 4\ndepth: 4\n") == "text: depth");
  CHECK(changed("steps: 2", "steps: 2000000000") == "text: steps");
  CHECK(changed("steps: 2", "steps: -1") == "text: steps");
  CHECK(changed("layer_norm: yes", "layer_norm: 2") == "text: layer_norm");
  CHECK(changed("start_flag", "start") == "text: integration");
  CHECK(changed(" near ", " by ") == "text: step.1");
  CHECK(changed("encoder.0: mesh 9", "encoder.0: ../mesh 9") == "text: encoders");
}

TEST_CASE("weight file: what was written is read back, bit by bit", "[learned]") {
  const fake::Folder folder("weight_file_0");
  WeightFile content = tiny_file();
  content.weights.decoder.layers[0].weight(0, 0) = std::numeric_limits<float>::quiet_NaN();
  content.weights.decoder.layers[0].weight(0, 1) = -0.f;
  content.weights.tables.node.mean[3] = std::numeric_limits<float>::denorm_min();
  const std::filesystem::path path = folder.path / "w.h5";
  write_weight_file(path, content);
  const WeightFile back = read_weight_file(path);
  CHECK(architecture_text(back.architecture) == architecture_text(content.architecture));
  CHECK(back.training == content.training);
  CHECK(back.origin == content.origin);
  CHECK(back.version == content.version);
  CHECK(same_bits(content.architecture, back.weights, content.weights));
  CHECK(H5Fis_hdf5(path.c_str()) > 0);

  const std::string before = fake::whole(path);
  content.weights.decoder.layers.pop_back();
  CHECK_THROWS_AS(write_weight_file(path, content), Error);  // and the file stays as it was
  CHECK(fake::whole(path) == before);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path), std::filesystem::directory_iterator()) == 1);
  CHECK_THROWS_AS(write_weight_file(folder.path / "absent" / "w.h5", tiny_file()), Error);
}

TEST_CASE("weight file: half the size, each trained number changed by 5e-4 of itself at most", "[learned]") {
  const fake::Folder folder("weight_file_half");
  Architecture a = tiny();
  a.width = 32;
  WeightFile content{a, random_weights(a, 3), "", {}, "0.1.0"};
  content.weights.decoder.layers[0].weight(0, 0) = 1e-3f;
  content.weights.tables.node.mean[3] = 1.2345678e-9f;  // statistics keep all of their bits
  write_weight_file(folder.path / "w.h5", content);
  write_weight_file(folder.path / "half.h5", content, WeightStorage::half);
  CHECK(std::filesystem::file_size(folder.path / "half.h5") <
        0.75 * static_cast<double>(std::filesystem::file_size(folder.path / "w.h5")));
  WeightFile back = read_weight_file(folder.path / "half.h5");
  const std::vector<WeightArray> is = weight_arrays(a, back.weights), was = weight_arrays(a, content.weights);
  double largest = 0;
  for (std::size_t i = 0; i < is.size(); ++i)
    for (int k = 0; k < is[i].rows * is[i].columns; ++k) {
      const double change = std::abs(double{is[i].data[k]} - was[i].data[k]);
      const double size = std::abs(double{was[i].data[k]});
      if (is[i].trained && size < 6.1e-5) CHECK(is[i].data[k] == 0);
      if (is[i].trained && size > 6.2e-5) largest = std::max(largest, change / size);
      if (!is[i].trained) REQUIRE(change == 0);
    }
  CHECK(largest < 5e-4);
  CHECK(largest > 1e-5);
  write_weight_file(folder.path / "again.h5", back, WeightStorage::half);
  CHECK(same_bits(a, read_weight_file(folder.path / "again.h5").weights, back.weights));

  content.weights.decoder.layers[0].weight(0, 0) = 7e4f;
  CHECK_THROWS_WITH(write_weight_file(folder.path / "large.h5", content, WeightStorage::half),
                    Catch::Matchers::Contains("65,504"));
}

namespace {

// Cut off, or with one to three bytes changed; most of those where HDF5 keeps its tables.
std::string damaged(std::string bytes, int trial, std::mt19937& random) {
  if (trial % 4 == 0) bytes.resize(random() % bytes.size());
  for (int k = 0; k < trial % 4; ++k) {
    const std::size_t place = random() % (k == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 4096));
    bytes[place] = static_cast<char>(bytes[place] ^ (1 + random() % 255));
  }
  return bytes;
}

void check_damage(const std::string& name, int trials) {
  const fake::Folder folder(name);
  write_weight_file(folder.path / "w.h5", tiny_file());
  const std::string whole = fake::whole(folder.path / "w.h5");
  std::mt19937 random(1);
  for (int trial = 0; trial < trials; ++trial) {
    const std::string bytes = damaged(whole, trial, random);
    if (bytes == whole) continue;
    CHECK(problem(fake::write(folder, "bad.h5", bytes)) != "none");
  }
}

}  // namespace

TEST_CASE("weight file: damage of any kind is an error before HDF5 sees it", "[learned]") {
  check_damage("weight_damage", 200);
  const fake::Folder folder("weight_file_1");
  write_weight_file(folder.path / "w.h5", tiny_file());
  CHECK(problem(fake::write(folder, "bad.h5", "")) != "none");
  CHECK(problem(fake::write(folder, "bad.h5", fake::whole(folder.path / "w.h5") + "x")) != "none");
  CHECK(problem(folder.path / "absent.h5") != "none");
}

TEST_CASE("weight file: two thousand damaged ones", "[.long][weights-long]") {
  check_damage("weight_damage_long", 2000);
}

TEST_CASE("weight file: one that is wrong on purpose is an error that names the field", "[learned]") {
  const fake::Folder folder("weight_file_2");
  const std::filesystem::path path = folder.path / "w.h5";
  const auto after = [&path](const auto& change) {
    write_weight_file(path, tiny_file());
    change();
    return problem(path);
  };
  const std::string field = "weights/steps/001/node/layer0/weight", text = architecture_text(tiny());
  const auto contains = [](const std::string& part) { return Catch::Matchers::Contains(part); };
  const std::vector<float> values(1000);
  CHECK_THAT(after([&] { replace(path, field, -1, {}, nullptr); }), contains(field + ": is missing"));
  CHECK_THAT(after([&] { replace(path, field, H5T_IEEE_F32LE, {4, 23}, values.data()); }), contains(field));
  CHECK_THAT(after([&] { replace(path, field, H5T_IEEE_F32LE, {96}, values.data()); }), contains(field));
  CHECK_THAT(after([&] { replace(path, field, H5T_IEEE_F32LE, {1, 4, 24}, values.data()); }), contains("rank"));
  CHECK_THAT(after([&] { replace(path, field, H5T_IEEE_F64LE, {4, 24}, nullptr); }), contains("32-bit"));
  CHECK_THAT(after([&] { replace(path, field, H5T_IEEE_F32LE, {1u << 31, 1u << 31}, nullptr); }), contains(field));
  CHECK_THAT(after([&] { replace(path, "version", H5T_NATIVE_INT, {1}, values.data()); }), contains("version"));
  CHECK_THAT(after([&] { replace_text(path, "format", "selvedge weights 2"); }), contains("format"));
  CHECK_THAT(after([&] { replace_text(path, "architecture", "width: 4\n"); }), contains("architecture"));
  CHECK_THAT(after([&] { replace_text(path, "architecture", std::string(17 << 20, 'x')); }), contains("longer"));
  std::string wide = text;
  wide.replace(wide.find("width: 4\n"), 9, "width: 4096\n");
  CHECK_THAT(after([&] { replace_text(path, "architecture", wide); }), contains("more than the file can hold"));
}

TEST_CASE("weight file: values that lie elsewhere are refused", "[learned]") {
  const fake::Folder folder("weight_file_3");
  const std::filesystem::path path = folder.path / "w.h5", other = folder.path / "other.h5";
  const std::string field = "weights/decoder/layer2/bias";
  write_weight_file(other, tiny_file());
  write_weight_file(path, tiny_file());
  hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(file, field.c_str(), H5P_DEFAULT);
  H5Lcreate_external(other.c_str(), field.c_str(), file, field.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  write_seal(path);
  CHECK_THAT(problem(path), Catch::Matchers::Contains("another file"));

  fake::write(folder, "raw", std::string(12, 'x'));
  write_weight_file(path, tiny_file());
  file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(file, field.c_str(), H5P_DEFAULT);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(creation, (folder.path / "raw").c_str(), 0, 12);
  const hsize_t three = 3;
  const hid_t space = H5Screate_simple(1, &three, nullptr);
  H5Dclose(H5Dcreate2(file, field.c_str(), H5T_IEEE_F32LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  H5Sclose(space);
  H5Pclose(creation);
  H5Fclose(file);
  write_seal(path);
  CHECK_THAT(problem(path), Catch::Matchers::Contains("does not write"));
}

TEST_CASE("weight file: another file of this program is not taken for a checkpoint", "[learned]") {
  const std::filesystem::path scales = source_root() / "configs/weights/refu.h5";
  CHECK_THROWS_WITH(read_weight_file(scales),
                    Catch::Contains("holds no weights of a network") && Catch::Contains("run.refu.weights"));
}

}  // namespace selvedge::test_weight_file
