#include "pipeline/bodies/body_smpl.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_hdf5.hpp"
#include "pipeline/tools/convert_body.hpp"
#include "tests/pipeline/fake_body.hpp"
#include "tests/pipeline/fake_smpl.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_body_smpl {

using fake::published;

namespace {

constexpr int vertices = 60;

const std::vector<int> smpl_parents{-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};

// A body with as many joints, whose numbers all fit into float.
BodyModel model(int joints, int columns) {
  BodyModel body = fake::body(joints, vertices, columns, true, static_cast<unsigned>(joints));
  const auto round = [](auto&& matrix) { matrix = matrix.template cast<float>().template cast<double>().eval(); };
  round(body.skin.rest);
  round(body.skin.shape_directions);
  round(body.skin.pose_directions);
  for (SkinWeights* m : {&body.skin.weights, &body.regressor})
    for (Eigen::Index k = 0; k < m->nonZeros(); ++k) m->valuePtr()[k] = static_cast<float>(m->valuePtr()[k]);
  if (joints == 24) body.parents = smpl_parents;
  body.joints = smpl_joint_names(joints);
  return body;
}

void check_same(const BodyModel& read, const BodyModel& written, int shapes) {
  CHECK(read.joints == written.joints);
  CHECK(read.parents == written.parents);
  CHECK(read.skin.rest == written.skin.rest);
  CHECK(read.skin.triangles == written.skin.triangles);
  CHECK(read.skin.shape_directions == written.skin.shape_directions.leftCols(shapes));
  CHECK(read.skin.pose_directions == written.skin.pose_directions);
  CHECK(Eigen::MatrixXd(read.regressor) == Eigen::MatrixXd(written.regressor));
  CHECK(read.regressor.nonZeros() == written.regressor.nonZeros());
  CHECK((Eigen::MatrixXd(read.skin.weights) - Eigen::MatrixXd(written.skin.weights)).cwiseAbs().maxCoeff() < 1e-6);
  for (int v = 0; v < vertices; ++v) CHECK(std::abs(read.skin.weights.row(v).sum() - 1) < 1e-15);
}

// The error about a SMPL file that was changed.
template <class Change>
std::string complaint(const fake::Folder& folder, const Change& change) {
  fake::NpzEntries entries = published<double, std::uint32_t>(model(24, 10));
  change(entries);
  try {
    read_smpl(fake::write_npz(folder.path / "SMPL_X.npz", entries));
  } catch (const Error& error) {
    CHECK_FALSE(error.cure().empty());
    const std::string where = error.where(), file = (folder.path / "SMPL_X.npz").string() + ": ";
    CHECK(where.starts_with(file));
    return where.substr(std::min(where.size(), file.size())) + ": " + error.problem() + " | " + error.cure();
  }
  return "";
}

using fake::has;

}  // namespace

TEST_CASE("the joints of the family have their names") {
  const auto smpl = smpl_joint_names(24), smplh = smpl_joint_names(52), smplx = smpl_joint_names(55);
  REQUIRE(smpl.size() == 24);
  REQUIRE(smplh.size() == 52);
  REQUIRE(smplx.size() == 55);
  CHECK(smpl[0] == "pelvis");
  CHECK(smpl[16] == "left_shoulder");
  CHECK(smpl[23] == "right_hand");
  CHECK(smplh[21] == "right_wrist");
  CHECK(smplh[22] == "left_index1");
  CHECK(smplh[36] == "left_thumb3");
  CHECK(smplh[37] == "right_index1");
  CHECK(smplh[51] == "right_thumb3");
  CHECK(smplx[22] == "jaw");
  CHECK(smplx[24] == "right_eye_smplhf");
  CHECK(smplx[25] == "left_index1");
  CHECK(smplx[54] == "right_thumb3");
  for (std::size_t j = 0; j < 22; ++j) CHECK((smpl[j] == smplh[j] && smpl[j] == smplx[j]));
  CHECK(smpl_joint_names(21).empty());
}

TEST_CASE("models of the published layout are read") {
  const fake::Folder folder("smpl");
  struct Case {
    int joints, columns;
  };
  for (const Case c : {Case{24, 10}, Case{24, 300}, Case{52, 16}, Case{55, 20}, Case{55, 400}})
    for (const bool compressed : {false, true}) {
      const BodyModel written = model(c.joints, c.columns);
      INFO(c.joints << " joints, " << c.columns << " columns");
      const auto path = folder.path / "SMPL_NEUTRAL.npz";
      fake::write_npz(path, published<double, std::uint32_t>(written), compressed && c.columns <= 20);
      const BodyModel once = read_smpl(path);
      CHECK(once.name == "SMPL_NEUTRAL");
      check_same(once, written, 10);
      fake::write_npz(path, published<float, std::int64_t>(written));
      check_same(read_smpl(path), written, 10);
      fake::write_npz(path, published<double, std::int32_t>(written));  // the root's parent is -1
      check_same(read_smpl(path, 4), written, 4);
    }
}

TEST_CASE("as many shapes as the file has can be asked for, and no expressions") {
  const fake::Folder folder("smpl_shapes");
  struct Case {
    int joints, columns, shapes;
  };
  for (const Case c : {Case{24, 300, 300}, Case{52, 16, 16}, Case{55, 20, 10}, Case{55, 400, 300}}) {
    const BodyModel written = model(c.joints, c.columns);
    const auto path = fake::write_npz(folder.path / "m.npz", published<float, std::uint32_t>(written));
    check_same(read_smpl(path, c.shapes), written, c.shapes);
    check_same(read_smpl(path, 0), written, 0);
    CHECK_THROWS_AS(read_smpl(path, c.shapes + 1), Error);
    CHECK_THROWS_AS(read_smpl(path, -1), Error);
  }
}

TEST_CASE("a model that was read poses as the one that was written") {
  const fake::Folder folder("smpl_posed");
  const BodyModel written = model(24, 10);
  const BodyModel read = read_smpl(fake::write_npz(folder.path / "m.npz", published<float, std::uint32_t>(written)));
  const Eigen::VectorXd shape = Eigen::VectorXd::LinSpaced(10, -2, 2);
  const BodyPose pose = fake::pose(24);
  CHECK((posed(read, shape, pose) - posed(written, shape, pose)).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("the command writes a model of the family as scenes read it") {
  const fake::Folder folder("smpl_converted");
  const auto path = fake::write_npz(folder.path / "m.npz", published<double, std::uint32_t>(model(24, 10)));
  const BodyReport report = convert_body({path, {}, {}, "m", folder.path / "m.h5"});
  CHECK((report.vertices == vertices && report.joints == 24 && report.shapes == 10 && !report.closed));
  check_same(read_body(folder.path / "m.h5"), read_smpl(path), 10);
}

TEST_CASE("the joint regressor may come as the parts of a sparse matrix") {
  const fake::Folder folder("smpl_sparse");
  const BodyModel written = model(24, 10);
  Eigen::SparseMatrix<double, Eigen::RowMajor> csr = written.regressor;
  Eigen::SparseMatrix<double, Eigen::ColMajor> csc = written.regressor;
  csr.makeCompressed();
  csc.makeCompressed();
  const auto parts = [&](const auto& matrix) {
    fake::NpzEntries entries = published<double, std::uint32_t>(written);
    entries.erase("J_regressor");
    const auto list = [](const auto* begin, Eigen::Index count) { return std::vector(begin, begin + count); };
    const auto count = static_cast<std::size_t>(matrix.nonZeros()), outer = std::size_t(matrix.outerSize() + 1);
    entries["J_regressor_data"] = fake::npy({count}, list(matrix.valuePtr(), matrix.nonZeros()));
    entries["J_regressor_indices"] = fake::npy({count}, list(matrix.innerIndexPtr(), matrix.nonZeros()));
    entries["J_regressor_indptr"] = fake::npy({outer}, list(matrix.outerIndexPtr(), matrix.outerSize() + 1));
    return entries;
  };
  const auto path = folder.path / "m.npz";
  check_same(read_smpl(fake::write_npz(path, parts(csr))), written, 10);
  check_same(read_smpl(fake::write_npz(path, parts(csc))), written, 10);

  const auto refuses = [&](const std::string& field, const std::vector<std::size_t>& shape, std::vector<int> values) {
    fake::NpzEntries entries = parts(csr);
    entries[field] = fake::npy(shape, values);
    CHECK_THROWS_WITH(read_smpl(fake::write_npz(path, entries)), Catch::Contains(field));
  };
  refuses("J_regressor_indptr", {7}, std::vector<int>(7));
  refuses("J_regressor_indptr", {25}, std::vector<int>(25));
  std::vector<int> backwards(25, 80);
  backwards.front() = 0;
  backwards.back() = 72;
  refuses("J_regressor_indptr", {25}, backwards);
  refuses("J_regressor_indices", {72}, std::vector<int>(72, 60));
  refuses("J_regressor_indices", {72}, std::vector<int>(72, -1));
  refuses("J_regressor_indices", {3}, std::vector<int>(3));
}

TEST_CASE("each missing or pickled field is named, with the conversion") {
  const fake::Folder folder("smpl_missing");
  CHECK(complaint(folder, [](fake::NpzEntries&) {}).empty());
  for (const std::string field :
       {"v_template", "f", "shapedirs", "posedirs", "J_regressor", "weights", "kintree_table"}) {
    INFO(field);
    CHECK(has(complaint(folder, [&](fake::NpzEntries& e) { e.erase(field); }), field + ": is missing"));
    const std::string pickled =
        complaint(folder, [&](fake::NpzEntries& e) { e[field] = fake::npy_of("'|O'", false, "()", "\x80\x03}q."); });
    CHECK(has(pickled, field + ": is stored as pickled Python objects"));
    CHECK(has(pickled, "np.savez("));
  }
  for (const std::string field : {"J", "bs_style", "bs_type", "joint2num", "part2num", "hands_meanl"})
    CHECK(complaint(folder, [&](fake::NpzEntries& e) { e.erase(field); }).empty());
}

TEST_CASE("each wrong shape is named") {
  const fake::Folder folder("smpl_shape");
  const auto reshaped = [&](const std::string& field, const std::vector<std::size_t>& shape) {
    std::size_t count = 1;
    for (const std::size_t extent : shape) count *= extent;
    const std::string said =
        complaint(folder, [&](fake::NpzEntries& e) { e[field] = fake::npy(shape, std::vector<double>(count)); });
    INFO(said);
    CHECK(has(said, field + ": has the shape "));
  };
  reshaped("v_template", {60, 4});
  reshaped("v_template", {180});
  reshaped("f", {60, 4});
  reshaped("f", {180});
  reshaped("shapedirs", {59, 3, 10});
  reshaped("shapedirs", {60, 10, 3});
  reshaped("shapedirs", {180, 10});
  reshaped("posedirs", {60, 3, 206});
  reshaped("posedirs", {207, 180});
  reshaped("J_regressor", {60, 24});
  reshaped("J_regressor", {24, 61});
  reshaped("weights", {24, 60});
  reshaped("weights", {60, 23});
  reshaped("kintree_table", {24, 2});
  reshaped("kintree_table", {24});
  const auto fewer = [](fake::NpzEntries& e) { e["shapedirs"] = fake::npy({60, 3, 8}, std::vector<double>(1440)); };
  CHECK(has(complaint(folder, fewer), "shapedirs: has 8 shapes, 10 are asked for"));
  const auto empty = [](fake::NpzEntries& e) { e["v_template"] = fake::npy({0, 3}, std::vector<double>()); };
  CHECK_FALSE(complaint(folder, empty).empty());
}

TEST_CASE("indices out of range, trees that are none and numbers that are not finite are named") {
  const fake::Folder folder("smpl_values");
  const auto with = [&](auto change) {
    return complaint(folder, [&](fake::NpzEntries& entries) {
      BodyModel body = model(24, 10);
      change(body);
      entries = published<double, std::int64_t>(body);
    });
  };
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  CHECK(has(with([](BodyModel& b) { b.skin.triangles(3, 1) = 60; }), "f: has the index 60"));
  CHECK(has(with([](BodyModel& b) { b.skin.triangles(3, 1) = -1; }), "f: has the index -1"));
  CHECK(has(with([&](BodyModel& b) { b.skin.rest(3, 1) = nan; }), "v_template: is not finite at vertex 3"));
  CHECK(has(with([&](BodyModel& b) { b.skin.shape_directions(7, 1) = infinite; }),
            "shapedirs: is not finite at vertex 2"));
  CHECK(has(with([&](BodyModel& b) { b.skin.pose_directions(7, 1) = nan; }), "posedirs: is not finite at vertex 2"));
  CHECK(has(with([&](BodyModel& b) { b.regressor.valuePtr()[4] = nan; }), "J_regressor: is not finite in row 1"));
  CHECK(has(with([&](BodyModel& b) { b.skin.weights.valuePtr()[4] = nan; }), "weights: is not finite in row 1"));
  CHECK(has(with([](BodyModel& b) { b.skin.weights.valuePtr()[0] += 0.1; }), "weights: sums to"));
  CHECK(has(with([](BodyModel& b) { b.parents[5] = 24; }), "kintree_table: has the parent 24"));
  CHECK(has(with([](BodyModel& b) { b.parents[5] = 6; }), "kintree_table: has the parent 6 for joint 5"));
  CHECK(has(with([](BodyModel& b) { b.parents[5] = -1; }), "kintree_table: has the parent -1 for joint 5"));
  CHECK(has(with([](BodyModel& b) { b.parents[0] = 1; }), "kintree_table: has the parent 1 for joint 0"));
  const auto hand = [](fake::NpzEntries& e) { e["kintree_table"] = fake::npy({2, 16}, std::vector<int>(32)); };
  CHECK(has(complaint(folder, hand), "kintree_table: has 16 joints"));
}

}  // namespace selvedge::test_body_smpl
